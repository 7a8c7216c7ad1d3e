//! The tessellation beside the exact surfaces: overlay, wireframe, A/B wipe, error heat map.
//!
//! Wiring: while a view of it is on, `follow` keeps [`Tessellation`] true to the scene: a thread meshes (`job`), shows what it
//! has, measures it, and after an edit does so again for what the edit touched. `wipe` drags the divider; `export` writes
//! mesh files; `render` draws [`Made`] in the passes of the exact picture. Panels read [`Tessellation`] and write
//! [`TessellationRequest`]s. Nothing here is part of the document: there are no steps to undo.

mod choices;
mod export;
mod follow;
mod job;
mod made;
mod wipe;

use std::path::PathBuf;

use bevy::prelude::*;

pub use choices::{BadTolerance, TessellationChoices, TessellationView, automatic_tolerance};
pub use export::MeshFormat;
pub use follow::{Progress, Stop, Tessellation};
pub use made::{Figures, Largest, Made};
pub use wipe::Wipe;

use super::EditorSystems;

/// What panels ask for.
#[derive(Message, Debug, Clone, PartialEq)]
pub enum TessellationRequest {
    /// Show or make it in another way.
    Choose(TessellationChoices),
    /// Stop the work under way.
    Cancel,
    /// Start what was stopped again.
    Again,
    /// Start again with room for this many triangles.
    Allow(usize),
    /// Fly to where the deviation is largest.
    ShowLargest,
    /// Write the mesh to a file.
    Export(PathBuf),
}

/// Adds the tessellation.
pub struct TessellationPlugin;

impl Plugin for TessellationPlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<TessellationRequest>()
            .init_resource::<Tessellation>()
            .init_resource::<Wipe>()
            .init_resource::<export::Exporting>()
            .add_systems(Update, wipe::drag.in_set(super::NavigationInput).after(super::handles::HandleInput))
            .add_systems(
                Update,
                (choices::command_requests, export::command_requests).in_set(EditorSystems::Tools),
            )
            .add_systems(
                Update,
                (follow::serve, follow::follow, export::serve)
                    .chain()
                    .after(EditorSystems::Derive)
                    .before(EditorSystems::Present),
            );
    }
}
