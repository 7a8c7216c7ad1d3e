//! Settings are kept between runs, and nothing depends on that.

use bevy::input::InputPlugin;
use bevy::prelude::*;
use bevy::window::{FileDragAndDrop, RequestRedraw};
use hairline::editor::EditorPlugin;
use hairline::editor::files::{SettingsStore, remember};
use hairline::editor::settings::Settings;
use hairline::editor::tools::{Action, CommandRequest};

fn app(path: std::path::PathBuf) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, InputPlugin))
        .add_message::<FileDragAndDrop>()
        .add_message::<RequestRedraw>()
        .insert_resource(SettingsStore { path: Some(path) })
        .add_plugins(EditorPlugin { windowed: false });
    app.update();
    app
}

#[test]
fn choices_survive_a_restart() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("deep").join("settings.json");
    let mut first = app(path.clone());
    first.world_mut().write_message(CommandRequest(Action::ToggleTheme));
    first.update();
    remember(&mut first.world_mut().resource_mut::<Settings>(), std::path::Path::new("/models/a.igs"));
    {
        let choices = &mut first.world_mut().resource_mut::<Settings>().tessellation;
        (choices.tolerance_mm, choices.wipe) = (Some(0.25), 0.75);
        choices.view = hairline::editor::tessellation::TessellationView::Wipe;
    }
    first.update();
    let second = app(path);
    let settings = second.world().resource::<Settings>();
    assert!(settings.light);
    assert_eq!((settings.tessellation.tolerance_mm, settings.tessellation.wipe), (Some(0.25), 0.75));
    // Meshing a large model takes a while: nobody asked for it yet.
    assert_eq!(settings.tessellation.view, hairline::editor::tessellation::TessellationView::Off);
    assert_eq!(settings.recent, [std::path::PathBuf::from("/models/a.igs")]);
}

#[test]
fn spoiled_settings_mean_defaults() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("settings.json");
    std::fs::write(&path, b"{ not json").expect("writable");
    let app = app(path);
    assert_eq!(*app.world().resource::<Settings>(), Settings::default());
}

#[test]
fn recent_files_are_few_and_latest_first() {
    let mut settings = Settings::default();
    for i in 0..20 {
        remember(&mut settings, std::path::Path::new(&format!("/models/{i}.igs")));
    }
    remember(&mut settings, std::path::Path::new("/models/15.igs"));
    assert_eq!(settings.recent.len(), 10);
    assert_eq!(settings.recent[0], std::path::PathBuf::from("/models/15.igs"));
    assert_eq!(settings.recent.iter().filter(|p| p.ends_with("15.igs")).count(), 1);
}
