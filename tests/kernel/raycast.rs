//! The ray-casting oracle against shapes whose hits are known in closed form, and against itself.

use glam::{DVec2, DVec3};
use hairline::kernel::bezier::BezierPatch;
use hairline::kernel::nurbs::NurbsSurface;
use hairline::kernel::query::raycast::patch_hits;
use hairline::kernel::query::{RayHits, Raycaster};
use hairline::kernel::view::Ray;

use crate::zoo::{Seed, sphere, torus};

fn caster(surface: &NurbsSurface) -> Raycaster {
    Raycaster::new(surface.to_bezier().into_iter().map(|p| (0, p)).collect())
}

fn direction(seed: &mut Seed) -> DVec3 {
    loop {
        let d = seed.point3();
        if (1.0..100.0).contains(&d.length_squared()) {
            return d.normalize();
        }
    }
}

fn parameters(hits: &RayHits) -> Vec<f64> {
    assert!(hits.complete);
    hits.hits.iter().map(|h| h.t).collect()
}

#[test]
fn a_sphere_is_hit_where_the_formula_says() {
    let caster = caster(&sphere());
    let mut seed = Seed(1);
    for _ in 0..2000 {
        let direction = direction(&mut seed);
        let origin = seed.point3() * 0.4;
        let middle = -origin.dot(direction);
        let distance = (origin + direction * middle).length();
        let expected = if distance < 1.0 {
            let half = (1.0 - distance * distance).sqrt();
            vec![middle - half, middle + half]
        } else {
            vec![]
        };
        let hits = caster.hits(&Ray { origin, direction });
        let found = parameters(&hits);
        assert_eq!(found.len(), expected.len(), "{origin} {direction}: {found:?} {expected:?}");
        for ((t, e), hit) in found.iter().zip(&expected).zip(&hits.hits) {
            assert!((t - e).abs() < 1e-13 / (1.0 - distance).sqrt().max(1e-7), "{t} {e}");
            assert!(hit.residual < 1e-14);
            assert!((hit.normal.normalize().dot(hit.point).abs() - 1.0).abs() < 1e-7);
        }
    }
}

#[test]
fn rays_through_edges_corners_and_poles_count_once() {
    let caster = caster(&sphere());
    let straight = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::Z];
    let slanted = [DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.0, 1.0, 1.0), DVec3::new(1.0, 1.0, 0.0)];
    for toward in straight.into_iter().chain(slanted) {
        let direction = toward.normalize();
        let hits = caster.hits(&Ray { origin: -3.0 * direction, direction });
        let found = parameters(&hits);
        assert_eq!(found.len(), 2, "{toward}: {:?}", hits.hits);
        assert!((found[0] - 2.0).abs() < 1e-12 && (found[1] - 4.0).abs() < 1e-12);
    }
}

#[test]
fn a_ray_that_touches_a_sphere_hits_it() {
    let caster = caster(&sphere());
    let mut seed = Seed(5);
    for _ in 0..200 {
        let d = direction(&mut seed);
        let side = d.any_orthonormal_vector();
        let hits = caster.hits(&Ray { origin: side - 2.0 * d, direction: d });
        assert!(hits.complete);
        // Rounding makes it a touch, two hits close together or a miss by the last bits.
        assert!(hits.hits.iter().all(|h| (h.t - 2.0).abs() < 1e-6 && h.residual < 1e-13));
        let clear = caster.hits(&Ray { origin: side * (1.0 - 1e-12) - 2.0 * d, direction: d });
        assert_eq!(parameters(&clear).len(), 2, "{d}");
        let past = caster.hits(&Ray { origin: side * (1.0 + 1e-12) - 2.0 * d, direction: d });
        assert_eq!(parameters(&past).len(), 0, "{d}");
    }
}

/// Zeros of a quartic by bisection between the zeros of its derivative, recursively.
fn zeros(c: &[f64], low: f64, high: f64) -> Vec<f64> {
    if c.len() <= 1 {
        return vec![];
    }
    let value = |x: f64| c.iter().rev().fold(0.0, |a, k| a * x + k);
    let slope: Vec<f64> = c.iter().enumerate().skip(1).map(|(k, a)| a * k as f64).collect();
    let mut cuts = vec![low];
    cuts.extend(zeros(&slope, low, high));
    cuts.push(high);
    let pairs = cuts.windows(2).filter(|p| value(p[0]) * value(p[1]) < 0.0);
    pairs
        .map(|p| {
            let (mut a, mut b) = (p[0], p[1]);
            for _ in 0..200 {
                let m = 0.5 * (a + b);
                if value(a) * value(m) <= 0.0 { b = m } else { a = m }
            }
            0.5 * (a + b)
        })
        .collect()
}

