//! Where many points lie with respect to one face, fast.
//!
//! [`Face::classify_native`] looks at every trim curve to see whether one passes close by. For many
//! points a tree over the curves' boxes pays: far from all curves the parity grid with slabs answers at
//! once, points close to one ask that one, and only points beside it take the long way. The answers are the same.

use glam::{DVec2, DVec3};

use super::BoundsTree;
use crate::kernel::face::{Face, NEAR, ON_TOLERANCE, Side};
use crate::kernel::trim::{FillRule, SlabGrid, TrimStructure, oracle};
use crate::kernel::view::Bounds;

/// A face with a tree over its trim curves, and slabs over its parity grid.
#[derive(Debug)]
pub struct Locator {
    face: Face,
    tree: BoundsTree,
    slabs: SlabGrid,
}

impl Locator {
    /// Builds the tree; slabs are made where they are asked for.
    pub fn new(face: Face) -> Self {
        let flat = |p: DVec2| DVec3::new(p.x, p.y, 0.0);
        let list = &face.pieces;
        let bounds: Vec<Bounds> =
            list.pieces().iter().map(|p| Bounds::of([flat(list.start(p)), flat(list.end(p))])).collect();
        let tree = BoundsTree::new(&bounds);
        let slabs = face.slab_grid();
        Self { face, tree, slabs }
    }

    /// The face.
    pub fn face(&self) -> &Face {
        &self.face
    }

    /// The same as [`Face::classify_native`].
    pub fn classify_native(&self, u: f64, v: f64) -> Side {
        let p = self.face.domain.normalise(DVec2::new(u, v));
        let inside = p.cmpge(DVec2::ZERO).all() && p.cmple(DVec2::ONE).all();
        if !inside {
            return self.face.classify_native(u, v);
        }
        let (list, mut near, mut on) = (&self.face.pieces, false, false);
        self.tree.within(p.extend(0.0), 2.0 * NEAR, |piece| {
            let within = |tolerance| oracle::is_on_piece(list, &list.pieces()[piece], p, tolerance);
            near = near || within(NEAR);
            on = on || near && within(ON_TOLERANCE);
        });
        let inside = match (on, near) {
            (true, _) => return Side::On,
            (false, true) => oracle::inside(list, p, FillRule::EvenOdd),
            (false, false) => self.slabs.classify(p.as_vec2()),
        };
        if inside { Side::In } else { Side::Out }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::demo;

    #[test]
    fn answers_as_the_face_does_on_every_demo_face() {
        for record in demo::model().faces.iter().filter(|f| !f.loops.is_empty()) {
            let locator = Locator::new(record.derive().expect("a valid face"));
            let face = locator.face();
            for k in 0..600_u32 {
                // Points all over and beyond the domain, and points on and beside the curves.
                let spread =
                    DVec2::new(f64::from(k) * 0.754_877, f64::from(k) * 0.569_84).fract() * 1.2 - 0.1;
                let pieces = face.pieces.pieces();
                let start = face.pieces.start(&pieces[k as usize * 7 % pieces.len()]);
                let beside = start + DVec2::new(1e-6, -3e-7) * f64::from(k % 5);
                for p in [spread, beside].map(|p| face.domain.native(p)) {
                    assert_eq!(locator.classify_native(p.x, p.y), face.classify_native(p.x, p.y), "{p}");
                }
            }
        }
    }
}
