//! What closing a gap must not do to other edges: turn a stretch of a boundary naked, or bring a third face to an edge.
//!
//! A trim that is moved may leave the end of a third face behind, or come to lie along one: a sliver of an edge, often shorter
//! than the gap was wide, that no longer has two sides. Edges of the face that moves and of all that it borders on are
//! counted before and after.

use std::collections::BTreeSet;

use crate::inspect::{EdgeKey, EdgeKind, Inspection};
use crate::scene::records::FaceRecord;

/// What an edit does to other edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Harm {
    /// Another edge of the face would open.
    Opens,
    /// A stretch would have only one side.
    Naked {
        /// Its length (model units).
        length: f64,
    },
    /// A stretch would have three sides or more.
    NonManifold {
        /// Its length (model units).
        length: f64,
    },
}

impl Harm {
    /// What would happen, with `length` as people write it.
    pub(super) fn told(&self, length: &dyn Fn(f64) -> String) -> String {
        match self {
            Self::Opens => "would open another edge of the face".into(),
            Self::Naked { length: l } => {
                format!("would leave {} of another edge with one side only", length(*l))
            }
            Self::NonManifold { length: l } => {
                format!("would make {} of an edge non-manifold, with three sides or more", length(*l))
            }
        }
    }
}

/// How many edges of a kind there are, and their length.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Tally {
    count: usize,
    length: f64,
}

impl Tally {
    /// What there is more of now, if anything. Stretches may be cut in two, or grow with a neighbour, without harm.
    fn grown(&self, now: &Self) -> Option<f64> {
        (now.count > self.count && now.length > self.length).then_some(now.length - self.length)
    }
}

/// The edges round a face, to be compared before and after an edit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surroundings {
    faces: BTreeSet<usize>,
    naked: Tally,
    non_manifold: Tally,
}

impl Surroundings {
    /// The edges of `face` and of those that it borders on.
    pub fn of(inspection: &Inspection, face: usize) -> Self {
        let mut faces = BTreeSet::from([face]);
        for key in inspection.edges_of(face) {
            faces.extend(inspection.edge(&key).into_iter().flat_map(|e| e.faces()));
        }
        Self::among(inspection, faces)
    }

    fn among(inspection: &Inspection, faces: BTreeSet<usize>) -> Self {
        let keys: BTreeSet<EdgeKey> = faces.iter().flat_map(|f| inspection.edges_of(*f)).collect();
        let tally = |kind: EdgeKind| {
            let edges = keys.iter().filter_map(|k| inspection.edge(k)).filter(|e| e.kind == kind);
            edges.fold(Tally::default(), |t, e| Tally { count: t.count + 1, length: t.length + e.length() })
        };
        Self { naked: tally(EdgeKind::Naked), non_manifold: tally(EdgeKind::NonManifold), faces }
    }

    /// What was done to these edges, now that `inspection` has the changed face.
    pub fn harm(&self, inspection: &Inspection) -> Option<Harm> {
        let now = Self::among(inspection, self.faces.clone());
        let non_manifold = self.non_manifold.grown(&now.non_manifold);
        let naked = self.naked.grown(&now.naked);
        let non_manifold = non_manifold.map(|length| Harm::NonManifold { length });
        non_manifold.or(naked.map(|length| Harm::Naked { length }))
    }
}

/// What taking `face` anew from `changed` would do to other edges. `record`: the faces as they are, by position.
pub fn harm_of(
    inspection: &Inspection,
    face: usize,
    changed: &FaceRecord,
    record: &dyn Fn(usize) -> Option<FaceRecord>,
) -> Option<Harm> {
    // What lies further away is the same before and after, and need not be looked at.
    let near = Surroundings::of(inspection, face).faces;
    let around: BTreeSet<usize> = near.iter().flat_map(|f| Surroundings::of(inspection, *f).faces).collect();
    let around: Vec<usize> = around.into_iter().collect();
    let records: Vec<FaceRecord> = around.iter().map(|f| record(*f)).collect::<Option<_>>()?;
    let at = around.binary_search(&face).ok()?;
    let mut local = Inspection::with_scale(&records, |_| *inspection.scale());
    let before = Surroundings::of(&local, at);
    local.update(at, changed);
    before.harm(&local)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::nurbs::{KnotVector, NurbsSurface};
    use glam::DVec3;

    /// A square of 10 at `corner` with sides along `x` and `y`.
    fn square(corner: DVec3, x: DVec3, y: DVec3) -> FaceRecord {
        let knots = || KnotVector::bezier(1, 0.0, 1.0).expect("valid test data");
        let points = vec![corner, corner + 10.0 * y, corner + 10.0 * x, corner + 10.0 * (x + y)];
        let surface = NurbsSurface::new(knots(), knots(), points, vec![1.0; 4]).expect("valid test data");
        FaceRecord::new(surface, Vec::new())
    }

    #[test]
    fn a_third_side_and_a_lost_side_are_harm_and_standing_still_is_none() {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let left = square(at(-10.0, 0.0, 0.0), DVec3::X, DVec3::Y);
        let right = square(DVec3::ZERO, DVec3::X, DVec3::Y);
        // Shares the upper side of the right one.
        let upper = square(at(0.0, 10.0, 0.0), DVec3::X, DVec3::Z);
        let faces = [left.clone(), right.clone(), upper.clone()];
        let inspection = Inspection::of(&faces);
        let record = |k: usize| faces.get(k).cloned();
        assert_eq!(harm_of(&inspection, 2, &upper, &record), None);
        // Along the edge of the other two.
        let turned = square(DVec3::ZERO, DVec3::Z, DVec3::Y);
        let found = harm_of(&inspection, 2, &turned, &record);
        assert!(
            matches!(found, Some(Harm::NonManifold { length }) if (length - 10.0).abs() < 1e-9),
            "{found:?}"
        );
        let away = square(at(30.0, 0.0, 0.0), DVec3::X, DVec3::Y);
        let found = harm_of(&inspection, 1, &away, &record);
        assert!(matches!(found, Some(Harm::Naked { .. })), "{found:?}");
        let told = Harm::NonManifold { length: 2.0 }.told(&|x| format!("{x} mm"));
        assert!(told.contains("2 mm") && told.contains("three sides"), "{told}");
    }
}
