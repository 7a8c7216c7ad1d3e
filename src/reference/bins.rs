//! Which cells may cover which tile of the picture: the rasteriser's part on the CPU.

use glam::{Vec2, Vec3};

use super::solve::{Axes, axes_apply};
use crate::encoding::cell::Cell;
use crate::encoding::view::View;

/// A rectangle of pixels, ends exclusive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PixelRect {
    /// First column and row.
    pub min: [u32; 2],
    /// One past the last column and row.
    pub max: [u32; 2],
}

/// The pixels that the box of `cell` may cover; `None` when it is out of sight. `shift` is the cell's
/// origin in view axes.
pub fn cover(view: &View, axes: &Axes, cell: &Cell, shift: Vec3) -> Option<PixelRect> {
    let axis = |a: [f32; 4]| axes_apply(axes, Vec3::new(a[0], a[1], a[2])) * a[3];
    let centre = axes_apply(axes, Vec3::from(cell.box_centre)) + shift;
    let (x, y, z) = (axis(cell.box_x), axis(cell.box_y), axis(cell.box_z));
    let perspective = view.depth[3] != 0.0;
    let near = view.depth[0];
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    let (mut behind, mut before) = (false, false);
    for k in 0..8 {
        let sign = |bit: i32| if k & bit == 0 { -1.0 } else { 1.0 };
        let p = centre + sign(1) * x + sign(2) * y + sign(4) * z;
        if perspective && p.z < near {
            behind = true;
            continue;
        }
        before = true;
        let w = view.depth[2] + view.depth[3] * p.z;
        let ndc = p.truncate() * Vec2::from(view.clip_scale) / w;
        let pixel = (ndc * Vec2::new(1.0, -1.0) * 0.5 + 0.5) * Vec2::from(view.size);
        low = low.min(pixel);
        high = high.max(pixel);
    }
    let size = Vec2::from(view.size);
    if !before {
        return None;
    }
    if behind {
        // The box reaches behind the eye: it may cover anything.
        (low, high) = (Vec2::ZERO, size);
    }
    // Two pixels cover the jitter and rounding.
    let low = (low - 2.0).max(Vec2::ZERO);
    let high = (high + 2.0).min(size);
    if !(low.x < high.x && low.y < high.y) {
        return None;
    }
    Some(PixelRect { min: [low.x as u32, low.y as u32], max: [high.x.ceil() as u32, high.y.ceil() as u32] })
}
