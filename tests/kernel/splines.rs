//! Insertion, restriction, elevation and decomposition leave a spline where it is, derivatives included.

use glam::DVec2;
use hairline::kernel::bezier::BezierPatch;
use hairline::kernel::nurbs::{Direction, NurbsCurve2, NurbsSurface};
use proptest::prelude::*;

use crate::zoo::{Seed, samples};

/// Curves of degree 1 to 9 and the high degrees seen in real files.
fn degrees() -> impl Strategy<Value = usize> {
    prop_oneof![8 => 1usize..=9, 1 => Just(13), 1 => Just(15), 1 => Just(22)]
}

/// Asserts equal points and first derivatives at `parameters`. Tolerances are relative to the size of the
/// control polygon (20) and, for derivatives, to their own size.
fn same_curve(a: &NurbsCurve2, b: &NurbsCurve2, parameters: &[f64]) {
    for &t in parameters {
        let (da, db) = (a.derivatives(t, 2), b.derivatives(t, 2));
        assert!((da[0] - db[0]).length() < 2e-12, "point at {t}: {} {}", da[0], db[0]);
        assert!(
            (da[1] - db[1]).length() < 1e-10 * (1e3 + da[1].length()),
            "derivative at {t}: {da:?} {db:?}"
        );
    }
}

fn same_surface(a: &NurbsSurface, b: &NurbsSurface, us: &[f64], vs: &[f64]) {
    for (u, v) in us.iter().flat_map(|u| vs.iter().map(move |v| (*u, *v))) {
        let (ja, jb) = (a.jet(u, v), b.jet(u, v));
        assert!((ja.point - jb.point).length() < 2e-12, "point at {u} {v}");
        assert!((ja.du - jb.du).length() < 1e-10 * (1e3 + ja.du.length()), "du at {u} {v}");
        assert!((ja.dv - jb.dv).length() < 1e-10 * (1e3 + ja.dv.length()), "dv at {u} {v}");
    }
}

