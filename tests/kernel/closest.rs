//! Closest points against closed forms and dense sampling.

use glam::{DVec2, DVec3};
use hairline::kernel::query::{closest_on_curve, closest_on_surface};

use crate::zoo::{Seed, arc, sphere, torus};

#[test]
fn a_circle_is_nearest_along_the_radius() {
    let circle = arc(DVec2::new(1.0, 2.0), 3.0, 4).to_bezier();
    let mut seed = Seed(11);
    for _ in 0..500 {
        let target = seed.point2();
        let radius = (target - DVec2::new(1.0, 2.0)).length();
        let found = closest_on_curve(&circle, target).expect("pieces");
        assert!((found.distance - (radius - 3.0).abs()).abs() < 1e-11, "{target}: {found:?}");
    }
}

#[test]
fn curves_of_the_zoo_are_never_nearer_elsewhere() {
    for seed in 0..150 {
        let mut seed = Seed(seed);
        let degree = 1 + seed.below(9);
        let curve = seed.curve(degree, true);
        let pieces = curve.to_bezier();
        let target = seed.point2();
        let found = closest_on_curve(&pieces, target).expect("pieces");
        assert!(((found.point - target).length() - found.distance).abs() < 1e-12);
        let (piece, (a, b)) =
            pieces.iter().find(|(_, i)| found.t >= i.0 && found.t <= i.1).expect("in the domain");
        let at = piece.point((found.t - a) / (b - a));
        let jump = pieces.iter().any(|(_, i)| i.0 == found.t);
        assert!(jump || (at - found.point).length() < 1e-9, "{found:?} {at}");
        for (piece, _) in &pieces {
            for k in 0..=2000 {
                let distance = (piece.point(f64::from(k) / 2000.0) - target).length();
                assert!(distance > found.distance - 1e-10, "{found:?}: {distance} at {k}");
            }
        }
    }
}

#[test]
fn a_sphere_and_a_torus_are_nearest_along_the_normal() {
    let mut seed = Seed(12);
    let (ball, ring) = (sphere().to_bezier(), torus(3.0, 1.0).to_bezier());
    for _ in 0..150 {
        let target = seed.point3() * 0.5;
        let found = closest_on_surface(&ball, target).expect("patches");
        assert!((found.distance - (target.length() - 1.0).abs()).abs() < 1e-11, "{target}: {found:?}");
        assert!((sphere().point(found.uv.x, found.uv.y) - found.point).length() < 1e-9);
        let across = target.truncate().length() - 3.0;
        let expected = (across.hypot(target.z) - 1.0).abs();
        let found = closest_on_surface(&ring, target).expect("patches");
        assert!((found.distance - expected).abs() < 1e-11, "{target}: {found:?}");
    }
    // All points are equally near to the centre: still an answer.
    let found = closest_on_surface(&ball, DVec3::ZERO).expect("patches");
    assert!((found.distance - 1.0).abs() < 1e-12);
}

#[test]
fn surfaces_of_the_zoo_are_never_nearer_elsewhere() {
    for seed in 0..60 {
        let mut seed = Seed(seed);
        let degrees = (1 + seed.below(5), 1 + seed.below(5));
        let patch = seed.patch(degrees, true);
        // Half of them on the surface itself.
        let on = seed.below(2) == 0;
        let target = if on { patch.point(seed.unit(), seed.unit()) } else { seed.point3() };
        let found = closest_on_surface(std::slice::from_ref(&patch), target).expect("one patch");
        assert!((patch.point(found.uv.x, found.uv.y) - found.point).length() < 1e-9);
        if on {
            assert!(found.distance < 1e-10, "{found:?}");
        }
        for k in 0..10_000 {
            let distance =
                (patch.point(f64::from(k / 100) / 99.0, f64::from(k % 100) / 99.0) - target).length();
            assert!(distance > found.distance - 1e-10, "{found:?}: {distance}");
        }
    }
}
