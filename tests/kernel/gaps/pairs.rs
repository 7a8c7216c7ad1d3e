//! Pairs of faces that share an edge exactly, written differently on either side.

use glam::{DVec2, DVec3};
use hairline::inspect::{Edge, EdgeKind, Inspection};
use hairline::kernel::nurbs::{Direction, KnotVector, NurbsCurve2, NurbsSurface};
use hairline::kernel::primitives::{arc, extrusion, outline, revolution};
use hairline::scene::records::{FaceRecord, LoopRecord, LoopRole};

/// A face without anything but its geometry; no loops: all of the surface.
pub fn face(surface: NurbsSurface, loops: Vec<Vec<NurbsCurve2>>) -> FaceRecord {
    let role = |k: usize| if k == 0 { LoopRole::Outer } else { LoopRole::Inner };
    let loops = loops.into_iter().enumerate().map(|(k, curves)| LoopRecord::new(role(k), curves)).collect();
    FaceRecord::new(surface, loops)
}

/// A quarter of a cylinder of `radius` about z, from height `low` to `high`. u is around, v is up.
pub fn cylinder(radius: f64, low: f64, high: f64) -> NurbsSurface {
    let circle =
        arc(DVec3::Z * low, DVec3::X * radius, DVec3::Y * radius, 0.0, 1.5).expect("valid test data");
    extrusion(&circle, DVec3::Z * (high - low)).expect("valid test data")
}

/// Part of a ball of `radius` between two latitudes. u is around, v is up.
pub fn ball(radius: f64, low: f64, high: f64) -> NurbsSurface {
    let meridian =
        arc(DVec3::ZERO, DVec3::X * radius, DVec3::Z * radius, low, high).expect("valid test data");
    revolution(&meridian, DVec3::ZERO, DVec3::Z, 0.0, 1.5).expect("valid test data")
}

/// A free-form rational surface over the unit square, about 40 x 40 x 8.
pub fn hills(seed: u32) -> NurbsSurface {
    let knots = |inner: &[f64]| {
        let all = [0.0; 4].into_iter().chain(inner.iter().copied()).chain([1.0; 4]).collect();
        KnotVector::new(3, all).expect("valid test data")
    };
    let (ku, kv) = (knots(&[0.3, 0.7]), knots(&[0.45]));
    let (nu, nv) = (ku.control_count(), kv.control_count());
    let wave = |k: usize| (f64::from(seed) + 1.0) * 12.9898 * (k as f64 + 1.0);
    let points = (0..nu * nv)
        .map(|k| {
            let (i, j) = (k / nv, k % nv);
            let at = DVec2::new(i as f64 / (nu - 1) as f64, j as f64 / (nv - 1) as f64) * 40.0;
            at.extend(4.0 * wave(k).sin())
        })
        .collect();
    let weights = (0..nu * nv).map(|k| 1.0 + 0.6 * (1.7 * wave(k)).cos()).collect();
    NurbsSurface::new(ku, kv, points, weights).expect("valid test data")
}

/// The same surface written otherwise: bit 0 exchanges u and v, bit 1 raises degrees, bit 2 inserts knots.
pub fn rewritten(surface: &NurbsSurface, how: u32) -> NurbsSurface {
    let mut result = surface.clone();
    if how & 2 != 0 {
        result = result
            .elevated(Direction::U, 1)
            .expect("valid test data")
            .elevated(Direction::V, 2)
            .expect("valid test data");
    }
    if how & 4 != 0 {
        let inside = |d: Direction, s: f64| {
            let (a, b) = surface.knots(d).domain();
            a + (b - a) * s
        };
        result = result
            .inserted(Direction::U, &[inside(Direction::U, 0.123), inside(Direction::U, 0.8)])
            .expect("valid test data");
        result = result.inserted(Direction::V, &[inside(Direction::V, 0.61)]).expect("valid test data");
    }
    if how & 1 != 0 { result.transposed() } else { result }
}

