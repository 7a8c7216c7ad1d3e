//! The box around everything shown.

use bevy::prelude::*;

use crate::editor::object::{DerivedFace, Shown};
use crate::kernel::view::Bounds;

/// Boxes of the scene: what fitting and the grid go by.
#[derive(Resource, Debug, Clone, Copy, PartialEq)]
pub struct SceneBounds {
    /// Around all faces shown.
    pub shown: Bounds,
    /// Around all faces.
    pub all: Bounds,
}

impl Default for SceneBounds {
    fn default() -> Self {
        Self { shown: Bounds::EMPTY, all: Bounds::EMPTY }
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

/// Joins the boxes again when a face was derived, shown, hidden or removed.
pub(super) fn update(
    mut bounds: ResMut<SceneBounds>,
    faces: Query<(&DerivedFace, &Shown)>,
    changed: Query<(), Or<(Changed<DerivedFace>, Changed<Shown>)>>,
    mut removed: RemovedComponents<DerivedFace>,
) {
    if changed.is_empty() && removed.read().count() == 0 {
        return;
    }
    let mut joined = SceneBounds::default();
    for (derived, shown) in &faces {
        joined.all = joined.all.union(derived.0.bounds);
        if shown.0 {
            joined.shown = joined.shown.union(derived.0.bounds);
        }
    }
    bounds.set_if_neq(joined);
}
