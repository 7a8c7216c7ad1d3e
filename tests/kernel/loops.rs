//! Trim loops as files have them: seams, rings, poles, gaps, missing outer loops.

use glam::{DVec2, DVec3};
use hairline::commands::bench::shapes::circle;
use hairline::kernel::face::{Face, Side, TrimRemark};
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
use hairline::scene::records::{FaceRecord, LoopRecord, LoopRole};

/// A cone frustum about z: u in 0..4 goes once round, v in 0..1 from radius `bottom` to `top`.
fn cone(bottom: f64, top: f64) -> NurbsSurface {
    let knots_u = KnotVector::new(2, vec![0., 0., 0., 1., 1., 2., 2., 3., 3., 4., 4., 4.]).expect("sorted");
    let knots_v = KnotVector::bezier(1, 0.0, 1.0).expect("degree 1");
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    let round = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    for (i, (x, y)) in round.into_iter().enumerate() {
        for (radius, z) in [(bottom, 0.0), (top, 3.0)] {
            points.push(DVec3::new(f64::from(x) * radius, f64::from(y) * radius, z));
            weights.push(if i % 2 == 0 { 1.0 } else { half });
        }
    }
    NurbsSurface::new(knots_u, knots_v, points, weights).expect("counts fit")
}

fn plane() -> NurbsSurface {
    let knots = || KnotVector::bezier(1, 0.0, 1.0).expect("degree 1");
    let points = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    NurbsSurface::new(knots(), knots(), points.to_vec(), vec![1.0; 4]).expect("counts fit")
}

fn face(surface: NurbsSurface, loops: Vec<LoopRecord>) -> Face {
    let record = FaceRecord::new(surface, loops);
    record.derive().expect("a valid face")
}

/// An open chain of lines.
fn lines(points: &[(f64, f64)]) -> Vec<NurbsCurve2> {
    points.windows(2).map(|p| NurbsCurve2::line(DVec2::from(p[0]), DVec2::from(p[1]))).collect()
}

fn record(curves: Vec<NurbsCurve2>) -> LoopRecord {
    LoopRecord::new(LoopRole::Unknown, curves)
}

fn round_hole(u: f64, v: f64, radius: f64) -> LoopRecord {
    let curves = circle(DVec2::new(u, v), radius, 0.3, true);
    let knots = || KnotVector::bezier(2, 0.0, 1.0).expect("degree 2");
    let curve = |c: hairline::kernel::bezier::BezierCurve2| NurbsCurve2::new(knots(), c.points, c.weights);
    record(curves.into_iter().map(|c| curve(c).expect("counts fit")).collect())
}

fn expect(face: &Face, points: &[(f64, f64, Side)]) {
    for (u, v, side) in points {
        assert_eq!(
            face.classify_native(*u, *v),
            *side,
            "({u}, {v}) in {:?}, {:?}",
            face.domain,
            face.remarks
        );
    }
}

use Side::{In, On, Out};

#[test]
fn no_loop_is_the_whole_surface_and_its_border_is_on() {
    let face = face(plane(), vec![]);
    expect(&face, &[(0.5, 0.5, In), (0.0, 0.5, On), (1.0, 1.0, On), (1.1, 0.5, Out), (f64::NAN, 0.5, Out)]);
    // For drawing, points on the border count as inside: no seam may leak.
    use hairline::kernel::trim::TrimStructure;
    for p in [(0.0, 0.0), (1.0, 0.3), (0.3, 1.0), (1.000_000_2, 0.5)] {
        assert!(face.grid.classify(glam::Vec2::new(p.0, p.1)), "{p:?}");
    }
}

#[test]
fn two_rings_without_seam_bound_a_band_whatever_their_direction_and_start() {
    for (from, to, start) in [(0.0, 4.0, 1.5), (4.0, 0.0, 1.5), (0.0, 4.0, -2.0)] {
        let low = record(lines(&[(from, 0.2), (0.5 * (from + to), 0.3), (to, 0.2)]));
        let high = record(lines(&[(start, 0.8), (start + 4.0, 0.8)]));
        let face = face(cone(1.0, 1.0), vec![low, high]);
        expect(
            &face,
            &[
                (0.1, 0.5, In),
                (3.9, 0.5, In),
                (2.0, 0.28, Out),
                (0.1, 0.28, In),
                (2.0, 0.9, Out),
                (1.0, 0.1, Out),
            ],
        );
        assert!(face.remarks.iter().any(|r| matches!(r, TrimRemark::OpenByPeriod { .. })));
    }
}

#[test]
fn a_single_ring_bounds_the_side_of_the_pole() {
    let ring = || vec![record(lines(&[(4.0, 0.5), (0.0, 0.5)]))];
    expect(&face(cone(1.0, 0.0), ring()), &[(1.0, 0.7, In), (3.9, 0.99, In), (1.0, 0.3, Out)]);
    expect(&face(cone(0.0, 1.0), ring()), &[(1.0, 0.3, In), (0.1, 0.01, In), (1.0, 0.7, Out)]);
    // No pole: the face lies to the left of the ring.
    expect(&face(cone(1.0, 1.0), ring()), &[(1.0, 0.3, In), (1.0, 0.7, Out)]);
}

