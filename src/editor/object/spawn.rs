//! From records to entities: model > parts > faces > loops.

use std::path::PathBuf;
use std::sync::Arc;

use bevy::prelude::*;

use super::{AuthoredFace, DerivedFace, Model, ModelEntry, Part, PartEntry, Scene, Shown, TrimLoop};
use crate::editor::derive::Derived;
use crate::exchange::report::ImportReport;
use crate::scene::records::{FaceRecord, ModelRecord};

/// A model ready to be shown: its records and, face by face, what was derived from them in the background.
#[derive(Debug, Clone, Default)]
pub struct LoadedModel {
    /// Where it was read from.
    pub path: Option<PathBuf>,
    /// The records.
    pub record: ModelRecord,
    /// What the import did.
    pub report: ImportReport,
    /// One per face of the record, in order. May be shorter: the rest is derived later.
    pub derived: Vec<Option<Arc<Derived>>>,
}

/// Spawns the entities of `loaded` and enters them into `scene`.
pub fn spawn_model(commands: &mut Commands, scene: &mut Scene, loaded: LoadedModel) -> Entity {
    let LoadedModel { path, record, report, derived } = loaded;
    let ModelRecord { name, unit, parts, faces } = record;
    let model = commands.spawn(Model { name: name.clone(), path, unit, report: Arc::new(report) }).id();

    // One bucket per part and one for faces that name none; empty ones are dropped.
    let mut buckets: Vec<Vec<(usize, FaceRecord)>> = vec![Vec::new(); parts.len() + 1];
    for (index, face) in faces.into_iter().enumerate() {
        let part = face.part.filter(|p| *p < parts.len()).unwrap_or(parts.len());
        buckets[part].push((index, face));
    }
    let mut entries = Vec::new();
    for (part_index, bucket) in buckets.into_iter().enumerate().filter(|(_, bucket)| !bucket.is_empty()) {
        let part_name = match parts.get(part_index) {
            Some(part) if !part.name.is_empty() => part.name.clone(),
            Some(_) => format!("Part {}", part_index + 1),
            None if entries.is_empty() => name.clone(),
            None => "Other faces".to_owned(),
        };
        let part = commands.spawn((Part { name: part_name }, ChildOf(model))).id();
        let faces = bucket
            .into_iter()
            .map(|(index, record)| {
                spawn_face(commands, model, part, index, record, derived.get(index).cloned().flatten())
            })
            .collect();
        entries.push(PartEntry { entity: part, faces });
    }
    scene.models.push(ModelEntry { entity: model, parts: entries });
    scene.revision += 1;
    model
}

fn spawn_face(
    commands: &mut Commands,
    model: Entity,
    part: Entity,
    index: usize,
    record: FaceRecord,
    derived: Option<Arc<Derived>>,
) -> Entity {
    let loops = record.loops.len();
    let authored = AuthoredFace { record: Arc::new(record), number: index + 1, model };
    let mut entity = commands.spawn((authored, Shown(true), ChildOf(part)));
    if let Some(face) = derived {
        entity.insert(DerivedFace(face));
    }
    let face = entity.id();
    for index in 0..loops {
        commands.spawn((TrimLoop { index }, ChildOf(face)));
    }
    face
}

/// Despawns `model` with all that is under it.
pub fn despawn_model(commands: &mut Commands, scene: &mut Scene, model: Entity) {
    if let Some(position) = scene.models.iter().position(|m| m.entity == model) {
        scene.models.remove(position);
        scene.revision += 1;
        commands.entity(model).despawn();
    }
}
