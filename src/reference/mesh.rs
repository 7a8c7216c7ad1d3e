//! Triangles of the untrimmed surfaces, trimmed per pixel. Twin of `shaders/pass/mesh.wgsl` and of the rasteriser
//! before it.
//!
//! Triangles are drawn in homogeneous coordinates (Olano and Greer 1997), so that none has to be clipped: three
//! edge functions of the pixel, found from the inverse of the matrix of its corners, tell coverage, 1/w and the
//! perspective-correct weights of the corners.

use glam::{DMat3, DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::cast::{Fragment, grid_view, view_axes};
use super::pack::{pack_heat, pack_normal};
use super::solve::{BELOW_ONE, axes_apply};
use super::visibility::{self, VisibilityBuffer};
use crate::encoding::view::{CAST_HEAT, CAST_TRIM, View};
use crate::encoding::{FaceHeader, FaceSlot, MeshScene, MeshVertex, PackedScene};
use crate::kernel::trim::grid::classify;
use crate::kernel::trim::tally::Counters;

/// Rows of the picture drawn by one task.
const BAND: u32 = 16;

/// Draws the triangles that `meshes` has selected, and casts the faces in `lacking`.
pub fn draw(scene: &PackedScene, meshes: &MeshScene, lacking: &[FaceSlot], view: &View) -> VisibilityBuffer {
    let cells = lacking.iter().flat_map(|slot| scene.cells_of(*slot)).collect();
    let mut buffer = visibility::draw_cells(scene, view, cells);
    let triangles: Vec<Triangle> =
        meshes.indices().par_chunks_exact(3).filter_map(|corners| set_up(meshes, view, corners)).collect();
    let width = buffer.width;
    buffer.fragments.par_chunks_mut((width * BAND).max(1) as usize).enumerate().for_each(|(band, rows)| {
        let first = band as u32 * BAND;
        let count = rows.len() as u32 / width.max(1);
        for triangle in triangles.iter().filter(|t| t.rows.0 < first + count && t.rows.1 > first) {
            for y in triangle.rows.0.max(first)..triangle.rows.1.min(first + count) {
                for x in triangle.columns.0..triangle.columns.1 {
                    let here = &mut rows[((y - first) * width + x) as usize];
                    if let Some(fragment) = shade(scene, meshes, view, triangle, [x, y], here.depth) {
                        *here = fragment;
                    }
                }
            }
        }
    });
    buffer
}

/// A triangle ready to draw.
struct Triangle<'a> {
    corners: [&'a MeshVertex; 3],
    /// Edge functions by rows: weights of the corners times 1 / w are `edges * (x, y, 1)` of the pixel.
    edges: DMat3,
    /// Columns and rows that it may cover, ends exclusive.
    columns: (u32, u32),
    rows: (u32, u32),
}

fn set_up<'a>(meshes: &'a MeshScene, view: &View, corners: &[u32]) -> Option<Triangle<'a>> {
    let axes = view_axes(view);
    let xyz = |v: [f32; 4]| Vec3::new(v[0], v[1], v[2]);
    let corners: [&MeshVertex; 3] = std::array::from_fn(|k| &meshes.vertex_data()[corners[k] as usize]);
    let origin = &meshes.origin_data()[corners[0].face as usize];
    let high = Vec3::from(origin.high) - xyz(view.reference_high);
    let low = Vec3::from(origin.low) - xyz(view.reference_low);
    let shift = axes_apply(&axes, high + low);
    let size = Vec2::from(view.size).as_dvec2();
    let place = |corner: &MeshVertex| {
        let p = shift + axes_apply(&axes, Vec3::from(corner.position));
        let w = f64::from(view.depth[2] + view.depth[3] * p.z);
        let clip = (p.truncate() * Vec2::from(view.clip_scale)).as_dvec2();
        // To pixels from the upper left, times w; the jitter moves the surface the other way.
        let x = 0.5 * size.x * (clip.x + w) - f64::from(view.jitter[0]) * w;
        let y = 0.5 * size.y * (w - clip.y) - f64::from(view.jitter[1]) * w;
        DVec3::new(x, y, w)
    };
    let placed = corners.map(place);
    let (mut min, mut max) = ([0.0; 2], [size.x, size.y]);
    if placed.iter().all(|p| p.z > 0.0) {
        for axis in 0..2 {
            let along = placed.map(|p| p[axis] / p.z);
            min[axis] = along.into_iter().fold(f64::INFINITY, f64::min).max(0.0);
            max[axis] = along.into_iter().fold(f64::NEG_INFINITY, f64::max).min(max[axis]);
        }
    } else if placed.iter().all(|p| p.z <= 0.0) {
        return None;
    }
    let matrix = DMat3::from_cols(placed[0], placed[1], placed[2]);
    let edges = matrix.inverse();
    if !edges.is_finite() || !(min[0] < max[0] && min[1] < max[1]) {
        return None;
    }
    let range = |axis: usize| (min[axis].floor() as u32, max[axis].ceil() as u32);
    Some(Triangle { corners, edges, columns: range(0), rows: range(1) })
}

