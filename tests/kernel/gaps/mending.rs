//! Gaps that trims can close are closed, as one edit that can be taken back; others are refused with a reason.

use glam::{DVec2, DVec3};
use hairline::inspect::mend::{MendError, MendOptions, close};
use hairline::inspect::{Edge, EdgeKind, Inspection};
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2};
use hairline::scene::document::SceneRecord;
use hairline::scene::records::{FaceRecord, ModelRecord};

use super::pairs::*;

const TOLERANCE: f64 = 1e-6;

fn shared(faces: &[FaceRecord]) -> Edge {
    let inspection = Inspection::of(faces);
    let edges = of_kind(&inspection, EdgeKind::Shared);
    assert_eq!(edges.len(), 1);
    edges[0].clone()
}

fn options(side: Option<usize>) -> MendOptions {
    MendOptions { tolerance: TOLERANCE, side, model: 0 }
}

/// Closes the only shared edge through a scene; the gap that a new inspection finds.
fn mend(faces: &[FaceRecord], side: Option<usize>) -> f64 {
    let edge = shared(faces);
    let mended = close(faces, &edge, &options(side)).expect("it can be closed");
    assert!(mended.before > TOLERANCE && mended.after <= TOLERANCE, "{mended:?}");
    assert!((mended.before - edge.gap.expect("valid test data").maximum).abs() <= 1e-3 * mended.before);
    let model = ModelRecord { faces: faces.to_vec(), ..ModelRecord::default() };
    let before = SceneRecord { models: vec![model], ..SceneRecord::default() };
    let mut scene = before.clone();
    mended.edit.apply(&mut scene).expect("it fits the scene");
    // Loops stay closed, bit for bit.
    for trim_loop in &scene.models[0].faces[mended.face].loops {
        let end = |c: &NurbsCurve2, last: bool| c.point(if last { c.domain().1 } else { c.domain().0 });
        let count = trim_loop.curves.len();
        for k in 0..count {
            let (this, next) = (&trim_loop.curves[k], &trim_loop.curves[(k + 1) % count]);
            assert!((end(this, true) - end(next, false)).length() < 1e-14, "curve {k} is joined to the next");
        }
    }
    let after = shared(&scene.models[0].faces).gap.expect("valid test data").maximum;
    assert!((after - mended.after).abs() <= 1e-3 * after + 1e-12, "{after} as said: {}", mended.after);
    mended.edit.inverse().apply(&mut scene).expect("it can be taken back");
    assert_eq!(scene, before);
    after
}

#[test]
fn a_bump_is_flattened_from_either_side() {
    for size in [1e-3, 0.05, 0.5] {
        let surface = hills(4);
        let [left, mut right] = divided(&surface, 0);
        let curve = &right.loops[0].curves[3];
        let mut points = curve.points().to_vec();
        points[2] += DVec2::new(size / 40.0, 0.1 * size / 40.0);
        right.loops[0].curves[3] = NurbsCurve2::new(curve.knots().clone(), points, curve.weights().to_vec())
            .expect("valid test data");
        let faces = [left, right];
        for side in [None, Some(0), Some(1)] {
            assert!(mend(&faces, side) <= TOLERANCE);
        }
    }
}

#[test]
fn a_straight_side_follows_a_curved_one() {
    // The lower square ends in a line, the upper one in a curve with an inflection, off at both ends too.
    let lower = face(plane(50.0, 0.0), vec![rectangle([0.0, 0.0], [1.0, 0.5])]);
    let mut curves = rectangle([0.0, 0.5], [1.0, 1.0]);
    let points = [(0.0, 0.5005), (0.3, 0.5025), (0.6, 0.498), (1.0, 0.5003)].map(DVec2::from);
    curves[0] = NurbsCurve2::new(
        KnotVector::bezier(3, 0.0, 1.0).expect("valid test data"),
        points.to_vec(),
        vec![1.0, 2.0, 1.0, 1.0],
    )
    .expect("valid test data");
    curves[1] = NurbsCurve2::line(points[3], DVec2::new(1.0, 1.0));
    curves[3] = NurbsCurve2::line(DVec2::new(0.0, 1.0), points[0]);
    let faces = [lower, face(plane(50.0, 0.0), vec![curves])];
    assert!(mend(&faces, Some(0)) <= TOLERANCE);
    assert!(mend(&faces, Some(1)) <= TOLERANCE);
}

#[test]
fn what_trims_cannot_close_is_refused_with_the_distance_left() {
    let (lower, upper) = (face(cylinder(20.0, 0.0, 15.0), vec![]), cylinder(20.0, 15.0, 40.0));
    let apart = face(upper.map_points(|p| p + DVec3::Z * 0.02), vec![]);
    let faces = [lower.clone(), apart];
    let refusal = close(&faces, &shared(&faces), &options(None));
    assert!(
        matches!(refusal, Err(MendError::SurfacesApart { left, .. }) if (left - 0.02).abs() < 1e-6),
        "{refusal:?}"
    );
    let step = face(cylinder(20.01, 15.0, 40.0), vec![]);
    let faces = [lower.clone(), step];
    let refusal = close(&faces, &shared(&faces), &options(None));
    assert!(matches!(refusal, Err(MendError::SurfacesApart { left, .. }) if left > 0.0099), "{refusal:?}");
    // Overlapping cylinders: the upper border of the lower one can be drawn back, as a loop of its own.
    let overlap = face(upper.map_points(|p| p - DVec3::Z * 0.02), vec![]);
    assert!(mend(&[lower, overlap], Some(0)) <= TOLERANCE);
}

#[test]
fn other_edges_and_tolerances_are_refused() {
    let faces = divided(&hills(0), 0);
    let edge = shared(&faces);
    assert!(matches!(close(&faces, &edge, &options(None)), Err(MendError::Closed { .. })));
    let bad = MendOptions { tolerance: 0.0, ..options(None) };
    assert!(matches!(close(&faces, &edge, &bad), Err(MendError::Tolerance { .. })));
    assert!(matches!(close(&faces[..1], &edge, &options(None)), Err(MendError::Stale { face: 2 })));
    let naked = Edge { uses: edge.uses[..1].to_vec(), ..edge };
    assert!(matches!(close(&faces, &naked, &options(None)), Err(MendError::Sides { sides: 1 })));
}
