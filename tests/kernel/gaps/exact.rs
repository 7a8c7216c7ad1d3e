//! Nothing is invented where sides coincide, however they are written; every part of every curve is classed.

use glam::{DVec2, DVec3};
use hairline::inspect::{EdgeKind, Inspection, Statistics};
use hairline::kernel::nurbs::NurbsCurve2;
use hairline::kernel::primitives::{arc, revolution};
use hairline::scene::records::FaceRecord;

use super::pairs::*;

fn assert_no_gap(inspection: &Inspection, what: &str) {
    let size = inspection.scale().size;
    let largest = Statistics::of(inspection).quantile(1.0);
    assert!(largest <= 1e-12 * size, "{what}: {largest:e} invented at size {size}");
    assert_complete(inspection);
}

#[test]
fn no_way_of_writing_a_side_makes_a_gap() {
    for seed in 0..3 {
        for how in 0..16 {
            let what = format!("surface {seed}, written as {how}");
            let inspection = Inspection::of(&divided(&hills(seed), how));
            assert_no_gap(&inspection, &what);
            let shared = of_kind(&inspection, EdgeKind::Shared);
            assert_eq!((shared.len(), of_kind(&inspection, EdgeKind::Naked).len()), (1, 6), "{what}");
            let gap = shared[0].gap.expect("shared edges have gaps");
            assert!(gap.angle < 1e-6, "{what}: the surface goes on smoothly, angle {}", gap.angle);
            // Both loops run counter-clockwise, unless turned or mirrored: against each other.
            let against = (how & 8 == 0) == (how & 1 == 0) || how & 1 != 0;
            assert_eq!(shared[0].uses[1].forward, !(how & 8 == 0), "{what} {against}");
        }
    }
}

#[test]
fn different_splits_and_t_junctions_are_matched_part_by_part() {
    let surface = hills(5);
    let [left, right] = divided(&surface, 6);
    let split = |face: &FaceRecord, at: &[f64]| {
        let mut face = face.clone();
        let curves: Vec<NurbsCurve2> = face.loops[0]
            .curves
            .iter()
            .flat_map(|c| {
                let (a, b) = c.domain();
                let stops: Vec<f64> = [0.0].iter().chain(at).chain(&[1.0]).map(|s| a + (b - a) * s).collect();
                stops
                    .windows(2)
                    .map(|w| c.restricted(w[0], w[1]).expect("valid test data"))
                    .collect::<Vec<_>>()
            })
            .collect();
        face.loops[0].curves = curves;
        face
    };
    for (a, b, edges) in [
        (split(&left, &[]), split(&right, &[0.3]), 2),
        (split(&left, &[0.2, 0.6]), split(&right, &[]), 3),
        (split(&left, &[0.25]), split(&right, &[0.4, 0.9]), 4),
    ] {
        let inspection = Inspection::of(&[a, b]);
        assert_no_gap(&inspection, "split sides");
        let shared = of_kind(&inspection, EdgeKind::Shared);
        let length: f64 = shared.iter().map(|e| e.length()).sum();
        let whole = Inspection::of(&divided(&surface, 0));
        let expected = of_kind(&whole, EdgeKind::Shared)[0].length();
        assert_eq!(shared.len(), edges);
        assert!((length - expected).abs() < 1e-6 * expected, "{length}, expected {expected}");
    }
}

