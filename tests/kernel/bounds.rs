//! Tight boxes of trimmed faces against closed forms.

use std::f64::consts::TAU;

use glam::{DMat3, DVec2, DVec3};
use hairline::kernel::bezier::{BezierCurve2, BezierPatch};
use hairline::kernel::face::UvRect;
use hairline::kernel::nurbs::NurbsSurface;
use hairline::kernel::primitives;
use hairline::kernel::query::{Boundary, Sheet, trimmed_bounds};
use hairline::kernel::trim::PieceList;
use hairline::kernel::view::Bounds;

use crate::zoo::{Seed, arc, sphere, torus};

fn bounds(surface: &NurbsSurface, loops: &[Vec<BezierCurve2>]) -> Bounds {
    let mut pieces = PieceList::default();
    for curves in loops {
        curves.iter().for_each(|c| pieces.push(&c.points, &c.weights, None));
        pieces.close_chain();
    }
    let unit = UvRect { min: DVec2::ZERO, max: DVec2::ONE };
    let patches: Vec<BezierPatch> = surface.to_bezier();
    trimmed_bounds(&Sheet::new(&patches), &Boundary::new(&pieces, &unit))
}

fn assert_bounds(found: Bounds, min: DVec3, max: DVec3) {
    let off = (found.min - min).abs().max((found.max - max).abs()).max_element();
    assert!(off < 3e-8 * (max - min).length(), "{found:?}, expected {min} {max}");
}

/// Some rotations, the first one none.
fn turns() -> impl Iterator<Item = DMat3> {
    let mut seed = Seed(9);
    std::iter::once(DMat3::IDENTITY).chain((0..6).map(move |_| {
        let axis = seed.point3().normalize();
        DMat3::from_axis_angle(axis, seed.between(0.0, 6.0))
    }))
}

#[test]
fn a_sphere_in_any_attitude_fills_its_cube() {
    for turn in turns() {
        let found = bounds(&sphere().map_points(|p| turn * p + DVec3::splat(5.0)), &[]);
        assert_bounds(found, DVec3::splat(4.0), DVec3::splat(6.0));
    }
}

#[test]
fn a_torus_in_any_attitude() {
    for turn in turns() {
        let (major, minor) = (2.0, 0.7);
        let axis = turn.z_axis;
        // Reach along a direction d: the ring reaches R |d x axis|, the tube r more.
        let ring = DVec3::new(
            axis.cross(DVec3::X).length(),
            axis.cross(DVec3::Y).length(),
            axis.cross(DVec3::Z).length(),
        );
        let reach = major * ring + minor;
        assert_bounds(bounds(&torus(major, minor).map_points(|p| turn * p), &[]), -reach, reach);
    }
}

#[test]
fn a_cap_of_the_sphere_stops_at_its_rim() {
    // The square |x|, |y| <= ... of uv around the point at u = 0.5, v = 1.5, a circle in uv.
    let cap: Vec<BezierCurve2> =
        arc(DVec2::new(0.5, 1.5), 0.3, 4).to_bezier().into_iter().map(|(piece, _)| piece).collect();
    let found = bounds(&sphere(), &[cap]);
    let surface = sphere();
    let mut expected = Bounds::EMPTY;
    for k in 0..200_000 {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 200_000.0).sin_cos();
        let p = surface.point(0.5 + 0.3 * cos, 1.5 + 0.3 * sin);
        expected = expected.union(Bounds { min: p, max: p });
    }
    assert_bounds(found, expected.min, expected.max);
}

#[test]
fn random_patches_are_held_and_touched() {
    let mut seed = Seed(4);
    for round in 0..20 {
        let degrees = (1 + seed.below(4), 1 + seed.below(4));
        let patch = seed.patch(degrees, round % 2 == 0);
        let patches = [patch.clone()];
        let found = trimmed_bounds(&Sheet::new(&patches), &Boundary::default());
        let grid = (0..401 * 401).map(|k| patch.point((k / 401) as f64 / 400.0, (k % 401) as f64 / 400.0));
        let sampled = Bounds::of(grid);
        let size = sampled.diagonal();
        assert!(found.min.cmple(sampled.min + 1e-7 * size).all(), "{found:?} {sampled:?}");
        assert!(found.max.cmpge(sampled.max - 1e-7 * size).all(), "{found:?} {sampled:?}");
        // Sampling misses little, but for the spikes that weights of 0.01 to 100 make.
        if patch.is_rational() {
            continue;
        }
        let off = (found.min - sampled.min).abs().max((found.max - sampled.max).abs()).max_element();
        assert!(off < 2e-3 * size, "{found:?} {sampled:?}");
    }
}

#[test]
fn a_peak_on_the_cut_between_two_parts_is_found() {
    // A ring whose patches meet beside the extremes in v and are cut right through them in u.
    let (major, minor) = (10.0, 3.0);
    for start in [3.927, 4.712, 5.883] {
        let centre = DVec3::new(major, 0.0, 0.0);
        let tube = primitives::arc(centre, DVec3::X * minor, DVec3::Y * minor, start, start + TAU).unwrap();
        let ring = primitives::revolution(&tube, DVec3::ZERO, DVec3::Y, 0.0, TAU).unwrap();
        let reach = DVec3::new(major + minor, minor, major + minor);
        assert_bounds(bounds(&ring, &[]), -reach, reach);
    }
}
