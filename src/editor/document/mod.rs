//! The open document as a file: saving it, and never losing it.
//!
//! Wiring: `Input` stops what would lose unsaved work (`guard`) until the [`Question`] is answered; `Tools` serves
//! saving, which takes a [`Snapshot`] and writes it on a thread; `ApplyEdits` takes the result. While there is
//! unsaved work a copy is kept to recover from (`autosave`); the title says whose window it is.

mod autosave;
mod guard;
mod merge;
mod naming;
mod question;
mod save;
mod snapshot;
mod title;

use std::path::PathBuf;

use bevy::prelude::*;

pub use autosave::Recovery;
pub use guard::{Discarding, Proceed};
pub use naming::Naming;
pub use question::{Answer, Question, Questions};
pub use save::{SaveRequest, Saving, Target};
pub use snapshot::{Snapshot, restore};
pub use title::document_name;

use super::EditorSystems;
use crate::scene::file::Fingerprint;
use crate::scene::settings::ViewRecord;

/// Which file the document belongs to, and what of it the editor only carries along.
#[derive(Resource, Debug, Default)]
pub struct DocumentFile {
    /// The scene file; none before the first save.
    pub path: Option<PathBuf>,
    /// What it was like when last read or written.
    pub fingerprint: Option<Fingerprint>,
    /// Views to come back to.
    pub views: Vec<ViewRecord>,
    /// How gaps are drawn, by name.
    pub gaps: Option<String>,
    /// Tells documents of this run apart that have no path.
    pub number: u64,
    /// The copy it was recovered from: removed when there is a newer one, or it was saved or closed.
    pub recovered: Option<PathBuf>,
}

impl DocumentFile {
    /// Another document.
    pub fn start_over(&mut self) {
        *self = Self { number: self.number + 1, ..Self::default() };
    }
}

/// Adds the document.
pub struct DocumentPlugin;

impl Plugin for DocumentPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<DocumentFile>()
            .init_resource::<Questions>()
            .init_resource::<Saving>()
            .init_resource::<Recovery>()
            .init_resource::<autosave::Autosave>()
            .add_message::<Proceed>()
            .add_message::<Answer>()
            .add_message::<SaveRequest>()
            .add_message::<bevy::window::WindowCloseRequested>()
            .add_systems(PostStartup, autosave::offer)
            .add_systems(
                Update,
                (guard::stop, question::answer, save::command_requests, save::start)
                    .chain()
                    .in_set(EditorSystems::Tools)
                    .before(super::files::StartLoading),
            )
            .add_systems(Update, (save::finish, guard::proceed).chain().in_set(EditorSystems::ApplyEdits))
            .add_systems(
                Update,
                (autosave::keep, autosave::finish, title::show).in_set(EditorSystems::Present),
            );
    }
}
