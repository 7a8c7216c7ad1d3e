//! The box around everything shown.

use bevy::ecs::entity::EntityHashMap;
use bevy::prelude::*;

use super::bounds_tree::BoundsTree;
use super::derived::Derived;
use crate::editor::object::{DerivedFace, FaceChange, Shown};
use crate::kernel::view::Bounds;

/// Boxes of the scene, what fitting and the grid go by, and the number of its trim curves.
#[derive(Resource, Debug, Clone, Copy, PartialEq)]
pub struct SceneBounds {
    /// Around all faces shown.
    pub shown: Bounds,
    /// Around all faces.
    pub all: Bounds,
    /// Trim curves of all faces.
    pub curves: usize,
}

impl Default for SceneBounds {
    fn default() -> Self {
        Self { shown: Bounds::EMPTY, all: Bounds::EMPTY, curves: 0 }
    }
}

impl SceneBounds {
    /// Diagonal of everything, or 1 when nothing is open: the length that steps are measured by.
    pub fn scale(&self) -> f64 {
        let diagonal = self.all.diagonal();
        if diagonal > 0.0 && diagonal.is_finite() { diagonal } else { 1.0 }
    }

    /// What a view of everything should show; a unit cube when nothing is open.
    pub fn to_fit(&self) -> Bounds {
        [self.shown, self.all]
            .into_iter()
            .find(|b| !b.is_empty())
            .unwrap_or(Bounds { min: glam::DVec3::splat(-1.0), max: glam::DVec3::ONE })
    }
}

/// The box of each face, so that one that changes costs nothing for the others.
#[derive(Resource, Debug, Default)]
pub(super) struct FaceBoxes {
    /// Place in the trees and number of trim curves.
    places: EntityHashMap<(usize, usize)>,
    free: Vec<usize>,
    shown: BoundsTree,
    all: BoundsTree,
    curves: usize,
}

impl FaceBoxes {
    fn set(&mut self, face: Entity, derived: &Derived, shown: bool) {
        let next = self.free.last().copied().unwrap_or(self.places.len());
        let (place, curves) = self.places.entry(face).or_insert_with(|| {
            self.free.pop();
            (next, 0)
        });
        self.curves = self.curves - *curves + derived.curves;
        *curves = derived.curves;
        self.all.set(*place, derived.bounds);
        self.shown.set(*place, if shown { derived.bounds } else { Bounds::EMPTY });
    }

    fn remove(&mut self, face: Entity) {
        if let Some((place, curves)) = self.places.remove(&face) {
            self.curves -= curves;
            self.all.set(place, Bounds::EMPTY);
            self.shown.set(place, Bounds::EMPTY);
            self.free.push(place);
        }
    }
}

/// Joins the boxes again when faces were derived, shown, hidden or removed.
pub(super) fn update(
    mut bounds: ResMut<SceneBounds>,
    mut boxes: ResMut<FaceBoxes>,
    mut changes: MessageReader<FaceChange>,
    faces: Query<(&DerivedFace, &Shown)>,
) {
    if changes.is_empty() {
        return;
    }
    for change in changes.read() {
        let (FaceChange::Derived(face) | FaceChange::Shown(face) | FaceChange::Removed(face)) = *change;
        match faces.get(face) {
            Ok((derived, shown)) => boxes.set(face, &derived.0, shown.0),
            Err(_) => boxes.remove(face),
        }
    }
    let (shown, all, curves) = (boxes.shown.all(), boxes.all.all(), boxes.curves);
    bounds.set_if_neq(SceneBounds { shown, all, curves });
}