#[test]
fn holes_over_the_seam_are_cut_on_both_sides() {
    let outer = record(lines(&[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (0.0, 1.0), (0.0, 0.0)]));
    for u in [0.0, 4.0] {
        let face = face(cone(1.0, 1.0), vec![outer.clone(), round_hole(u, 0.5, 0.3)]);
        let points = [(0.2, 0.5, Out), (3.8, 0.5, Out), (0.4, 0.5, In), (3.6, 0.5, In), (2.0, 0.5, In)];
        expect(&face, &points);
    }
    let rings = vec![record(lines(&[(0.0, 0.1), (4.0, 0.1)])), record(lines(&[(4.0, 0.9), (0.0, 0.9)]))];
    let mut loops = rings;
    loops.push(round_hole(4.0, 0.5, 0.3));
    expect(
        &face(cone(1.0, 1.0), loops),
        &[(0.2, 0.5, Out), (3.8, 0.5, Out), (0.4, 0.5, In), (2.0, 0.95, Out)],
    );
}

#[test]
fn loops_past_the_seam_get_shifted_patches() {
    let outer = record(lines(&[(3.0, 0.2), (5.0, 0.2), (5.0, 0.8), (3.0, 0.8), (3.0, 0.2)]));
    let face = face(cone(1.0, 1.0), vec![outer]);
    expect(&face, &[(3.5, 0.5, In), (4.5, 0.5, In), (0.5, 0.5, In), (2.0, 0.5, Out), (3.5, 0.1, Out)]);
    let mut ranges: Vec<(f64, f64)> = face.patches.iter().map(|p| (p.uv_min.x, p.uv_max.x)).collect();
    ranges.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(ranges, [(3.0, 4.0), (4.0, 5.0)]);
}

#[test]
fn a_curve_continued_a_period_away_is_shifted_back() {
    let mut curves = lines(&[(3.0, 0.2), (4.0, 0.2)]);
    curves.extend(lines(&[(0.0, 0.2), (1.0, 0.2), (1.0, 0.8), (0.0, 0.8)]));
    curves.extend(lines(&[(4.0, 0.8), (3.0, 0.8), (3.0, 0.2)]));
    let face = face(cone(1.0, 1.0), vec![record(curves)]);
    expect(&face, &[(3.5, 0.5, In), (0.5, 0.5, In), (2.0, 0.5, Out)]);
    assert!(face.remarks.is_empty(), "{:?}", face.remarks);
}

#[test]
fn a_missing_pole_edge_is_bridged_without_moving_the_far_side() {
    let mut curves = lines(&[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0)]);
    curves.extend(lines(&[(0.0, 1.0), (0.0, 0.0)]));
    let face = face(cone(1.0, 0.0), vec![record(curves)]);
    expect(&face, &[(0.5, 0.5, In), (3.5, 0.99, In)]);
    assert_eq!((face.domain.min.x, face.domain.max.x), (0.0, 4.0));
}

#[test]
fn gaps_are_closed_and_told() {
    let face = face(plane(), vec![record(lines(&[(0.1, 0.1), (0.9, 0.1), (0.9, 0.9), (0.1, 0.11)]))]);
    expect(&face, &[(0.8, 0.5, In), (0.2, 0.8, Out)]);
    let [TrimRemark::Gap { loop_index: 0, curve: 0, uv, .. }] = face.remarks[..] else {
        panic!("{:?}", face.remarks);
    };
    assert!((uv - 0.01).abs() < 1e-12);
}

#[test]
fn curves_that_run_backwards_are_turned() {
    for turned in 0..4 {
        let mut curves = lines(&[(0.1, 0.1), (0.9, 0.1), (0.9, 0.9), (0.1, 0.9), (0.1, 0.1)]);
        curves[turned] = curves[turned].reversed();
        let face = face(plane(), vec![record(curves)]);
        expect(&face, &[(0.5, 0.5, In), (0.2, 0.5, In), (0.05, 0.5, Out)]);
        assert_eq!(face.remarks, [TrimRemark::Reversed { loop_index: 0, curve: turned }]);
    }
}

#[test]
fn inner_loops_alone_are_holes_in_the_whole_surface() {
    let mut hole = round_hole(0.5, 0.5, 0.2);
    hole.role = LoopRole::Inner;
    let face = face(plane(), vec![hole]);
    expect(&face, &[(0.5, 0.5, Out), (0.1, 0.1, In)]);
    assert_eq!(face.remarks, [TrimRemark::NoOuterLoop]);
}

#[test]
fn loops_beyond_the_surface_are_cut_to_it() {
    let face = face(plane(), vec![round_hole(0.9, 0.5, 0.3), record(lines(&[(0.9, 0.5), (0.9, 0.5)]))]);
    expect(&face, &[(0.95, 0.5, In), (0.62, 0.5, In), (0.95, 0.9, Out), (1.05, 0.5, Out)]);
    assert!(face.remarks.iter().any(|r| matches!(r, TrimRemark::BeyondSurface { .. })), "{:?}", face.remarks);
    assert!(face.remarks.contains(&TrimRemark::EmptyLoop { loop_index: 1 }));
}

#[test]
fn patches_without_any_of_the_face_are_left_out() {
    let face = face(cone(1.0, 1.0), vec![round_hole(1.5, 0.5, 0.2)]);
    assert_eq!(face.patches.len(), 1);
}
