//! Editing: operations asked for become edits, edits become components, and steps of a history.
//!
//! Wiring: [`EditRequest`]s come from the uv panel, handles, menus and keys; `ApplyEdits` serves them in order, on
//! the components themselves (`apply`), so that `Derive` finds exactly the faces that changed. A drag is
//! `Begin`, any number of `Preview`s, and `Commit` or `Cancel`: one step, or none.
//!
//! Invariant: outside of a drag the components are what the edits of the history led to.

mod apply;
mod commands;
mod document;
mod operations;
mod prompt;
mod session;
mod structure;
mod values;

use bevy::prelude::*;

pub use apply::apply_edit;
pub use commands::{Clipboard, RunEdit};
pub use document::OpenDocument;
pub use operations::{Target, curves_meant, operations};
pub use prompt::Prompt;
pub use session::{ApplyRequests, Editing, SavePoint};

use super::EditorSystems;
use crate::scene::Edit;
use crate::scene::operation::Operation;

/// Asks for a change of the document. Served in order; what does not fit the moment is ignored.
#[derive(Message, Debug, Clone, PartialEq)]
pub enum EditRequest {
    /// Does it, as one step. Ends a drag first, without a step.
    Perform(Operation),
    /// Does all of them as one step of this name, or none.
    PerformAll(String, Vec<Operation>),
    /// Does a change that was worked out elsewhere, as one step. Ends a drag first, without a step.
    Apply(Edit),
    /// Starts a drag.
    Begin,
    /// Shows the document as it was at `Begin` with this done to it, instead of the last preview. When it is
    /// refused the last preview stays.
    Preview(Operation),
    /// Ends the drag: what is shown becomes one step.
    Commit,
    /// Ends the drag and takes it back.
    Cancel,
    /// Takes the last step back; during a drag the drag.
    Undo,
    /// Does the step undone last again.
    Redo,
    /// Undoes or redoes until this many steps are in effect.
    GoTo(usize),
}

/// Adds editing.
pub struct EditingPlugin;

impl Plugin for EditingPlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<EditRequest>()
            .init_resource::<Editing>()
            .add_message::<RunEdit>()
            .init_resource::<Prompt>()
            .init_resource::<Clipboard>()
            .add_systems(
                Update,
                (session::command_requests, commands::command_requests, commands::run)
                    .chain()
                    .in_set(EditorSystems::Tools),
            )
            .add_systems(Update, session::serve.in_set(ApplyRequests).in_set(EditorSystems::ApplyEdits));
    }
}
