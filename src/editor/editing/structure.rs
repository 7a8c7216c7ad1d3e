//! Changes of what there is: faces of a model, its parts, whole models.

use bevy::prelude::*;

use crate::editor::object::{
    FacePlace, LoadedModel, Model, ModelEntry, Records, Scene, despawn_model, insert_model, regroup,
    spawn_face,
};
use crate::scene::EditError;
use crate::scene::edit::ModelHead;
use crate::scene::records::{FaceRecord, ModelRecord};

/// Replaces faces of a model; the others are numbered anew.
pub(super) fn faces(
    world: &mut World,
    model: usize,
    at: usize,
    before: &[FaceRecord],
    after: &[FaceRecord],
) -> Result<(), EditError> {
    let place = || format!("the list of faces of model {}", model + 1);
    let missing = || EditError::Missing { place: place() };
    let entry = world.resource::<Scene>().models.get(model).cloned().ok_or_else(missing)?;
    let end = at.checked_add(before.len()).filter(|end| *end <= entry.order.len()).ok_or_else(missing)?;
    let old = &entry.order[at..end];
    let is = |record: Option<FaceRecord>, before: &FaceRecord| record.is_some_and(|r| r == *before);
    let same = world
        .run_system_cached_with(records_of, old.to_vec())
        .is_ok_and(|records| records.into_iter().zip(before).all(|(record, before)| is(record, before)));
    if !same {
        return Err(EditError::Mismatch { place: place() });
    }
    let mut commands = world.commands();
    let new: Vec<Entity> = after
        .iter()
        .enumerate()
        .map(|(k, record)| {
            let place = FacePlace { number: at + k + 1, model: entry.entity };
            spawn_face(&mut commands, place, record.clone(), None)
        })
        .collect();
    old.iter().for_each(|face| commands.entity(*face).despawn());
    world.flush();
    if let Some(entry) = world.resource_mut::<Scene>().models.get_mut(model) {
        entry.order.splice(at..end, new);
    }
    regroup(world, model);
    Ok(())
}

fn records_of(In(faces): In<Vec<Entity>>, records: Records) -> Vec<Option<FaceRecord>> {
    faces.into_iter().map(|face| records.face(face)).collect()
}

/// Replaces name, unit and parts of a model.
pub(super) fn head(
    world: &mut World,
    model: usize,
    before: &ModelHead,
    after: &ModelHead,
) -> Result<(), EditError> {
    let place = || format!("name, unit or parts of model {}", model + 1);
    let entity = world.resource::<Scene>().models.get(model).map(|m| m.entity);
    let Some(mut record) = entity.and_then(|e| world.get_mut::<Model>(e)) else {
        return Err(EditError::Missing { place: place() });
    };
    let ModelHead { name, unit, parts } = before;
    if (&record.name, &record.unit, &record.parts) != (name, unit, parts) {
        return Err(EditError::Mismatch { place: place() });
    }
    let ModelHead { name, unit, parts } = after.clone();
    (record.name, record.unit, record.parts) = (name, unit, parts);
    regroup(world, model);
    Ok(())
}

/// Replaces models of the scene.
pub(super) fn models(
    world: &mut World,
    at: usize,
    before: &[ModelRecord],
    after: &[ModelRecord],
) -> Result<(), EditError> {
    let place = || "the list of models".to_owned();
    let open = world.resource::<Scene>().models.clone();
    let Some(old) = at.checked_add(before.len()).and_then(|end| open.get(at..end)) else {
        return Err(EditError::Missing { place: place() });
    };
    let same = world.run_system_cached_with(models_of, old.to_vec()).is_ok_and(|records| {
        records.iter().zip(before).all(|(record, before)| record.as_ref() == Some(before))
    });
    if !same {
        return Err(EditError::Mismatch { place: place() });
    }
    world.resource_scope(|world, mut scene: Mut<Scene>| {
        let mut commands = world.commands();
        old.iter().for_each(|model| despawn_model(&mut commands, &mut scene, model.entity));
        for (k, record) in after.iter().enumerate() {
            let loaded = LoadedModel { record: record.clone(), ..LoadedModel::default() };
            insert_model(&mut commands, &mut scene, at + k, loaded);
        }
    });
    world.flush();
    Ok(())
}

fn models_of(In(models): In<Vec<ModelEntry>>, records: Records) -> Vec<Option<ModelRecord>> {
    models.iter().map(|model| records.model(model)).collect()
}
