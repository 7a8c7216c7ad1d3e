//! The foot of the ball: a profile of degree 7 turned around the axis, exact and closed.

use glam::DVec2;

use super::assembly::Assembly;
use super::outline::bezier;
use super::shape::revolved;

/// Adds the foot.
pub fn add(assembly: &mut Assembly) {
    assembly.part("Foot", [0.80, 0.52, 0.20]);
    let p = DVec2::new;
    let profile = bezier(vec![
        p(34.0, 0.2),
        p(34.0, 7.0),
        p(12.0, 3.0),
        p(4.0, 10.0),
        p(4.0, 18.0),
        p(8.0, 26.0),
        p(24.0, 22.0),
        p(24.0, 33.0),
    ]);
    assembly.face("Foot", revolved(&profile), Vec::new());
}
