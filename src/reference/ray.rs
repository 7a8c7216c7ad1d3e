//! Rays in view axes. Twin of `shaders/lib/ray.wgsl`.

use glam::{Vec2, Vec3};

/// The points `(offset + slope z, z)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// x / z and y / z.
    pub slope: Vec2,
    /// x and y at z = 0.
    pub offset: Vec2,
}

/// The point of a ray at depth `z`.
pub fn ray_point(ray: Ray, z: f32) -> Vec3 {
    (ray.offset + ray.slope * z).extend(z)
}
