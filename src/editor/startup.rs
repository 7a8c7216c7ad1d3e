//! Starting the editor: what the machine must have, said plainly when it does not.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::settings::{Backends, RenderCreation, WgpuSettings};
use bevy::window::{ExitCondition, PresentMode, WindowResolution};

use super::EditorPlugin;
use super::document::Recovery;
use super::files::{OpenFiles, SettingsStore, Source};

/// How the editor is started.
#[derive(Debug, Clone, Default)]
pub struct EditorOptions {
    /// Files to open; the path `demo` is the built-in demo scene, which is also opened when there are none.
    pub files: Vec<PathBuf>,
}

/// Why the editor cannot start.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StartError {
    /// No X server or Wayland compositor.
    #[error(
        "no display: neither DISPLAY nor WAYLAND_DISPLAY is set. Start the editor from a desktop session, or \
         without one under `xvfb-run` (package xvfb). `hairline render` makes pictures without a window."
    )]
    NoDisplay,
    /// The display named in the environment does not answer.
    #[error("cannot connect to the display {name}: is it running, and may this user connect?")]
    DisplayRefused {
        /// What the environment says.
        name: String,
    },
    /// No Vulkan driver.
    #[error(
        "no Vulkan driver found. Install one for your graphics card, or the software driver: \
         `sudo apt-get install mesa-vulkan-drivers`. `hairline render --backend cpu` needs none."
    )]
    NoVulkan,
    /// The event loop ended with an error.
    #[error("the window ended with error {code}")]
    Ended {
        /// What the event loop says.
        code: u8,
    },
}

/// Runs the editor until its window is closed.
///
/// # Errors
/// When the machine lacks what a window needs, or the editor ended with an error.
pub fn run(options: EditorOptions) -> Result<(), StartError> {
    check_display()?;
    check_vulkan()?;
    // Frames cost most on software drivers, which gain nothing from a main world that runs ahead.
    let plugins = DefaultPlugins
        .set(WindowPlugin {
            primary_window: Some(window()),
            // Unsaved work is asked about first.
            close_when_requested: false,
            exit_condition: ExitCondition::DontExit,
            ..default()
        })
        .set(RenderPlugin {
            render_creation: RenderCreation::Automatic(Box::new(WgpuSettings {
                backends: Some(Backends::VULKAN),
                ..default()
            })),
            synchronous_pipeline_compilation: true,
            ..default()
        })
        .set(bevy::log::LogPlugin {
            filter: "error,hairline=warn".into(),
            level: bevy::log::Level::WARN,
            ..default()
        })
        .disable::<PipelinedRenderingPlugin>();
    let mut app = App::new();
    app.add_plugins(plugins)
        .insert_resource(SettingsStore::of_user())
        .insert_resource(Recovery::of_user())
        .add_plugins(EditorPlugin { windowed: true });
    let source = |path: &PathBuf| match path == Path::new("demo") {
        true => Source::Demo,
        false => Source::File(path.clone()),
    };
    let sources = match options.files.as_slice() {
        [] => vec![Source::Demo],
        files => files.iter().map(source).collect(),
    };
    app.world_mut().write_message(OpenFiles { sources, replace: true });
    match app.run() {
        AppExit::Success => Ok(()),
        AppExit::Error(code) => Err(StartError::Ended { code: code.get() }),
    }
}

fn window() -> Window {
    Window {
        title: "Hairline".into(),
        name: Some("hairline".into()),
        resolution: WindowResolution::new(1440, 900),
        present_mode: PresentMode::AutoVsync,
        resize_constraints: WindowResizeConstraints { min_width: 640.0, min_height: 420.0, ..default() },
        ..default()
    }
}

/// Whether there is a display to open a window on.
///
/// # Errors
/// [`StartError::NoDisplay`] and [`StartError::DisplayRefused`].
fn check_display() -> Result<(), StartError> {
    if cfg!(not(target_os = "linux")) {
        return Ok(());
    }
    let variable = |name| std::env::var(name).ok().filter(|v| !v.is_empty());
    match (variable("WAYLAND_DISPLAY").or_else(|| variable("WAYLAND_SOCKET")), variable("DISPLAY")) {
        (Some(_), _) => Ok(()),
        (None, Some(name)) if x11_answers(&name) => Ok(()),
        (None, Some(name)) => Err(StartError::DisplayRefused { name }),
        (None, None) => Err(StartError::NoDisplay),
    }
}

/// Whether the X server of a local display name like `:1.0` accepts connections; remote ones are believed.
fn x11_answers(name: &str) -> bool {
    let Some(local) = name.strip_prefix(':').or_else(|| name.strip_prefix("unix:")) else { return true };
    let number = local.split('.').next().unwrap_or(local);
    let path = format!("/tmp/.X11-unix/X{number}");
    #[cfg(target_os = "linux")]
    {
        use std::os::linux::net::SocketAddrExt;
        use std::os::unix::net::{SocketAddr, UnixStream};
        let by_file = UnixStream::connect(&path).is_ok();
        by_file
            || SocketAddr::from_abstract_name(path.as_bytes())
                .is_ok_and(|address| UnixStream::connect_addr(&address).is_ok())
    }
    #[cfg(not(target_os = "linux"))]
    {
        let _ = path;
        true
    }
}

/// Whether wgpu finds an adapter.
///
/// # Errors
/// [`StartError::NoVulkan`].
fn check_vulkan() -> Result<(), StartError> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::VULKAN;
    let instance = wgpu::Instance::new(descriptor);
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
    if adapters.is_empty() { Err(StartError::NoVulkan) } else { Ok(()) }
}
