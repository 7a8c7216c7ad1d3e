//! Opening files: dialog, drag and drop, recent files, command line; read in the background.
//!
//! Wiring: [`OpenFiles`] asks for files (`document` asks back where that loses work); `Tools` starts a worker thread per request and `ApplyEdits` takes
//! what it delivers and spawns it (see `object`). Settings are read at start and written when they change.

mod dialog;
mod drop;
mod load;
mod reader;
mod store;

use std::path::PathBuf;

use bevy::prelude::*;

pub use dialog::{FileDialogs, Picked, Purpose};
pub use load::{LoadProgress, Loading, close_all};
pub use reader::{LoadError, LoadedScene, SceneFile, read_source};
pub use store::{SettingsStore, remember};

use super::EditorSystems;

/// What to open.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// A file.
    File(PathBuf),
    /// The built-in demo scene.
    Demo,
}

/// Asks for files to be opened.
#[derive(Message, Debug, Clone, PartialEq, Eq)]
pub struct OpenFiles {
    /// What to open, in order.
    pub sources: Vec<Source>,
    /// Whether what is open now is closed first (once the first file is read without error).
    pub replace: bool,
}

/// The moment in `Tools` when files begin to be read.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct StartLoading;

/// Adds files.
pub struct FilesPlugin;

impl Plugin for FilesPlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<OpenFiles>()
            .init_resource::<Loading>()
            .init_resource::<FileDialogs>()
            .init_resource::<SettingsStore>()
            .add_systems(Startup, store::read)
            .add_systems(Update, drop::open_dropped.in_set(EditorSystems::Input))
            .add_systems(
                Update,
                (dialog::command_requests, load::command_requests, load::start)
                    .chain()
                    .in_set(StartLoading)
                    .in_set(EditorSystems::Tools),
            )
            .add_systems(Update, load::finish.in_set(EditorSystems::ApplyEdits))
            .add_systems(Last, store::write_changed);
    }
}
