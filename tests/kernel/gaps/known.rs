//! Gaps put in on purpose, of which the size is known in closed form, are found to one percent.

use glam::{DVec2, DVec3};
use hairline::inspect::{EdgeKind, Gap, GapSense, Inspection};
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2};
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
