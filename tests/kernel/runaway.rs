//! Surfaces that no number of triangles follows: folded back within a hair, pinched, crumpled. Each comes out, with a number of
//! vertices that goes by what it is, whatever it does.

use glam::{DVec2, DVec3};
use hairline::kernel::face::Face;
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
use hairline::kernel::tessellate::{FaceMesh, TessellationOptions, tessellate};
use hairline::kernel::trim::loop_record::{LoopRecord, LoopRole};

use crate::zoo::Seed;

/// Knots from 0 to 1 with as many control points as `count`, the inner ones where they are asked to be.
fn knots(degree: usize, inner: &[f64]) -> KnotVector {
    let end = |x: f64| std::iter::repeat_n(x, degree + 1);
    KnotVector::new(degree, end(0.0).chain(inner.iter().copied()).chain(end(1.0)).collect()).expect("knots")
}

fn surface(u: KnotVector, v: KnotVector, rows: &[Vec<DVec3>]) -> NurbsSurface {
    let points = rows.concat();
    let weights = vec![1.0; points.len()];
    NurbsSurface::new(u, v, points, weights).expect("a surface")
}

fn meshed(surface: &NurbsSurface, loops: &[LoopRecord], tolerance: f64) -> FaceMesh {
    let face = Face::derive(surface, loops).expect("a face");
    tessellate(&face, &TessellationOptions::new(tolerance)).expect("a mesh")
}

/// Inner knots of a cubic that goes its own way within `hair` about the middle.
fn hair_knots(hair: f64) -> Vec<f64> {
    [0.5 - hair, 0.5 + hair].into_iter().flat_map(|x| [x, x, x]).collect()
}

/// Rings of a tube: control points of a closed quadratic-like cubic about `centre`, in the plane of `x` and `y`.
fn ring(centre: DVec3, x: DVec3, y: DVec3) -> Vec<DVec3> {
    let corners = [(1.0, 0.0), (1.0, 0.55), (0.55, 1.0), (0.0, 1.0), (-0.55, 1.0), (-1.0, 0.55), (-1.0, 0.0)];
    let below = [(-1.0, -0.55), (-0.55, -1.0), (0.0, -1.0), (0.55, -1.0), (1.0, -0.55), (1.0, 0.0)];
    corners.iter().chain(&below).map(|(a, b)| centre + x * *a + y * *b).collect()
}

fn transposed(rings: &[Vec<DVec3>]) -> Vec<Vec<DVec3>> {
    (0..rings[0].len()).map(|k| rings.iter().map(|r| r[k]).collect()).collect()
}

#[test]
fn a_pipe_whose_frame_turns_over_within_a_hair_is_a_few_triangles() {
    let third = [1.0, 2.0, 3.0].map(|x| x / 4.0);
    let around = || knots(3, &third.map(|x| [x; 3]).concat());
    for hair in [1e-3, 1e-6, 1e-11] {
        let at = |z: f64, tilt: f64| {
            let x = DVec3::new(tilt.cos(), 0.0, tilt.sin());
            ring(DVec3::Z * z, x, DVec3::Y)
        };
        // Before the hair, within it (there and back, farther than it ends), after it.
        let rings = [
            at(0.0, 0.0),
            at(1.0, 0.0),
            at(2.0, 0.0),
            at(3.0, 0.0),
            at(3.0, 1.4),
            at(3.0, -0.9),
            at(3.0, 0.8),
            at(4.0, 0.8),
            at(5.0, 0.8),
            at(6.0, 0.8),
        ];
        let pipe = surface(around(), knots(3, &hair_knots(hair)), &transposed(&rings));
        let mesh = meshed(&pipe, &[], 0.01);
        let count = mesh.quality.evaluations;
        assert!((100..3000).contains(&count), "{hair}: {count}");
        let left = mesh.quality.over_tolerance;
        assert!(left * 50 <= mesh.triangles.len(), "{hair}: {left} of {}", mesh.triangles.len());
    }
}

