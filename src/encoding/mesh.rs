//! Untrimmed triangles of faces at several levels of detail, for the renderer that trims them per pixel.
//!
//! A level `k` stands for an error of at most `2^k` model units. Each face keeps the levels that were asked for;
//! a picture draws one of each face in sight. Parts where the trims keep nothing are left out, parts that they keep
//! whole are marked, so that no curve is looked at there. Positions are relative to an origin of the face,
//! rounded like those of cells.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use rayon::prelude::*;

use super::arena::Arena;
use super::bisection::{SortedMesh, sort_triangles};
use super::cell::split_high_low;
use super::level::{LevelView, level_error};
use super::lone_curve::TriangleTrim;
use super::scene::{FaceSlot, PackedScene};
use crate::kernel::face::Face;
use crate::kernel::tessellate::{TessellationOptions, UntrimmedMesh, untrimmed};
use crate::kernel::view::Bounds;

/// Mirror of `MeshVertex` in `shaders/layout/mesh.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[expect(missing_docs, reason = "described in the shader's layout")]
pub struct MeshVertex {
    pub position: [f32; 3],
    pub face: u32,
    pub normal: [f32; 3],
    pub flags: u32,
    pub uv: [f32; 2],
    pub entry: u32,
    pub pad0: u32,
}

impl MeshVertex {
    /// No trim curve passes through the triangle.
    pub const WHOLE: u32 = 1;
    /// Points are kept where the value of `entry`, the only segment that passes through the triangle, is 0.
    pub const ZERO_KEPT: u32 = 2;
}

/// Mirror of `MeshOrigin` in `shaders/layout/mesh.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[expect(missing_docs, reason = "described in the shader's layout")]
pub struct MeshOrigin {
    pub high: [f32; 3],
    pub pad0: u32,
    pub low: [f32; 3],
    pub pad1: u32,
}

#[derive(Debug, Clone)]
struct Part {
    vertices: Range<u32>,
    /// Corners of the triangles, positions in the scene's vertex array: of those that are kept whole, that one segment passes
    /// through, and of others.
    lists: [Vec<u32>; 3],
}

/// A face takes no more triangles than this; where it would, it is better cast.
const FACE_TRIANGLES: usize = 60_000;

/// Triangles that trims pass through are halved until their sides are this many times the error of the level: ten to
/// twenty pixels where that is half a pixel. Shorter ones leave less to trim, but take longer to draw than that saves.
const TRIMMED_SIDE: f64 = 40.0;

/// The triangles of `face` at a level, sorted by what its trims leave of them. `None` where it takes too many, or
/// cannot be tessellated.
pub fn build(face: &Face, level: i32) -> Option<SortedMesh> {
    let mesh = surface(face, level)?;
    Some(sort_triangles(mesh, face, TRIMMED_SIDE * level_error(level), FACE_TRIANGLES))
}

/// The triangles of the untrimmed surface: within the level's error as far as P2's estimate at points of the surface tells.
pub(super) fn surface(face: &Face, level: i32) -> Option<UntrimmedMesh> {
    let options = TessellationOptions {
        conservative: false,
        triangle_limit: FACE_TRIANGLES,
        ..TessellationOptions::new(level_error(level))
    };
    untrimmed(face, &options).ok()
}

/// The triangles of all faces of a packed scene, by the same slots.
#[derive(Debug, Clone, Default)]
pub struct MeshScene {
    pub(crate) vertices: Arena<MeshVertex>,
    pub(crate) origins: Arena<MeshOrigin>,
    parts: BTreeMap<(FaceSlot, i32), Part>,
    /// Levels that a face takes too many triangles for.
    refused: BTreeSet<(FaceSlot, i32)>,
    selected: Vec<(FaceSlot, i32)>,
    indices: Vec<u32>,
    ends: [usize; 3],
    revision: u64,
}

impl MeshScene {
    /// Whether a face's triangles are there at exactly this level.
    pub fn has(&self, slot: FaceSlot, level: i32) -> bool {
        self.parts.contains_key(&(slot, level))
    }

