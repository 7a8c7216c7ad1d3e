//! Which way faces look, so that neighbours agree.
//!
//! Files of loose trimmed surfaces do not say on which side of a face the material is. Where two faces share an edge the
//! mesh knows: one must run along it against the other. Faces whose own senses agree keep them; where they do not, the
//! faces that hang together are turned to agree, closed ones so that they look outwards, open ones as most of their
//! area looks.

use super::model_mesh::ModelMesh;

/// Side of a triangle by the bits of its ends, in order, with its face and whether it runs in that order.
type Edge = ([[u64; 3]; 2], usize, bool);

/// For each face whether it is to be turned against `du x dv`, from what its file says.
pub fn orientations(mesh: &ModelMesh, reversed: &[bool]) -> Vec<bool> {
    let count = mesh.faces.len();
    let mut edges: Vec<Edge> = Vec::new();
    for (face, m) in mesh.faces.iter().enumerate().filter_map(|(k, m)| Some((k, m.as_ref().ok()?))) {
        let key = |v: u32| (m.positions[v as usize] + 0.0).to_array().map(f64::to_bits);
        for [a, b, c] in &m.triangles {
            edges.extend([(a, b), (b, c), (c, a)].map(|(a, b)| {
                let (a, b) = (key(*a), key(*b));
                if a < b { ([a, b], face, true) } else { ([b, a], face, false) }
            }));
        }
    }
    edges.sort_unstable();
    let mut open = vec![false; count];
    let mut votes: std::collections::BTreeMap<(usize, usize), i64> = std::collections::BTreeMap::new();
    for same in edges.chunk_by(|a, b| a.0 == b.0) {
        match same {
            [a, b] if a.1 != b.1 => {
                // Along each other both ways: alike. Both the same way: one is to be turned.
                *votes.entry((a.1, b.1)).or_default() += if a.2 != b.2 { 1 } else { -1 };
            }
            [_, _] => {}
            others => others.iter().for_each(|e| open[e.1] = true),
        }
    }
    let mut order: Vec<((usize, usize), i64)> = votes.into_iter().collect();
    order.sort_by_key(|(pair, votes)| (-votes.abs(), *pair));
    let sense = |face: usize| reversed.get(face).copied().unwrap_or(false);
    let mut shells = Shells::new(count);
    for ((a, b), votes) in &order {
        shells.join(*a, *b, *votes < 0, sense(*a) != sense(*b));
    }
    let mut result: Vec<bool> = (0..count).map(sense).collect();
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
    for face in 0..count {
        members[shells.root(face).0].push(face);
    }
    for shell in members.iter().filter(|s| s.len() > 1) {
        if shells.agrees[shells.root(shell[0]).0] {
            continue;
        }
        let turned: Vec<bool> = shell.iter().map(|face| shells.root(*face).1).collect();
        let (mut volume, mut liking) = (0.0, 0.0);
        for (face, turned) in shell.iter().zip(&turned) {
            let Ok(m) = &mesh.faces[*face] else { continue };
            let sign = |wrong: bool| if wrong { -1.0 } else { 1.0 };
            liking += sign(*turned != sense(*face)) * m.area();
            let at = |v: u32| m.positions[v as usize];
            let swept = m.triangles.iter().map(|[a, b, c]| at(*a).dot(at(*b).cross(at(*c)))).sum::<f64>();
            volume += sign(*turned) * swept;
        }
        let closed = shell.iter().all(|face| !open[*face]);
        let invert = if closed { volume < 0.0 } else { liking < 0.0 };
        for (face, turned) in shell.iter().zip(turned) {
            result[*face] = turned != invert;
        }
    }
    result
}

/// Faces that hang together, each turned or not against the first.
struct Shells {
    parent: Vec<usize>,
    against: Vec<bool>,
    /// Whether the senses that faces came with fit together.
    agrees: Vec<bool>,
}

impl Shells {
    fn new(count: usize) -> Self {
        Self { parent: (0..count).collect(), against: vec![false; count], agrees: vec![true; count] }
    }

    /// First face of a shell, and whether `face` is turned against it.
    fn root(&self, mut face: usize) -> (usize, bool) {
        let mut turned = false;
        while self.parent[face] != face {
            turned ^= self.against[face];
            face = self.parent[face];
        }
        (face, turned)
    }

    /// Two faces that touch: `opposite` to each other in the mesh, and `differing` in what their file says.
    fn join(&mut self, a: usize, b: usize, opposite: bool, differing: bool) {
        let ((ra, ta), (rb, tb)) = (self.root(a), self.root(b));
        let agrees = opposite == differing;
        if ra != rb {
            let (low, high) = (ra.min(rb), ra.max(rb));
            self.parent[high] = low;
            self.against[high] = ta ^ tb ^ opposite;
            self.agrees[low] = self.agrees[low] && self.agrees[high] && agrees;
        } else {
            self.agrees[ra] = self.agrees[ra] && agrees;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::tessellate::FaceMesh;
    use glam::DVec3;

    #[test]
    fn faces_of_a_body_are_turned_to_look_outwards() {
        let p = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let face = |t: [usize; 3]| {
            Ok(FaceMesh {
                positions: t.map(|k| p[k]).to_vec(),
                triangles: vec![[0, 1, 2]],
                ..FaceMesh::default()
            })
        };
        let outwards = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        for wrong in 0..16u32 {
            let turned = |k: usize| wrong >> k & 1 == 1;
            let faces = (0..4).map(|k| {
                let [a, b, c] = outwards[k];
                face(if turned(k) { [a, c, b] } else { [a, b, c] })
            });
            let mesh = ModelMesh::of(faces.collect());
            let found = orientations(&mesh, &[false; 4]);
            if wrong == 0 || wrong == 15 {
                // The file's senses fit together: they stay, inwards as well (a void).
                assert_eq!(found, [false; 4]);
            } else {
                assert_eq!(found, [0, 1, 2, 3].map(turned));
            }
        }
    }
}