#[test]
fn a_face_between_two_is_a_t_junction() {
    // Two small squares beside a large one: its right side is two edges.
    let faces = [
        face(plane(100.0, 0.0), vec![rectangle([0.0, 0.0], [0.5, 1.0])]),
        face(plane(100.0, 0.0), vec![rectangle([0.5, 0.0], [0.8, 0.35])]),
        face(plane(100.0, 0.0), vec![rectangle([0.5, 0.35], [0.8, 1.0])]),
    ];
    let inspection = Inspection::of(&faces);
    assert_no_gap(&inspection, "squares");
    let mut lengths: Vec<f64> = of_kind(&inspection, EdgeKind::Shared).iter().map(|e| e.length()).collect();
    lengths.sort_by(f64::total_cmp);
    let expected = [30.0, 35.0, 65.0];
    assert!(lengths.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{lengths:?}");
}

#[test]
fn closed_surfaces_have_seams_and_poles() {
    let half = arc(DVec3::ZERO, DVec3::X, DVec3::Z, -0.5 * std::f64::consts::PI, 0.5 * std::f64::consts::PI);
    let ball = revolution(&half.expect("valid test data"), DVec3::ZERO, DVec3::Z, 0.0, std::f64::consts::TAU)
        .expect("valid test data");
    let inspection = Inspection::of(&[face(ball, vec![])]);
    let count = |kind| of_kind(&inspection, kind).len();
    assert_eq!(
        [EdgeKind::Seam, EdgeKind::Degenerate, EdgeKind::Naked].map(count),
        [1, 2, 0],
        "{:?}",
        Statistics::of(&inspection)
    );
    assert_no_gap(&inspection, "ball");
    // Two halves that meet in two meridians and at both poles.
    let halves = [(0.0, 3.0), (3.0, std::f64::consts::TAU)].map(|(from, to)| {
        let half =
            arc(DVec3::ZERO, DVec3::X, DVec3::Z, -0.5 * std::f64::consts::PI, 0.5 * std::f64::consts::PI);
        face(
            revolution(&half.expect("valid test data"), DVec3::ZERO, DVec3::Z, from, to)
                .expect("valid test data"),
            vec![],
        )
    });
    let inspection = Inspection::of(&halves);
    let count = |kind| of_kind(&inspection, kind).len();
    assert_eq!([EdgeKind::Shared, EdgeKind::Degenerate, EdgeKind::Naked].map(count), [2, 4, 0]);
    assert_no_gap(&inspection, "two halves of a ball");
}

#[test]
fn circles_that_start_elsewhere_are_matched_in_two_parts() {
    let circle = |turn: f64| {
        let (sin, cos) = f64::sin_cos(turn);
        let curve = arc(
            DVec3::new(0.5, 0.5, 0.0),
            DVec3::new(cos, sin, 0.0) * 0.2,
            DVec3::new(-sin, cos, 0.0) * 0.2,
            0.0,
            std::f64::consts::TAU,
        );
        curve.expect("valid test data").map_points(DVec3::truncate)
    };
    let outside = face(plane(50.0, 0.0), vec![rectangle([0.0, 0.0], [1.0, 1.0]), vec![circle(0.3)]]);
    let inside = face(plane(50.0, 0.0), vec![vec![circle(2.0)]]);
    let inspection = Inspection::of(&[outside, inside]);
    assert_no_gap(&inspection, "a disc in a hole");
    let shared = of_kind(&inspection, EdgeKind::Shared);
    let length: f64 = shared.iter().map(|e| e.length()).sum();
    assert_eq!(shared.len(), 2);
    assert!((length - 20.0 * std::f64::consts::PI).abs() < 1e-6);
    let gap = shared[0].gap.expect("valid test data");
    assert!(gap.angle < 1e-6, "the disc lies in the hole, not on the plate: {}", gap.angle);
}

#[test]
fn a_fold_has_its_angle() {
    let floor = face(plane(10.0, 0.0), vec![]);
    // Stands on the side y = 0, leaning out by 30 degrees from upright.
    let lean = DVec2::from_angle(120f64.to_radians());
    let mut wall = face(plane(10.0, 0.0), vec![]);
    wall.surface = wall.surface.map_points(|p| DVec3::new(p.x, p.y * lean.x, p.y * lean.y));
    let inspection = Inspection::of(&[floor, wall]);
    let shared = of_kind(&inspection, EdgeKind::Shared);
    assert_eq!(shared.len(), 1);
    let angle = shared[0].gap.expect("valid test data").angle.to_degrees();
    assert!((angle - 60.0).abs() < 1e-9, "{angle}");
}

#[test]
fn skins_of_a_sheet_and_sides_of_a_slot_are_not_neighbours() {
    let faces = [face(plane(100.0, 0.0), vec![]), face(plane(100.0, 0.5), vec![])];
    let inspection = Inspection::of(&faces);
    assert_eq!(of_kind(&inspection, EdgeKind::Naked).len(), 8, "two skins");
    // A slot 0.5 wide in one face.
    let slot = rectangle([0.1, 0.5], [0.9, 0.505]);
    let inspection =
        Inspection::of(&[face(plane(100.0, 0.0), vec![rectangle([0.0, 0.0], [1.0, 1.0]), slot])]);
    assert_eq!(of_kind(&inspection, EdgeKind::Naked).len(), 8, "slot");
    // A box of 0.5 height without a bottom: the lower edges stay naked beside the shared upper ones.
    let top = face(plane(100.0, 0.5), vec![]);
    let wall = |from: DVec3, along: DVec3| {
        let mut wall = face(plane(1.0, 0.0), vec![]);
        wall.surface = wall.surface.map_points(|p| from + along * p.x + DVec3::Z * 0.5 * p.y);
        wall
    };
    let (x, y) = (DVec3::X * 100.0, DVec3::Y * 100.0);
    let faces = [top, wall(DVec3::ZERO, x), wall(x, y), wall(x + y, -x), wall(y, -y)];
    let inspection = Inspection::of(&faces);
    let count = |kind| of_kind(&inspection, kind).len();
    assert_eq!([EdgeKind::Shared, EdgeKind::Naked].map(count), [8, 4]);
    assert_no_gap(&inspection, "box");
}
