//! Gaps put in on purpose, of which the size is known in closed form, are found to one percent.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use hairline::inspect::{EdgeKind, Gap, GapSense, Inspection};
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2};
use hairline::kernel::primitives::{arc, extrusion};
use hairline::scene::records::FaceRecord;

use super::pairs::*;

/// 1 nm to 1 mm.
const SIZES: [f64; 7] = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0];

/// The gap of the only shared edge.
fn gap(faces: &[FaceRecord], what: &str) -> Gap {
    let inspection = Inspection::of(faces);
    assert_complete(&inspection);
    let shared = of_kind(&inspection, EdgeKind::Shared);
    assert_eq!(shared.len(), 1, "{what}: {:#?}", inspection.edges().collect::<Vec<_>>());
    shared[0].gap.expect("shared edges have gaps")
}

fn assert_gap(gap: &Gap, size: f64, what: &str) {
    assert!((gap.maximum - size).abs() <= 0.01 * size, "{what}: {:e}, expected {size:e}", gap.maximum);
    let bound = gap.maximum + gap.error_bound;
    assert!(bound >= size * (1.0 - 1e-9) - 1e-12, "{what}: bound {bound:e} below {size:e}");
    assert!(gap.error_bound <= 0.01 * size, "{what}: bound {:e} for {size:e}", gap.error_bound);
    let ends = (gap.between[0].point - gap.between[1].point).length();
    assert!((ends - gap.maximum).abs() <= 1e-9 * size + 1e-12, "{what}: ends {ends:e} apart");
    let parts = gap.across.hypot(gap.step);
    assert!((parts - gap.maximum).abs() <= 1e-6 * size + 1e-12, "{what}: across and step make {parts:e}");
}

fn moved(face: &FaceRecord, by: DVec3) -> FaceRecord {
    FaceRecord { surface: face.surface.map_points(|p| p + by), ..face.clone() }
}

#[test]
fn cylinders_drawn_apart_or_together() {
    for size in SIZES {
        for how in 0..8 {
            let (lower, upper) = (cylinder(20.0, 0.0, 15.0), cylinder(20.0, 15.0, 40.0));
            let upper = face(rewritten(&upper, how), vec![]);
            let lower = face(lower, vec![]);
            for (by, sense) in [(size, GapSense::Opening), (-size, GapSense::Overlap)] {
                let what = format!("cylinder {size} {how} {sense:?}");
                let found = gap(&[lower.clone(), moved(&upper, DVec3::Z * by)], &what);
                assert_gap(&found, size, &what);
                assert_eq!(found.sense, sense, "{what}: {found:?}");
                assert!((found.across + by).abs() <= 1e-3 * size, "{what}: {found:?}");
                assert!((found.mean - size).abs() <= 0.01 * size, "{what}: mean {:e}", found.mean);
            }
        }
    }
}

#[test]
fn a_step_between_radii() {
    for size in SIZES {
        let lower = face(cylinder(20.0, 0.0, 15.0), vec![]);
        let upper = face(rewritten(&cylinder(20.0 + size, 15.0, 40.0), 7), vec![]);
        let what = format!("step {size}");
        let found = gap(&[lower, upper], &what);
        assert_gap(&found, size, &what);
        assert_eq!(found.sense, GapSense::Step, "{found:?}");
    }
}

#[test]
fn a_face_slid_along_its_edge_stands_out_at_both_ends() {
    for size in SIZES {
        let lower = face(plane(50.0, 0.0), vec![rectangle([0.0, 0.0], [1.0, 0.5])]);
        let upper = face(plane(50.0, 0.0), vec![rectangle([0.0, 0.5], [1.0, 1.0])]);
        let what = format!("slid by {size}");
        let faces = [lower, moved(&upper, DVec3::X * size)];
        let found = gap(&faces, &what);
        assert!((found.maximum - size).abs() <= 1e-9 * size + 1e-13, "{what}: {found:?}");
        assert_eq!(found.sense, GapSense::Opening, "{what}");
        assert!(
            (found.along - size).abs() <= 1e-6 * size + 1e-13 && found.step <= 1e-12,
            "{what}: {found:?}"
        );
        assert_eq!(of_kind(&Inspection::of(&faces), EdgeKind::Naked).len(), 6, "{what}");
    }
    // Slid much further it is a partial overlap: what is beside nothing is naked.
    let lower = face(plane(50.0, 0.0), vec![rectangle([0.0, 0.0], [1.0, 0.5])]);
    let upper = face(plane(50.0, 0.0), vec![rectangle([0.0, 0.5], [1.0, 1.0])]);
    let faces = [lower, moved(&upper, DVec3::X * 15.0)];
    assert!(gap(&faces, "far").maximum <= 1e-12);
    assert_eq!(of_kind(&Inspection::of(&faces), EdgeKind::Naked).len(), 8);
}

