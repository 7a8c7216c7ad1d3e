//! Vertices inside a face that the tolerance does not need are taken out again.
//!
//! Refinement puts vertices where triangles are worst at the time; later ones make some of the earlier superfluous. A vertex
//! is drawn onto a neighbour, and stays away when every triangle that changes keeps the tolerance, faces the
//! same way and is no sliver in parameters. Vertices of the boundary stay.

use super::placing::Vertices;
use super::refine::Refinement;
use super::untangle::facing;

/// Rounds over the vertices at most.
const ROUNDS: usize = 3;
/// Neighbours that a vertex is tried on at most, those that make the roundest triangles first.
const CHOICES: usize = 4;
/// Triangles in parameters are at least this high for their longest side.
const THINNEST: f64 = 2e-3;

/// Takes vertices inside out of `triangles` as far as `refinement` allows; asks now and then whether
/// the work is `cancelled`.
pub(super) fn decimate(
    triangles: &mut Vec<[u32; 3]>,
    vertices: &Vertices,
    refinement: &Refinement,
    cancelled: &dyn Fn() -> bool,
) {
    if vertices.fixed == vertices.uvs.len() {
        return;
    }
    let mut around: Vec<Vec<u32>> = (0..vertices.uvs.len()).map(|_| Vec::with_capacity(8)).collect();
    for (k, t) in triangles.iter().enumerate() {
        t.iter().for_each(|v| around[*v as usize].push(k as u32));
    }
    let fixed = vertices.fixed;
    let mut gone = vec![false; triangles.len()];
    let mut waiting: Vec<u32> = (fixed as u32..vertices.uvs.len() as u32).collect();
    for _ in 0..ROUNDS {
        if waiting.is_empty() || cancelled() {
            break;
        }
        let mut again = Vec::new();
        // The last ones in came where little was missing.
        for vertex in waiting.into_iter().rev() {
            let star = around[vertex as usize].clone();
            let Some(onto) = target(vertex, &star, triangles, vertices, refinement) else { continue };
            for k in star {
                let t = &mut triangles[k as usize];
                if t.contains(&onto) {
                    gone[k as usize] = true;
                    for v in *t {
                        around[v as usize].retain(|other| *other != k);
                    }
                } else {
                    t.iter_mut().filter(|v| **v == vertex).for_each(|v| *v = onto);
                    around[onto as usize].push(k);
                }
            }
            around[vertex as usize].clear();
            let beside = around[onto as usize].iter().flat_map(|k| triangles[*k as usize]);
            again.extend(beside.filter(|v| *v as usize >= fixed));
        }
        again.sort_unstable();
        again.dedup();
        again.retain(|v| !around[*v as usize].is_empty());
        waiting = again;
    }
    let mut k = 0;
    triangles.retain(|_| {
        k += 1;
        !gone[k - 1]
    });
}

/// The neighbour that a vertex can be drawn onto.
fn target(
    vertex: u32,
    star: &[u32],
    triangles: &[[u32; 3]],
    vertices: &Vertices,
    refinement: &Refinement,
) -> Option<u32> {
    // The ring round it, once round.
    let next = |from: u32| {
        star.iter().find_map(|k| {
            let t = triangles[*k as usize];
            (0..3).find(|i| t[*i] == vertex && t[(i + 1) % 3] == from).map(|i| t[(i + 2) % 3])
        })
    };
    let first = triangles[*star.first()? as usize].into_iter().find(|v| *v != vertex)?;
    let mut ring = vec![first];
    while ring.len() <= star.len() {
        match next(ring[ring.len() - 1])? {
            v if v == first => break,
            v => ring.push(v),
        }
    }
    if ring.len() != star.len() || ring.len() < 3 {
        return None;
    }
    let count = ring.len();
    let made = |onto: usize| (1..count - 1).map(move |i| [onto, (onto + i) % count, (onto + i + 1) % count]);
    let height = |t: [usize; 3]| {
        let [a, b, c] = t.map(|i| refinement.places.of(vertices.uvs[ring[i] as usize]));
        let area = (b - a).perp_dot(c - a);
        area / (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared())
    };
    let mut choices: Vec<(f64, usize)> = (0..count)
        .map(|onto| (made(onto).map(height).fold(f64::INFINITY, f64::min), onto))
        .filter(|(least, _)| *least > THINNEST)
        .collect();
    choices.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (uv, p) = (vertices.uvs[vertex as usize], vertices.on_surface[vertex as usize]);
    let covers = |t: &[u32; 3]| {
        let corners = t.map(|v| vertices.uvs[v as usize]);
        let sides = [0, 1, 2].map(|k| (corners[(k + 1) % 3] - corners[k]).perp_dot(uv - corners[k]));
        sides.iter().all(|x| *x >= 0.0) || sides.iter().all(|x| *x <= 0.0)
    };
    let fits = |onto: usize| {
        let named = made(onto).map(|t| t.map(|i| ring[i]));
        // The vertex itself is mostly farthest off, and that is known already.
        named.clone().all(|t| !covers(&t) || refinement.reaches(vertices, &t, p))
            && named.clone().all(|t| facing(&t, vertices) > 0.0)
            && refinement.hold(vertices, named)
    };
    choices.into_iter().take(CHOICES).find(|(_, onto)| fits(*onto)).map(|(_, onto)| ring[onto])
}