fn inner_knots(seed: &mut Seed, (start, end): (f64, f64)) -> Vec<f64> {
    (0..1 + seed.below(4)).map(|_| seed.between(start, end)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn insertion_keeps_a_curve(seed: u64, degree in degrees(), rational: bool) {
        let mut seed = Seed(seed);
        let curve = seed.curve(degree, rational);
        let new = inner_knots(&mut seed, curve.domain());
        let finer = curve.inserted(&new).expect("inside");
        prop_assert_eq!(finer.points().len(), curve.points().len() + new.len());
        prop_assert_eq!(finer.is_rational(), curve.is_rational());
        same_curve(&curve, &finer, &samples(curve.knots(), 5));
    }

    #[test]
    fn restriction_keeps_the_part(seed: u64, degree in degrees(), rational: bool) {
        let mut seed = Seed(seed);
        let curve = seed.curve(degree, rational);
        let (start, end) = curve.domain();
        let a = start + (end - start) * seed.between(0.0, 0.4);
        let b = end - (end - start) * seed.between(0.0, 0.4);
        let part = curve.restricted(a, b).expect("inside");
        prop_assert_eq!(part.domain(), (a, b));
        prop_assert!(part.knots().is_clamped());
        same_curve(&curve, &part, &samples(part.knots(), 5));
        same_curve(&curve, &curve.clamped(), &samples(curve.knots(), 5));
    }

    #[test]
    fn elevation_keeps_a_curve(seed: u64, degree in degrees(), rational: bool, times in 1usize..5) {
        let curve = Seed(seed).curve(degree, rational);
        let higher = curve.elevated(times).expect("below the limit");
        prop_assert_eq!(higher.degree(), degree + times);
        same_curve(&curve, &higher, &samples(curve.knots(), 5));
    }

    #[test]
    fn pieces_of_a_curve_are_the_curve(seed: u64, degree in degrees(), rational: bool) {
        let curve = Seed(seed).curve(degree, rational);
        let pieces = curve.to_bezier();
        for (piece, (a, b)) in &pieces {
            let (low, high) = piece.hull();
            for k in 1..8 {
                let s = k as f64 / 8.0;
                let exact = curve.derivatives(a + (b - a) * s, 2);
                let jet = piece.jet(s);
                prop_assert!((jet.point - exact[0]).length() < 2e-12);
                let d1 = jet.d1 / (b - a);
                prop_assert!((d1 - exact[1]).length() < 1e-10 * (1e3 + d1.length()));
                prop_assert!(jet.point.cmpge(low - 1e-12).all() && jet.point.cmple(high + 1e-12).all());
                let (left, right) = piece.split(s);
                prop_assert_eq!(left.end(), right.start());
                prop_assert!((left.point(0.5) - piece.point(0.5 * s)).length() < 1e-12);
                let middle = piece.restrict(0.25 * s, s);
                prop_assert!((middle.point(1.0 / 3.0) - piece.point(0.5 * s)).length() < 2e-12);
            }
        }
    }

    #[test]
    fn insertion_and_elevation_keep_a_surface(seed: u64, du in 1usize..=9, dv in 1usize..=9, rational: bool) {
        let mut seed = Seed(seed);
        let surface = seed.surface((du, dv), rational);
        let (us, vs) = (samples(surface.knots_u(), 2), samples(surface.knots_v(), 2));
        for direction in [Direction::U, Direction::V] {
            let new = inner_knots(&mut seed, surface.knots(direction).domain());
            same_surface(&surface, &surface.inserted(direction, &new).expect("inside"), &us, &vs);
            same_surface(&surface, &surface.elevated(direction, 2).expect("low"), &us, &vs);
        }
        same_surface(&surface, &surface.clamped(), &us, &vs);
        let (value, iso) = (us[0], surface.iso_curve(Direction::U, us[0]));
        for v in vs {
            prop_assert!((iso.point(v) - surface.point(value, v)).length() < 2e-12);
        }
    }

    #[test]
    fn patches_of_a_surface_are_the_surface(
        seed: u64, du in prop_oneof![4 => 1usize..=9, 1 => Just(15)], dv in prop_oneof![4 => 1usize..=9, 1 => Just(15)],
        rational: bool,
    ) {
        let surface = Seed(seed).surface((du, dv), rational);
        for patch in surface.to_bezier() {
            let bounds = patch.bounds();
            for k in 0..9 {
                let uv = DVec2::new((k / 3) as f64 + 0.5, (k % 3) as f64 + 0.5) / 3.0;
                let native = patch.native(uv);
                let (exact, jet) = (surface.jet(native.x, native.y), patch.jet(uv.x, uv.y));
                prop_assert!((jet.point - exact.point).length() < 3e-12);
                prop_assert!((patch.point(uv.x, uv.y) - exact.point).length() < 3e-12);
                let size = patch.uv_max - patch.uv_min;
                prop_assert!((jet.du / size.x - exact.du).length() < 1e-10 * (1e3 + exact.du.length()));
                prop_assert!((jet.dv / size.y - exact.dv).length() < 1e-10 * (1e3 + exact.dv.length()));
                let swapped = patch.swap();
                prop_assert!((swapped.jet(uv.y, uv.x).duv - jet.duv).length() <= 1e-9 * (1e4 + jet.duv.length()));
                prop_assert!(jet.point.cmpge(bounds.min - 1e-12).all() && jet.point.cmple(bounds.max + 1e-12).all());
            }
        }
    }

    #[test]
    fn parts_of_a_patch_are_the_patch(seed: u64, du in 1usize..=15, dv in 1usize..=15, rational: bool) {
        let mut seed = Seed(seed);
        let patch = seed.patch((du, dv), rational);
        let min = DVec2::new(seed.between(0.0, 0.5), seed.between(0.0, 0.5));
        let max = DVec2::new(seed.between(0.55, 1.0), seed.between(0.55, 1.0));
        for part in patch.quarters().into_iter().chain([patch.restrict(min, max)]) {
            for k in 0..9 {
                let uv = DVec2::new((k / 3) as f64, (k % 3) as f64) / 2.0;
                let native = part.native(uv);
                let exact = patch.point(native.x, native.y);
                prop_assert!((part.point(uv.x, uv.y) - exact).length() < 2e-12);
            }
        }
    }
}

#[test]
fn neighbouring_patches_share_their_edge_bit_for_bit() {
    for seed in 0..50 {
        let surface = Seed(seed).surface((3, 2), seed % 2 == 0);
        let patches = surface.to_bezier();
        for (a, b) in patches.iter().flat_map(|a| patches.iter().map(move |b| (a, b))) {
            let knots = surface.knots_u();
            let joined = a.uv_max.x == b.uv_min.x && a.uv_min.y == b.uv_min.y;
            if joined && knots.multiplicity(a.uv_max.x) <= 3 {
                assert_eq!(edge(a, 3), edge(b, 0), "seed {seed}");
            }
        }
    }
}

fn edge(patch: &BezierPatch, i: usize) -> (&[glam::DVec3], &[f64]) {
    let row = i * (patch.degree_v + 1)..(i + 1) * (patch.degree_v + 1);
    (&patch.points[row.clone()], &patch.weights[row])
}

#[test]
fn normal_cones_hold_the_normals_of_all_parts() {
    let mut found = 0;
    for seed in 0..300 {
        let mut seed = Seed(seed);
        let degrees = (1 + seed.below(6), 1 + seed.below(6));
        let patch = seed.patch(degrees, true);
        let corner = DVec2::new(seed.between(0.0, 0.8), seed.between(0.0, 0.8));
        let part = patch.restrict(corner, corner + 0.1);
        let Some(cone) = part.normal_cone() else { continue };
        found += 1;
        for k in 0..100 {
            let jet = part.jet((k / 10) as f64 / 9.0, (k % 10) as f64 / 9.0);
            let normal = jet.du.cross(jet.dv).normalize();
            assert!(normal.dot(cone.axis) > cone.half_angle.cos() - 1e-9);
        }
    }
    assert!(found > 100, "only {found} of 300 small parts have a cone");
}
