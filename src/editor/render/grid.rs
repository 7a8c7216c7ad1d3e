//! Where the lines of the ground grid are.
//!
//! The spacing is a power of ten that follows the size of the view; the finer lines fade out as the view
//! grows, so that nothing jumps. The grid lies under the model, on z = 0 where the model stands on it.

use glam::DVec3;

use super::strokes::LineInstance;
use crate::editor::camera::motion::view_size;
use crate::editor::theme::Palette;
use crate::kernel::view::{Bounds, Camera};

/// Fine lines on either side of the middle.
const SPAN: f64 = 59.0;
/// Fine lines in the height of the view at most; ten times fewer at least.
const DENSITY: f64 = 40.0;
/// Width of an axis, logical pixels.
const AXIS_PX: f32 = 1.6;

/// The grid of one view. Lines are counted from the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grid {
    /// Crossing of lines next to the target of the view: the middle of what is drawn.
    pub middle: [i64; 2],
    /// Height of the ground.
    pub z: f64,
    /// Distance of the lines.
    pub spacing: f64,
    /// Strength of the lines between the tenth ones, 0..1, and of those.
    pub strength: [f32; 2],
}

/// Mirror of `Grid` in `shaders/pass/grid.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct GridUniform {
    pub clip_from_relative: [[f32; 4]; 4],
    pub centre: [f32; 4],
    pub color: [f32; 4],
    pub tenth: [f32; 2],
    pub axes: [f32; 2],
    pub spacing: f32,
    pub strength: f32,
    pub width_px: f32,
    pub depth: f32,
}

/// Height of the ground under `bounds`.
fn ground(bounds: &Bounds) -> f64 {
    if bounds.is_empty() || bounds.min.z.abs() < 0.02 * bounds.diagonal() { 0.0 } else { bounds.min.z }
}

impl Grid {
    /// The grid for a view.
    pub fn of(camera: &Camera, bounds: &Bounds, light: bool) -> Self {
        let size = view_size(camera).max(1e-12);
        let exponent = (size / DENSITY).log10();
        let spacing = 10f64.powf(exponent.ceil());
        // 1 when the fine lines are widest apart, 0 when they are about to vanish.
        let fineness = (exponent.ceil() - exponent) as f32;
        let snap = |x: f64| (x / spacing).round() as i64;
        let strength = if light { [0.16 * fineness, 0.34] } else { [0.13 * fineness, 0.30] };
        let middle = [snap(camera.target.x), snap(camera.target.y)];
        Self { middle, z: ground(bounds), spacing, strength }
    }

    /// The crossing of lines `i`, `j`.
    fn crossing(&self, i: f64, j: f64) -> DVec3 {
        DVec3::new(i * self.spacing, j * self.spacing, self.z)
    }

    /// What the shader gets, but for the projection and the depth.
    pub fn uniform(&self, eye: DVec3, palette: &Palette, pixels: f32) -> GridUniform {
        let [i, j] = self.middle;
        let centre = (self.crossing(i as f64, j as f64) - eye).as_vec3();
        let [r, g, b, _] = bevy_egui::egui::Rgba::from(palette.grid).to_array();
        GridUniform {
            clip_from_relative: [[0.0; 4]; 4],
            centre: centre.extend(SPAN as f32).to_array(),
            color: [r, g, b, self.strength[0]],
            tenth: self.middle.map(|k| -(k.rem_euclid(10) as f32)),
            axes: self.middle.map(|k| -k as f32),
            spacing: self.spacing as f32,
            strength: self.strength[1],
            width_px: pixels,
            depth: 1.0,
        }
    }

    /// The axes in the square of the grid, relative to the eye.
    pub fn axes(&self, eye: DVec3, palette: &Palette, pixels: f32) -> Vec<LineInstance> {
        let [i, j] = self.middle.map(|k| k as f64);
        let line = |color, (i0, j0), (i1, j1)| {
            let at = |i, j| (self.crossing(i, j) - eye).as_vec3().to_array();
            let c = bevy_egui::egui::Rgba::from(color);
            LineInstance::new(at(i0, j0), at(i1, j1), [c.r(), c.g(), c.b(), 0.75], AXIS_PX * pixels)
        };
        let mut lines = Vec::new();
        if i.abs() <= SPAN {
            lines.push(line(palette.axis_y, (0.0, j - SPAN), (0.0, j + SPAN)));
        }
        if j.abs() <= SPAN {
            lines.push(line(palette.axis_x, (i - SPAN, 0.0), (i + SPAN, 0.0)));
        }
        lines
    }

    /// Middle relative to the eye, and radius of the disc outside of which nothing is drawn.
    pub fn fade(&self, eye: DVec3) -> [f32; 4] {
        let [i, j] = self.middle.map(|k| k as f64);
        (self.crossing(i, j) - eye).as_vec3().extend((SPAN * self.spacing) as f32).to_array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(target: DVec3, height: f64) -> Camera {
        let mut camera = Camera { target, ..crate::editor::camera::ViewCamera::default().now };
        camera.projection = crate::kernel::view::Projection::Orthographic { height };
        camera
    }

    #[test]
    fn the_spacing_follows_the_view_and_the_middle_the_target() {
        let palette = Palette::default();
        for (height, target) in [(1.0, 0.3), (70.0, -1234.5), (5e4, 8e6)] {
            let view = camera(DVec3::new(target, -target, 0.0), height);
            let grid = Grid::of(&view, &Bounds::EMPTY, false);
            let lines = view_size(&view) / grid.spacing;
            assert!((4.0..=40.0 + 1e-9).contains(&lines), "{lines} lines");
            let away = grid.crossing(grid.middle[0] as f64, grid.middle[1] as f64) - view.target;
            assert!(away.truncate().abs().max_element() <= 0.5 * grid.spacing * (1.0 + 1e-9));
            let uniform = grid.uniform(view.eye, &palette, 1.0);
            // A line of the origin's is a tenth one, and what is a tenth line is a multiple of ten.
            for (axis, tenth) in uniform.axes.into_iter().zip(uniform.tenth) {
                assert_eq!((axis - tenth) % 10.0, 0.0);
            }
        }
    }

    #[test]
    fn axes_out_of_reach_are_not_drawn() {
        let palette = Palette::default();
        let near = Grid::of(&camera(DVec3::ZERO, 10.0), &Bounds::EMPTY, false);
        assert_eq!(near.axes(DVec3::ZERO, &palette, 1.0).len(), 2);
        let far = Grid::of(&camera(DVec3::new(0.0, 1e4, 0.0), 10.0), &Bounds::EMPTY, false);
        assert_eq!(far.axes(DVec3::ZERO, &palette, 1.0).len(), 1, "the y axis");
    }
}
