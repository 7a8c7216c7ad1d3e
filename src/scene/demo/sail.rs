//! A free-form sheet of degree 15 x 9 with openings of single Bezier curves of degree 22 and 13.

use glam::{DVec2, DVec3};

use super::assembly::Assembly;
use super::outline::{rectangle, rosette, single_bezier};
use super::shape::sheet;

/// Adds the sail behind the ball.
pub fn add(assembly: &mut Assembly) {
    assembly.part("Sail", [0.62, 0.10, 0.06]);
    let surface = sheet(15, 9, |s, t| {
        let angle = 0.35 * std::f64::consts::PI + s * 0.9 * std::f64::consts::PI;
        let radius = 78.0 + 10.0 * (t * 5.0).sin() + 4.0 * (s * 12.0).cos();
        DVec3::new(radius * angle.cos(), radius * angle.sin(), 6.0 + 95.0 * t)
    });
    let rosette_at = |centre: DVec2, size: f64, petals: f64| {
        let path = rosette(petals, 0.25, 0.3);
        move |t: f64| centre + path(t) * size
    };
    let loops = vec![
        rectangle(DVec2::splat(0.02), DVec2::splat(0.98)),
        single_bezier(rosette_at(DVec2::new(0.3, 0.8), 0.08, 4.0), 22),
        single_bezier(rosette_at(DVec2::new(0.7, 0.8), 0.08, 2.0), 13),
    ];
    assembly.face("Sail", surface, loops);
}