#[test]
fn lids_moved_off_a_tube_have_the_length_of_the_move() {
    // Closed curves with seams in other places: somewhere the way is perpendicular to the circle.
    let circle = |height: f64| arc(DVec3::Z * height, DVec3::X * 20.0, DVec3::Y * 20.0, 0.0, TAU);
    let tube = extrusion(&circle(0.0).expect("valid test data"), DVec3::Z * 15.0).expect("valid test data");
    for size in SIZES {
        for turn in [0.0, 1e-4, 0.02, 1.0] {
            let axis = DVec2::from_angle(turn);
            let (x, y) = (axis.extend(0.0) * 0.4, axis.perp().extend(0.0) * 0.4);
            let rim = arc(DVec3::new(0.5, 0.5, 0.0), x, y, 0.0, TAU).expect("valid test data");
            let mut lid = face(plane(50.0, 15.0), vec![vec![rim.map_points(DVec3::truncate)]]);
            let by = DVec3::new(-0.48, 0.6, 0.64) * size;
            lid.surface = lid.surface.map_points(|p| p - DVec3::new(25.0, 25.0, 0.0) + by);
            let what = format!("lid {size} turned by {turn}");
            let inspection = Inspection::of(&[face(tube.clone(), vec![]), lid]);
            assert_complete(&inspection);
            let shared = of_kind(&inspection, EdgeKind::Shared);
            let gaps = shared.iter().map(|e| e.gap.expect("shared edges have gaps"));
            let worst = gaps.max_by(|a, b| a.maximum.total_cmp(&b.maximum)).expect("the rim is shared");
            assert!((worst.maximum - size).abs() <= 0.01 * size, "{what}: {worst:?}");
            assert_eq!(of_kind(&inspection, EdgeKind::Naked).len(), 1, "{what}: the other rim");
        }
    }
}

#[test]
fn balls_cut_along_a_circle() {
    for size in SIZES {
        let lower = face(ball(30.0, -0.4, 0.2), vec![]);
        let upper = face(rewritten(&ball(30.0, 0.2, 0.9), 5), vec![]);
        let what = format!("ball {size}");
        // The circle lies in a plane of constant z.
        let found = gap(&[lower, moved(&upper, DVec3::Z * size)], &what);
        assert_gap(&found, size, &what);
        assert_eq!(found.sense, GapSense::Opening, "{found:?}");
    }
}

#[test]
fn bumps_in_a_pcurve_have_their_height_and_mean() {
    // The parabola of height `size` over the straight side of a square of side 50, at z = 0.
    for size in SIZES {
        for place in [1.0, -1.0] {
            let height = size / 50.0 * place;
            let top = 0.5 + height;
            let lower = face(plane(50.0, 0.0), vec![rectangle([0.0, 0.0], [1.0, 0.5])]);
            let parabola = NurbsCurve2::new(
                KnotVector::bezier(2, 0.0, 1.0).expect("valid test data"),
                // The middle control point lies twice as high as the curve.
                vec![DVec2::new(0.0, 0.5), DVec2::new(0.5, 2.0 * top - 0.5), DVec2::new(1.0, 0.5)],
                vec![1.0; 3],
            );
            let mut curves = rectangle([0.0, 0.5], [1.0, 1.0]);
            curves[0] = parabola.expect("valid test data");
            let what = format!("bump {size} {place}");
            let found = gap(&[lower, face(plane(50.0, 0.0), vec![curves])], &what);
            assert_gap(&found, size, &what);
            assert!((found.mean - 2.0 / 3.0 * size).abs() <= 0.01 * size, "{what}: mean {:e}", found.mean);
            assert!((found.between[0].uv.x - 0.5).abs() < 0.02, "{what}: {:?}", found.between);
            let sense = if place > 0.0 { GapSense::Opening } else { GapSense::Overlap };
            assert_eq!(found.sense, sense, "{what}");
        }
    }
}

