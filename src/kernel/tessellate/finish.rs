//! The mesh of a face from its vertices and triangles, without what degenerate surfaces leave in them.

use glam::DVec3;

use super::mesh::{FaceMesh, Quality};
use super::placing::Vertices;

/// Edges of triangles that look away from the surface: where one of them is a chord it is too long.
pub(super) fn folded(vertices: &Vertices, triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut edges = Vec::new();
    for t in triangles {
        let p = t.map(|v| vertices.positions[v as usize]);
        let side: DVec3 = t.iter().map(|v| vertices.normals[*v as usize]).sum();
        let solid = p[0] != p[1] && p[1] != p[2] && p[2] != p[0];
        if solid && (p[1] - p[0]).cross(p[2] - p[0]).dot(side) < 0.0 {
            edges.extend((0..3).map(|k| [t[k], t[(k + 1) % 3]]));
        }
    }
    edges
}

/// Leaves out vertices without triangles and triangles without area, and names what is left anew.
pub(super) fn finish(
    vertices: Vertices,
    triangles: Vec<[u32; 3]>,
    loops: Vec<Vec<u32>>,
    quality: Quality,
) -> FaceMesh {
    let at = |i: u32| vertices.positions[i as usize];
    let solid = |t: &[u32; 3]| {
        let [a, b, c] = t.map(at);
        a != b && b != c && c != a
    };
    let all = triangles.len();
    let mut triangles: Vec<[u32; 3]> = triangles.into_iter().filter(solid).collect();
    if triangles.len() < all {
        take_flaps_out(&mut triangles, at);
    }
    triangles.sort_unstable();
    let mut used = vec![false; vertices.uvs.len()];
    triangles.iter().flatten().for_each(|v| used[*v as usize] = true);
    let mut name = vec![u32::MAX; used.len()];
    let mut mesh = FaceMesh { quality, ..FaceMesh::default() };
    for (k, _) in used.iter().enumerate().filter(|u| *u.1) {
        name[k] = mesh.positions.len() as u32;
        mesh.positions.push(vertices.positions[k]);
        mesh.normals.push(vertices.normals[k]);
        mesh.uvs.push(vertices.uvs[k]);
    }
    mesh.triangles = triangles.into_iter().map(|t| t.map(|v| name[v as usize])).collect();
    let kept =
        |ring: Vec<u32>| ring.into_iter().map(|v| name[v as usize]).filter(|v| *v != u32::MAX).collect();
    mesh.loops = loops.into_iter().map(kept).collect();
    mesh
}

/// Takes out pairs of triangles that are each other's back. Where all of a pole is one vertex, what is left of the triangles
/// round a vertex beside it may be such a pair: a flap, on an edge that others have already.
fn take_flaps_out(triangles: &mut Vec<[u32; 3]>, at: impl Fn(u32) -> DVec3) {
    // The corners in an order of their own, and whether that is the other way round.
    let named = |t: &[u32; 3]| {
        let mut key = t.map(|v| (at(v) + 0.0).to_array().map(f64::to_bits));
        let first = (0..3).min_by_key(|k| key[*k]).unwrap_or(0);
        key.rotate_left(first);
        let turned = key[1] > key[2];
        if turned {
            key.swap(1, 2);
        }
        (key, turned)
    };
    let mut sides: Vec<_> = triangles.iter().enumerate().map(|(k, t)| (named(t), k)).collect();
    sides.sort_unstable();
    let mut gone = vec![false; triangles.len()];
    for pair in sides.chunk_by(|a, b| a.0.0 == b.0.0).filter(|same| same.len() == 2 && same[0].0 != same[1].0)
    {
        pair.iter().for_each(|(_, k)| gone[*k] = true);
    }
    let mut k = 0;
    triangles.retain(|_| {
        k += 1;
        !gone[k - 1]
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flap_on_a_pole_that_is_one_vertex_is_taken_out() {
        // 0 and 1 are the pole, 2 to 4 stand round it, 5 between the two of the pole and 3.
        let pole = DVec3::ZERO;
        let places = [pole, pole, DVec3::X, DVec3::new(0.7, 0.7, 0.0), DVec3::Y, DVec3::new(0.3, 0.3, 0.0)];
        let mut triangles = vec![[0, 2, 3], [0, 3, 5], [1, 5, 3], [1, 3, 4]];
        take_flaps_out(&mut triangles, |v| places[v as usize]);
        assert_eq!(triangles, [[0, 2, 3], [1, 3, 4]]);
    }
}