#[test]
fn folds_back_within_a_hair_come_to_an_end() {
    for hair in [1e-3, 1e-9] {
        for back in [0.3, 1e-5] {
            // Along v to the middle, back by a bit and on.
            let row = |x: f64| -> Vec<DVec3> {
                let lift = 0.2 * (6.0 * x).sin();
                let ys = [0.0, 0.2, 0.4, 0.5, 0.5 - back, 0.5 + back, 0.5, 0.6, 0.8, 1.0];
                ys.iter().map(|y| DVec3::new(x, *y, lift * (1.0 + y))).collect()
            };
            let rows: Vec<_> = (0..7).map(|k| row(f64::from(k) / 6.0)).collect();
            let sheet = surface(knots(3, &[0.25, 0.5, 0.75]), knots(3, &hair_knots(hair)), &rows);
            let count = meshed(&sheet, &[], 1e-3).quality.evaluations;
            assert!(count < 12_000, "{hair} {back}: {count}");
        }
    }
}

#[test]
fn rows_that_coincide_cusps_and_pinches_come_to_an_end() {
    let inner = [0.2, 0.4, 0.6, 0.8];
    let net = |at: &dyn Fn(f64, f64) -> DVec3| -> Vec<Vec<DVec3>> {
        (0..8).map(|i| (0..8).map(|j| at(f64::from(i), f64::from(j))).collect()).collect()
    };
    let bowl = |i: f64, j: f64| DVec3::new(i, j, 0.1 * (i * i + j * j));
    // Rows that are one; a row that is one point; a row that runs backwards; a cusp along a line.
    let nets = [
        net(&|i, j| bowl(if (2.0..=5.0).contains(&i) { 3.0 } else { i }, j)),
        net(&|i, j| if i == 3.0 { DVec3::new(3.0, 3.5, 0.0) } else { bowl(i, j) }),
        net(&|i, j| bowl(if i == 4.0 { 1.0 } else { i }, j)),
        net(&|i, j| bowl(i, j) + DVec3::Z * if (3.0..=4.0).contains(&j) { 3.0 } else { 0.0 }),
        net(&|i, j| bowl((i - 3.5).abs(), j)),
        net(&|i, _| bowl(i, 3.0)),
    ];
    for (k, net) in nets.iter().enumerate() {
        let sheet = surface(knots(3, &inner), knots(3, &inner), net);
        let face = Face::derive(&sheet, &[]).expect("a face");
        // A net that is a line may have no triangles at all.
        let Ok(mesh) = tessellate(&face, &TessellationOptions::new(1e-2)) else { continue };
        assert!(mesh.quality.evaluations < 20_000, "{k}: {}", mesh.quality.evaluations);
    }
}

#[test]
fn crumpled_nets_come_to_an_end() {
    for seed in 0..2 {
        let mut seed = Seed(seed);
        let rows: Vec<Vec<DVec3>> = (0..9).map(|_| (0..9).map(|_| seed.point3()).collect()).collect();
        let inner = [0.3, 0.3 + 1e-7, 0.5, 0.5, 0.8];
        let sheet = surface(knots(3, &inner), knots(3, &inner), &rows);
        let mesh = meshed(&sheet, &[], 0.02);
        assert!(mesh.quality.evaluations < 60_000, "{}", mesh.quality.evaluations);
    }
}

#[test]
fn a_zig_zag_of_thousands_of_points_comes_to_an_end() {
    let inner = [0.25, 0.5, 0.75];
    let rows: Vec<Vec<DVec3>> = (0..7)
        .map(|i| (0..7).map(|j| DVec3::new(f64::from(i), f64::from(j), f64::from((i * j) % 3))).collect())
        .collect();
    let sheet = surface(knots(3, &inner), knots(3, &inner), &rows);
    let teeth = 2000;
    let mut corners = vec![DVec2::new(0.1, 0.1), DVec2::new(0.9, 0.1)];
    for k in 0..teeth {
        let x = 0.9 - 0.8 * f64::from(k) / f64::from(teeth);
        corners.push(DVec2::new(x, if k % 2 == 0 { 0.5 } else { 0.5 + 1e-4 }));
    }
    corners.push(corners[0]);
    let inner = (1..corners.len() - 1).map(|k| k as f64 / (corners.len() - 1) as f64).collect::<Vec<_>>();
    let weights = vec![1.0; corners.len()];
    let edge = NurbsCurve2::new(knots(1, &inner), corners, weights).expect("a curve");
    let mesh = meshed(&sheet, &[LoopRecord::new(LoopRole::Outer, vec![edge])], 1e-2);
    assert!(mesh.quality.evaluations < 30_000, "{}", mesh.quality.evaluations);
}
