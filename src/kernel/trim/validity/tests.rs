//! Each kind of problem is found where it was made, and sound faces have none.

use glam::{DVec2, DVec3};

use super::*;
use crate::kernel::nurbs::{KnotVector, NurbsCurve2};
use crate::kernel::primitives::outline::{circle, polygon, rectangle, rosette, smooth};
use crate::kernel::trim::LoopRole;

fn plane() -> NurbsSurface {
    let knots = KnotVector::bezier(1, 0.0, 1.0).expect("degree 1");
    let points = vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::X + DVec3::Y];
    NurbsSurface::new(knots.clone(), knots, points, vec![1.0; 4]).expect("a square")
}

fn problems(loops: Vec<(LoopRole, Vec<NurbsCurve2>)>) -> Vec<LoopProblem> {
    let loops: Vec<LoopRecord> =
        loops.into_iter().map(|(role, curves)| LoopRecord::new(role, curves)).collect();
    check(&plane(), &loops.iter().collect::<Vec<_>>())
}

fn outer() -> (LoopRole, Vec<NurbsCurve2>) {
    (LoopRole::Outer, rectangle(DVec2::ZERO, DVec2::ONE))
}

fn hole(curves: Vec<NurbsCurve2>) -> (LoopRole, Vec<NurbsCurve2>) {
    (LoopRole::Inner, curves)
}

const MIDDLE: DVec2 = DVec2::splat(0.5);

#[test]
fn sound_faces_have_no_problems() {
    let flower = smooth(|t| MIDDLE + 0.3 * rosette(7.0, 0.4, 0.2)(t), 70);
    let island = circle(MIDDLE, 0.1);
    assert_eq!(problems(vec![outer(), hole(flower), (LoopRole::Outer, island)]), []);
    let demo = crate::kernel::trim::loop_record::LoopRecord::new(LoopRole::Inner, circle(MIDDLE, 0.2));
    assert_eq!(check(&plane(), &[&demo]), [], "a hole in the whole surface");
}

#[test]
fn crossings_are_found_where_they_are() {
    let eight = polygon(&[(0.1, 0.1), (0.9, 0.9), (0.9, 0.1), (0.1, 0.9)].map(DVec2::from));
    let found = problems(vec![hole(eight)]);
    assert!(
        matches!(found[0].kind, ProblemKind::CrossesItself { curve: 2 }) && found.len() == 1,
        "{found:?}"
    );
    assert!(found[0].uv.distance(MIDDLE) < 1e-12 && found[0].severity() == Severity::Error);
    let one = circle(DVec2::new(0.4, 0.5), 0.2);
    let two = circle(DVec2::new(0.6, 0.5), 0.2);
    let found = problems(vec![outer(), hole(one), hole(two)]);
    let height = 0.2f64.hypot(0.0).powi(2) - 0.01;
    let expected = [DVec2::new(0.5, 0.5 - height.sqrt()), DVec2::new(0.5, 0.5 + height.sqrt())];
    assert_eq!(found.len(), 2, "{found:?}");
    for point in expected {
        assert!(found.iter().any(|p| p.uv.distance(point) < 1e-8), "{found:?}");
    }
    // A single cubic with a loop of its own.
    let knots = KnotVector::bezier(3, 0.0, 1.0).expect("degree 3");
    let points = [(0.3, 0.2), (1.1, 0.8), (-0.1, 0.8), (0.7, 0.2)].map(DVec2::from).to_vec();
    let bow = NurbsCurve2::new(knots, points, vec![1.0; 4]).expect("finite");
    let close = NurbsCurve2::line(DVec2::new(0.7, 0.2), DVec2::new(0.3, 0.2));
    let found = problems(vec![hole(vec![bow, close])]);
    assert!(found.iter().any(|p| matches!(p.kind, ProblemKind::CrossesItself { curve: 0 })), "{found:?}");
}

#[test]
fn near_misses_are_not_crossings() {
    for gap in [1e-3, 1e-6] {
        let inner = smooth(|t| MIDDLE + 0.3 * rosette(5.0, 0.3, 0.2)(t), 40);
        let around = smooth(|t| MIDDLE + (0.3 + gap) * rosette(5.0, 0.3, 0.2)(t), 40);
        assert_eq!(problems(vec![outer(), hole(around), (LoopRole::Outer, inner)]), [], "{gap}");
    }
}

#[test]
fn overlapping_and_folded_back_pieces_end_and_are_reported() {
    let left = rectangle(DVec2::new(0.1, 0.1), DVec2::new(0.5, 0.5));
    let right = rectangle(DVec2::new(0.5, 0.2), DVec2::new(0.8, 0.4));
    assert!(
        problems(vec![hole(left), hole(right)]).iter().any(|p| matches!(p.kind, ProblemKind::Crosses { .. }))
    );
    let curve = circle(MIDDLE, 0.3);
    assert!(!problems(vec![hole(curve.clone()), hole(curve)]).is_empty(), "a loop twice");
    let spike = polygon(&[(0.1, 0.1), (0.9, 0.1), (0.5, 0.1), (0.5, 0.6)].map(DVec2::from));
    assert!(problems(vec![hole(spike)]).iter().any(|p| matches!(p.kind, ProblemKind::CrossesItself { .. })));
}

