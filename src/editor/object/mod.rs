//! What is in the editor's world: models, parts, faces and loops as entities.
//!
//! Wiring: resource [`Scene`] (the index). No systems: entities are spawned by `files` and read by all.

mod components;
mod scene;
mod spawn;

use bevy::prelude::*;

pub use components::{AuthoredFace, DerivedFace, Model, Part, Shown, TrimLoop};
pub use scene::{ModelEntry, PartEntry, Scene};
pub use spawn::{LoadedModel, despawn_model, spawn_model};

/// Adds the scene index.
pub struct ObjectPlugin;

impl Plugin for ObjectPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Scene>();
    }
}