/// What the triangle shows at a pixel, if it covers it, is nearer than `best` and kept.
fn shade(
    scene: &PackedScene,
    meshes: &MeshScene,
    view: &View,
    triangle: &Triangle,
    [x, y]: [u32; 2],
    best: f32,
) -> Option<Fragment> {
    let weights = triangle.edges * DVec3::new(f64::from(x) + 0.5, f64::from(y) + 0.5, 1.0);
    let inverse_w = weights.element_sum();
    if weights.min_element() < 0.0 || inverse_w <= 0.0 {
        return None;
    }
    let part = (weights / inverse_w).as_vec3();
    let w = (1.0 / inverse_w) as f32;
    // w = c + d z in perspective; else z is mixed like everything.
    let perspective = view.depth[3] != 0.0;
    let depth = if perspective {
        view.depth[0] / w
    } else {
        view.depth[0] + view.depth[1] * mixed_z(meshes, view, triangle, part)
    };
    if !(depth > best && depth <= 1.0) {
        return None;
    }
    let mix2 = |pick: fn(&MeshVertex) -> [f32; 2]| {
        (0..3).fold(Vec2::ZERO, |sum, k| sum + part[k] * Vec2::from(pick(triangle.corners[k])))
    };
    let slot = triangle.corners[0].face;
    let face = &scene.faces.data()[slot as usize];
    let uv = mix2(|v| v.uv).clamp(Vec2::ZERO, Vec2::splat(BELOW_ONE));
    let (trim, heat) = (view.flags & CAST_TRIM != 0, view.flags & CAST_HEAT != 0);
    let trimmed = face.flags & FaceHeader::TRIMMED != 0 && triangle.corners[0].flags & MeshVertex::WHOLE == 0;
    let mut counters = Counters::default();
    let kept = !(trim && trimmed) || classify(&grid_view(scene, face), uv.x, uv.y, &mut counters);
    if !kept && !heat {
        return None;
    }
    let axes = view_axes(view);
    let sum = (0..3).fold(Vec3::ZERO, |sum, k| sum + part[k] * Vec3::from(triangle.corners[k].normal));
    let normal = axes_apply(&axes, sum);
    let normal = normal / normal.length().max(1e-37);
    let word =
        if heat { pack_heat(normal, counters.evaluations as u32, kept, 0) } else { pack_normal(normal) };
    Some(Fragment { words: [slot + 1, uv.x.to_bits(), uv.y.to_bits(), word], depth })
}

fn mixed_z(meshes: &MeshScene, view: &View, triangle: &Triangle, part: Vec3) -> f32 {
    let axes = view_axes(view);
    let xyz = |v: [f32; 4]| Vec3::new(v[0], v[1], v[2]);
    let origin = &meshes.origin_data()[triangle.corners[0].face as usize];
    let high = Vec3::from(origin.high) - xyz(view.reference_high);
    let low = Vec3::from(origin.low) - xyz(view.reference_low);
    let position = (0..3).fold(Vec3::ZERO, |sum, k| sum + part[k] * Vec3::from(triangle.corners[k].position));
    axes_apply(&axes, high + low + position).z
}
