//! How far every single triangle is from the exact face: what a heat map shows.
//!
//! The vertices of a mesh lie on the surface, so a figure per vertex would say nothing; each triangle is sampled inside and
//! along its edges, by the same distances as [`mod@super::measure`]. Triangles go in parallel; the result does not depend on
//! how many threads there are.

use rayon::prelude::*;

use super::measure::Target;
use super::model_mesh::{ModelMesh, Work};
use crate::kernel::face::Face;
use crate::kernel::tessellate::{FaceMesh, TessellateError};

/// Samples along an edge of a triangle.
const DENSITY: usize = 6;

/// For each triangle of `mesh` the largest distance of its points from the trimmed `face`, model units, in the order of
/// [`FaceMesh::triangles`]. Distances above `doubt` (the tolerance, say) count only after the whole surface
/// was searched for a nearer point.
///
/// # Errors
/// [`TessellateError::Cancelled`] as soon as `cancelled` says so.
pub fn face_deviations(
    face: &Face,
    mesh: &FaceMesh,
    doubt: f64,
    cancelled: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<f64>, TessellateError> {
    let target = Target::new(face);
    let of = |triangle: &[u32; 3]| {
        if cancelled() {
            return Err(TessellateError::Cancelled);
        }
        let p = triangle.map(|v| mesh.positions[v as usize]);
        let uv = triangle.map(|v| mesh.uvs[v as usize]);
        let mut worst = 0.0f64;
        for i in 0..=DENSITY {
            for j in 0..=DENSITY - i {
                let l = [i, j, DENSITY - i - j].map(|x| x as f64 / DENSITY as f64);
                let at = p[0] * l[0] + p[1] * l[1] + p[2] * l[2];
                let start = uv[0] * l[0] + uv[1] * l[1] + uv[2] * l[2];
                worst = worst.max(target.offer(at, start, worst.max(doubt)).1);
            }
        }
        Ok(worst)
    };
    mesh.triangles.par_iter().with_min_len(64).map(of).collect()
}

/// The same for all faces of a model; `None` for those without a mesh. `work` follows it and may call it off.
///
/// # Errors
/// [`TessellateError::Cancelled`] when called off.
pub fn deviations(
    faces: &[Option<&Face>],
    mesh: &ModelMesh,
    doubt: f64,
    work: &Work,
) -> Result<Vec<Option<Vec<f64>>>, TessellateError> {
    let all = mesh.triangle_count().max(1) as f64;
    let done = std::sync::atomic::AtomicUsize::new(0);
    let result = faces
        .par_iter()
        .zip(&mesh.faces)
        .map(|(face, mesh)| {
            let (Some(face), Ok(mesh)) = (face, mesh) else { return Ok(None) };
            let found = face_deviations(face, mesh, doubt, work.cancelled)?;
            let before = done.fetch_add(found.len(), std::sync::atomic::Ordering::Relaxed);
            (work.progress)((before + found.len()) as f64 / all);
            Ok(Some(found))
        })
        .collect::<Result<_, _>>()?;
    (work.progress)(1.0);
    Ok(result)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::nurbs::{KnotVector, NurbsSurface};
    use crate::kernel::tessellate::{TessellationOptions, tessellate};
    use crate::meshing::mesh_faces;
    use glam::DVec3;

    /// A paraboloid, `z = 4 - x^2 - y^2` over the square from -1 to 1.
    fn bowl() -> Face {
        let knots = || KnotVector::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).expect("knots");
        let square = [1.0, -1.0, 1.0];
        let at = |k: usize| {
            let (i, j) = (k / 3, k % 3);
            DVec3::new(i as f64 - 1.0, j as f64 - 1.0, 4.0 - square[i] - square[j])
        };
        let surface = NurbsSurface::new(knots(), knots(), (0..9).map(at).collect(), vec![1.0; 9]);
        Face::derive(&surface.expect("a surface"), &[]).expect("a face")
    }

    #[test]
    fn a_vertex_that_is_moved_shows_in_its_triangles_alone() {
        let face = bowl();
        let tolerance = 0.05;
        let options = TessellationOptions { balanced: false, ..TessellationOptions::new(tolerance) };
        let mut mesh = tessellate(&face, &options).expect("a mesh");
        let before = face_deviations(&face, &mesh, tolerance, &|| false).expect("not called off");
        let worst = before.iter().copied().fold(0.0, f64::max);
        assert!(worst > 0.3 * tolerance && worst <= tolerance, "{worst}");
        let moved = mesh.positions.len() - 1;
        mesh.positions[moved] += 4.0 * tolerance * mesh.normals[moved];
        let after = face_deviations(&face, &mesh, tolerance, &|| false).expect("not called off");
        for (triangle, (before, after)) in mesh.triangles.iter().zip(before.iter().zip(&after)) {
            if triangle.contains(&(moved as u32)) {
                assert!(*after > 3.5 * tolerance && *after < 4.0 * tolerance + 1e-9, "{after}");
            } else {
                assert_eq!(before, after);
            }
        }
    }

    #[test]
    fn it_can_be_called_off() {
        let face = bowl();
        let options = TessellationOptions::new(1e-2);
        let faces = [Some(&face)];
        let mesh = mesh_faces(&faces, &options, &Work::QUIET).expect("a mesh");
        let work = Work { progress: &|_| (), cancelled: &|| true };
        assert_eq!(deviations(&faces, &mesh, 1e-2, &work), Err(TessellateError::Cancelled));
    }
}
