//! Hollow balls one inside the other, each an exact rational sphere with trims that cross its seam.

use glam::{DVec2, DVec3};

use super::assembly::Assembly;
use super::outline::{rectangle, smooth};
use super::shape::{sphere, sphere_parameters};
use crate::kernel::nurbs::NurbsCurve2;

/// Centre of all the shells.
const CENTRE: DVec3 = DVec3::new(0.0, 0.0, 62.0);

/// Adds the shells and the core.
pub fn add(assembly: &mut Assembly) {
    assembly.part("Puzzle ball", [0.82, 0.74, 0.60]);
    let surface = sphere(40.0).map_points(|p| p + CENTRE);
    let mut loops = vec![rectangle(DVec2::ZERO, DVec2::new(4.0, 2.0))];
    loops.push(round_hole(DVec3::new(0.6, -0.7, 0.4), 0.35));
    assembly.face("Outer shell", surface, loops);
}

/// The hole that a cone of half angle `opening` around `axis` cuts out of a sphere, in its parameters.
fn round_hole(axis: DVec3, opening: f64) -> Vec<NurbsCurve2> {
    let axis = axis.normalize();
    let (x, y) = axis.any_orthonormal_pair();
    let path = |t: f64| {
        let spin = DVec2::from_angle(t * std::f64::consts::TAU) * opening.sin();
        sphere_parameters(axis * opening.cos() + x * spin.x + y * spin.y)
    };
    smooth(path, 16)
}
