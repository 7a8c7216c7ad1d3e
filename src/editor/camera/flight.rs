//! The short flight from one view to the next.
//!
//! Orientation goes along the great arc, the target along the line, distance and size of view
//! geometrically, all with one smooth ease. The end is exactly the wanted camera.

use std::time::Duration;

use glam::{DMat3, DQuat, DVec3};

use crate::kernel::view::{Camera, Projection};

/// How long a flight takes.
pub const FLIGHT_TIME: Duration = Duration::from_millis(280);

/// A flight under way.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// Where it started.
    pub from: Camera,
    /// Where it ends.
    pub to: Camera,
    /// Time flown so far.
    pub elapsed: Duration,
}

impl Flight {
    /// A flight that has not started to move.
    pub fn new(from: Camera, to: Camera) -> Self {
        Self { from, to, elapsed: Duration::ZERO }
    }

    /// Whether the end is reached.
    pub fn is_over(&self) -> bool {
        self.elapsed >= FLIGHT_TIME
    }

    /// The camera now.
    pub fn camera(&self) -> Camera {
        if self.is_over() {
            return self.to;
        }
        let t = self.elapsed.as_secs_f64() / FLIGHT_TIME.as_secs_f64();
        between(&self.from, &self.to, t * t * (3.0 - 2.0 * t))
    }
}

/// The camera a fraction `t` of the way.
fn between(from: &Camera, to: &Camera, t: f64) -> Camera {
    let orientation = |camera: &Camera| {
        let (right, up, back) = camera.axes();
        DQuat::from_mat3(&DMat3::from_cols(right, up, back)).normalize()
    };
    let rotation = orientation(from).slerp(orientation(to), t);
    let target = from.target.lerp(to.target, t);
    let distance = geometric(from.distance(), to.distance(), t);
    let projection = match (from.projection, to.projection) {
        (Projection::Orthographic { height: a }, Projection::Orthographic { height: b }) => {
            Projection::Orthographic { height: geometric(a, b, t) }
        }
        (_, to) => to,
    };
    Camera { eye: target + (rotation * DVec3::Z) * distance, target, up: rotation * DVec3::Y, projection }
}

fn geometric(a: f64, b: f64, t: f64) -> f64 {
    if a > 0.0 && b > 0.0 { a.powf(1.0 - t) * b.powf(t) } else { a + (b - a) * t }
}
