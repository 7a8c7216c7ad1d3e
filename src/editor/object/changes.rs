//! Which faces changed: noted by the components' hooks, so that finding out costs nothing for the others.
//!
//! Invariant: a face whose surface, attributes or loops were inserted, replaced or removed is in
//! [`Changes::authored`] until `derive` took it, and is announced by a [`FaceChange`] when its derived data,
//! visibility or existence changed.

use bevy::ecs::lifecycle::HookContext;
use bevy::ecs::world::DeferredWorld;
use bevy::prelude::*;

use super::{AuthoredFace, TrimLoop};

/// Faces to derive again.
#[derive(Resource, Debug, Default)]
pub struct Changes {
    authored: Vec<Entity>,
}

/// Something that follows from a face changed.
#[derive(Message, Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceChange {
    /// Its derived data is new.
    Derived(Entity),
    /// It was shown or hidden.
    Shown(Entity),
    /// It is gone.
    Removed(Entity),
}

impl Changes {
    /// Takes the faces whose authored components changed since the last call, each once, in the order in which they
    /// first changed.
    pub fn take(&mut self) -> Vec<Entity> {
        let mut seen = bevy::ecs::entity::EntityHashSet::default();
        let mut taken = std::mem::take(&mut self.authored);
        taken.retain(|face| seen.insert(*face));
        taken
    }
}

fn note(world: &mut DeferredWorld, face: Entity) {
    if let Some(mut changes) = world.get_resource_mut::<Changes>() {
        // A loop after its face, and its neighbours after it: the common case costs no memory.
        if changes.authored.last() != Some(&face) {
            changes.authored.push(face);
        }
    }
}

fn announce(world: &mut DeferredWorld, change: FaceChange) {
    if let Some(mut messages) = world.get_resource_mut::<Messages<FaceChange>>() {
        messages.write(change);
    }
}

pub(super) fn face_inserted(mut world: DeferredWorld, context: HookContext) {
    note(&mut world, context.entity);
}

pub(super) fn loop_inserted(mut world: DeferredWorld, context: HookContext) {
    if let Some(face) = world.get::<TrimLoop>(context.entity).map(|l| l.face) {
        note(&mut world, face);
    }
}

/// A loop that goes with its face changes nothing; one that goes alone does.
pub(super) fn loop_removed(mut world: DeferredWorld, context: HookContext) {
    if let Some(face) = world.get::<TrimLoop>(context.entity).map(|l| l.face)
        && world.get::<AuthoredFace>(face).is_some()
    {
        note(&mut world, face);
    }
}

pub(super) fn derived_inserted(mut world: DeferredWorld, context: HookContext) {
    announce(&mut world, FaceChange::Derived(context.entity));
}

pub(super) fn derived_removed(mut world: DeferredWorld, context: HookContext) {
    announce(&mut world, FaceChange::Removed(context.entity));
}

pub(super) fn shown_inserted(mut world: DeferredWorld, context: HookContext) {
    announce(&mut world, FaceChange::Shown(context.entity));
}
