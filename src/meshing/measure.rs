//! The true distance between a mesh and the exact faces, by dense samples.
//!
//! From the mesh: points of every triangle, each against the nearest point of its face's surface, found by Newton's method
//! from the triangle's own parameters. From the face: points of its surface inside the trims against the nearest triangle
//! of its mesh. What is found is a lower bound of the true distance that tends to it with more samples.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::model_mesh::ModelMesh;
use crate::kernel::face::{Face, Side};
use crate::kernel::query::BoundsTree;
use crate::kernel::tessellate::{FaceMesh, Ground};
use crate::kernel::view::Bounds;

/// Distances between a mesh and a model.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Distance {
    /// Largest distance from a point of the mesh to the surface.
    pub mesh_to_surface: f64,
    /// Largest distance from a point of a face to its mesh.
    pub surface_to_mesh: f64,
    /// Samples taken.
    pub samples: usize,
}

impl Distance {
    /// The larger of the two: the Hausdorff distance as far as sampled.
    pub fn largest(&self) -> f64 {
        self.mesh_to_surface.max(self.surface_to_mesh)
    }

    fn join(self, other: Self) -> Self {
        Self {
            mesh_to_surface: self.mesh_to_surface.max(other.mesh_to_surface),
            surface_to_mesh: self.surface_to_mesh.max(other.surface_to_mesh),
            samples: self.samples + other.samples,
        }
    }
}

/// Measures `mesh` against `faces` with about `density` samples along each edge of a triangle, at most
/// `most_per_face` from each side of a face.
pub fn measure(faces: &[Option<&Face>], mesh: &ModelMesh, density: usize, most_per_face: usize) -> Distance {
    faces
        .par_iter()
        .zip(&mesh.faces)
        .filter_map(|(face, mesh)| Some(measure_face((*face)?, mesh.as_ref().ok()?, density, most_per_face)))
        .reduce(Distance::default, Distance::join)
}

/// The same for one face.
pub fn measure_face(face: &Face, mesh: &FaceMesh, density: usize, most: usize) -> Distance {
    let ground = Ground::new(face);
    let mut distance = Distance::default();
    let boxes: Vec<Bounds> =
        mesh.triangles.iter().map(|t| Bounds::of(t.map(|v| mesh.positions[v as usize]))).collect();
    let tree = BoundsTree::new(&boxes);
    let per_triangle = (density + 1) * (density + 2) / 2;
    let skip = (mesh.triangles.len() * per_triangle / most.max(1)).max(1);
    for triangle in mesh.triangles.iter().step_by(skip) {
        let p = triangle.map(|v| mesh.positions[v as usize]);
        let uv = triangle.map(|v| mesh.uvs[v as usize]);
        for i in 0..=density {
            for j in 0..=density - i {
                let l = [i as f64, j as f64, (density - i - j) as f64].map(|x| x / density as f64);
                let at = p[0] * l[0] + p[1] * l[1] + p[2] * l[2];
                let start = uv[0] * l[0] + uv[1] * l[1] + uv[2] * l[2];
                let (foot, off) = project(&ground, at, start);
                distance.mesh_to_surface = distance.mesh_to_surface.max(off);
                distance.samples += 1;
                // The surface's own points near the foot against the mesh.
                if face.classify_native(foot.x, foot.y) == Side::In {
                    let off = to_mesh(mesh, &tree, ground.point(foot), off.max(1e-300) * 1.0001);
                    distance.surface_to_mesh = distance.surface_to_mesh.max(off);
                }
            }
        }
    }
    let side =
        ((most as f64).sqrt() as usize).clamp(4, 40 + 2 * (mesh.triangles.len() as f64).sqrt() as usize);
    for k in 0..side * side {
        let share = DVec2::new((k % side) as f64 + 0.5, (k / side) as f64 + 0.5) / side as f64;
        let uv = face.domain.native(share);
        if face.classify_native(uv.x, uv.y) == Side::In {
            let p = ground.point(uv);
            let off =
                to_mesh(mesh, &tree, p, distance.surface_to_mesh.max(distance.mesh_to_surface).max(1e-9));
            distance.surface_to_mesh = distance.surface_to_mesh.max(off);
            distance.samples += 1;
        }
    }
    distance
}

/// Foot of `p` on the surface, going downhill from `start`; and the distance.
fn project(ground: &Ground, p: DVec3, start: DVec2) -> (DVec2, f64) {
    let mut uv = start;
    let mut best = ground.point(uv).distance(p);
    for _ in 0..10 {
        let at = ground.tangents(uv);
        let off = p - at.point;
        let (a, b, c) = (at.du.dot(at.du), at.du.dot(at.dv), at.dv.dot(at.dv));
        let (x, y) = (off.dot(at.du), off.dot(at.dv));
        let det = a * c - b * b;
        let mut step =
            if det > 1e-14 * a * c { DVec2::new(c * x - b * y, a * y - b * x) / det } else { DVec2::ZERO };
        let mut moved = false;
        for _ in 0..5 {
            let next = uv + step;
            let distance = ground.point(next).distance(p);
            if distance < best {
                moved = best - distance > 1e-9 * best;
                (uv, best) = (next, distance);
                break;
            }
            step *= 0.3;
        }
        if !moved {
            break;
        }
    }
    (uv, best)
}

/// Distance of `p` from the nearest triangle; searched first within `about`.
fn to_mesh(mesh: &FaceMesh, tree: &BoundsTree, p: DVec3, about: f64) -> f64 {
    let mut reach = about.max(1e-12 * tree.bounds().diagonal());
    for _ in 0..64 {
        let mut best = f64::INFINITY;
        tree.within(p, reach, |k| {
            let t = mesh.triangles[k].map(|v| mesh.positions[v as usize]);
            best = best.min(to_triangle(p, t));
        });
        if best <= reach {
            return best;
        }
        reach *= 2.0;
    }
    f64::INFINITY
}

/// Distance of a point from a triangle (Ericson 2005, section 5.1.5).
fn to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let normal = ab.cross(ac);
    let squared = normal.length_squared();
    if squared > 0.0 {
        let v = normal.dot(ap.cross(ac)) / squared;
        let w = normal.dot(ab.cross(ap)) / squared;
        if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
            return normal.dot(ap).abs() / squared.sqrt();
        }
    }
    use crate::kernel::tessellate::line_error::distance_to_segment;
    distance_to_segment(p, a, b).min(distance_to_segment(p, b, c)).min(distance_to_segment(p, c, a))
}
