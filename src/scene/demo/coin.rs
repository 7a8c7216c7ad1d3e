//! A medal leaning in the foreground: rings nested five deep, among them single closed curves of
//! degree 22, with a rim that is an exact quarter of a torus section turned around.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};

use super::assembly::Assembly;
use super::lettering::place;
use super::outline::{circle, rosette, single_bezier, smooth};
use super::shape::{plane, torus};

/// Radius of the medal.
const RADIUS: f64 = 17.0;

/// Adds the medal.
pub fn add(assembly: &mut Assembly) {
    assembly.part("Medal", [0.72, 0.74, 0.78]);
    let turn = DQuat::from_rotation_z(0.62) * DQuat::from_rotation_x(1.15);
    let centre = DVec3::new(20.0, -78.0, 16.6);
    let corner = DVec2::splat(RADIUS + 1.0);
    let disc = plane(centre, turn * DVec3::X, turn * DVec3::Y, -corner, corner);
    let origin = DVec2::ZERO;
    let mut loops = vec![
        circle(origin, RADIUS),
        place(&single_bezier(rosette(4.0, 0.2, 0.0), 22), |p| p * 9.2),
        place(&single_bezier(rosette(4.0, 0.2, 0.0), 22), |p| p * 7.6),
        place(&smooth(rosette(8.0, 0.18, 0.0), 32), |p| p * 4.4),
        circle(origin, 2.6),
    ];
    loops.extend((0..24).map(|k| {
        let angle = TAU * (k as f64 + 0.5) / 24.0;
        circle(DVec2::from_angle(angle) * 13.6, if k % 3 == 1 { 1.45 } else { 0.9 })
    }));
    assembly.face("Medal", disc, loops);
    assembly.colour([0.80, 0.52, 0.20]);
    assembly.face("Rim of the medal", torus(RADIUS, 1.1).map_points(|p| centre + turn * p), Vec::new());
}
