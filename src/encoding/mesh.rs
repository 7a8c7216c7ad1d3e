//! Untrimmed triangles of faces at several levels of detail, for the renderer that trims them per pixel.
//!
//! A face is drawn whole where that takes few triangles, else piece by piece ([`super::piece`]): each piece in sight at the level
//! that its nearest point asks for, the others not at all. So how many triangles a picture takes depends on what is in the
//! window, however near it is. Pieces keep the levels that were asked for; seams close the gaps between them.

use std::collections::BTreeMap;
use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use rayon::prelude::*;

use super::arena::Arena;
use super::level::LevelView;
use super::mesh_choice::{Choice, Cover, Seams};
use super::piece::{Halves, WHOLE};
use super::piece_mesh::{Built, PieceMesh, build};
use super::scene::{FaceSlot, PackedScene};
use super::seam::OnLine;
use crate::kernel::face::{Face, UvRect};

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
    pub origin: u32,
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

/// Face, node of its piece and level.
pub(super) type Key = (FaceSlot, u32, i32);

/// A piece that a picture needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Want {
    /// The face.
    pub slot: FaceSlot,
    /// The piece's number, see [`super::piece`].
    pub node: u32,
    /// The coarsest level that is fine enough.
    pub level: i32,
    /// Its native parameters; `None`: all of the face.
    pub rect: Option<UvRect>,
}

impl Want {
    /// What tells it from others.
    pub fn key(&self) -> (FaceSlot, u32, i32) {
        (self.slot, self.node, self.level)
    }
}

/// What there is to draw a picture from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Selection {
    /// Faces that cannot be tessellated: to be cast.
    pub cast: Vec<FaceSlot>,
    /// Whether something stands for all other faces in sight, be it too coarse.
    pub complete: bool,
    /// Pieces that are not there yet.
    pub wanted: Vec<Want>,
}

#[derive(Debug, Clone)]
pub(super) struct Part {
    vertices: Range<u32>,
    origin: u32,
    pub(super) rect: UvRect,
    /// Corners of the triangles, positions in the scene's vertex array; see [`PieceMesh`].
    lists: [Vec<u32>; 3],
    pub(super) borders: [[Vec<OnLine>; 2]; 2],
}

/// A piece that takes too many triangles at a level and finer ones.
#[derive(Debug, Clone, Copy)]
pub(super) struct Divided {
    pub(super) level: i32,
    /// `None`: and cannot be divided.
    pub(super) halves: Option<Halves>,
}

/// The triangles of all faces of a packed scene, by the same slots.
#[derive(Debug, Clone, Default)]
pub struct MeshScene {
    pub(crate) vertices: Arena<MeshVertex>,
    pub(crate) origins: Arena<MeshOrigin>,
    pub(super) parts: BTreeMap<Key, Part>,
    pub(super) divided: BTreeMap<(FaceSlot, u32), Divided>,
    selected: Vec<Key>,
    indices: Vec<u32>,
    ends: [usize; 3],
    revision: u64,
}

