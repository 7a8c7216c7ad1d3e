//! Which faces are selected, hovered and shown.
//!
//! Wiring: messages [`SelectRequest`] and [`VisibilityRequest`] come from the viewport, the tree, the
//! report and the command table; `ApplyEdits` turns them into the resource [`Selection`] and the component
//! [`Shown`](super::object::Shown). Nothing else writes those.

mod set;
mod visibility;

use bevy::prelude::*;

pub use set::{SelectMode, SelectRequest, Selection};
pub use visibility::VisibilityRequest;

use super::EditorSystems;

/// Within [`EditorSystems::ApplyEdits`]: after it the selection is that of this frame.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ApplySelection;

/// Adds selection and visibility.
pub struct SelectionPlugin;

impl Plugin for SelectionPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Selection>()
            .add_message::<SelectRequest>()
            .add_message::<VisibilityRequest>()
            .configure_sets(Update, ApplySelection.in_set(EditorSystems::ApplyEdits))
            .add_systems(
                Update,
                (set::command_requests, visibility::command_requests).in_set(EditorSystems::Tools),
            )
            .add_systems(
                Update,
                (set::drop_despawned, set::apply, visibility::apply).chain().in_set(ApplySelection),
            );
    }
}
