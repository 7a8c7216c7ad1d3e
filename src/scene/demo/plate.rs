//! A round plate with a sunflower of holes (Vogel's spiral), and plain plates of many holes for
//! tests and benchmarks.

use glam::{DVec2, DVec3};

use super::assembly::Assembly;
use super::outline::{circle, rectangle, trim_loop};
use super::shape::{plane, torus};
use crate::kernel::nurbs::NurbsCurve2;
use crate::scene::records::{FaceRecord, LoopRole};

/// Radius of the plate.
const RADIUS: f64 = 100.0;
/// Turn from one seed of a sunflower to the next.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Adds the plate and its rim.
pub fn add(assembly: &mut Assembly) {
    assembly.part("Sunflower plate", [0.055, 0.065, 0.085]);
    let corner = DVec2::splat(RADIUS + 1.0);
    let mut loops = vec![circle(DVec2::ZERO, RADIUS)];
    loops.extend(sunflower());
    assembly.face("Plate", plane(DVec3::ZERO, DVec3::X, DVec3::Y, -corner, corner), loops);
    assembly.colour([0.80, 0.52, 0.20]);
    assembly.face("Rim", torus(RADIUS, 2.0), Vec::new());
}

/// Round holes between two circles, growing outwards.
fn sunflower() -> impl Iterator<Item = Vec<NurbsCurve2>> {
    const SEEDS: usize = 760;
    let scale = (RADIUS - 6.0) / (SEEDS as f64).sqrt();
    (0..SEEDS).filter_map(move |k| {
        let radius = scale * (k as f64 + 0.5).sqrt();
        let centre = DVec2::from_angle(k as f64 * GOLDEN_ANGLE) * radius;
        (radius > 36.0).then(|| circle(centre, 0.62 + 0.95 * (radius - 36.0) / (RADIUS - 42.0)))
    })
}

/// A unit square with `count` round holes of equal size in rows: the face `holes_N` of the
/// benchmarks with `4 * count` rational quadratic segments.
pub fn holes(count: usize) -> FaceRecord {
    let side = (count as f64).sqrt().ceil().max(1.0);
    let mut loops = vec![trim_loop(LoopRole::Outer, rectangle(DVec2::ZERO, DVec2::ONE))];
    for k in 0..count {
        let cell = DVec2::new((k as f64 % side).floor() + 0.5, (k as f64 / side).floor() + 0.5);
        loops.push(trim_loop(LoopRole::Inner, circle(cell / side, 0.35 / side)));
    }
    let surface = plane(DVec3::ZERO, DVec3::X, DVec3::Y, DVec2::ZERO, DVec2::ONE);
    FaceRecord { name: Some(format!("{count} holes")), ..FaceRecord::new(surface, loops) }
}
