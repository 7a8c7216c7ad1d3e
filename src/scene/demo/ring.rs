//! A torus with openings across the seam of its tube: the outer loop runs past the knots by half a
//! period in v and by part of one in u.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};

use super::assembly::Assembly;
use super::outline::{rectangle, smooth};
use super::shape::torus;

/// Number of openings.
const OPENINGS: usize = 10;

/// Adds the ring.
pub fn add(assembly: &mut Assembly) {
    assembly.part("Ring", [0.03, 0.22, 0.42]);
    let turn = DQuat::from_rotation_z(0.3) * DQuat::from_rotation_x(0.16);
    let centre = DVec3::new(74.0, -26.0, 9.0);
    let mut loops = vec![rectangle(DVec2::new(0.4, -2.0), DVec2::new(4.4, 2.0))];
    loops.extend((0..OPENINGS).map(|k| {
        let middle = DVec2::new(0.4 + 4.0 * (k as f64 + 0.5) / OPENINGS as f64, 0.3);
        smooth(
            move |t| {
                let p = DVec2::from_angle(TAU * t) * DVec2::new(0.085, 1.15);
                middle + DVec2::new(p.x + 0.15 * p.y, p.y)
            },
            16,
        )
    }));
    assembly.face("Ring", torus(15.0, 6.0).map_points(|p| centre + turn * p), loops);
}