#[test]
fn gaps_ends_borders_and_nesting_are_told_in_words() {
    let mut open = rectangle(DVec2::splat(0.2), DVec2::splat(0.4));
    open.remove(1);
    let point = NurbsCurve2::line(MIDDLE, MIDDLE);
    let found =
        problems(vec![outer(), hole(open), hole(vec![point]), hole(circle(DVec2::new(0.95, 0.5), 0.1))]);
    let words: Vec<String> = found.iter().map(ToString::to_string).collect();
    for expected in [
        "loop 2 is open: a gap of 2.000e-1 in uv after curve 1",
        "loop 3, curve 1 has no length",
        "loop 3 has no extent",
        "loop 4, curve 1 leaves the surface by 5.000e-2 in uv",
        "loop 1, curve 2 meets loop 4, curve 1",
    ] {
        assert!(words.iter().any(|w| w == expected), "{expected}: {words:?}");
    }
    let apart = problems(vec![
        (LoopRole::Outer, circle(DVec2::splat(0.2), 0.1)),
        hole(circle(DVec2::splat(0.7), 0.1)),
    ]);
    assert_eq!(apart[0].to_string(), "hole 2 lies in no outer loop and is drawn as a face");
    let nested = problems(vec![outer(), (LoopRole::Outer, circle(MIDDLE, 0.1))]);
    assert_eq!(nested[0].to_string(), "outer loop 2 lies inside loop 1 and is drawn as a hole");
}

#[test]
fn the_demo_scene_is_sound() {
    for face in crate::scene::demo::model().faces {
        let found = check(&face.surface, &face.loops.iter().collect::<Vec<_>>());
        // It has curves without length, where cuts fall on knots.
        assert!(found.iter().all(|p| p.severity() == Severity::Note), "{:?}: {found:?}", face.name);
    }
}

mod after_edits {
    use std::sync::Arc;

    use proptest::prelude::*;

    use super::*;

    /// A face with `side` times `side` holes.
    fn sieve(side: usize) -> Vec<Arc<LoopRecord>> {
        let (_, border) = outer();
        let mut loops = vec![LoopRecord::new(LoopRole::Outer, border)];
        let step = 1.0 / side as f64;
        for k in 0..side * side {
            let centre = DVec2::new(step * ((k % side) as f64 + 0.5), step * ((k / side) as f64 + 0.5));
            loops.push(LoopRecord::new(LoopRole::Inner, circle(centre, 0.35 * step)));
        }
        loops.into_iter().map(Arc::new).collect()
    }

    fn moved(from: &LoopRecord, by: DVec2, scale: f64) -> LoopRecord {
        let middle = from.curves[0].points()[0];
        let map = |p: DVec2| middle + (p - middle) * scale + by;
        LoopRecord::new(from.role, from.curves.iter().map(|c| c.map_points(map)).collect())
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
        /// Whatever is moved, shrunk to nothing, thrown out of the domain or given another role.
        #[test]
        fn remembering_gives_what_a_fresh_check_gives(
            moves in proptest::collection::vec(
                (0usize..26, -0.4f64..0.4, -0.4f64..0.4, prop_oneof![Just(0.0), 0.2f64..3.0], 0u8..3), 1..12)
        ) {
            let surface = Arc::new(plane());
            let mut loops = sieve(5);
            let mut memory = Memory::default();
            memory.check(&surface, &loops);
            for (which, u, v, scale, role) in moves {
                let mut record = moved(&loops[which], DVec2::new(u, v), scale);
                record.role = [LoopRole::Inner, LoopRole::Outer, LoopRole::Unknown][usize::from(role)];
                loops[which] = Arc::new(record);
                let fresh = check(&surface, &loops.iter().map(|l| &**l).collect::<Vec<_>>());
                prop_assert_eq!(memory.check(&surface, &loops), fresh);
            }
        }
    }

    #[test]
    fn only_the_loop_that_moved_is_looked_at() {
        let surface = Arc::new(plane());
        let mut loops = sieve(10);
        let mut memory = Memory::default();
        let all: usize = loops.iter().map(|l| l.curves.len()).sum();
        assert_eq!(memory.curves_to_check(&surface, &loops), all);
        assert_eq!(memory.check(&surface, &loops), []);
        loops[7] = Arc::new(moved(&loops[7], DVec2::new(0.1, 0.0), 1.0));
        assert_eq!(memory.curves_to_check(&surface, &loops), loops[7].curves.len());
        assert!(!memory.check(&surface, &loops).is_empty(), "it lies on its neighbour");
    }
}