#[test]
fn a_torus_is_hit_where_its_quartic_says() {
    let (major, minor) = (2.0, 0.7);
    let caster = caster(&torus(major, minor));
    let mut seed = Seed(2);
    let mut counts = [0; 5];
    for _ in 0..2000 {
        let d = direction(&mut seed);
        // Origin next to the torus, so that the quartic is well conditioned.
        let o = seed.point3() * 0.25;
        let o = o - d * o.dot(d);
        // (|p|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2) along p = o + t d, |d| = 1, o . d = 0.
        let k = o.length_squared() + major * major - minor * minor;
        let (a, b, c) = (d.x * d.x + d.y * d.y, 2.0 * (o.x * d.x + o.y * d.y), o.x * o.x + o.y * o.y);
        let r = 4.0 * major * major;
        let expected = zeros(&[k * k - r * c, -r * b, 2.0 * k - r * a, 0.0, 1.0], -20.0, 20.0);
        let hits = caster.hits(&Ray { origin: o, direction: d });
        let found = parameters(&hits);
        if found.len() != expected.len() {
            let close = expected.windows(2).any(|p| p[1] - p[0] < 1e-6);
            assert!(close, "{o} {d}: {found:?} {expected:?}");
            continue;
        }
        counts[found.len()] += 1;
        for (t, e) in found.iter().zip(&expected) {
            assert!((t - e).abs() < 1e-7, "{found:?} {expected:?}");
        }
    }
    assert!(counts[2] > 100 && counts[4] > 50, "{counts:?}");
}

/// Hits found by a dense grid of Newton starts.
fn brute(patch: &BezierPatch, ray: &Ray) -> Vec<DVec2> {
    let (a, b) = ray.direction.any_orthonormal_pair();
    let mut found: Vec<DVec2> = Vec::new();
    for k in 0..900 {
        let mut x = DVec2::new((k / 30) as f64 + 0.5, (k % 30) as f64 + 0.5) / 30.0;
        for _ in 0..30 {
            let j = patch.jet(x.x, x.y);
            let plane = |p: DVec3| DVec2::new(a.dot(p), b.dot(p));
            let matrix = glam::DMat2::from_cols(plane(j.du), plane(j.dv));
            let step = matrix.inverse() * plane(j.point - ray.origin);
            if !step.is_finite() || step.length() > 1.0 {
                break;
            }
            x -= step;
            if step.length() < 1e-14 {
                break;
            }
        }
        let off = patch.point(x.x, x.y) - ray.origin;
        let residual = (off - ray.direction * off.dot(ray.direction)).length();
        let inside = x.cmpge(DVec2::ZERO).all() && x.cmple(DVec2::ONE).all();
        if inside && residual < 1e-12 && !found.iter().any(|f| (*f - x).length() < 1e-7) {
            found.push(x);
        }
    }
    found
}

#[test]
fn folded_patches_of_all_degrees_lose_no_hit() {
    let mut seed = Seed(3);
    let mut most = 0;
    for round in 0..120 {
        let degrees = (1 + seed.below(9), 1 + seed.below(9));
        let patch = seed.patch(degrees, round % 2 == 0);
        // Towards a point of the patch, so that there is something to hit.
        let target = patch.point(seed.unit(), seed.unit());
        let direction = direction(&mut seed);
        let ray = Ray { origin: target - 40.0 * direction, direction };
        let found = patch_hits(&patch, &ray);
        assert!(found.complete);
        assert!(!found.hits.is_empty());
        most = most.max(found.hits.len());
        assert!(found.hits.iter().all(|h| h.residual < 1e-12));
        for uv in brute(&patch, &ray) {
            let near = found.hits.iter().any(|h| (h.uv - uv).length() < 1e-6);
            assert!(near, "{degrees:?}: {uv} missing among {:?}", found.hits);
        }
        for (i, hit) in found.hits.iter().enumerate() {
            let twin = found.hits[..i].iter().any(|h| (h.uv - hit.uv).length() < 1e-9);
            assert!(!twin, "{hit:?} twice");
        }
    }
    assert!(most >= 3, "the zoo has folds, but no ray hit more than {most} sheets");
}

#[test]
fn a_ray_inside_a_plane_ends() {
    let patch = BezierPatch {
        degree_u: 1,
        degree_v: 1,
        points: vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::new(1.0, 1.0, 0.0)],
        weights: vec![1.0; 4],
        uv_min: DVec2::ZERO,
        uv_max: DVec2::ONE,
    };
    let direction = DVec3::new(1.0, 0.3, 0.0).normalize();
    let hits = patch_hits(&patch, &Ray { origin: DVec3::new(-1.0, 0.1, 0.0), direction });
    assert!(hits.hits.iter().all(|h| h.residual < 1e-12));
    // Just above the plane: nothing.
    let hits = patch_hits(&patch, &Ray { origin: DVec3::new(-1.0, 0.1, 1e-9), direction });
    assert_eq!(hits.hits.len(), 0);
}