#[test]
fn a_narrow_bump_on_a_free_form_surface_is_found() {
    // One side's pcurve is pushed in u at one control point of many; the measure is a dense search.
    for size in [1e-6, 1e-4, 1e-2] {
        let surface = hills(2);
        let [left, mut right] = divided(&surface, 0);
        let base = &right.loops[0].curves[3];
        let fine: Vec<f64> = (1..20).map(|k| f64::from(k) / 20.0).collect();
        let fine = base.inserted(&fine).expect("valid test data");
        let mut points = fine.points().to_vec();
        points[11].x += size;
        let pushed =
            NurbsCurve2::new(fine.knots().clone(), points, fine.weights().to_vec()).expect("valid test data");
        let lift = |c: &NurbsCurve2, t: f64| {
            let uv = c.point(t);
            surface.point(uv.x, uv.y)
        };
        // Feet on the tangent of the old curve are close enough at these sizes.
        let known = (0..=20_000).map(|k| f64::from(k) / 20_000.0).map(|t| {
            let apart = lift(&pushed, t) - lift(&fine, t);
            let d = fine.derivatives(t, 1);
            let jet = surface.jet(d[0].x, d[0].y);
            let along = (jet.du * d[1].x + jet.dv * d[1].y).normalize();
            (apart - along * apart.dot(along)).length()
        });
        let known = known.fold(0.0, f64::max);
        right.loops[0].curves[3] = pushed;
        let what = format!("narrow bump {size}");
        let found = gap(&[left, right], &what);
        assert!(
            (found.maximum - known).abs() <= 0.01 * known,
            "{what}: {:e}, expected {known:e}",
            found.maximum
        );
    }
}

#[test]
fn gaps_of_many_humps_are_measured_at_the_highest() {
    // Control points off at random, as rounding leaves them: against a dense search over both curves.
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    for seed in 0..12 {
        let surface = hills(seed);
        let [left, mut right] = divided(&surface, 0);
        let base = &right.loops[0].curves[3];
        let count = 1 + 2 * seed;
        let inner: Vec<f64> = (1..=count).map(|k| f64::from(k) / f64::from(count + 1)).collect();
        let fine = base.inserted(&inner).expect("valid test data");
        let size = 10f64.powi(-2 - (seed as i32) % 4);
        let mut points = fine.points().to_vec();
        let last = points.len() - 1;
        points[1..last].iter_mut().for_each(|p| p.x += size / 40.0 * random());
        let pushed =
            NurbsCurve2::new(fine.knots().clone(), points, fine.weights().to_vec()).expect("valid test data");
        let known = (0..=20_000).map(|k| f64::from(k) / 20_000.0).map(|t| {
            let (d, e) = (fine.derivatives(t, 1), pushed.point(t));
            let jet = surface.jet(d[0].x, d[0].y);
            let along = (jet.du * d[1].x + jet.dv * d[1].y).normalize();
            let apart = surface.point(e.x, e.y) - jet.point;
            (apart - along * apart.dot(along)).length()
        });
        let known = known.fold(0.0, f64::max);
        right.loops[0].curves[3] = pushed;
        let found = gap(&[left, right], "humps");
        let off = (found.maximum / known - 1.0).abs();
        assert!(off <= 0.01, "seed {seed}: {:e}, expected {known:e}", found.maximum);
        assert!(found.maximum + found.error_bound >= known * (1.0 - 1e-4), "seed {seed}: {found:?}");
    }
}

#[test]
fn absurd_scales_keep_the_figures() {
    // (size of the model, where it lies): parts of 1e-3 at 1e6 have 1e-10 of rounding.
    for (scale, far) in [(1e-6, 0.0), (1.0, 1e4), (1e6, 0.0), (1e-3, 1e3), (1e-3, 1e6)] {
        let size = 1e-3 * scale;
        let place = |face: &FaceRecord| FaceRecord {
            surface: face.surface.map_points(|p| p * scale + DVec3::splat(far)),
            ..face.clone()
        };
        let lower = face(cylinder(20.0, 0.0, 15.0), vec![]);
        let upper = moved(&face(cylinder(20.0, 15.0, 40.0), vec![]), DVec3::Z * 1e-3);
        let what = format!("scale {scale}, far {far}");
        let found = gap(&[place(&lower), place(&upper)], &what);
        let rounding = 64.0 * f64::EPSILON * (far + 40.0 * scale);
        assert!((found.maximum - size).abs() <= 0.01 * size + rounding, "{what}: {:e}", found.maximum);
    }
}