/// A pcurve written otherwise: bit 0 exchanges u and v, bit 1 raises the degree, bit 2 inserts knots, bit 3
/// turns it round.
pub fn rewritten_curve(curve: &NurbsCurve2, how: u32) -> NurbsCurve2 {
    let mut result = curve.clone();
    if how & 1 != 0 {
        result = result.map_points(|p| DVec2::new(p.y, p.x));
    }
    if how & 2 != 0 {
        result = result.elevated(2).expect("valid test data");
    }
    if how & 4 != 0 {
        let (a, b) = result.domain();
        result = result
            .inserted(&[a + 0.37 * (b - a), a + 0.37 * (b - a), a + 0.9 * (b - a)])
            .expect("valid test data");
    }
    if how & 8 != 0 { result.reversed() } else { result }
}

/// A wavy curve across the unit square from its lower to its upper side.
pub fn divide() -> NurbsCurve2 {
    let knots =
        KnotVector::new(3, vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0]).expect("valid test data");
    let points =
        [(0.5, 0.0), (0.35, 0.2), (0.7, 0.5), (0.4, 0.8), (0.55, 1.0)].map(|(u, v)| DVec2::new(u, v));
    NurbsCurve2::new(knots, points.to_vec(), vec![1.0, 1.4, 0.7, 1.2, 1.0]).expect("valid test data")
}

/// Two faces on the same surface over the unit square, left and right of [`divide`]; the second is written as `how`
/// says.
pub fn divided(surface: &NurbsSurface, how: u32) -> [FaceRecord; 2] {
    let middle = divide();
    let corner = DVec2::new;
    let line = NurbsCurve2::line;
    let left = vec![
        line(corner(0.0, 0.0), corner(0.5, 0.0)),
        middle.clone(),
        line(corner(0.55, 1.0), corner(0.0, 1.0)),
        line(corner(0.0, 1.0), corner(0.0, 0.0)),
    ];
    let right = [
        line(corner(0.5, 0.0), corner(1.0, 0.0)),
        line(corner(1.0, 0.0), corner(1.0, 1.0)),
        line(corner(1.0, 1.0), corner(0.55, 1.0)),
        middle.reversed(),
    ];
    let mut curves: Vec<NurbsCurve2> = right.iter().map(|c| rewritten_curve(c, how & 7)).collect();
    if how & 8 != 0 {
        curves = curves.iter().rev().map(NurbsCurve2::reversed).collect();
    }
    [face(surface.clone(), vec![left]), face(rewritten(surface, how), vec![curves])]
}

/// The edges of a kind.
pub fn of_kind(inspection: &Inspection, kind: EdgeKind) -> Vec<&Edge> {
    inspection.edges().map(|e| e.1).filter(|e| e.kind == kind).collect()
}

/// Checks that the stretches of each curve fill it without gap or overlap, and that lengths add up.
pub fn assert_complete(inspection: &Inspection) {
    let mut uses: Vec<_> = inspection.edges().flat_map(|e| &e.1.uses).collect();
    uses.sort_by(|a, b| a.curve.cmp(&b.curve).then(a.interval.0.total_cmp(&b.interval.0)));
    for group in uses.chunk_by(|a, b| a.curve == b.curve) {
        let curve = inspection.curve(&group[0].curve).expect("a use names a curve");
        let (start, end) = curve.domain();
        assert_eq!(
            (group[0].interval.0, group[group.len() - 1].interval.1),
            (start, end),
            "{:?}",
            group[0].curve
        );
        assert!(group.windows(2).all(|w| w[0].interval.1 == w[1].interval.0), "{group:?}");
        let sum: f64 = group.iter().map(|u| u.length).sum();
        assert!((sum - curve.length()).abs() <= 1e-9 * curve.length(), "{:?}: {sum}", group[0].curve);
    }
}

/// A rectangle in uv as a loop.
pub fn rectangle(min: [f64; 2], max: [f64; 2]) -> Vec<NurbsCurve2> {
    outline::rectangle(min.into(), max.into())
}

/// The plane z = `height` over the parameters 0..1 times `size`.
pub fn plane(size: f64, height: f64) -> NurbsSurface {
    let knots = KnotVector::bezier(1, 0.0, 1.0).expect("valid test data");
    let points = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)];
    let points = points.map(|(x, y)| DVec3::new(x * size, y * size, height)).to_vec();
    NurbsSurface::new(knots.clone(), knots, points, vec![1.0; 4]).expect("valid test data")
}
