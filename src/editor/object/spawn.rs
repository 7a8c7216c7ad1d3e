//! From records to entities: model > parts > faces > loops.

use std::path::PathBuf;
use std::sync::Arc;

use bevy::prelude::*;

use super::{
    AuthoredFace, DerivedFace, FacePlace, Model, ModelEntry, Part, PartEntry, Scene, Shown, TrimLoop,
};
use crate::editor::derive::Derived;
use crate::exchange::report::ImportReport;
use crate::scene::FaceAttributes;
use crate::scene::records::{FaceRecord, ModelRecord, PartRecord};

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

/// Spawns the entities of `loaded` and enters them into `scene` behind the others.
pub fn spawn_model(commands: &mut Commands, scene: &mut Scene, loaded: LoadedModel) -> Entity {
    let at = scene.models.len();
    insert_model(commands, scene, at, loaded)
}

/// Spawns the entities of `loaded` and enters them into `scene` at a position.
pub fn insert_model(commands: &mut Commands, scene: &mut Scene, at: usize, loaded: LoadedModel) -> Entity {
    let LoadedModel { path, record, report, derived } = loaded;
    let ModelRecord { name, unit, parts, faces } = record;
    let report = Arc::new(report);
    let model = commands.spawn_empty().id();
    let mut order = Vec::with_capacity(faces.len());
    let mut part_of = Vec::with_capacity(faces.len());
    for (index, record) in faces.into_iter().enumerate() {
        part_of.push(record.part);
        let place = FacePlace { number: index + 1, model };
        order.push(spawn_face(commands, place, record, derived.get(index).cloned().flatten()));
    }
    let groups = group(&name, &parts, &order, &part_of);
    let entries = groups.into_iter().map(|group| {
        let part =
            commands.spawn((Part { name: group.name }, ChildOf(model))).add_children(&group.faces).id();
        PartEntry { index: group.index, entity: part, faces: group.faces }
    });
    let entries = entries.collect();
    commands.entity(model).insert(Model { name, path, unit, parts, report });
    scene.models.insert(at.min(scene.models.len()), ModelEntry { entity: model, parts: entries, order });
    scene.revision += 1;
    model
}

/// Faces to be shown under one part.
#[derive(Debug)]
pub(super) struct Group {
    pub index: Option<usize>,
    pub name: String,
    pub faces: Vec<Entity>,
}

/// One group per part and one for faces that name none; empty ones are dropped.
pub(super) fn group(
    model: &str,
    parts: &[PartRecord],
    faces: &[Entity],
    part_of: &[Option<usize>],
) -> Vec<Group> {
    let mut buckets: Vec<Vec<Entity>> = vec![Vec::new(); parts.len() + 1];
    for (face, part) in faces.iter().zip(part_of) {
        buckets[part.filter(|p| *p < parts.len()).unwrap_or(parts.len())].push(*face);
    }
    let mut groups = Vec::new();
    for (index, faces) in buckets.into_iter().enumerate().filter(|(_, faces)| !faces.is_empty()) {
        let name = match parts.get(index) {
            Some(part) if !part.name.is_empty() => part.name.clone(),
            Some(_) => format!("Part {}", index + 1),
            None if groups.is_empty() => model.to_owned(),
            None => "Other faces".to_owned(),
        };
        groups.push(Group { index: (index < parts.len()).then_some(index), name, faces });
    }
    groups
}

/// Spawns a face and its loops. The caller makes it a child of its part.
pub fn spawn_face(
    commands: &mut Commands,
    place: FacePlace,
    record: FaceRecord,
    derived: Option<Arc<Derived>>,
) -> Entity {
    let attributes = Arc::new(FaceAttributes::of(&record));
    let face = commands.spawn((place, Shown(true))).id();
    let loops: Vec<Entity> = record
        .loops
        .into_iter()
        .map(|record| commands.spawn((TrimLoop { face, record: Arc::new(record) }, ChildOf(face))).id())
        .collect();
    let mut entity = commands.entity(face);
    entity.insert(AuthoredFace { surface: Arc::new(record.surface), attributes, loops });
    if let Some(derived) = derived {
        entity.insert(DerivedFace(derived));
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