    /// Makes and selects what a view needs: for each visible face in sight the level at which it is wrong by at most
    /// `error_px` pixels. Returns the faces that are to be cast instead.
    pub fn prepare<'a>(
        &mut self,
        scene: &PackedScene,
        faces: impl Fn(FaceSlot) -> Option<&'a Face>,
        view: &LevelView,
        error_px: f64,
    ) -> Vec<FaceSlot> {
        let wanted: Vec<_> = wanted(scene, view, error_px).collect();
        let missing: Vec<_> = wanted
            .iter()
            .filter(|(slot, level)| !self.knows(*slot, *level))
            .filter_map(|(slot, level)| Some((*slot, *level, faces(*slot)?)))
            .collect();
        let built: Vec<_> = missing
            .into_par_iter()
            .map(|(slot, level, face)| (slot, level, face, build(face, level)))
            .collect();
        for (slot, level, face, mesh) in built {
            self.take(slot, level, face, mesh.as_ref());
        }
        self.select(wanted)
    }

    /// Takes what [`build`] made, or notes that it made nothing.
    pub fn take(&mut self, slot: FaceSlot, level: i32, face: &Face, mesh: Option<&SortedMesh>) {
        match mesh {
            Some(mesh) => self.insert(slot, level, mesh, face),
            None => {
                self.refused.insert((slot, level));
            }
        }
    }

    /// Whether a face's triangles at this level are there or known to be too many.
    pub fn knows(&self, slot: FaceSlot, level: i32) -> bool {
        self.has(slot, level) || self.is_refused(slot, level)
    }

    fn is_refused(&self, slot: FaceSlot, level: i32) -> bool {
        self.refused.range((slot, level)..=(slot, i32::MAX)).next().is_some()
    }

    /// Packs a face's triangles at a level, in place of what was there at that level.
    pub fn insert(&mut self, slot: FaceSlot, level: i32, mesh: &SortedMesh, face: &Face) {
        self.drop_part((slot, level));
        let origin = self.origin_of(slot, mesh);
        let (vertices, lists) = compact(slot, mesh, face, origin);
        let vertices = self.vertices.insert(&vertices);
        let lists = lists.map(|indices| indices.into_iter().map(|i| vertices.start + i).collect());
        self.parts.insert((slot, level), Part { vertices, lists });
        self.selected.clear();
    }

    /// Drops all levels of a face: it changed or is gone.
    pub fn forget(&mut self, slot: FaceSlot) {
        let levels: Vec<i32> = self.levels(slot).collect();
        levels.into_iter().for_each(|level| self.drop_part((slot, level)));
        self.refused.retain(|(s, _)| *s != slot);
        if self.origins.data().get(slot.0 as usize).is_some() {
            self.origins.set(slot.0, MeshOrigin::zeroed());
        }
        self.selected.clear();
    }

    /// Drops what is not selected when more than `most` vertices are held.
    pub fn trim_to(&mut self, most: usize) {
        if self.vertices.live() > most {
            let unused: Vec<_> =
                self.parts.keys().filter(|key| self.selected.binary_search(key).is_err()).copied().collect();
            unused.into_iter().for_each(|key| self.drop_part(key));
        }
    }

    /// Chooses what is drawn: for each face the level wanted, or the next finer, or the finest there is. Returns
    /// the faces of which there is nothing or that take too many triangles.
    pub fn select(&mut self, wanted: impl IntoIterator<Item = (FaceSlot, i32)>) -> Vec<FaceSlot> {
        let (mut chosen, mut lacking) = (Vec::new(), Vec::new());
        for (slot, level) in wanted {
            let finer = self.parts.range((slot, i32::MIN)..=(slot, level)).next_back();
            let any = finer.or_else(|| self.parts.range((slot, level)..=(slot, i32::MAX)).next());
            match any {
                Some((key, _)) if !self.is_refused(slot, level) => chosen.push(*key),
                _ => lacking.push(slot),
            }
        }
        chosen.sort_unstable();
        if chosen != self.selected || self.indices.is_empty() {
            self.indices.clear();
            for list in 0..self.ends.len() {
                for key in &chosen {
                    self.indices.extend_from_slice(&self.parts[key].lists[list]);
                }
                self.ends[list] = self.indices.len();
            }
            self.selected = chosen;
            self.revision += 1;
        }
        lacking
    }

    /// Vertex positions of the selected triangles, three each: see [`Self::ends`].
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Where lists end in the indices: of triangles that are kept whole, that one trim segment alone passes through, of others.
    pub fn ends(&self) -> [usize; 3] {
        self.ends
    }

    /// All vertices, free ones included.
    pub fn vertex_data(&self) -> &[MeshVertex] {
        self.vertices.data()
    }

    /// Origins by face slot.
    pub fn origin_data(&self) -> &[MeshOrigin] {
        self.origins.data()
    }

    /// Grows when other triangles are selected.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Marks everything as changed, so that the next upload sends it all.
    pub fn touch_all(&mut self) {
        self.vertices.touch_all();
        self.origins.touch_all();
        self.revision += 1;
    }

    fn levels(&self, slot: FaceSlot) -> impl Iterator<Item = i32> + '_ {
        self.parts.range((slot, i32::MIN)..=(slot, i32::MAX)).map(|((_, level), _)| *level)
    }

    fn drop_part(&mut self, key: (FaceSlot, i32)) {
        if let Some(part) = self.parts.remove(&key) {
            self.vertices.remove(part.vertices);
            // Its vertices may be used again.
            self.selected.clear();
            self.indices.clear();
        }
    }

    /// The face's origin: the middle of its first triangles, kept for all levels.
    fn origin_of(&mut self, slot: FaceSlot, sorted: &SortedMesh) -> DVec3 {
        while self.origins.data().len() <= slot.0 as usize {
            self.origins.insert(&[MeshOrigin::zeroed()]);
        }
        if self.levels(slot).next().is_none() {
            let corners = kept(sorted).flat_map(|(triangle, _)| triangle);
            let centre = Bounds::of(corners.map(|c| sorted.mesh.positions[c as usize])).centre();
            let (high, low) = split_high_low(centre);
            self.origins.set(slot.0, MeshOrigin { high, pad0: 0, low, pad1: 0 });
        }
        let origin = self.origins.data()[slot.0 as usize];
        DVec3::from(origin.high.map(f64::from)) + DVec3::from(origin.low.map(f64::from))
    }
}

