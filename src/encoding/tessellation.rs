//! Triangles of a finished tessellation, packed face by face to be drawn in place of the exact surfaces.
//!
//! A face is packed once, on whatever thread made its mesh; a scene is put together from the faces that are shown and has
//! nothing to work out. Positions are relative to an origin of the face, rounded like those of cells.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::arena::Arena;
use super::cell::split_high_low;
use super::mesh::MeshVertex;
use super::scene::FaceSlot;
use crate::kernel::face::Face;
use crate::kernel::tessellate::FaceMesh;
use crate::kernel::view::Bounds;

/// Mirror of `TessellationPart` in `shaders/layout/tessellation.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[expect(missing_docs, reason = "described in the shader's layout")]
pub struct TessellationPart {
    pub high: [f32; 3],
    pub slot: u32,
    pub low: [f32; 3],
    pub pad0: u32,
}

/// Level of a deviation as large as the tolerance.
pub const LEVEL_OF_TOLERANCE: u32 = 200;
/// Level of the largest deviation that is told from larger ones.
pub const LARGEST_LEVEL: u32 = 254;
/// Level of triangles that were not measured.
pub const UNMEASURED: u32 = 255;

/// The level that stands for a distance from the exact surface, for `deviation_colour`.
pub fn deviation_level(deviation: f64, tolerance: f64) -> u32 {
    let level = f64::from(LEVEL_OF_TOLERANCE) * deviation / tolerance;
    // What is within the tolerance is never shown beyond it.
    if deviation <= tolerance {
        level.round() as u32
    } else {
        (level.ceil().min(f64::from(LARGEST_LEVEL)) as u32).max(LEVEL_OF_TOLERANCE + 1)
    }
}

/// The packed triangles of one face.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PackedMesh {
    origin: DVec3,
    vertices: Vec<MeshVertex>,
    corners: Vec<u32>,
    levels: Vec<u32>,
}

impl PackedMesh {
    /// Packs a mesh of `face`, not measured yet.
    pub fn new(face: &Face, mesh: &FaceMesh) -> Self {
        let (high, low) = split_high_low(Bounds::of(mesh.positions.iter().copied()).centre());
        // What `f32` pairs can express of it.
        let origin = DVec3::from(high.map(f64::from)) + DVec3::from(low.map(f64::from));
        let vertices = mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs);
        let pack = |((position, normal), uv): ((&DVec3, &DVec3), &glam::DVec2)| MeshVertex {
            position: (*position - origin).as_vec3().to_array(),
            face: 0,
            normal: normal.as_vec3().to_array(),
            flags: 0,
            uv: face.domain.normalise(*uv).as_vec2().to_array(),
            entry: 0,
            origin: 0,
        };
        Self {
            origin,
            vertices: vertices.map(pack).collect(),
            corners: mesh.triangles.as_flattened().to_vec(),
            levels: vec![UNMEASURED; mesh.triangles.len()],
        }
    }

    /// The same with how far each triangle is from the exact face.
    pub fn measured(self, deviations: &[f64], tolerance: f64) -> Self {
        let levels = deviations.iter().map(|d| deviation_level(*d, tolerance)).collect();
        Self { levels, ..self }
    }
}

/// The triangles of all faces that are shown.
#[derive(Debug, Clone, Default)]
pub struct TessellationScene {
    pub(crate) vertices: Arena<MeshVertex>,
    pub(crate) parts: Arena<TessellationPart>,
    pub(crate) corners: Arena<u32>,
    pub(crate) levels: Arena<u32>,
}

impl TessellationScene {
    /// Puts packed faces together, each with its slot in the face table.
    pub fn of<'a>(faces: impl IntoIterator<Item = (FaceSlot, &'a PackedMesh)>) -> Self {
        let (mut vertices, mut parts, mut corners, mut levels) = (vec![], vec![], vec![], vec![]);
        for (slot, mesh) in faces {
            let (face, first) = (parts.len() as u32, vertices.len() as u32);
            let (high, low) = split_high_low(mesh.origin);
            parts.push(TessellationPart { high, slot: slot.0, low, pad0: 0 });
            vertices.extend(mesh.vertices.iter().map(|v| MeshVertex { face, ..*v }));
            corners.extend(mesh.corners.iter().map(|c| first + c));
            levels.extend_from_slice(&mesh.levels);
        }
        let mut scene = Self::default();
        scene.vertices.insert(&vertices);
        scene.parts.insert(&parts);
        scene.corners.insert(&corners);
        scene.levels.insert(&levels);
        scene
    }

    /// Whether the triangles are those of `other`, whatever was measured of either.
    pub fn has_triangles_of(&self, other: &Self) -> bool {
        self.vertices.data() == other.vertices.data()
            && self.parts.data() == other.parts.data()
            && self.corners.data() == other.corners.data()
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.levels.data().len()
    }

    /// Marks everything as changed, so that the next upload sends it all.
    pub fn touch_all(&mut self) {
        self.vertices.touch_all();
        self.parts.touch_all();
        self.corners.touch_all();
        self.levels.touch_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_measured_changes_no_triangle() {
        let face = crate::scene::demo::model().faces[4].derive().expect("valid test data");
        let mesh = |tolerance: f64| {
            let options = crate::kernel::tessellate::TessellationOptions::new(tolerance);
            let mesh = crate::kernel::tessellate::tessellate(&face, &options).expect("few triangles");
            (mesh.triangles.len(), PackedMesh::new(&face, &mesh))
        };
        let ((count, coarse), (_, fine)) = (mesh(0.1), mesh(0.001));
        let scene = |mesh: &PackedMesh| TessellationScene::of([(FaceSlot(3), mesh)]);
        let measured = scene(&coarse.clone().measured(&vec![0.05; count], 0.1));
        assert!(measured.has_triangles_of(&scene(&coarse)) && !measured.has_triangles_of(&scene(&fine)));
        assert!(measured.levels.data() != scene(&coarse).levels.data());
    }

    #[test]
    fn levels_tell_on_which_side_of_the_tolerance_a_triangle_is() {
        for tolerance in [1e-6, 0.3, 25.0] {
            let level = |part: f64| deviation_level(part * tolerance, tolerance);
            assert_eq!([level(0.0), level(0.5), level(1.0)], [0, 100, LEVEL_OF_TOLERANCE]);
            assert_eq!([level(1.0 + 1e-9), level(1e6)], [LEVEL_OF_TOLERANCE + 1, LARGEST_LEVEL]);
        }
        assert_eq!(deviation_level(f64::INFINITY, 1.0), LARGEST_LEVEL);
        assert_ne!(deviation_level(f64::NAN, 1.0), 0, "no figure is no good figure");
    }
}
