//! The rows of the model tree: what is expanded and passes the filter, flattened.
//!
//! Rows are made again only when the scene, the expansion or the filter changes, so that 50,000 faces cost
//! nothing per frame; the panel draws the few rows in view.

use std::collections::HashSet;

use bevy::prelude::*;

use super::FaceViewItem;
use crate::editor::object::Scene;

/// One row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Row {
    /// A model, by position in the scene.
    Model(usize),
    /// A part, by position of model and part.
    Part(usize, usize),
    /// A face.
    Face(Entity),
    /// A loop of a face.
    Loop(Entity, usize),
}

/// Rows and what they were made from.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub rows: Vec<Row>,
    made_from: Option<(u64, u64, String)>,
    /// Counts changes of the expansion.
    pub expansion: u64,
    /// Faces that show their loops.
    pub open_faces: HashSet<Entity>,
    /// Parts and models that hide their children.
    pub closed: HashSet<Entity>,
}

impl Rows {
    /// Opens or closes a face, part or model.
    pub(super) fn toggle(&mut self, set: fn(&mut Self) -> &mut HashSet<Entity>, entity: Entity) {
        let set = set(self);
        if !set.remove(&entity) {
            set.insert(entity);
        }
        self.expansion += 1;
    }

    /// Makes the rows again if anything they depend on changed.
    pub(super) fn update<'a>(
        &mut self,
        scene: &Scene,
        filter: &str,
        face: impl Fn(Entity) -> Option<FaceViewItem<'a, 'a>>,
    ) {
        let key = (scene.revision, self.expansion, filter.to_lowercase());
        if self.made_from.as_ref() == Some(&key) {
            return;
        }
        self.rows.clear();
        let filter = key.2.trim();
        let several = scene.models.len() > 1;
        for (m, model) in scene.models.iter().enumerate() {
            let single_part = model.parts.len() == 1;
            if several || single_part || model.parts.is_empty() {
                self.rows.push(Row::Model(m));
                if self.closed.contains(&model.entity) && filter.is_empty() {
                    continue;
                }
            }
            for (p, part) in model.parts.iter().enumerate() {
                let faces: Vec<Entity> = part
                    .faces
                    .iter()
                    .copied()
                    .filter(|f| filter.is_empty() || face(*f).is_some_and(|f| passes(&f, filter)))
                    .collect();
                if !single_part && (filter.is_empty() || !faces.is_empty()) {
                    self.rows.push(Row::Part(m, p));
                    if self.closed.contains(&part.entity) && filter.is_empty() {
                        continue;
                    }
                }
                for entity in faces {
                    self.rows.push(Row::Face(entity));
                    if self.open_faces.contains(&entity) {
                        let loops = face(entity).map_or(0, |f| f.authored.loops.len());
                        self.rows.extend((0..loops).map(|i| Row::Loop(entity, i)));
                    }
                }
            }
        }
        self.made_from = Some(key);
    }
}

/// Whether number, name, source entity or layer of a face match.
fn passes(face: &FaceViewItem, filter: &str) -> bool {
    let (record, number) = (&face.authored.attributes, face.place.number);
    number.to_string() == filter
        || record.name.as_ref().is_some_and(|n| n.to_lowercase().contains(filter))
        || format!("face {number}").starts_with(filter)
        || record.source.as_ref().is_some_and(|s| s.entity == filter || format!("d{}", s.id) == filter)
        || record.layer.is_some_and(|l| format!("layer {l}") == filter)
}
