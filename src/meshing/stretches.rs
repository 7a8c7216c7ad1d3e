//! Runs cut into stretches, and which of their ends are one vertex.
//!
//! Ends of runs that lie on another run cut it (T-junctions); ends within reach of each other become one vertex, the
//! nearest first. Every run has a reach of its own, so that a border without a neighbour may look farther than others.
//! Invariant: the two ends of a stretch stay apart unless it is nothing (a pole, rounding, a line that closes a gap) or
//! closed.

use std::collections::BTreeMap;

use glam::DVec3;

use super::seams::{RunAddress, Stretch};
use crate::kernel::query::BoundsTree;
use crate::kernel::tessellate::Run;
use crate::kernel::view::Bounds;

/// Runs of all faces that could be prepared, by address.
pub(super) type Runs<'a> = Vec<(RunAddress, &'a Run)>;

/// How near things must be to be one, model units.
#[derive(Debug, Clone)]
pub(super) struct Reaches {
    /// For what is short enough to be nothing.
    pub(super) base: f64,
    /// For two stretches that are left between the same two vertices.
    pub(super) last_two: f64,
    /// Of each run.
    pub(super) of: Vec<f64>,
}

/// Stretches of the same part of a face make a seam within this part of the reach.
pub(super) const SAME_FACE: f64 = 0.02;
/// Stretches shorter than this part of the reach and of their chain are nothing.
pub(super) const NOTHING: f64 = 0.3;
const NOTHING_OF_CHAIN: f64 = 0.01;
/// Ends this part of the reach off a run cut it: less than ends may be from each other, for spikes are thin.
const CUT: f64 = 0.2;
/// Ends farther apart than this part of the reach meet in their middle.
pub(super) const APART: f64 = 0.02;
/// Ends closer than this share of a run's own length are not one vertex.
const SHARE: f64 = 0.2;

/// Runs cut up.
pub(super) struct Cut {
    /// By address and parameter, with the vertices at their ends.
    pub(super) stretches: Vec<Stretch>,
    /// The run of each stretch.
    pub(super) runs: Vec<usize>,
    /// About the length of each stretch.
    pub(super) lengths: Vec<f64>,
    /// Where the vertices are.
    pub(super) vertices: Vec<DVec3>,
}

/// Cuts `runs` at `cuts` and finds the vertices.
pub(super) fn cut(runs: &Runs, cuts: &[Vec<f64>], reaches: &Reaches) -> Cut {
    let (mut stretches, mut of, mut places, mut own) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (k, ((address, run), cuts)) in runs.iter().zip(cuts).enumerate() {
        for pair in cuts.windows(2) {
            stretches.push(Stretch {
                address: *address,
                range: (pair[0], pair[1]),
                ends: [places.len(), places.len() + 1],
                seam: usize::MAX,
                forward: true,
            });
            of.push(k);
            places.extend([pair[0], pair[1]].map(|s| run.point(s)));
            own.push(rough_part(run, pair[0], pair[1]));
        }
    }
    let closes_gap = |k: usize| runs[of[k]].1.source.is_none();
    let reach = |k: usize| reaches.of[of[k]];
    let is_nothing = nothing(&stretches, &places, &own, &|k| reaches.base.min(reach(k)), &closes_gap);
    let far = end_reaches(&stretches, &own, &is_nothing, &reach);
    let one: Vec<[usize; 2]> =
        (0..stretches.len()).filter(|k| is_nothing[*k]).map(|k| stretches[k].ends).collect();
    let ends: Vec<(DVec3, f64)> = places.into_iter().zip(far).collect();
    let (names, vertices) = clusters(&ends, &one, reaches.base);
    for stretch in &mut stretches {
        stretch.ends = stretch.ends.map(|e| names[e]);
    }
    Cut { stretches, runs: of, lengths: own, vertices }
}

/// About the length of a run between two parameters: of each piece between its chord and its control polygon
/// (Gravesen 1997), of a part of one its share. Where these are far from each other, as for a whole circle in one piece,
/// of chords along it.
pub(super) fn rough_part(run: &Run, from: f64, to: f64) -> f64 {
    /// Chords of a piece that is far from its control polygon.
    const CHORDS: usize = 16;
    const NEAR: f64 = 0.7;
    let (first, last) = (from as usize, (to.ceil() as usize).clamp(1, run.pieces.len()));
    let piece = |k: usize| {
        let curve = &run.pieces[k].space;
        let n = curve.degree() as f64;
        let polygon: f64 = curve.points.windows(2).map(|p| p[0].distance(p[1])).sum();
        let chord = curve.start().distance(curve.end());
        let (low, high) = ((from - k as f64).max(0.0), (to - k as f64).min(1.0));
        if chord < NEAR * polygon && n > 1.0 {
            let at = |i: usize| run.point(k as f64 + low + (high - low) * i as f64 / CHORDS as f64);
            return (0..CHORDS).map(|i| at(i).distance(at(i + 1))).sum();
        }
        (2.0 * chord + (n - 1.0) * polygon) / (n + 1.0) * (high - low)
    };
    (first..last).map(piece).sum()
}

