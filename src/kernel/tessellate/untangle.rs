//! Triangles that look away from the surface are turned, where an edge between two triangles can be swapped.
//!
//! A triangulation in parameters may fold in space where the surface runs very unevenly over its parameters, or where three
//! vertices of a boundary lie nearly on a line. Swapping the edge between such a triangle and its neighbour keeps the
//! vertices and, as the two make a convex figure in parameters, the region covered.

use std::collections::BTreeMap;

use glam::DVec3;

use super::placing::Vertices;

/// Rounds over all triangles at most.
const ROUNDS: usize = 4;
/// Figures of less area than this part of their squared size count as not convex.
const CONVEX: f64 = 1e-9;

/// Swaps edges of `triangles` until no swap makes fewer of them look away. Triangles must stay `within` the tolerance.
pub(super) fn untangle(triangles: &mut [[u32; 3]], vertices: &Vertices, within: impl Fn([u32; 3]) -> bool) {
    let facing = |t: &[u32; 3]| facing(t, vertices);
    let mut away: Vec<usize> = (0..triangles.len()).filter(|k| facing(&triangles[*k]) < 0.0).collect();
    if away.is_empty() {
        return;
    }
    let mut beside: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for (k, t) in triangles.iter().enumerate() {
        beside.extend((0..3).map(|i| ([t[i], t[(i + 1) % 3]], k)));
    }
    for _ in 0..ROUNDS {
        let mut left = Vec::new();
        for k in away {
            let t = triangles[k];
            if facing(&t) >= 0.0 {
                continue;
            }
            let swap = (0..3).find_map(|i| {
                let [a, b, c] = [t[i], t[(i + 1) % 3], t[(i + 2) % 3]];
                let other = *beside.get(&[b, a])?;
                let d = *triangles[other].iter().find(|v| **v != a && **v != b)?;
                let made = [[a, d, c], [d, b, c]];
                let better = made.iter().all(|t| facing(t) >= 0.0 && spans(t, vertices) && within(*t));
                (better && !beside.contains_key(&[c, d]) && !beside.contains_key(&[d, c])).then_some((
                    other,
                    [a, b],
                    made,
                ))
            });
            let Some((other, [a, b], made)) = swap else {
                left.push(k);
                continue;
            };
            beside.remove(&[a, b]);
            beside.remove(&[b, a]);
            for (number, t) in [(k, made[0]), (other, made[1])] {
                triangles[number] = t;
                beside.extend((0..3).map(|i| ([t[i], t[(i + 1) % 3]], number)));
            }
        }
        if left.is_empty() {
            break;
        }
        away = left;
    }
}

/// Above zero for triangles that look along the surface's normal, zero for those without a side.
pub(super) fn facing(t: &[u32; 3], vertices: &Vertices) -> f64 {
    let p = t.map(|v| vertices.positions[v as usize]);
    if p[0] == p[1] || p[1] == p[2] || p[2] == p[0] {
        return 0.0;
    }
    let side: DVec3 = t.iter().map(|v| vertices.normals[*v as usize]).sum();
    (p[1] - p[0]).cross(p[2] - p[0]).dot(side)
}

/// Whether a triangle is counter-clockwise in parameters, with some area.
fn spans(t: &[u32; 3], vertices: &Vertices) -> bool {
    let [a, b, c] = t.map(|v| vertices.uvs[v as usize]);
    let size = (b - a).length_squared().max((c - a).length_squared());
    (b - a).perp_dot(c - a) > CONVEX * size
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn a_folded_pair_is_turned_and_a_flat_one_left() {
        let uvs = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|p| DVec2::new(p.0, p.1));
        // In space vertex 1 lies beyond the diagonal from 0 to 2.
        let place = |p: DVec2, k: usize| if k == 1 { DVec3::new(0.4, 0.6, 0.0) } else { p.extend(0.0) };
        let positions: Vec<DVec3> = uvs.iter().enumerate().map(|(k, p)| place(*p, k)).collect();
        let vertices = Vertices {
            uvs: uvs.to_vec(),
            on_surface: positions.clone(),
            upright: positions.clone(),
            positions,
            normals: vec![DVec3::Z; 4],
            gaps: vec![0.0; 4],
            fixed: 4,
        };
        let mut triangles = [[0, 1, 2], [0, 2, 3]];
        assert!(facing(&triangles[0], &vertices) < 0.0);
        untangle(&mut triangles, &vertices, |_| false);
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
        let mut flat = vertices.clone();
        flat.positions = uvs.iter().map(|p| p.extend(0.0)).collect();
        untangle(&mut triangles, &flat, |_| true);
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    }
}
