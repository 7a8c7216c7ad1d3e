//! Rays in view axes. Twin of `shaders/lib/ray.wgsl`.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles};

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

/// Depth at which a ray meets the plane through `p` with normal `n`.
pub fn plane_depth(n: Vec3, p: Vec3, ray: Ray) -> f32 {
    let down = n.dot(ray.slope.extend(1.0));
    n.dot(p - ray.offset.extend(0.0)) / if down.abs() < 1e-30 { 1e-30 } else { down }
}

/// A box in view axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewBox {
    /// Centre.
    pub centre: Vec3,
    /// Unit axis, half length.
    pub x: Vec4,
    /// The same.
    pub y: Vec4,
    /// The same.
    pub z: Vec4,
}

fn slab(ray: Ray, centre: Vec3, axis: Vec4) -> Vec2 {
    let turn = axis.xyz().dot(ray.slope.extend(1.0));
    let start = axis.xyz().dot(ray.offset.extend(0.0) - centre);
    let safe = if turn.abs() < 1e-20 { 1e-20 } else { turn };
    let (a, b) = ((-axis.w - start) / safe, (axis.w - start) / safe);
    Vec2::new(a.min(b), a.max(b))
}

/// Depths at which a ray enters and leaves a box; it passes by when the first is larger.
pub fn box_span(ray: Ray, bound: &ViewBox) -> Vec2 {
    let x = slab(ray, bound.centre, bound.x);
    let y = slab(ray, bound.centre, bound.y);
    let z = slab(ray, bound.centre, bound.z);
    Vec2::new(x.x.max(y.x).max(z.x), x.y.min(y.y).min(z.y))
}

/// The largest depth value (reverse z) behind `z`: 1 from the near plane on.
pub fn depth_from(planes: Vec4, z: f32) -> f32 {
    let w = planes.z + planes.w * z;
    if w > 0.0 { ((planes.x + planes.y * z) / w).min(1.0) } else { 1.0 }
}