/// Visible faces in sight with the level at which they are wrong by at most `error_px` pixels.
pub fn wanted<'a>(
    scene: &'a PackedScene,
    view: &'a LevelView,
    error_px: f64,
) -> impl Iterator<Item = (FaceSlot, i32)> + 'a {
    let shown = scene.slots().filter(|slot| !scene.cells_of(*slot).is_empty());
    shown.filter_map(move |slot| Some((slot, view.level(&scene.face_bounds(slot)?, error_px)?)))
}

/// Triangles that show anything.
fn kept(sorted: &SortedMesh) -> impl Iterator<Item = ([u32; 3], TriangleTrim)> + '_ {
    let all = sorted.mesh.triangles.iter().zip(&sorted.trims);
    all.filter(|(_, trim)| **trim != TriangleTrim::Empty).map(|(t, trim)| (*t, *trim))
}

/// The vertices that are used, once for triangles of the same kind, and the indices into them of the lists.
fn compact(
    slot: FaceSlot,
    sorted: &SortedMesh,
    face: &Face,
    origin: DVec3,
) -> (Vec<MeshVertex>, [Vec<u32>; 3]) {
    let mesh = &sorted.mesh;
    // Only looked into: its order decides nothing.
    let mut numbers: HashMap<(TriangleTrim, u32), u32> = HashMap::new();
    let (mut vertices, mut lists) = (Vec::new(), [const { Vec::new() }; 3]);
    for (triangle, trim) in kept(sorted) {
        let (list, flags, entry) = match trim {
            TriangleTrim::Empty => continue,
            TriangleTrim::Whole => (0, MeshVertex::WHOLE, 0),
            TriangleTrim::Lone(curve) if curve.zero_kept => (1, MeshVertex::ZERO_KEPT, curve.entry),
            TriangleTrim::Lone(curve) => (1, 0, curve.entry),
            TriangleTrim::Several => (2, 0, 0),
        };
        for corner in triangle {
            let c = corner as usize;
            let number = *numbers.entry((trim, corner)).or_insert_with(|| {
                vertices.push(MeshVertex {
                    position: (mesh.positions[c] - origin).as_vec3().to_array(),
                    face: slot.0,
                    normal: mesh.normals[c].as_vec3().to_array(),
                    flags,
                    uv: face.domain.normalise(mesh.uvs[c]).as_vec2().to_array(),
                    entry,
                    pad0: 0,
                });
                vertices.len() as u32 - 1
            });
            lists[list].push(number);
        }
    }
    (vertices, lists)
}
