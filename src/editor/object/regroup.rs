//! Entering changed lists of faces and parts into the index and the hierarchy.

use bevy::prelude::*;

use super::spawn::group;
use super::{AuthoredFace, FacePlace, Model, Part, PartEntry, Scene};

/// Makes numbers, parts and tree of the model at `position` agree with the order of its faces again. Parts
/// that stay keep their entities.
pub fn regroup(world: &mut World, position: usize) {
    world.resource_scope(|world, mut scene: Mut<Scene>| {
        let scene = &mut *scene;
        let Some(entry) = scene.models.get_mut(position) else { return };
        let Some(model) = world.get::<Model>(entry.entity).cloned() else { return };
        let place = |number| FacePlace { number, model: entry.entity };
        let mut part_of = Vec::with_capacity(entry.order.len());
        for (index, face) in entry.order.iter().enumerate() {
            part_of.push(world.get::<AuthoredFace>(*face).and_then(|f| f.attributes.part));
            if world.get::<FacePlace>(*face) != Some(&place(index + 1)) {
                world.entity_mut(*face).insert(place(index + 1));
            }
        }
        let mut old = std::mem::take(&mut entry.parts);
        for group in group(&model.name, &model.parts, &entry.order, &part_of) {
            let kept = old.iter().position(|p| p.index == group.index).map(|k| old.remove(k));
            let part = match &kept {
                Some(kept) => kept.entity,
                None => world.spawn(ChildOf(entry.entity)).id(),
            };
            world.entity_mut(part).insert(Part { name: group.name });
            if kept.is_none_or(|k| k.faces != group.faces) {
                for face in &group.faces {
                    if world.get::<ChildOf>(*face).map(|c| c.parent()) != Some(part) {
                        world.entity_mut(*face).insert(ChildOf(part));
                    }
                }
            }
            entry.parts.push(PartEntry { index: group.index, entity: part, faces: group.faces });
        }
        // Their faces have moved elsewhere or are gone.
        for part in &old {
            world.despawn(part.entity);
        }
        scene.revision += 1;
    });
}
