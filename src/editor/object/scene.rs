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
    /// Its faces in the order of the record: number `n` is at `n - 1`.
    pub order: Vec<Entity>,
}

/// A part and its faces.
#[derive(Debug, Clone)]
pub struct PartEntry {
    /// Position in the parts of the model; none for faces that name no part.
    pub index: Option<usize>,
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
        self.models.iter().map(|m| m.order.len()).sum()
    }

    /// The face at a position of a model at a position.
    pub fn face(&self, model: usize, face: usize) -> Option<Entity> {
        self.models.get(model)?.order.get(face).copied()
    }

    /// The position of a model.
    pub fn position(&self, model: Entity) -> Option<usize> {
        self.models.iter().position(|m| m.entity == model)
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
