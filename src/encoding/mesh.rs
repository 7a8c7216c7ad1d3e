//! Untrimmed triangles of faces at several levels of detail, for the renderer that trims them per pixel.
//!
//! A level `k` stands for an error of at most `2^k` model units. Each face keeps the levels that were asked for;
//! a picture draws one of each face in sight. Parts where the trims keep nothing are left out, parts that they keep
//! whole are marked, so that no curve is looked at there. Positions are relative to an origin of the face,
//! rounded like those of cells.

use std::collections::BTreeMap;
use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};

use super::arena::Arena;
use super::cell::split_high_low;
use super::coverage::{Coverage, coverage};
use super::scene::FaceSlot;
use crate::kernel::trim::ParityGrid;
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
    pub pad0: u32,
    pub pad1: u32,
}

impl MeshVertex {
    /// No trim curve passes through the triangle.
    pub const WHOLE: u32 = 1;
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

/// A corner of an untrimmed triangle mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshCorner {
    /// Point of the surface, model units.
    pub point: DVec3,
    /// `du x dv`, unit; zero at poles.
    pub normal: DVec3,
    /// Face-normalised parameters.
    pub uv: DVec2,
}

/// Triangles of one face whose surface is at most a level's error away from them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MeshShape {
    /// Corners.
    pub corners: Vec<MeshCorner>,
    /// Positions of three corners each, counter-clockwise in (u, v).
    pub triangles: Vec<[u32; 3]>,
}

#[derive(Debug, Clone)]
struct Part {
    vertices: Range<u32>,
    /// Positions in the scene's vertex array.
    indices: Vec<u32>,
}

/// The triangles of all faces of a packed scene, by the same slots.
#[derive(Debug, Clone, Default)]
pub struct MeshScene {
    pub(crate) vertices: Arena<MeshVertex>,
    pub(crate) origins: Arena<MeshOrigin>,
    parts: BTreeMap<(FaceSlot, i32), Part>,
    selected: Vec<(FaceSlot, i32)>,
    indices: Vec<u32>,
    revision: u64,
}

impl MeshScene {
    /// Whether a face's triangles are there at exactly this level.
    pub fn has(&self, slot: FaceSlot, level: i32) -> bool {
        self.parts.contains_key(&(slot, level))
    }

    /// Packs a face's triangles at a level, in place of what was there at that level. `grid`: its trims.
    pub fn insert(&mut self, slot: FaceSlot, level: i32, shape: &MeshShape, grid: Option<&ParityGrid>) {
        self.drop_part((slot, level));
        let kept = kept_triangles(shape, grid);
        let origin = self.origin_of(slot, &kept, shape);
        let (vertices, indices) = compact(slot, shape, &kept, origin);
        let vertices = self.vertices.insert(&vertices);
        let indices = indices.into_iter().map(|i| vertices.start + i).collect();
        self.parts.insert((slot, level), Part { vertices, indices });
        self.selected.clear();
    }

    /// Drops all levels of a face: it changed or is gone.
    pub fn forget(&mut self, slot: FaceSlot) {
        let levels: Vec<i32> = self.levels(slot).collect();
        levels.into_iter().for_each(|level| self.drop_part((slot, level)));
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
    /// the faces of which there is nothing.
    pub fn select(&mut self, wanted: impl IntoIterator<Item = (FaceSlot, i32)>) -> Vec<FaceSlot> {
        let (mut chosen, mut lacking) = (Vec::new(), Vec::new());
        for (slot, level) in wanted {
            let finer = self.parts.range((slot, i32::MIN)..=(slot, level)).next_back();
            let any = finer.or_else(|| self.parts.range((slot, level)..=(slot, i32::MAX)).next());
            match any {
                Some((key, _)) => chosen.push(*key),
                None => lacking.push(slot),
            }
        }
        chosen.sort_unstable();
        if chosen != self.selected || self.indices.is_empty() {
            self.indices.clear();
            for key in &chosen {
                self.indices.extend_from_slice(&self.parts[key].indices);
            }
            self.selected = chosen;
            self.revision += 1;
        }
        lacking
    }

    /// Vertex positions of the selected triangles, three each.
    pub fn indices(&self) -> &[u32] {
        &self.indices
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
    fn origin_of(&mut self, slot: FaceSlot, kept: &[(usize, bool)], shape: &MeshShape) -> DVec3 {
        while self.origins.data().len() <= slot.0 as usize {
            self.origins.insert(&[MeshOrigin::zeroed()]);
        }
        if self.levels(slot).next().is_none() {
            let corners = kept.iter().flat_map(|(k, _)| shape.triangles[*k]);
            let centre = Bounds::of(corners.map(|c| shape.corners[c as usize].point)).centre();
            let (high, low) = split_high_low(centre);
            self.origins.set(slot.0, MeshOrigin { high, pad0: 0, low, pad1: 0 });
        }
        let origin = self.origins.data()[slot.0 as usize];
        DVec3::from(origin.high.map(f64::from)) + DVec3::from(origin.low.map(f64::from))
    }
}

/// Triangles that show anything, by position, and whether they are kept whole.
fn kept_triangles(shape: &MeshShape, grid: Option<&ParityGrid>) -> Vec<(usize, bool)> {
    let covered = |(k, triangle): (usize, &[u32; 3])| {
        let uv = triangle.map(|c| shape.corners[c as usize].uv);
        let (min, max) = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
        match grid.map_or(Coverage::Whole, |grid| coverage(grid, min, max)) {
            Coverage::Empty => None,
            found => Some((k, found == Coverage::Whole)),
        }
    };
    shape.triangles.iter().enumerate().filter_map(covered).collect()
}

/// The vertices that are used, once for whole triangles and once for others, and the indices into them.
fn compact(
    slot: FaceSlot,
    shape: &MeshShape,
    kept: &[(usize, bool)],
    origin: DVec3,
) -> (Vec<MeshVertex>, Vec<u32>) {
    const UNUSED: u32 = u32::MAX;
    let mut numbers = [vec![UNUSED; shape.corners.len()], vec![UNUSED; shape.corners.len()]];
    let (mut vertices, mut indices) = (Vec::new(), Vec::with_capacity(3 * kept.len()));
    for (k, whole) in kept {
        for c in shape.triangles[*k] {
            let number = &mut numbers[usize::from(*whole)][c as usize];
            if *number == UNUSED {
                *number = vertices.len() as u32;
                let corner = &shape.corners[c as usize];
                vertices.push(MeshVertex {
                    position: (corner.point - origin).as_vec3().to_array(),
                    face: slot.0,
                    normal: corner.normal.as_vec3().to_array(),
                    flags: if *whole { MeshVertex::WHOLE } else { 0 },
                    uv: corner.uv.as_vec2().to_array(),
                    pad0: 0,
                    pad1: 0,
                });
            }
            indices.push(*number);
        }
    }
    (vertices, indices)
}
