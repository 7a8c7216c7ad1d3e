//! What is in the editor's world: models, parts, faces and loops as entities.
//!
//! Wiring: resource [`Scene`] (the index), [`Changes`] and the message [`FaceChange`], both written by the hooks
//! of the components. No systems: entities are spawned by `files` and `editing` and read by all.

mod changes;
mod components;
mod records;
mod regroup;
mod scene;
mod spawn;

use bevy::prelude::*;

pub use changes::{Changes, FaceChange};
pub use components::{AuthoredFace, DerivedFace, FacePlace, Model, Part, Shown, TrimLoop};
pub use records::{FaceParts, Records};
pub use regroup::regroup;
pub use scene::{ModelEntry, PartEntry, Scene};
pub use spawn::{LoadedModel, despawn_model, insert_model, spawn_face, spawn_model};

/// Adds the scene index.
pub struct ObjectPlugin;

impl Plugin for ObjectPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Scene>().init_resource::<Changes>().add_message::<FaceChange>();
    }
}
