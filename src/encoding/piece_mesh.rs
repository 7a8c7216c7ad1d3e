//! The untrimmed triangles of a piece of a face at a level of detail, sorted by what trims leave of them and packed.
//!
//! A level `k` stands for an error of at most `2^k` model units. Parts where the trims keep nothing are left out, parts that they
//! keep whole are marked, so that no curve is looked at there. Positions are relative to an origin of the piece, rounded like
//! those of cells. A piece that takes too many triangles is cut in half instead.

use std::collections::HashMap;

use glam::DVec3;

use super::bisection::{SortedMesh, sort_triangles};
use super::cell::split_high_low;
use super::level::level_error;
use super::lone_curve::TriangleTrim;
use super::mesh::{MeshOrigin, MeshVertex, Want};
use super::piece::{Halves, WHOLE, halves};
use super::seam::OnLine;
use crate::kernel::face::{Face, UvRect};
use crate::kernel::tessellate::{TessellateError, TessellationOptions, UntrimmedMesh, untrimmed_over};
use crate::kernel::view::Bounds;

/// A piece is divided where its surface takes more triangles than this: larger pieces are fine as a whole where only a corner is
/// near, many smaller ones have more border, ...
const PIECE_TRIANGLES: usize = 1_200;
/// ... or this many with those that are divided along trims.
const SORTED_TRIANGLES: usize = 2_400;
/// What is too thin to be divided takes no more than this.
const THIN_TRIANGLES: usize = 60_000;

/// Triangles that trims pass through are halved until their sides are this many times the error of the level: ten to
/// twenty pixels where that is half a pixel. Shorter ones leave less to trim, but take longer to draw than that saves.
const TRIMMED_SIDE: f64 = 40.0;

/// What became of a piece.
#[derive(Debug, Clone)]
pub enum Built {
    /// Its triangles.
    Mesh(PieceMesh),
    /// They are too many.
    Halves(Halves),
    /// It cannot be tessellated: better cast the face.
    Nothing,
}

/// Packed triangles. Vertices lack their face and the position of their origin.
#[derive(Debug, Clone)]
pub struct PieceMesh {
    pub(super) rect: UvRect,
    pub(super) origin: MeshOrigin,
    pub(super) vertices: Vec<MeshVertex>,
    /// Corners of the triangles: of those that are kept whole, that one segment passes through, and of others.
    pub(super) lists: [Vec<u32>; 3],
    /// Vertices on the borders of a piece that is not the whole face: at the least u and the largest, at the least v and the largest.
    pub(super) borders: [[Vec<OnLine>; 2]; 2],
}

/// Makes the triangles of a piece.
pub fn build(face: &Face, want: &Want) -> Built {
    let rect = want.rect.unwrap_or(face.domain);
    let length = TRIMMED_SIDE * level_error(want.level);
    let sorted = |mesh, most| sort_triangles(mesh, face, length, most);
    let found = surface(face, &rect, want.level, PIECE_TRIANGLES).map(|mesh| sorted(mesh, SORTED_TRIANGLES));
    let pack = |mesh: &SortedMesh| Built::Mesh(PieceMesh::new(face, rect, mesh, want.node != WHOLE));
    match found {
        Ok(mesh) if mesh.mesh.triangles.len() < SORTED_TRIANGLES => pack(&mesh),
        Ok(_) | Err(TessellateError::TooManyTriangles { .. }) => match halves(face, want.node, &rect) {
            Some(halves) => Built::Halves(halves),
            None => match surface(face, &rect, want.level, THIN_TRIANGLES) {
                Ok(mesh) => pack(&sorted(mesh, THIN_TRIANGLES)),
                Err(_) => Built::Nothing,
            },
        },
        Err(_) => Built::Nothing,
    }
}