impl MeshScene {
    /// Makes and selects what a view needs: for each visible face what of it is in sight, wrong by at most `error_px` pixels.
    /// Returns the faces that are to be cast instead.
    pub fn prepare<'a>(
        &mut self,
        scene: &PackedScene,
        faces: impl Fn(FaceSlot) -> Option<&'a Face>,
        view: &LevelView,
        error_px: f64,
    ) -> Vec<FaceSlot> {
        loop {
            let Selection { mut cast, wanted, .. } = self.select(scene, view, error_px);
            let (missing, lacking): (Vec<_>, Vec<_>) =
                wanted.into_iter().map(|want| (want, faces(want.slot))).partition(|(_, face)| face.is_some());
            if missing.is_empty() {
                cast.extend(lacking.into_iter().map(|(want, _)| want.slot));
                return cast;
            }
            let work = missing.into_par_iter().filter_map(|(want, face)| Some((want, build(face?, &want))));
            for (want, built) in work.collect::<Vec<_>>() {
                self.take(&want, built);
            }
        }
    }

    /// Takes what [`build`] made of a piece.
    pub fn take(&mut self, want: &Want, built: Built) {
        let divided = match built {
            Built::Mesh(mesh) => return self.insert(want.key(), mesh),
            Built::Halves(halves) => Divided { level: want.level, halves: Some(halves) },
            Built::Nothing => Divided { level: want.level, halves: None },
        };
        let held = self.divided.entry((want.slot, want.node)).or_insert(divided);
        held.level = held.level.max(want.level);
        held.halves = held.halves.or(divided.halves);
    }

    fn insert(&mut self, key: Key, mesh: PieceMesh) {
        self.drop_part(key);
        let PieceMesh { rect, origin, mut vertices, mut lists, mut borders } = mesh;
        let origin = self.origins.insert(&[origin]).start;
        for vertex in &mut vertices {
            (vertex.face, vertex.origin) = (key.0.0, origin);
        }
        let vertices = self.vertices.insert(&vertices);
        lists.iter_mut().flatten().for_each(|i| *i += vertices.start);
        borders.iter_mut().flatten().flatten().for_each(|(_, i)| *i += vertices.start);
        self.parts.insert(key, Part { vertices, origin, rect, lists, borders });
        self.selected.clear();
    }

    /// Drops all that was made of a face: it changed or is gone.
    pub fn forget(&mut self, slot: FaceSlot) {
        let of_face = (slot, 0, i32::MIN)..=(slot, u32::MAX, i32::MAX);
        let keys: Vec<Key> = self.parts.range(of_face).map(|(key, _)| *key).collect();
        keys.into_iter().for_each(|key| self.drop_part(key));
        self.divided.retain(|(s, _), _| *s != slot);
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

    /// Chooses what is drawn: of each visible face in sight, or each piece of it, the level at which it is wrong by at most
    /// `error_px` pixels, or the next finer, or what there is.
    pub fn select(&mut self, scene: &PackedScene, view: &LevelView, error_px: f64) -> Selection {
        let mut choice = Choice::new(self, view, error_px);
        let mut found = Selection { complete: true, ..Selection::default() };
        for slot in scene.slots().filter(|slot| !scene.cells_of(*slot).is_empty()) {
            let Some(bounds) = scene.face_bounds(slot) else { continue };
            match choice.cover((slot, WHOLE), &bounds, None) {
                Cover::Yes => {}
                Cover::NotYet => found.complete = false,
                Cover::Never => found.cast.push(slot),
            }
        }
        let mut keys;
        (keys, found.wanted) = choice.made();
        keys.sort_unstable();
        if keys != self.selected || self.indices.is_empty() {
            self.draw(keys);
        }
        found
    }

    fn draw(&mut self, keys: Vec<Key>) {
        self.indices.clear();
        for list in 0..self.ends.len() {
            for key in &keys {
                self.indices.extend_from_slice(&self.parts[key].lists[list]);
            }
            self.ends[list] = self.indices.len();
        }
        // The grid tells all over a seam.
        for of_face in keys.chunk_by(|a, b| a.0 == b.0).filter(|keys| keys.len() > 1) {
            let seams = Seams::new(self, of_face).all();
            self.indices.extend(seams);
        }
        self.ends[2] = self.indices.len();
        self.selected = keys;
        self.revision += 1;
    }

    /// Vertex positions of the selected triangles, three each: see [`Self::ends`].
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Where lists end in the indices: of triangles that are kept whole, that one trim segment alone passes through, of others.
    pub fn ends(&self) -> [usize; 3] {
        self.ends
    }

    /// What is selected: face, native parameters and level of each piece.
    pub fn selected(&self) -> impl Iterator<Item = (FaceSlot, UvRect, i32)> + '_ {
        self.selected.iter().map(|key| (key.0, self.parts[key].rect, key.2))
    }

    /// All vertices, free ones included.
    pub fn vertex_data(&self) -> &[MeshVertex] {
        self.vertices.data()
    }

    /// Origins that vertices name.
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

    fn drop_part(&mut self, key: Key) {
        if let Some(part) = self.parts.remove(&key) {
            self.vertices.remove(part.vertices);
            self.origins.remove(part.origin..part.origin + 1);
            // Its vertices may be used again; those of what is not selected are in no list that is drawn.
            if self.selected.binary_search(&key).is_ok() {
                self.selected.clear();
                self.indices.clear();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::encoding::scene::FaceShape;
    use crate::kernel::view::{Camera, Projection};
    use crate::scene::demo;

    #[test]
    fn what_is_coarse_stands_in_until_pieces_are_there() {
        let faces = demo::model().faces;
        let record = faces.iter().find(|f| f.loops.len() > 3).expect("holes");
        let face = record.derive().expect("valid test data");
        let packed = PackedScene::from_faces([FaceShape::of(&face, None, false)]);
        let slot = packed.slots().next().expect("one face");
        let mut meshes = MeshScene::default();
        let patch = &face.patches[face.patches.len() / 2];
        let target = patch.point(0.5, 0.5);
        let seen = |meshes: &mut MeshScene, distance: f64| {
            let eye = target + DVec3::new(0.3, 0.4, 0.8) * distance;
            let projection = Projection::Perspective { fov_y: 0.7 };
            let view = LevelView::new(&Camera { eye, target, up: DVec3::Z, projection }, [640, 480]);
            meshes.select(&packed, &view, 0.5)
        };
        let diagonal =
            face.patches.iter().fold(crate::kernel::view::Bounds::EMPTY, |b, p| b.union(p.bounds()));
        let (far, near) = (3.0 * diagonal.diagonal(), 0.01 * diagonal.diagonal());
        let first = seen(&mut meshes, far);
        assert!(!first.complete && first.wanted.len() == 1 && first.wanted[0].rect.is_none());
        let mut most = 0;
        for distance in [far, near, far] {
            let mut found = seen(&mut meshes, distance);
            while let Some(want) = found.wanted.first() {
                let built = build(&face, want);
                meshes.take(want, built);
                found = seen(&mut meshes, distance);
                let selected: Vec<_> = meshes.selected().collect();
                assert!(!found.complete || !selected.is_empty());
                assert!(most == 0 || found.complete, "what was there before stands in");
                // No part of the face is drawn twice.
                for (k, (_, a, _)) in selected.iter().enumerate() {
                    assert!(selected[..k].iter().all(|(_, b, _)| {
                        let (low, high) = (a.min.max(b.min), a.max.min(b.max));
                        low.x >= high.x || low.y >= high.y
                    }));
                }
            }
            most = most.max(meshes.selected().count());
            assert!(found.complete && found.cast.is_empty());
        }
        assert!(most > 2, "{most}");
        // Making room takes nothing of what is drawn.
        let (held, drawn) = (meshes.vertices.live(), meshes.indices().to_vec());
        meshes.trim_to(0);
        assert!(meshes.vertices.live() < held && !drawn.is_empty() && meshes.indices() == drawn);
        meshes.forget(slot);
        assert!(!seen(&mut meshes, far).complete && meshes.indices().is_empty());
    }
}
