//! One ray against one cell. Twin of `shaders/pass/cast.wgsl`.

use glam::{Vec2, Vec3};

use super::pack::{pack_heat, pack_normal};
use super::ray::{Ray, ViewBox};
use super::solve::{
    ANY, Axes, BELOW_ONE, FARTHER, HAIR, NEARER, Piece, axes_apply, newton, piece_conics, piece_seeds,
};
use crate::encoding::cell::Cell;
use crate::encoding::view::{CAST_HEAT, CAST_TRIM, View};
use crate::encoding::{FaceHeader, PackedScene};
use crate::kernel::trim::grid::{GridView, classify, classify_listed};
use crate::kernel::trim::tally::Counters;

/// What a pixel shows: the words of the visibility buffer and the depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fragment {
    /// Face slot + 1 (0: nothing), u and v (bits of `f32`), normal or counts.
    pub words: [u32; 4],
    /// Reverse z.
    pub depth: f32,
}

impl Fragment {
    /// Background.
    pub const NONE: Self = Self { words: [0; 4], depth: 0.0 };
}

fn xyz(v: [f32; 4]) -> Vec3 {
    Vec3::new(v[0], v[1], v[2])
}

/// The view's axes.
pub fn view_axes(view: &View) -> Axes {
    Axes { right: xyz(view.right), up: xyz(view.up), forward: xyz(view.forward) }
}

/// The ray of a sample position in pixels.
pub fn view_ray(view: &View, pixel: Vec2) -> Ray {
    let ndc = (2.0 * pixel / Vec2::from(view.size) - 1.0) * Vec2::new(1.0, -1.0);
    Ray { slope: ndc * Vec2::from(view.slope_scale), offset: ndc * Vec2::from(view.offset_scale) }
}

/// The cell as seen by `view`: what the vertex stage computes once per cell.
pub fn piece_of(view: &View, cell: &Cell) -> Piece {
    let axes = view_axes(view);
    let high = Vec3::from(cell.origin_high) - xyz(view.reference_high);
    let low = Vec3::from(cell.origin_low) - xyz(view.reference_low);
    let shift = axes_apply(&axes, high + low);
    let turn = |m: [f32; 3]| axes_apply(&axes, Vec3::from(m));
    Piece {
        first_point: cell.first_point,
        degrees: cell.degrees,
        residual: cell.residual,
        size: cell.size,
        shift,
        m00: turn(cell.m00) + shift,
        m10: turn(cell.m10),
        m01: turn(cell.m01),
        m20: turn(cell.m20),
        m11: turn(cell.m11),
        m02: turn(cell.m02),
    }
}

/// The box of a cell as seen by `view`, widened by what rounding and the tolerance of the solver may move a hit.
pub fn box_of(view: &View, cell: &Cell, shift: Vec3) -> ViewBox {
    let axes = view_axes(view);
    let centre = axes_apply(&axes, Vec3::from(cell.box_centre)) + shift;
    let far = (centre.z + cell.size).max(0.0);
    let margin = BOX_PIXELS * (view.pixel[0] + view.pixel[1] * far) + BOX_SLACK * cell.size;
    let turn = |a: [f32; 4]| axes_apply(&axes, xyz(a)).extend(a[3] + margin);
    ViewBox { centre, x: turn(cell.box_x), y: turn(cell.box_y), z: turn(cell.box_z) }
}

/// Boxes are widened by this many pixels and this part of their size.
const BOX_PIXELS: f32 = 0.125;
const BOX_SLACK: f32 = 2e-3;

/// What casting took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct CastCounts {
    /// Rays that met the box of a cell.
    pub entered: u64,
    /// Of these, left because something nearer than the box was known.
    pub hidden: u64,
    /// Newton's method started.
    pub solves: u64,
    /// Surface evaluations.
    pub evaluations: u64,
    /// Hits asked for their trims.
    pub classified: u64,
}

