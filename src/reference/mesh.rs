//! Triangles of the untrimmed surfaces, trimmed per pixel. Twin of `shaders/pass/mesh.wgsl`.

use glam::{DVec2, Vec2, Vec3};
use rayon::prelude::*;

use super::cast::{Fragment, grid_view, is_kept, view_axes};
use super::pack::{pack_heat, pack_normal};
use super::raster::{Triangle, depth_of, place};
use super::solve::{BELOW_ONE, axes_apply};
use super::visibility::{self, VisibilityBuffer};
use crate::encoding::view::{CAST_HEAT, CAST_TRIM, View};
use crate::encoding::{FaceHeader, FaceSlot, MeshScene, MeshVertex, PackedScene};
use crate::kernel::trim::tally::Counters;

/// Rows of the picture drawn by one task.
const BAND: u32 = 16;

/// Draws the triangles that `meshes` has selected, and casts the faces in `lacking`.
pub fn draw(scene: &PackedScene, meshes: &MeshScene, lacking: &[FaceSlot], view: &View) -> VisibilityBuffer {
    let cells = lacking.iter().flat_map(|slot| scene.cells_of(*slot)).collect();
    let mut buffer = visibility::draw_cells(scene, view, cells);
    let triangles: Vec<Drawn> =
        meshes.indices().par_chunks_exact(3).filter_map(|corners| set_up(meshes, view, corners)).collect();
    let width = buffer.width;
    buffer.fragments.par_chunks_mut((width * BAND).max(1) as usize).enumerate().for_each(|(band, rows)| {
        let first = band as u32 * BAND;
        let count = rows.len() as u32 / width.max(1);
        for drawn in &triangles {
            let Triangle { columns, rows: covered, .. } = drawn.triangle;
            for y in covered.0.max(first)..covered.1.min(first + count) {
                for x in columns.0..columns.1 {
                    let here = &mut rows[((y - first) * width + x) as usize];
                    if let Some(fragment) = shade(scene, view, drawn, [x, y], here.depth) {
                        *here = fragment;
                    }
                }
            }
        }
    });
    buffer
}

/// A triangle of the scene ready to draw.
struct Drawn<'a> {
    triangle: Triangle,
    corners: [&'a MeshVertex; 3],
    /// In view axes.
    positions: [Vec3; 3],
}

fn set_up<'a>(meshes: &'a MeshScene, view: &View, corners: &[u32]) -> Option<Drawn<'a>> {
    let axes = view_axes(view);
    let xyz = |v: [f32; 4]| Vec3::new(v[0], v[1], v[2]);
    let corners: [&MeshVertex; 3] = std::array::from_fn(|k| &meshes.vertex_data()[corners[k] as usize]);
    let positions = corners.map(|corner| {
        let origin = &meshes.origin_data()[corner.origin as usize];
        let high = Vec3::from(origin.high) - xyz(view.reference_high);
        let low = Vec3::from(origin.low) - xyz(view.reference_low);
        axes_apply(&axes, high + low) + axes_apply(&axes, Vec3::from(corner.position))
    });
    let triangle = Triangle::new(positions.map(|p| place(view, p, DVec2::ZERO)), view)?;
    Some(Drawn { triangle, corners, positions })
}

/// What the triangle shows at a pixel, if it covers it, is nearer than `best` and kept.
fn shade(scene: &PackedScene, view: &View, drawn: &Drawn, pixel: [u32; 2], best: f32) -> Option<Fragment> {
    let part = drawn.triangle.weights(pixel)?;
    let z = (0..3).map(|k| part[k] * drawn.positions[k].z).sum();
    let depth = depth_of(view, z);
    if !(depth > best && depth <= 1.0) {
        return None;
    }
    let corners = &drawn.corners;
    let uv = (0..3).fold(Vec2::ZERO, |sum, k| sum + part[k] * Vec2::from(corners[k].uv));
    let uv = uv.clamp(Vec2::ZERO, Vec2::splat(BELOW_ONE));
    let slot = corners[0].face;
    let face = &scene.faces.data()[slot as usize];
    let (trim, heat) = (view.flags & CAST_TRIM != 0, view.flags & CAST_HEAT != 0);
    let trimmed = face.flags & FaceHeader::TRIMMED != 0 && corners[0].flags & MeshVertex::WHOLE == 0;
    let mut counters = Counters::default();
    let kept = !(trim && trimmed) || is_kept(&grid_view(scene, face), uv, &mut counters);
    if !kept && !heat {
        return None;
    }
    let sum = (0..3).fold(Vec3::ZERO, |sum, k| sum + part[k] * Vec3::from(corners[k].normal));
    let normal = axes_apply(&view_axes(view), sum);
    let normal = normal / normal.length().max(1e-37);
    let word =
        if heat { pack_heat(normal, counters.evaluations as u32, kept, 0) } else { pack_normal(normal) };
    Some(Fragment { words: [slot + 1, uv.x.to_bits(), uv.y.to_bits(), word], depth })
}