/// Adds to `cuts` the parameters of `single` runs where ends of others of them lie on them; whether there are any.
pub(super) fn add_cuts(
    runs: &Runs,
    single: &[bool],
    lengths: &[f64],
    reaches: &[f64],
    cuts: &mut [Vec<f64>],
) -> bool {
    let open: Vec<usize> = (0..runs.len()).filter(|k| single[*k]).collect();
    let boxes: Vec<Bounds> = open
        .iter()
        .map(|k| Bounds::of(runs[*k].1.pieces.iter().flat_map(|p| p.space.points.iter().copied())))
        .collect();
    let tree = BoundsTree::new(&boxes);
    let of_face = |face: usize| {
        let first = runs.partition_point(|r| r.0.face < face);
        runs[first..].iter().take_while(move |r| r.0.face == face)
    };
    let mut points: Vec<DVec3> = open.iter().flat_map(|k| runs[*k].1.ends()).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z)));
    points.dedup();
    let mut found = false;
    let widest = open.iter().map(|k| reaches[*k]).fold(0.0, f64::max);
    for point in points {
        tree.within(point, CUT * widest, |k| {
            let (k, run) = (open[k], runs[open[k]].1);
            let reach = reaches[k];
            let near = (CUT * reach).min(SHARE * lengths[k]);
            let away = |s: f64| run.point(s).distance(point) > 2.0 * near;
            if away(0.0) && away(run.range()) {
                let Some((s, off)) = run.nearest_within(point, near) else { return };
                // Where the face has a vertex of its own it is that which meets the point: this is the other side of a
                // sliver or spike.
                let own = || {
                    of_face(runs[k].0.face).any(|(_, r)| r.ends().iter().any(|e| e.distance(point) <= near))
                };
                if cuts[k].iter().all(|c| away(*c)) && (off <= SAME_FACE * reach || !own()) {
                    cuts[k].push(s);
                    found = true;
                }
            }
        });
    }
    cuts.iter_mut().for_each(|c| c.sort_by(f64::total_cmp));
    found
}

/// Which stretches are nothing: poles, rounding, lines that close gaps. What is an edge of a neighbour is not.
fn nothing(
    stretches: &[Stretch],
    places: &[DVec3],
    own: &[f64],
    reach: &dyn Fn(usize) -> f64,
    closes_gap: &dyn Fn(usize) -> bool,
) -> Vec<bool> {
    let chain = |s: &Stretch| (s.address.face, s.address.chain);
    let mut is_nothing = Vec::with_capacity(stretches.len());
    for same in stretches.chunk_by(|a, b| chain(a) == chain(b)) {
        let first = is_nothing.len();
        let lengths = &own[first..first + same.len()];
        let total: f64 = lengths.iter().sum();
        let least = |k: usize| (NOTHING * reach(first + k)).min(NOTHING_OF_CHAIN * total);
        let closes = |k: usize| lengths[k] <= reach(first + k).min(0.1 * total) && closes_gap(first + k);
        is_nothing.extend((0..same.len()).map(|k| lengths[k] <= least(k) || closes(k)));
    }
    if !is_nothing.contains(&true) {
        return is_nothing;
    }
    let boxes: Vec<Bounds> = places.iter().map(|p| Bounds { min: *p, max: *p }).collect();
    let tree = BoundsTree::new(&boxes);
    let kept = |k: usize| {
        let [start, end] = stretches[k].ends.map(|e| places[e]);
        let near = SHARE * own[k].min(start.distance(end));
        let mut kept = false;
        tree.within(start, near, |e| {
            // The other end of the stretch that ends here; the rest of a loop ends here as well, but is longer.
            let (here, other) = (places[e], places[e ^ 1]);
            let alike = here.distance(start) <= near && other.distance(end) <= near;
            kept |= alike && !is_nothing[e / 2] && own[e / 2] <= 2.0 * own[k];
        });
        kept
    };
    (0..stretches.len()).map(|k| is_nothing[k] && !kept(k)).collect()
}