impl std::ops::Add for CastCounts {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            entered: self.entered + other.entered,
            hidden: self.hidden + other.hidden,
            solves: self.solves + other.solves,
            evaluations: self.evaluations + other.evaluations,
            classified: self.classified + other.classified,
        }
    }
}

/// Casts one ray at one cell.
pub fn cast(
    scene: &PackedScene,
    view: &View,
    cell: &Cell,
    piece: &Piece,
    ray: Ray,
    counts: &mut CastCounts,
) -> Fragment {
    let face = &scene.faces.data()[cell.face as usize];
    let conics = piece_conics(ray, piece);
    let start = piece_seeds(piece, &conics);
    let axes = view_axes(view);
    let (mut evaluations, mut counters) = (0, Counters::default());
    let (trim, heat) = (view.flags & CAST_TRIM != 0, view.flags & CAST_HEAT != 0);
    let pixel_width = Vec2::from(view.pixel);
    let mut x = start.first;
    let mut branch = if start.count == 2 { NEARER } else { ANY };
    let mut going = start.count > 0;
    while going {
        let root = newton(scene.points.data(), ray, &axes, piece, &conics, pixel_width, x, branch);
        evaluations += root.evaluations;
        counts.solves += 1;
        counts.evaluations += u64::from(root.evaluations);
        // One zero and none found: the surface may have two where the model sees one.
        going = if branch == ANY { !root.converged } else { branch == NEARER };
        x = if branch == NEARER { start.second } else { start.first };
        branch = if branch == NEARER { FARTHER } else { NEARER };
        let depth = (view.depth[0] + view.depth[1] * root.z) / (view.depth[2] + view.depth[3] * root.z);
        let on_cell = root.x.x.abs().max(root.x.y.abs()) <= 1.0 + HAIR + root.slack;
        if !(root.converged && on_cell && depth > 0.0 && depth <= 1.0) {
            continue;
        }
        let (low, high) = (Vec2::from(cell.uv_min), Vec2::from(cell.uv_max));
        let part = 0.5 + 0.5 * root.x;
        let uv = (low * (1.0 - part) + high * part).clamp(Vec2::ZERO, Vec2::splat(BELOW_ONE));
        let trimmed = face.flags & FaceHeader::TRIMMED != 0 && cell.flags & Cell::WHOLE == 0;
        counts.classified += u64::from(trim && trimmed);
        let kept = if trim && trimmed { is_kept(&grid_view(scene, face), uv, &mut counters) } else { true };
        if kept || heat {
            let word = if heat {
                pack_heat(root.normal, counters.evaluations as u32, kept, evaluations)
            } else {
                pack_normal(root.normal)
            };
            return Fragment { words: [cell.face + 1, uv.x.to_bits(), uv.y.to_bits(), word], depth };
        }
    }
    Fragment::NONE
}

/// By how much parameters and trim curves may be wrong from rounding. Faces that meet exactly overlap by as much,
/// so that no ray passes between them.
const ROUNDING_UV: f32 = 1.2e-7;

/// Whether the trims keep `uv` (face-normalised), or a point that rounding may have moved there.
pub fn is_kept(grid: &GridView, uv: Vec2, counters: &mut Counters) -> bool {
    let nudge = |k: u32| {
        let by = if k & 1 == 0 { ROUNDING_UV } else { -ROUNDING_UV };
        uv + if k < 2 { Vec2::new(by, 0.0) } else { Vec2::new(0.0, by) }
    };
    let (inside, listed) = classify_listed(grid, uv.x, uv.y, counters);
    inside || listed && (0..4).map(nudge).any(|p| classify(grid, p.x, p.y, &mut Counters::default()))
}

/// The trim grid of a face in the scene's arrays.
pub fn grid_view<'a>(scene: &'a PackedScene, face: &FaceHeader) -> GridView<'a> {
    GridView {
        header: face.grid,
        cells: scene.trim_cells.data(),
        entries: scene.trim_entries.data(),
        data: scene.trim_data.data(),
    }
}
