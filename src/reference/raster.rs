//! Triangles on the pixels of a picture: the rasteriser's part on the processor.
//!
//! Homogeneous coordinates (Olano and Greer 1997), so that none has to be clipped: three edge functions of the pixel,
//! found from the inverse of the matrix of its corners, tell coverage, 1/w and the perspective-correct weights of the
//! corners.

use glam::{DMat3, DVec2, DVec3, Vec3};

use crate::encoding::View;

/// A triangle ready to draw.
#[derive(Debug, Clone, Copy)]
pub struct Triangle {
    /// Weights of the corners times 1 / w are `edges * (x, y, 1)` of the pixel.
    edges: DMat3,
    /// Columns that it may cover, end exclusive.
    pub columns: (u32, u32),
    /// Rows that it may cover, end exclusive.
    pub rows: (u32, u32),
}

/// A corner in pixels from the upper left, times w, and w. `p` in view axes; `shift_px` moves it on the screen, y down.
pub fn place(view: &View, p: Vec3, shift_px: DVec2) -> DVec3 {
    let size = DVec2::new(view.size[0].into(), view.size[1].into());
    let w = f64::from(view.depth[2] + view.depth[3] * p.z);
    let clip = DVec2::new((p.x * view.clip_scale[0]).into(), (p.y * view.clip_scale[1]).into());
    // The jitter moves the surface the other way.
    let x = 0.5 * size.x * (clip.x + w) + (shift_px.x - f64::from(view.jitter[0])) * w;
    let y = 0.5 * size.y * (w - clip.y) + (shift_px.y - f64::from(view.jitter[1])) * w;
    DVec3::new(x, y, w)
}

impl Triangle {
    /// The triangle of three placed corners; `None` when it covers nothing.
    pub fn new(placed: [DVec3; 3], view: &View) -> Option<Self> {
        let (mut min, mut max) = ([0.0; 2], [f64::from(view.size[0]), f64::from(view.size[1])]);
        if placed.iter().all(|p| p.z > 0.0) {
            for axis in 0..2 {
                let along = placed.map(|p| p[axis] / p.z);
                min[axis] = along.into_iter().fold(f64::INFINITY, f64::min).max(0.0);
                max[axis] = along.into_iter().fold(f64::NEG_INFINITY, f64::max).min(max[axis]);
            }
        } else if placed.iter().all(|p| p.z <= 0.0) {
            return None;
        }
        let edges = DMat3::from_cols(placed[0], placed[1], placed[2]).inverse();
        if !edges.is_finite() || !(min[0] < max[0] && min[1] < max[1]) {
            return None;
        }
        let range = |axis: usize| (min[axis].floor() as u32, max[axis].ceil() as u32);
        Some(Self { edges, columns: range(0), rows: range(1) })
    }

    /// Weights of the corners at a pixel's middle, if it is covered.
    pub fn weights(&self, [x, y]: [u32; 2]) -> Option<Vec3> {
        let weights = self.edges * DVec3::new(f64::from(x) + 0.5, f64::from(y) + 0.5, 1.0);
        let inverse_w = weights.element_sum();
        let covered = weights.min_element() >= 0.0 && inverse_w > 0.0;
        covered.then(|| (weights / inverse_w).as_vec3())
    }
}

/// Depth of a point in view axes.
pub fn depth_of(view: &View, z: f32) -> f32 {
    (view.depth[0] + view.depth[1] * z) / (view.depth[2] + view.depth[3] * z)
}
