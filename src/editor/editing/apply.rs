//! Edits on components: each change replaces only the components it is about.
//!
//! The same checks as on records: a change whose `before` is not there is an error, and an edit is applied
//! as a whole or not at all.

use std::sync::Arc;

use bevy::prelude::*;

use super::structure;
use crate::editor::object::{AuthoredFace, Scene, TrimLoop};
use crate::scene::edit::net_applied;
use crate::scene::records::LoopRecord;
use crate::scene::{Change, Edit, EditError, FaceId};

/// Applies all changes of an edit to the components, or none.
///
/// # Errors
/// A change does not fit; the document is then as it was before.
pub fn apply_edit(world: &mut World, edit: &Edit) -> Result<(), EditError> {
    for (done, change) in edit.changes.iter().enumerate() {
        if let Err(error) = apply(world, change) {
            for change in edit.changes[..done].iter().rev() {
                apply(world, &change.inverse())
                    .expect("invariant: what was applied a moment ago can be taken back");
            }
            return Err(error);
        }
    }
    Ok(())
}

fn apply(world: &mut World, change: &Change) -> Result<(), EditError> {
    match change {
        Change::Curves { face, trim_loop, .. } | Change::Role { face, trim_loop, .. } => {
            change_loop(world, *face, *trim_loop, change)
        }
        Change::Loops { face, at, before, after } => change_loops(world, *face, *at, before, after),
        Change::Surface { face, before, after } => {
            let (entity, mut authored) = find(world, *face)?;
            if *authored.surface != **before {
                return Err(EditError::Mismatch { place: format!("the surface of {face}") });
            }
            authored.surface = Arc::new((**after).clone());
            world.entity_mut(entity).insert(authored);
            Ok(())
        }
        Change::Net { face, before, after } => {
            let (entity, mut authored) = find(world, *face)?;
            authored.surface = Arc::new(net_applied(&authored.surface, *face, before, after)?);
            world.entity_mut(entity).insert(authored);
            Ok(())
        }
        Change::Attributes { face, before, after } => {
            let (entity, mut authored) = find(world, *face)?;
            if *authored.attributes != **before {
                return Err(EditError::Mismatch { place: format!("name or looks of {face}") });
            }
            authored.attributes = Arc::new((**after).clone());
            world.entity_mut(entity).insert(authored);
            if before.part != after.part {
                crate::editor::object::regroup(world, face.model);
            }
            Ok(())
        }
        Change::Faces { model, at, before, after } => structure::faces(world, *model, *at, before, after),
        Change::Model { model, before, after } => structure::head(world, *model, before, after),
        Change::Models { at, before, after } => structure::models(world, *at, before, after),
    }
}

/// A face and its authored component.
fn find(world: &World, id: FaceId) -> Result<(Entity, AuthoredFace), EditError> {
    let entity = world.resource::<Scene>().face(id.model, id.face);
    let found = entity.and_then(|entity| Some((entity, world.get::<AuthoredFace>(entity)?.clone())));
    found.ok_or_else(|| EditError::Missing { place: id.to_string() })
}

/// Applies a change of one loop to its component.
fn change_loop(world: &mut World, id: FaceId, index: usize, change: &Change) -> Result<(), EditError> {
    let missing = || EditError::Missing { place: format!("{id}, loop {}", index + 1) };
    let (face, authored) = find(world, id)?;
    let entity = *authored.loops.get(index).ok_or_else(missing)?;
    let mut record = LoopRecord::clone(&world.get::<TrimLoop>(entity).ok_or_else(missing)?.record);
    change.apply_to_loop(&mut record)?;
    world.entity_mut(entity).insert(TrimLoop { face, record: Arc::new(record) });
    Ok(())
}

/// Replaces loops of a face. Those that stay in place keep their entities.
fn change_loops(
    world: &mut World,
    id: FaceId,
    at: usize,
    before: &[LoopRecord],
    after: &[LoopRecord],
) -> Result<(), EditError> {
    let place = || format!("{id}: its loops from {} on", at + 1);
    let (face, mut authored) = find(world, id)?;
    let Some(old) = at.checked_add(before.len()).and_then(|end| authored.loops.get(at..end)) else {
        return Err(EditError::Missing { place: place() });
    };
    let is = |entity: &Entity, record: &LoopRecord| {
        world.get::<TrimLoop>(*entity).is_some_and(|l| *l.record == *record)
    };
    if !old.iter().zip(before).all(|(entity, record)| is(entity, record)) {
        return Err(EditError::Mismatch { place: place() });
    }
    let old = old.to_vec();
    let mut new = Vec::with_capacity(after.len());
    for (k, record) in after.iter().enumerate() {
        let trim_loop = TrimLoop { face, record: Arc::new(record.clone()) };
        new.push(match old.get(k) {
            Some(kept) => world.entity_mut(*kept).insert(trim_loop).id(),
            None => world.spawn((trim_loop, ChildOf(face))).id(),
        });
    }
    authored.loops.splice(at..at + before.len(), new);
    world.entity_mut(face).insert(authored);
    for gone in old.iter().skip(after.len()) {
        world.despawn(*gone);
    }
    if before.len() != after.len() {
        world.resource_mut::<Scene>().revision += 1;
    }
    Ok(())
}
