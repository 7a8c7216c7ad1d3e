//! The edges of a mesh, each once though faces on both sides have it: what is drawn as wires, and counted.
//!
//! Faces share positions bit for bit along their seams, so equal positions are one vertex.

use std::ops::Range;

use rayon::prelude::*;

use super::model_mesh::ModelMesh;

/// An edge of triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MeshEdge {
    /// Face that has it.
    pub face: u32,
    /// Its ends among the positions of that face.
    pub ends: [u32; 2],
    /// Another face that has it too.
    pub other: Option<u32>,
    /// Triangles at it: one at an open edge, two inside a body.
    pub triangles: u32,
}

impl MeshEdge {
    /// Whether there is a triangle on one side only.
    pub fn is_open(&self) -> bool {
        self.triangles == 1
    }
}

/// All edges of `mesh`, by face.
pub fn mesh_edges(mesh: &ModelMesh) -> Vec<MeshEdge> {
    let (names, spans) = welded(mesh);
    let faces = mesh.faces.iter().enumerate().filter_map(|(face, m)| Some((face, m.as_ref().ok()?)));
    // Names of the ends in order, face, and the ends in that face.
    let mut sides: Vec<([u32; 2], u32, [u32; 2])> = faces
        .flat_map(|(face, m)| {
            let of = &names[spans[face].clone()];
            let side = move |ends: [u32; 2]| {
                let [a, b] = ends.map(|v| of[v as usize]);
                ([a.min(b), a.max(b)], face as u32, ends)
            };
            m.triangles.iter().flat_map(move |[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]].map(side))
        })
        .collect();
    sides.par_sort_unstable();
    let mut edges: Vec<MeshEdge> = sides
        .chunk_by(|a, b| a.0 == b.0)
        .map(|same| {
            let (_, face, ends) = same[0];
            let other = same.iter().map(|s| s.1).find(|other| *other != face);
            MeshEdge { face, ends, other, triangles: same.len() as u32 }
        })
        .collect();
    edges.par_sort_unstable_by_key(|e| (e.face, e.ends));
    edges
}

/// A number for each vertex of each face, the same for the same position; and where those of each face are.
fn welded(mesh: &ModelMesh) -> (Vec<u32>, Vec<Range<usize>>) {
    let mut spans = Vec::with_capacity(mesh.faces.len());
    let mut positions = Vec::new();
    for face in &mesh.faces {
        let first = positions.len();
        // Zero has two signs.
        positions
            .extend(face.iter().flat_map(|m| &m.positions).map(|p| (*p + 0.0).to_array().map(f64::to_bits)));
        spans.push(first..positions.len());
    }
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.par_sort_unstable_by_key(|k| (positions[*k as usize], *k));
    let mut names = vec![0; positions.len()];
    for same in order.chunk_by(|a, b| positions[*a as usize] == positions[*b as usize]) {
        same.iter().for_each(|k| names[*k as usize] = same[0]);
    }
    (names, spans)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::tessellate::{FaceMesh, TessellateError};
    use glam::DVec3;

    #[test]
    fn edges_between_faces_are_one_and_the_rest_is_open() {
        // A tetrahedron of two faces, one with a vertex of negative zeros.
        let p = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let q = [-DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let face = |p: [DVec3; 4], triangles: Vec<[u32; 3]>| {
            Ok(FaceMesh { positions: p.to_vec(), triangles, ..FaceMesh::default() })
        };
        let two = [face(p, vec![[0, 2, 1], [0, 1, 3]]), face(q, vec![[1, 2, 3], [2, 0, 3]])];
        let closed =
            mesh_edges(&ModelMesh::of(vec![two[0].clone(), Err(TessellateError::Empty), two[1].clone()]));
        assert_eq!(closed.len(), 6);
        assert!(closed.iter().all(|e| e.triangles == 2 && !e.is_open()));
        assert_eq!(closed.iter().filter(|e| (e.face, e.other) == (0, Some(2))).count(), 4);
        let open = mesh_edges(&ModelMesh::of(vec![two[0].clone()]));
        assert_eq!((open.len(), open.iter().filter(|e| e.is_open()).count()), (5, 4));
    }
}
