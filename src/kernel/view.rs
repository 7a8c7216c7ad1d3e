//! Cameras in `f64`: where the eye is, how it projects, and the ray of each pixel.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// How a camera projects.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Projection {
    /// Central projection.
    Perspective {
        /// Full vertical opening angle, radians.
        fov_y: f64,
    },
    /// Parallel projection.
    Orthographic {
        /// Height of the visible window, model units.
        height: f64,
    },
}

/// Eye, target and projection. Right-handed; looks from `eye` to `target`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Position of the eye. For orthographic views: any point of the middle ray in front of the scene.
    pub eye: DVec3,
    /// Point looked at; the centre of orbiting, and where an orthographic ray has parameter 0.
    pub target: DVec3,
    /// Direction that is up on the screen; need not be perpendicular to the line of sight.
    pub up: DVec3,
    /// Projection.
    pub projection: Projection,
}

/// The standard views of CAD systems; z is up, front looks along +y.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum StandardView {
    Iso,
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
}

/// An axis-parallel box. Empty when `min > max`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

/// A ray `origin + t * direction`; `t` may be negative for orthographic cameras.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Start: the eye, or for orthographic views a point of the plane through the target.
    pub origin: DVec3,
    /// Unit direction away from the viewer.
    pub direction: DVec3,
}

impl Bounds {
    /// The empty box.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around `points`.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether nothing is in it.
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// Centre; the origin for an empty box.
    pub fn centre(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { 0.5 * (self.min + self.max) }
    }

    /// Length of the diagonal; 0 for an empty box.
    pub fn diagonal(&self) -> f64 {
        if self.is_empty() { 0.0 } else { (self.max - self.min).length() }
    }
}

impl StandardView {
    /// Direction of sight and up vector.
    pub fn directions(self) -> (DVec3, DVec3) {
        match self {
            Self::Iso => (DVec3::new(-1.0, 1.0, -1.0).normalize(), DVec3::Z),
            Self::Front => (DVec3::Y, DVec3::Z),
            Self::Back => (-DVec3::Y, DVec3::Z),
            Self::Left => (DVec3::X, DVec3::Z),
            Self::Right => (-DVec3::X, DVec3::Z),
            Self::Top => (-DVec3::Z, DVec3::Y),
            Self::Bottom => (DVec3::Z, -DVec3::Y),
        }
    }
}

impl Camera {
    /// A camera of the same kind that looks along `direction` and shows all of `bounds` in a window
    /// of `aspect` = width / height, with a margin of 5 %.
    pub fn fit(bounds: &Bounds, direction: DVec3, up: DVec3, projection: Projection, aspect: f64) -> Self {
        let target = bounds.centre();
        let radius = (0.5 * bounds.diagonal()).max(1e-9);
        let mut camera = Self { eye: target - direction, target, up, projection };
        let (right, up, back) = camera.axes();
        let half = 0.5 * if bounds.is_empty() { DVec3::ONE } else { bounds.max - bounds.min };
        let corners = (0..8).map(|k| {
            let sign = |bit: i32| if k & bit == 0 { -1.0 } else { 1.0 };
            let p = half * DVec3::new(sign(1), sign(2), sign(4));
            DVec3::new(p.dot(right), p.dot(up), p.dot(back))
        });
        const MARGIN: f64 = 1.05;
        match projection {
            Projection::Perspective { fov_y } => {
                let tan = (0.5 * fov_y).tan();
                let distance = corners
                    .map(|c| c.z + MARGIN * (c.y.abs() / tan).max(c.x.abs() / (tan * aspect)))
                    .fold(1e-6 * radius, f64::max);
                camera.eye = target + back * distance;
            }
            Projection::Orthographic { .. } => {
                let height =
                    corners.map(|c| 2.0 * c.y.abs().max(c.x.abs() / aspect)).fold(1e-6 * radius, f64::max);
                camera.eye = target + back * (2.0 * radius);
                camera.projection = Projection::Orthographic { height: MARGIN * height };
            }
        }
        camera
    }

    /// Unit vectors to the right, up and towards the viewer, in world space.
    pub fn axes(&self) -> (DVec3, DVec3, DVec3) {
        let back = (self.eye - self.target).try_normalize().unwrap_or(DVec3::Z);
        let right = self.up.cross(back).try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
        (right, back.cross(right), back)
    }

    /// Distance from eye to target.
    pub fn distance(&self) -> f64 {
        (self.eye - self.target).length()
    }

    /// Half the size (width, height) of the window in the plane through the target, model units.
    pub fn half_extent(&self, aspect: f64) -> DVec2 {
        let y = match self.projection {
            Projection::Perspective { fov_y } => (0.5 * fov_y).tan() * self.distance(),
            Projection::Orthographic { height } => 0.5 * height,
        };
        DVec2::new(y * aspect, y)
    }

    /// The ray through `ndc` (x right, y up, both in -1..1) of a window of `aspect` = width / height.
    pub fn ray(&self, ndc: DVec2, aspect: f64) -> Ray {
        let (right, up, back) = self.axes();
        let half = self.half_extent(aspect);
        let at_target = self.target + right * (ndc.x * half.x) + up * (ndc.y * half.y);
        match self.projection {
            Projection::Perspective { .. } => {
                Ray { origin: self.eye, direction: (at_target - self.eye).normalize() }
            }
            Projection::Orthographic { .. } => Ray { origin: at_target, direction: -back },
        }
    }
}
