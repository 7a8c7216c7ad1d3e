//! From records to derived data: patches, trimming structure, area, bounds.
//!
//! Wiring: `Derive` works on faces whose record changed and on nothing else; the box around all that is
//! shown follows in [`SceneBounds`], and a thread works out areas afterwards. Imports derive on their own thread before the faces are spawned.

mod bounds;
mod derived;
mod measure;

use std::sync::Arc;

use bevy::prelude::*;

pub use bounds::SceneBounds;
pub use derived::{Derived, Measures};

use super::EditorSystems;
use super::object::{AuthoredFace, DerivedFace};

/// Adds deriving.
pub struct DerivePlugin;

impl Plugin for DerivePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<SceneBounds>().add_systems(
            Update,
            (derive_changed, bounds::update, measure::start).chain().in_set(EditorSystems::Derive),
        );
    }
}

/// Rederives faces whose record changed after they were derived, and new ones that came without.
fn derive_changed(
    mut commands: Commands,
    faces: Query<(Entity, Ref<AuthoredFace>, Option<&DerivedFace>), Changed<AuthoredFace>>,
) {
    for (entity, authored, derived) in &faces {
        if derived.is_none() || !authored.is_added() {
            commands.entity(entity).insert(DerivedFace(Arc::new(Derived::of(&authored.record))));
        }
    }
}