/// The triangles of the untrimmed surface: within the level's error as far as P2's estimate at points of the surface tells.
pub(super) fn surface(
    face: &Face,
    rect: &UvRect,
    level: i32,
    most: usize,
) -> Result<UntrimmedMesh, TessellateError> {
    let options = TessellationOptions {
        conservative: false,
        triangle_limit: most,
        ..TessellationOptions::new(level_error(level))
    };
    untrimmed_over(face, rect, &options)
}

impl PieceMesh {
    fn new(face: &Face, rect: UvRect, sorted: &SortedMesh, has_borders: bool) -> Self {
        let corners = kept(sorted).flat_map(|(triangle, _)| triangle);
        let middle = Bounds::of(corners.map(|c| sorted.mesh.positions[c as usize])).centre();
        let (high, low) = split_high_low(middle);
        let origin = MeshOrigin { high, pad0: 0, low, pad1: 0 };
        let mut packing = Packing {
            sorted,
            face,
            // What `f32` pairs can express of it.
            origin: DVec3::from(high.map(f64::from)) + DVec3::from(low.map(f64::from)),
            numbers: HashMap::new(),
            vertices: Vec::new(),
        };
        let mut lists = [const { Vec::new() }; 3];
        for (triangle, trim) in kept(sorted) {
            let list = match trim {
                TriangleTrim::Empty => continue,
                TriangleTrim::Whole => 0,
                TriangleTrim::Lone(_) => 1,
                TriangleTrim::Several => 2,
            };
            lists[list].extend(triangle.map(|corner| packing.number(trim, corner)));
        }
        let mut borders: [[Vec<OnLine>; 2]; 2] = Default::default();
        if has_borders {
            for corner in 0..sorted.mesh.uvs.len() as u32 {
                let uv = sorted.mesh.uvs[corner as usize];
                for (axis, sides) in borders.iter_mut().enumerate() {
                    for (line, side) in [rect.min[axis], rect.max[axis]].into_iter().zip(sides) {
                        if uv[axis] == line {
                            side.push((uv[1 - axis], packing.number(TriangleTrim::Several, corner)));
                        }
                    }
                }
            }
        }
        borders.iter_mut().flatten().for_each(|side| side.sort_by(|a, b| a.0.total_cmp(&b.0)));
        Self { rect, origin, vertices: packing.vertices, lists, borders }
    }
}

/// Triangles that show anything.
fn kept(sorted: &SortedMesh) -> impl Iterator<Item = ([u32; 3], TriangleTrim)> + '_ {
    let all = sorted.mesh.triangles.iter().zip(&sorted.trims);
    all.filter(|(_, trim)| **trim != TriangleTrim::Empty).map(|(t, trim)| (*t, *trim))
}

/// The vertices that are used, once for triangles of the same kind.
struct Packing<'a> {
    sorted: &'a SortedMesh,
    face: &'a Face,
    origin: DVec3,
    /// Only looked into: its order decides nothing.
    numbers: HashMap<(TriangleTrim, u32), u32>,
    vertices: Vec<MeshVertex>,
}

impl Packing<'_> {
    fn number(&mut self, trim: TriangleTrim, corner: u32) -> u32 {
        let (mesh, c) = (&self.sorted.mesh, corner as usize);
        *self.numbers.entry((trim, corner)).or_insert_with(|| {
            let (flags, entry) = match trim {
                TriangleTrim::Whole => (MeshVertex::WHOLE, 0),
                TriangleTrim::Lone(curve) if curve.zero_kept => (MeshVertex::ZERO_KEPT, curve.entry),
                TriangleTrim::Lone(curve) => (0, curve.entry),
                TriangleTrim::Several | TriangleTrim::Empty => (0, 0),
            };
            self.vertices.push(MeshVertex {
                position: (mesh.positions[c] - self.origin).as_vec3().to_array(),
                face: 0,
                normal: mesh.normals[c].as_vec3().to_array(),
                flags,
                uv: self.face.domain.normalise(mesh.uvs[c]).as_vec2().to_array(),
                entry,
                origin: 0,
            });
            self.vertices.len() as u32 - 1
        })
    }
}
