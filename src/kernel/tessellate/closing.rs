//! Slivers that are missing between the triangles of a face and its chords.
//!
//! Where two curves of the boundary touch, their chords may cross by rounding however short they are, or one passes through a
//! vertex of the other. Even-odd leaves the sliver between them out, and neighbours that have those chords would stay open
//! there. The chords less the border of the triangles are closed ways round such slivers; they are filled.
//!
//! Invariant: nothing is added unless afterwards the border of the triangles is the chords, each in the direction of its loop.

use std::collections::BTreeMap;

use glam::DVec3;

/// Slivers with more corners than this are no slivers.
const MOST_CORNERS: usize = 6;

/// Adds what is missing to `triangles` within `loops` of vertices, all at places `at`; only what is thinner than `thin`.
pub(super) fn close(triangles: &mut Vec<[u32; 3]>, loops: &[Vec<u32>], at: impl Fn(u32) -> DVec3, thin: f64) {
    let mut names: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut name = |v: u32| *names.entry((at(v) + 0.0).to_array().map(f64::to_bits)).or_insert(v);
    // How much more often each edge is run through from its lesser to its greater vertex than back.
    let mut border: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    let add = |ways: &mut BTreeMap<[u32; 2], i32>, [a, b]: [u32; 2], times: i32| {
        if a != b {
            *ways.entry([a.min(b), a.max(b)]).or_default() += if a < b { times } else { -times };
        }
    };
    for t in triangles.iter() {
        let t = t.map(&mut name);
        (0..3).for_each(|k| add(&mut border, [t[k], t[(k + 1) % 3]], 1));
    }
    let mut missing: BTreeMap<[u32; 2], i32> = border.iter().map(|(edge, times)| (*edge, -times)).collect();
    for ring in loops {
        let ring: Vec<u32> = ring.iter().map(|v| name(*v)).collect();
        let ways = || (0..ring.len()).map(|k| [ring[k], ring[(k + 1) % ring.len()]]);
        // Loops may run either way round: with the triangles, mostly.
        let with = |[a, b]: [u32; 2]| {
            let times = border.get(&[a.min(b), a.max(b)]).copied().unwrap_or(0);
            if a < b { times } else { -times }
        };
        let sense = if ways().map(with).sum::<i32>() < 0 { -1 } else { 1 };
        ways().for_each(|way| add(&mut missing, way, sense));
    }
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for ([a, b], times) in missing {
        match times {
            0 => {}
            1 => next.entry(a).or_default().push(b),
            -1 => next.entry(b).or_default().push(a),
            _ => return,
        }
    }
    let mut made = Vec::new();
    while let Some(first) = next.keys().next().copied() {
        let mut way = vec![first];
        loop {
            let here = way[way.len() - 1];
            let Some(to) = next.get_mut(&here).and_then(Vec::pop) else { return };
            if next[&here].is_empty() {
                next.remove(&here);
            }
            if to == first {
                break;
            }
            way.push(to);
            if way.len() > MOST_CORNERS {
                return;
            }
        }
        for k in 1..way.len() - 1 {
            let t = [way[0], way[k], way[k + 1]];
            let [a, b, c] = t.map(&at);
            let longest = (b - a).length().max((c - b).length()).max((a - c).length());
            let area = (b - a).cross(c - a).length();
            // What has no width at all is no hole either.
            if !(area > 0.0 && area <= thin * longest) {
                return;
            }
            made.push(t);
        }
    }
    triangles.extend(made);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sliver_between_chords_that_cross_by_rounding_is_filled() {
        // A square whose lower side has a vertex (4) that rounding has put above the way from 0 to 5, which is left out.
        let places = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (1.0, 1e-9), (2.0, 0.0)];
        let at = |v: u32| DVec3::new(places[v as usize].0, places[v as usize].1, 0.0);
        let whole = vec![[0, 4, 3], [4, 5, 3], [5, 1, 2], [5, 2, 3]];
        for turned in [false, true] {
            let mut ring = vec![0, 5, 1, 2, 3];
            if turned {
                ring.reverse();
            }
            let mut triangles = whole.clone();
            close(&mut triangles, &[ring.clone()], at, 1e-3);
            assert_eq!(triangles.len(), 5);
            let mut sliver = triangles[4];
            let first = (0..3).min_by_key(|k| sliver[*k]).expect("three corners");
            sliver.rotate_left(first);
            assert_eq!(sliver, [0, 5, 4]);
            // Closed already, or missing more than a sliver.
            let again = triangles.clone();
            close(&mut triangles, &[ring.clone()], at, 1e-3);
            assert_eq!(triangles, again);
            let mut wide = whole[..3].to_vec();
            close(&mut wide, &[ring], at, 1e-3);
            assert_eq!(wide, whole[..3]);
        }
    }
}
