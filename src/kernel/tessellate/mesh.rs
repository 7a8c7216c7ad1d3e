//! The mesh of one face.

use glam::{DVec2, DVec3};

/// Triangles of a face with what downstream programs ask for per vertex.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FaceMesh {
    /// Positions, model units; off the surface within the tolerance if options let them be. Vertices of the boundary come first, in the order of [`FaceMesh::loops`].
    pub positions: Vec<DVec3>,
    /// Unit normals of the surface along `du x dv`.
    pub normals: Vec<DVec3>,
    /// Native parameters.
    pub uvs: Vec<DVec2>,
    /// Vertices of each triangle, counter-clockwise as seen against `du x dv`.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices along the boundary, loop after loop, each closed.
    pub loops: Vec<Vec<u32>>,
    /// What the tessellation can say of its error.
    pub quality: Quality,
}

/// What is known of the error of a mesh.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Quality {
    /// Largest bound (conservative) or estimate of the distance between a triangle and the surface.
    pub error: f64,
    /// Triangles that could not be brought within the tolerance, those with a boundary chord that is longer than the
    /// surface allows, say.
    pub over_tolerance: usize,
    /// Largest distance between a shared boundary vertex and this face: gaps of the model.
    pub gap: f64,
    /// Places where boundary chords cross.
    pub crossings: usize,
    /// Points evaluated on the surface.
    pub evaluations: usize,
}

impl FaceMesh {
    /// Sum of the triangles' areas.
    pub fn area(&self) -> f64 {
        let at = |i: u32| self.positions[i as usize];
        self.triangles.iter().map(|[a, b, c]| 0.5 * (at(*b) - at(*a)).cross(at(*c) - at(*a)).length()).sum()
    }
}
