//! The interactive editor: a window with the model, its tree, properties and report.
//!
//! One folder per capability; each `mod.rs` is the capability's wiring diagram. Data flows one way:
//! `files` (records) -> `object` (authored components) -> `derive` (derived components) -> `render` (extract,
//! upload, passes). `panels` read state and write messages; `tools` is the table of commands that menus, keys
//! and toolbar are made from; `selection`, `camera` and `settings` serve them. `render` knows nothing of files.

#![expect(clippy::too_many_arguments, reason = "systems state what they read and write in their parameters")]

pub mod camera;
pub mod derive;
pub mod diagnostics;
pub mod document;
pub mod editing;
pub mod elements;
pub mod files;
pub mod handles;
pub mod inspection;
pub mod object;
pub mod panels;
pub mod picking;
pub mod problems;
pub mod redraw;
pub mod render;
pub mod selection;
pub mod settings;
mod startup;
pub mod tessellation;
pub mod theme;
mod threads;
pub mod tools;
pub mod uv;
pub mod viewport;

use bevy::prelude::*;
use bevy_egui::EguiPlugin;

pub use startup::{EditorOptions, StartError, run};

/// The order of work in `Update`.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EditorSystems {
    /// Keys, mouse, dropped files: from input to messages and camera motions.
    Input,
    /// Commands: each capability serves its own.
    Tools,
    /// Authored and interaction components change: models spawned, selection and visibility applied.
    ApplyEdits,
    /// Derived components follow the authored ones.
    Derive,
    /// Flights, cameras and notices: what the frame will show.
    Present,
}

/// Within [`EditorSystems::Input`]: motions that need to know who has the pointer.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct NavigationInput;

/// The whole editor. Without a window (tests) everything but panels, rendering and input from egui.
pub struct EditorPlugin {
    /// Whether there is a window with panels.
    pub windowed: bool,
}

impl Plugin for EditorPlugin {
    fn build(&self, app: &mut App) {
        app.configure_sets(
            Update,
            (
                EditorSystems::Input,
                EditorSystems::Tools,
                EditorSystems::ApplyEdits,
                EditorSystems::Derive,
                EditorSystems::Present,
            )
                .chain(),
        )
        .configure_sets(Update, NavigationInput.in_set(EditorSystems::Input));
        app.add_plugins((
            object::ObjectPlugin,
            derive::DerivePlugin,
            editing::EditingPlugin,
            selection::SelectionPlugin,
            elements::ElementsPlugin,
            settings::SettingsPlugin,
            tools::ToolsPlugin,
            (files::FilesPlugin, document::DocumentPlugin),
            problems::ProblemsPlugin,
            camera::CameraPlugin,
            uv::UvPlugin,
            handles::HandlesPlugin,
            picking::PickingPlugin { windowed: self.windowed },
            (inspection::InspectionPlugin, tessellation::TessellationPlugin),
            redraw::RedrawPlugin,
        ))
        .init_resource::<panels::Notices>()
        .init_resource::<diagnostics::RenderFigures>();
        if self.windowed {
            app.add_plugins((
                EguiPlugin::default(),
                panels::PanelsPlugin,
                render::RenderPlugin,
                diagnostics::DiagnosticsPlugin,
                threads::OneThreadPlugin,
            ));
        }
    }
}
