//! The index of everything open: models, their parts, and their faces in file order.
//!
//! Panels and selection go by this list instead of walking the hierarchy each frame. It is written only
//! when models are added or removed.

use bevy::prelude::*;

/// Everything open, in the order it was opened.
#[derive(Resource, Debug, Default)]
pub struct Scene {
    /// Models in order of opening.
    pub models: Vec<ModelEntry>,
    /// Counts changes of the list.
    pub revision: u64,
}

/// A model and its parts.
#[derive(Debug, Clone)]
pub struct ModelEntry {
    /// Entity with [`super::Model`].
    pub entity: Entity,
    /// Parts with at least one face; faces that name no part are in one of the model's name.
    pub parts: Vec<PartEntry>,
}

/// A part and its faces.
#[derive(Debug, Clone)]
pub struct PartEntry {
    /// Entity with [`super::Part`].
    pub entity: Entity,
    /// Entities with [`super::AuthoredFace`], in file order.
    pub faces: Vec<Entity>,
}

impl Scene {
    /// All faces, model by model.
    pub fn faces(&self) -> impl Iterator<Item = Entity> + '_ {
        self.models.iter().flat_map(ModelEntry::faces)
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.models.iter().flat_map(|m| &m.parts).map(|p| p.faces.len()).sum()
    }

    /// Whether nothing is open.
    pub fn is_empty(&self) -> bool {
        self.models.is_empty()
    }
}

impl ModelEntry {
    /// All faces of the model, part by part.
    pub fn faces(&self) -> impl Iterator<Item = Entity> + '_ {
        self.parts.iter().flat_map(|p| p.faces.iter().copied())
    }
}
