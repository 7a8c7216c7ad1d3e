//! Which curves are near a box, while curves come and go.
//!
//! A tree over those of the beginning, and a short list of those that came later; when the list has grown long
//! the tree is built anew.

use std::sync::Arc;

use super::lifted::LiftedCurve;
use crate::kernel::query::BoundsTree;
use crate::kernel::view::Bounds;

/// Later curves before the tree is built anew.
const MOST_LATER: usize = 2_000;

/// A spatial index over numbered curves.
#[derive(Debug, Clone, Default)]
pub struct CurveIndex {
    tree: BoundsTree,
    later: Vec<u32>,
}

impl CurveIndex {
    /// Indexes all of `curves`.
    pub fn new(curves: &[Option<Arc<LiftedCurve>>]) -> Self {
        let bounds: Vec<Bounds> =
            curves.iter().map(|c| c.as_ref().map_or(Bounds::EMPTY, |c| *c.bounds())).collect();
        Self { tree: BoundsTree::new(&bounds), later: Vec::new() }
    }

    /// Adds number `id` of `curves`. Whether the tree was built anew: then no number without a curve is known
    /// to it.
    pub fn insert(&mut self, id: u32, curves: &[Option<Arc<LiftedCurve>>]) -> bool {
        self.later.push(id);
        let rebuild = self.later.len() > MOST_LATER;
        if rebuild {
            *self = Self::new(curves);
        }
        rebuild
    }

    /// Calls `visit` with each curve whose box comes within `distance` of that of `around`, itself included.
    pub fn near(
        &self,
        around: &Bounds,
        distance: f64,
        curves: &[Option<Arc<LiftedCurve>>],
        mut visit: impl FnMut(u32),
    ) {
        let meets = |b: &Bounds| {
            (b.min - around.max).max_element() <= distance && (around.min - b.max).max_element() <= distance
        };
        let mut offer = |id: u32| {
            if curves[id as usize].as_ref().is_some_and(|c| meets(c.bounds())) {
                visit(id);
            }
        };
        self.tree.meeting(around, distance, |k| offer(k as u32));
        self.later.iter().for_each(|id| offer(*id));
    }
}
