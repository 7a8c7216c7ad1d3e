//! Which lines make the ground grid.
//!
//! The spacing is a power of ten that follows the size of the view; the finer lines fade out as the view
//! grows, so that nothing jumps. The grid lies under the model, on z = 0 where the model stands on it.

use glam::DVec3;

use crate::editor::camera::motion::view_size;
use crate::editor::theme::Palette;
use crate::kernel::view::{Bounds, Camera};

/// Fine lines on either side of the middle.
const SPAN: i64 = 60;
/// Fine lines in the height of the view at most; ten times fewer at least.
const DENSITY: f64 = 40.0;

/// One line as the shader gets it: relative to the eye.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct LineInstance {
    pub start: [f32; 3],
    pub end: [f32; 3],
    /// Linear RGB, not premultiplied.
    pub color: [f32; 4],
    pub width_px: f32,
}

impl LineInstance {
    /// A line between two points relative to the eye; colour sRGB encoded, not premultiplied.
    pub fn new(start: [f32; 3], end: [f32; 3], color: [f32; 4], width_px: f32) -> Self {
        Self { start, end, color, width_px }
    }

    /// How the buffer is read.
    pub fn layout() -> wgpu::VertexBufferLayout<'static> {
        const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
            wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32];
        wgpu::VertexBufferLayout {
            array_stride: size_of::<LineInstance>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &ATTRIBUTES,
        }
    }
}

/// The grid of one view.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    pub lines: Vec<LineInstance>,
    /// Middle of the disc it fades away from.
    pub centre: DVec3,
    /// Radius of the disc.
    pub radius: f64,
}

/// Height of the ground under `bounds`.
fn ground(bounds: &Bounds) -> f64 {
    if bounds.is_empty() || bounds.min.z.abs() < 0.02 * bounds.diagonal() { 0.0 } else { bounds.min.z }
}

impl Grid {
    /// The grid for a view.
    pub fn of(camera: &Camera, bounds: &Bounds, palette: &Palette, scale_factor: f32) -> Self {
        let size = view_size(camera).max(1e-12);
        let exponent = (size / DENSITY).log10();
        let spacing = 10f64.powf(exponent.ceil());
        // 1 when the fine lines are widest apart, 0 when they are about to vanish.
        let fineness = exponent.ceil() - exponent;
        let z = ground(bounds);
        let snap = |x: f64| (x / spacing).round() as i64;
        let (ci, cj) = (snap(camera.target.x), snap(camera.target.y));
        let centre = DVec3::new(camera.target.x, camera.target.y, z);
        let radius = (SPAN - 1) as f64 * spacing;
        let relative = |x: f64, y: f64| (DVec3::new(x, y, z) - camera.eye).as_vec3().to_array();
        let ink = |color: bevy_egui::egui::Color32, alpha: f64| {
            let c = bevy_egui::egui::Rgba::from(color);
            [c.r(), c.g(), c.b(), alpha as f32]
        };
        let strength = |index: i64| match (index % 10 == 0, palette.light) {
            (true, false) => 0.30,
            (true, true) => 0.34,
            (false, false) => 0.13 * fineness,
            (false, true) => 0.16 * fineness,
        };
        let mut lines = Vec::new();
        for k in -SPAN..=SPAN {
            let (i, j) = (ci + k, cj + k);
            let (x, y) = (i as f64 * spacing, j as f64 * spacing);
            let (x0, x1) = ((ci - SPAN) as f64 * spacing, (ci + SPAN) as f64 * spacing);
            let (y0, y1) = ((cj - SPAN) as f64 * spacing, (cj + SPAN) as f64 * spacing);
            let mut line = |index: i64, axis, start, end| {
                let (color, width) = match index {
                    0 => (ink(axis, 0.75), 1.6),
                    _ => (ink(palette.grid, strength(index)), 1.0),
                };
                if color[3] > 0.004 {
                    lines.push(LineInstance { start, end, color, width_px: width * scale_factor });
                }
            };
            line(i, palette.axis_y, relative(x, y0), relative(x, y1));
            line(j, palette.axis_x, relative(x0, y), relative(x1, y));
        }
        Self { lines, centre, radius }
    }
}
