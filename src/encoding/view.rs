//! The camera of one cast as the GPU sees it.
//!
//! View axes: x right, y up, z forward, origin at the reference point: the eye, or for orthographic
//! cameras the target, so that large coordinates cancel before rounding. Depth is reversed (1 near,
//! 0 far): `near / z` in perspective, as in Bevy, and linear between the two planes in parallel views.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};

use super::cell::split_high_low;
use crate::kernel::view::{Camera, Projection};

/// Mirror of `View` in `shaders/layout/view.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[expect(missing_docs, reason = "described in the shader's layout")]
pub struct View {
    pub right: [f32; 4],
    pub up: [f32; 4],
    pub forward: [f32; 4],
    pub reference_high: [f32; 4],
    pub reference_low: [f32; 4],
    pub clip_scale: [f32; 2],
    pub slope_scale: [f32; 2],
    pub offset_scale: [f32; 2],
    pub jitter: [f32; 2],
    pub depth: [f32; 4],
    pub size: [f32; 2],
    pub pixel: [f32; 2],
    pub flags: u32,
    pub cell_count: u32,
    pub pad0: u32,
    pub pad1: u32,
}

/// Leave out what is trimmed away.
pub const CAST_TRIM: u32 = 1;
/// Write evaluation counts instead of normals.
pub const CAST_HEAT: u32 = 2;
/// Triangles of a tessellation are flat.
pub const CAST_FACETS: u32 = 4;
/// With [`CAST_HEAT`]: levels of the deviation of triangles instead of counts.
pub const CAST_DEVIATION: u32 = 8;

/// Depth planes of a projection, as distances along the line of sight from the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthRange {
    /// Distance of depth 1.
    pub near: f64,
    /// Distance of depth 0; ignored in perspective, where depth 0 is infinitely far.
    pub far: f64,
}

impl DepthRange {
    /// Planes that enclose a scene of the given bounding sphere for `camera`.
    pub fn around(camera: &Camera, centre: DVec3, radius: f64) -> Self {
        let (_, _, back) = camera.axes();
        let middle = (camera.eye - centre).dot(back);
        let reach = 1.01 * radius.max(1e-12 * middle.abs()).max(1e-12);
        match camera.projection {
            Projection::Perspective { .. } => {
                let closest = (1e-4 * camera.distance()).max(1e-7 * radius);
                Self { near: (middle - reach).max(closest), far: middle + reach }
            }
            Projection::Orthographic { .. } => Self { near: middle - reach, far: middle + reach },
        }
    }
}

impl View {
    /// The view of `camera` at `size` pixels; `jitter` shifts the samples by parts of a pixel.
    pub fn new(camera: &Camera, size: [u32; 2], jitter: [f32; 2], depth: DepthRange, flags: u32) -> Self {
        let (right, up, back) = camera.axes();
        let size_px = DVec2::new(size[0].max(1) as f64, size[1].max(1) as f64);
        let aspect = size_px.x / size_px.y;
        let half = camera.half_extent(aspect);
        let (reference, slope, offset, depth_row) = match camera.projection {
            Projection::Perspective { .. } => {
                let slope = half / camera.distance();
                (camera.eye, slope, DVec2::ZERO, [depth.near, 0.0, 0.0, 1.0])
            }
            Projection::Orthographic { .. } => {
                let span = (depth.far - depth.near).max(f64::MIN_POSITIVE);
                // z counts from the target, the planes from the eye.
                let far = depth.far - camera.distance();
                (camera.target, DVec2::ZERO, half, [far / span, -1.0 / span, 1.0, 0.0])
            }
        };
        let (high, low) = split_high_low(reference);
        let wide = |v: DVec3| {
            let v = v.as_vec3();
            [v.x, v.y, v.z, 0.0]
        };
        Self {
            right: wide(right),
            up: wide(up),
            forward: wide(-back),
            reference_high: [high[0], high[1], high[2], 0.0],
            reference_low: [low[0], low[1], low[2], 0.0],
            clip_scale: (1.0 / (slope + offset)).as_vec2().to_array(),
            slope_scale: slope.as_vec2().to_array(),
            offset_scale: offset.as_vec2().to_array(),
            jitter,
            depth: depth_row.map(|x| x as f32),
            size: size_px.as_vec2().to_array(),
            pixel: [(2.0 * offset.y / size_px.y) as f32, (2.0 * slope.y / size_px.y) as f32],
            flags,
            cell_count: 0,
            pad0: 0,
            pad1: 0,
        }
    }
}