/// How far each end may be from others that are the same vertex: less than the lengths of both stretches that meet there.
fn end_reaches(
    stretches: &[Stretch],
    own: &[f64],
    is_nothing: &[bool],
    reach: &dyn Fn(usize) -> f64,
) -> Vec<f64> {
    let mut reaches = vec![0.0; 2 * stretches.len()];
    let chain = |s: &Stretch| (s.address.face, s.address.chain);
    let mut first = 0;
    for same in stretches.chunk_by(|a, b| chain(a) == chain(b)) {
        let count = same.len();
        let lengths = &own[first..first + count];
        let is_nothing = &is_nothing[first..first + count];
        let total: f64 = lengths.iter().sum();
        // The next stretch that is something, going by `step`.
        let next = |k: usize, step: usize| {
            let mut others = (1..count).map(|i| (k + i * step) % count);
            others.find(|k| !is_nothing[*k]).map_or(total, |k| lengths[k])
        };
        for (k, length) in lengths.iter().enumerate() {
            let [start, end] = same[k].ends;
            let here = if is_nothing[k] { f64::INFINITY } else { *length };
            reaches[start] = reach(first + k).min(SHARE * here.min(next(k, count - 1)));
            reaches[end] = reach(first + k).min(SHARE * here.min(next(k, 1)));
        }
        first += count;
    }
    reaches
}

/// Names the clusters of ends that lie within reach of each other, or are `one`; and where each is: in the middle, or at its
/// first end where all are as good as there (part of `reach`), so that what is exact stays exact.
fn clusters(ends: &[(DVec3, f64)], one: &[[usize; 2]], reach: f64) -> (Vec<usize>, Vec<DVec3>) {
    let mut parent: Vec<usize> = (0..ends.len()).collect();
    fn root(parent: &mut [usize], mut k: usize) -> usize {
        while parent[k] != k {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        k
    }
    for [a, b] in one {
        let (a, b) = (root(&mut parent, *a), root(&mut parent, *b));
        parent[a.max(b)] = a.min(b);
    }
    // Ends in the same place are one; the first stands for them, with the farthest reach.
    let mut order: Vec<usize> = (0..ends.len()).collect();
    let place = |k: usize| (ends[k].0 + 0.0).to_array().map(f64::to_bits);
    order.sort_unstable_by_key(|k| (place(*k), *k));
    let mut firsts: Vec<(usize, f64)> = Vec::new();
    for same in order.chunk_by(|a, b| place(*a) == place(*b)) {
        for k in &same[1..] {
            let (a, b) = (root(&mut parent, same[0]), root(&mut parent, *k));
            parent[a.max(b)] = a.min(b);
        }
        firsts.push((same[0], same.iter().map(|k| ends[*k].1).fold(0.0, f64::max)));
    }
    let boxes: Vec<Bounds> = firsts.iter().map(|(k, _)| Bounds::of([ends[*k].0])).collect();
    let tree = BoundsTree::new(&boxes);
    let mut pairs: Vec<(f64, usize, usize, f64)> = Vec::new();
    for (first, (k, reach)) in firsts.iter().enumerate() {
        tree.within(ends[*k].0, *reach, |other| {
            let (l, far) = firsts[other];
            let (off, reach) = (ends[l].0.distance(ends[*k].0), reach.min(far));
            if other > first && off <= reach {
                pairs.push((off, *k, l, reach));
            }
        });
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    // The nearest first; the two ends of a stretch (which are neighbours in number) stay apart, unless it is closed.
    let closed = |k: usize| ends[k].0.distance(ends[k ^ 1].0) <= SAME_FACE * ends[k].1;
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    // What is around each cluster, and the size of it from the beginning.
    let mut around = vec![Bounds::EMPTY; ends.len()];
    for k in 0..ends.len() {
        let r = root(&mut parent, k);
        members.entry(r).or_default().push(k);
        around[r] = around[r].union(Bounds::of([ends[k].0]));
    }
    let own = |b: &Bounds| if b.is_empty() { 0.0 } else { b.diagonal() };
    let mut first: Vec<f64> = around.iter().map(own).collect();
    for (_, a, b, reach) in pairs {
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        let (a, b) = (a.min(b), a.max(b));
        if a == b {
            continue;
        }
        let [of_a, of_b] = [a, b].map(|k| members.get(&k).map_or(&[][..], Vec::as_slice));
        let (few, other) = if of_a.len() < of_b.len() { (of_a, b) } else { (of_b, a) };
        if few.iter().any(|k| !closed(*k) && root(&mut parent, k ^ 1) == other) {
            continue;
        }
        // Reaching from one to the next must not lead away: sheets of a pile are not one.
        let both = around[a].union(around[b]);
        if both.diagonal() > 2.0 * reach + first[a] + first[b] {
            continue;
        }
        (around[a], first[a]) = (both, first[a].max(first[b]));
        parent[b] = a;
        let moved = members.remove(&b).unwrap_or_default();
        members.entry(a).or_default().extend(moved);
    }
    let mut names = vec![usize::MAX; ends.len()];
    let mut vertices = Vec::new();
    for (r, members) in members {
        members.iter().for_each(|k| names[*k] = vertices.len());
        let around = members.iter().fold(Bounds::EMPTY, |b, k| b.union(Bounds::of([ends[*k].0])));
        vertices.push(if around.diagonal() > APART * reach { around.centre() } else { ends[r].0 });
    }
    (names, vertices)
}
