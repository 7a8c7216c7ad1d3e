//! Which stretches of outlines run along each other, and their common vertices.
//!
//! Ends of runs that lie on another run cut it (T-junctions); ends within reach of each other become one vertex; stretches
//! between the same two vertices whose middles meet are one seam. A seam is divided by its first stretch; the others take
//! its vertices, at their own nearest parameters. So the vertices are a function of the seam, not of a face.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::kernel::query::BoundsTree;
use crate::kernel::tessellate::{EdgeSample, Run, Tessellator};
use crate::kernel::view::Bounds;

/// A run by its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct RunAddress {
    /// Position of the face.
    pub face: usize,
    /// Chain of its outline.
    pub chain: usize,
    /// Run of the chain.
    pub run: usize,
}

/// Part of a run between two vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// The run.
    pub address: RunAddress,
    /// First and last parameter on it.
    pub range: (f64, f64),
    /// Vertices at its ends.
    pub ends: [usize; 2],
    /// Its seam.
    pub seam: usize,
    /// Whether it runs as the seam does.
    pub forward: bool,
}

/// Stretches that share their vertices.
#[derive(Debug, Clone, PartialEq)]
pub struct Seam {
    /// Positions in [`Seams::stretches`]; the first gives the direction.
    pub stretches: Vec<usize>,
}

/// All stretches, seams and vertices of a model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Seams {
    /// In order of address and parameter.
    pub stretches: Vec<Stretch>,
    /// In order of their first stretches.
    pub seams: Vec<Seam>,
    /// Positions of the vertices.
    pub vertices: Vec<DVec3>,
}

/// Runs of all faces that could be prepared.
type Runs<'a> = Vec<(RunAddress, &'a Run)>;

/// Share of the tolerance that chords keep whatever gaps there are.
const LEAST_SHARE: f64 = 0.3;
/// Stretches between the same vertices that each one is compared with at most.
const MOST_BESIDE: usize = 24;
/// Two stretches of which this part of their length is between them are not one, whatever their ends.
const THIN: f64 = 0.05;
/// Stretches of one face make a seam within this part of the reach.
const SAME_FACE: f64 = 0.02;
/// Feet farther off than this part of a step are looked for along the whole run.
const FAR: f64 = 0.05;
/// Stretches shorter than this part of the reach and of their chain are nothing.
const NOTHING: f64 = 0.3;
const NOTHING_OF_CHAIN: f64 = 0.01;
/// Places between the ends at which stretches of a seam are compared.
const GAP_SAMPLES: usize = 7;
/// Ends this part of the reach off a run cut it: less than ends may be from each other, for spikes are thin.
const CUT: f64 = 0.2;
/// Ends closer than this share of a run's own length are not one vertex.
const SHARE: f64 = 0.2;

impl Seams {
    /// Finds the seams of `faces`; ends and middles within `reach` (model units) meet.
    pub fn new(faces: &[Option<Tessellator>], reach: f64) -> Self {
        let runs: Runs = faces
            .iter()
            .enumerate()
            .filter_map(|(face, t)| t.as_ref().map(|t| (face, t)))
            .flat_map(|(face, t)| {
                t.outline().runs().map(move |(chain, run, r)| (RunAddress { face, chain, run }, r))
            })
            .collect();
        let lengths: Vec<f64> = runs.iter().map(|(_, run)| rough_part(run, 0.0, run.range())).collect();
        let mut cuts: Vec<Vec<f64>> = runs.iter().map(|(_, run)| vec![0.0, run.range()]).collect();
        let tolerance = faces.iter().flatten().map(Tessellator::tolerance).fold(0.0, f64::max);
        let widest = reach.max((1.0 - LEAST_SHARE) * tolerance);
        let whole = Self::between(&runs, &cuts, reach, widest);
        // Runs that have found their like from end to end need no cuts, whatever else ends on them.
        let single: Vec<bool> =
            whole.stretches.iter().map(|s| whole.seams[s.seam].stretches.len() == 1).collect();
        if add_cuts(&runs, &single, &lengths, reach, &mut cuts) {
            Self::between(&runs, &cuts, reach, widest)
        } else {
            whole
        }
    }

    /// The seams of `runs` divided at `cuts`.
    fn between(runs: &Runs, cuts: &[Vec<f64>], reach: f64, widest: f64) -> Self {
        let mut stretches = Vec::new();
        let mut places: Vec<DVec3> = Vec::new();
        let mut own: Vec<f64> = Vec::new();
        for ((address, run), cuts) in runs.iter().zip(cuts) {
            for pair in cuts.windows(2) {
                stretches.push(Stretch {
                    address: *address,
                    range: (pair[0], pair[1]),
                    ends: [places.len(), places.len() + 1],
                    seam: usize::MAX,
                    forward: true,
                });
                places.extend([pair[0], pair[1]].map(|s| run.point(s)));
                own.push(rough_part(run, pair[0], pair[1]));
            }
        }
        let is_gap = |a: &RunAddress| {
            let at = runs.binary_search_by(|r| r.0.cmp(a)).unwrap_or(0);
            runs[at].1.source.is_none()
        };
        let (reaches, nothing) = reaches(&stretches, &own, reach, &is_gap);
        let ends: Vec<(DVec3, f64)> = places.into_iter().zip(reaches).collect();
        let (names, vertices) = clusters(&ends, &nothing);
        for stretch in &mut stretches {
            stretch.ends = stretch.ends.map(|e| names[e]);
        }
        let mut result = Self { stretches, seams: Vec::new(), vertices };
        let of = |s: &Stretch| {
            let at = runs.binary_search_by(|r| r.0.cmp(&s.address)).unwrap_or(0);
            runs[at].1
        };
        result.pair(reach, widest, &of);
        result
    }

    /// Puts stretches between the same vertices together where their middles meet.
    fn pair<'a>(&mut self, reach: f64, widest: f64, run: &dyn Fn(&Stretch) -> &'a Run) {
        let mut groups: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for (k, stretch) in self.stretches.iter().enumerate() {
            let [a, b] = stretch.ends;
            groups.entry([a.min(b), a.max(b)]).or_default().push(k);
        }
        let mut firsts: Vec<Vec<usize>> = Vec::new();
        for group in groups.into_values() {
            let mut own = self.side_by_side(&group, reach, run);
            self.pair_last_two(&mut own, widest, run);
            firsts.extend(own);
        }
        firsts.sort_by_key(|s| s[0]);
        for (number, seam) in firsts.into_iter().enumerate() {
            seam.iter().for_each(|k| self.stretches[*k].seam = number);
            self.seams.push(Seam { stretches: seam });
        }
    }

    /// Where two stretches of different faces are left between the same two vertices, and no others, they are one seam as
    /// long as the gap between them leaves chords their share of the tolerance.
    fn pair_last_two<'a>(
        &mut self,
        seams: &mut Vec<Vec<usize>>,
        widest: f64,
        run: &dyn Fn(&Stretch) -> &'a Run,
    ) {
        let [a, b] = match seams.as_slice() {
            [a, b] if a.len() == 1 && b.len() == 1 => [a[0], b[0]],
            _ => return,
        };
        let [x, y] = [self.stretches[a], self.stretches[b]];
        if x.address.face == y.address.face || x.ends[0] == x.ends[1] {
            return;
        }
        let length = [x, y].map(|s| rough_part(run(&s), s.range.0, s.range.1));
        let reach = widest.min(THIN * length[0].min(length[1]));
        if let Some((forward, _)) = beside(run(&x), &x, run(&y), &y, reach) {
            self.stretches[b].forward = forward == self.stretches[a].forward;
            *seams = vec![vec![a, b]];
        }
    }

    /// Parts stretches between the same two vertices into those that run along each other, the nearest first; sets their
    /// directions. Two of the same face are one only if they are as good as one: the sides of a sliver are not.
    fn side_by_side<'a>(
        &mut self,
        group: &[usize],
        reach: f64,
        run: &dyn Fn(&Stretch) -> &'a Run,
    ) -> Vec<Vec<usize>> {
        let mut pairs: Vec<(f64, usize, usize, bool)> = Vec::new();
        for (i, a) in group.iter().enumerate() {
            // Many stretches between two vertices: by the first few.
            for (j, b) in group.iter().enumerate().skip(i + 1).take(MOST_BESIDE) {
                let (a, b) = (self.stretches[*a], self.stretches[*b]);
                let reach = if a.address.face == b.address.face { SAME_FACE * reach } else { reach };
                if let Some((forward, off)) = beside(run(&a), &a, run(&b), &b, reach) {
                    pairs.push((off, i, j, forward));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        // Each stretch's seam, and its direction in it.
        let mut seams: Vec<Vec<(usize, bool)>> = (0..group.len()).map(|i| vec![(i, true)]).collect();
        let mut of: Vec<usize> = (0..group.len()).collect();
        for (off, i, j, forward) in pairs {
            let (a, b) = (of[i].min(of[j]), of[i].max(of[j]));
            let face = |m: &(usize, bool)| self.stretches[group[m.0]].address.face;
            let common = seams[a].iter().any(|m| seams[b].iter().any(|n| face(m) == face(n)));
            if a == b || common && off > SAME_FACE * reach {
                continue;
            }
            let direction = |k: usize| seams[of[k]].contains(&(k, true));
            let same = (direction(i) == direction(j)) == forward;
            for (k, along) in std::mem::take(&mut seams[b]) {
                of[k] = a;
                seams[a].push((k, along == same));
            }
        }
        seams.retain(|seam| !seam.is_empty());
        for seam in &mut seams {
            seam.sort_unstable();
            let first = seam[0].1;
            seam.iter().for_each(|(k, along)| self.stretches[group[*k]].forward = *along == first);
        }
        seams.into_iter().map(|seam| seam.into_iter().map(|m| group[m.0]).collect()).collect()
    }

    /// The vertices of a seam on its first stretch, for `part` of the tolerance; on its curve if they are to be `plain`.
    pub fn divide(
        &self,
        seam: usize,
        faces: &[Option<Tessellator>],
        part: f64,
        plain: bool,
    ) -> Vec<EdgeSample> {
        let stretch = &self.stretches[self.seams[seam].stretches[0]];
        let Some((face, run)) = run_of(faces, &stretch.address) else { return Vec::new() };
        // What gaps use up of the tolerance is not there for chords.
        let rest = (1.0 - self.gap(seam, faces) / face.tolerance()).max(LEAST_SHARE);
        let mut samples = face.divide_part(run, stretch.range, part * rest, plain);
        let last = samples.len() - 1;
        samples[0].point = self.vertices[stretch.ends[0]];
        samples[last].point = self.vertices[stretch.ends[1]];
        samples
    }

    /// How far the ends of a seam's stretches are from their common vertices, and its stretches from each other.
    fn gap(&self, seam: usize, faces: &[Option<Tessellator>]) -> f64 {
        let stretches = &self.seams[seam].stretches;
        let mut gap = 0.0f64;
        for (number, which) in stretches.iter().enumerate() {
            let stretch = &self.stretches[*which];
            let Some((_, run)) = run_of(faces, &stretch.address) else { continue };
            let (from, to) = stretch.range;
            for (s, end) in [(from, stretch.ends[0]), (to, stretch.ends[1])] {
                gap = gap.max(run.point(s).distance(self.vertices[end]));
            }
            let owner = &self.stretches[stretches[0]];
            let Some((_, first)) = run_of(faces, &owner.address).filter(|_| number > 0) else { continue };
            let line = |run: &Run| run.pieces.len() == 1 && run.pieces[0].space.degree() == 1;
            let places = if line(run) && line(first) { 1 } else { GAP_SAMPLES };
            for k in 1..=places {
                let share = k as f64 / (places + 1) as f64;
                let point = first.point(owner.range.0 + (owner.range.1 - owner.range.0) * share);
                let share = if stretch.forward { share } else { 1.0 - share };
                let s = run.project(point, from + (to - from) * share, stretch.range);
                let mut off = run.point(s).distance(point);
                // The two may be run through at other speeds: the guess was too far away, then.
                if off > gap
                    && let Some((nearest, _)) = run.nearest_within(point, off)
                {
                    let s = run.project(point, nearest.clamp(from, to), stretch.range);
                    off = off.min(run.point(s).distance(point));
                }
                gap = gap.max(off);
            }
        }
        gap
    }

    /// The vertices of stretch `number` from those of its seam's first, in its own direction.
    pub fn transfer(
        &self,
        number: usize,
        first: &[EdgeSample],
        faces: &[Option<Tessellator>],
    ) -> Vec<EdgeSample> {
        let stretch = &self.stretches[number];
        let owner = &self.stretches[self.seams[stretch.seam].stretches[0]];
        let Some((_, run)) = run_of(faces, &stretch.address) else { return Vec::new() };
        if self.seams[stretch.seam].stretches[0] == number {
            return first.to_vec();
        }
        let (from, to) = stretch.range;
        let span = owner.range.1 - owner.range.0;
        let count = first.len();
        let mut samples: Vec<EdgeSample> = Vec::with_capacity(count);
        for k in 0..count {
            let source = if stretch.forward { &first[k] } else { &first[count - 1 - k] };
            let share = (source.s - owner.range.0) / span;
            let share = if stretch.forward { share } else { 1.0 - share };
            let s = match k {
                0 => from,
                _ if k + 1 == count => to,
                _ => {
                    let low = samples[k - 1].s;
                    let target = source.point - source.off;
                    let guess = (from + (to - from) * share).max(low);
                    let off = |s: f64| run.point(s).distance(target);
                    let mut s = run.project(target, guess, (low, to));
                    let step = run.point(guess).distance(samples[k - 1].point);
                    if (off(s) > FAR * step || !(s > low && s < to))
                        && let Some((nearest, _)) = run.nearest_within(target, off(s))
                    {
                        let near = run.project(target, nearest.clamp(low, to), (low, to));
                        s = if off(near) < off(s) { near } else { s };
                    }
                    // Vertices keep their order even where the curves do not follow each other.
                    if s > low && s < to { s } else { low + 1e-3 * (to - low) / (count - k) as f64 }
                }
            };
            samples.push(EdgeSample { s, uv: run.uv(s), ..*source });
        }
        samples
    }
}

/// The run at an address, with its face.
pub fn run_of<'f, 'a>(
    faces: &'f [Option<Tessellator<'a>>],
    address: &RunAddress,
) -> Option<(&'f Tessellator<'a>, &'f Run)> {
    let face = faces.get(address.face)?.as_ref()?;
    Some((face, face.outline().chains.get(address.chain)?.get(address.run)?))
}

/// About the length of a run between two parameters: of each piece between its chord and its control polygon
/// (Gravesen 1997), of a part of one its share.
fn rough_part(run: &Run, from: f64, to: f64) -> f64 {
    let (first, last) = (from as usize, (to.ceil() as usize).clamp(1, run.pieces.len()));
    let piece = |k: usize| {
        let curve = &run.pieces[k].space;
        let n = curve.degree() as f64;
        let polygon: f64 = curve.points.windows(2).map(|p| p[0].distance(p[1])).sum();
        let length = (2.0 * curve.start().distance(curve.end()) + (n - 1.0) * polygon) / (n + 1.0);
        length * ((to - k as f64).min(1.0) - (from - k as f64).max(0.0))
    };
    (first..last).map(piece).sum()
}

/// Adds to `cuts` the parameters of `single` runs where ends of others of them lie on them; whether there are any.
fn add_cuts(runs: &Runs, single: &[bool], lengths: &[f64], reach: f64, cuts: &mut [Vec<f64>]) -> bool {
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
    for point in points {
        tree.within(point, CUT * reach, |k| {
            let (k, run) = (open[k], runs[open[k]].1);
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

/// How far each end may be from others that are the same vertex: less than the lengths of both stretches that meet there.
/// And the pairs of ends of stretches that are nothing (poles, rounding, lines that close gaps), whose ends are one vertex.
fn reaches(
    stretches: &[Stretch],
    own: &[f64],
    reach: f64,
    is_gap: &dyn Fn(&RunAddress) -> bool,
) -> (Vec<f64>, Vec<[usize; 2]>) {
    let mut reaches = vec![reach; 2 * stretches.len()];
    let mut nothing = Vec::new();
    let chain = |s: &Stretch| (s.address.face, s.address.chain);
    let mut first = 0;
    for same in stretches.chunk_by(|a, b| chain(a) == chain(b)) {
        let count = same.len();
        let lengths = &own[first..first + count];
        let total: f64 = lengths.iter().sum();
        let least = (NOTHING * reach).min(NOTHING_OF_CHAIN * total);
        let closes = |k: usize| lengths[k] <= reach.min(0.1 * total) && is_gap(&same[k].address);
        let is_nothing: Vec<bool> = (0..count).map(|k| lengths[k] <= least || closes(k)).collect();
        // The next stretch that is something, going by `step`.
        let next = |k: usize, step: usize| {
            let mut others = (1..count).map(|i| (k + i * step) % count);
            others.find(|k| !is_nothing[*k]).map_or(total, |k| lengths[k])
        };
        for (k, length) in lengths.iter().enumerate() {
            let [start, end] = same[k].ends;
            let here = if is_nothing[k] { f64::INFINITY } else { *length };
            reaches[start] = reach.min(SHARE * here.min(next(k, count - 1)));
            reaches[end] = reach.min(SHARE * here.min(next(k, 1)));
            if is_nothing[k] {
                nothing.push([start, end]);
            }
        }
        first += count;
    }
    (reaches, nothing)
}

/// Names the clusters of ends that lie within reach of each other, or are `one`.
fn clusters(ends: &[(DVec3, f64)], one: &[[usize; 2]]) -> (Vec<usize>, Vec<DVec3>) {
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
    let boxes: Vec<Bounds> = ends.iter().map(|(p, _)| Bounds { min: *p, max: *p }).collect();
    let tree = BoundsTree::new(&boxes);
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (k, (p, reach)) in ends.iter().enumerate() {
        tree.within(*p, *reach, |other| {
            let off = ends[other].0.distance(*p);
            if other > k && off <= reach.min(ends[other].1) {
                pairs.push((off, k, other));
            }
        });
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    // The nearest first; the two ends of a stretch (which are neighbours in number) stay apart, unless it is closed.
    let closed = |k: usize| ends[k].0.distance(ends[k ^ 1].0) <= SAME_FACE * ends[k].1;
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for k in 0..ends.len() {
        members.entry(root(&mut parent, k)).or_default().push(k);
    }
    for (_, a, b) in pairs {
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
        parent[b] = a;
        let moved = members.remove(&b).unwrap_or_default();
        members.entry(a).or_default().extend(moved);
    }
    let mut names = vec![usize::MAX; ends.len()];
    let mut vertices = Vec::new();
    for k in 0..ends.len() {
        let r = root(&mut parent, k);
        if names[r] == usize::MAX {
            names[r] = vertices.len();
            vertices.push(ends[r].0);
        }
        names[k] = names[r];
    }
    (names, vertices)
}

/// Whether `b` runs along `a`; then whether in the same direction, and how far off.
fn beside(a: &Run, along: &Stretch, b: &Run, other: &Stretch, reach: f64) -> Option<(bool, f64)> {
    let at = |stretch: &Stretch, share: f64| stretch.range.0 + (stretch.range.1 - stretch.range.0) * share;
    let closed = along.ends[0] == along.ends[1];
    let opposite = !closed && along.ends != other.ends;
    let near = |p: DVec3, guess: f64| {
        let foot = |guess: f64| {
            let s = a.project(p, guess, along.range);
            Some((s, a.point(s).distance(p))).filter(|f| f.1 <= reach)
        };
        // Mostly the two are run through alike.
        let guess = at(along, if opposite { 1.0 - guess } else { guess });
        (!closed).then(|| foot(guess)).flatten().or_else(|| {
            let best = (0..=16)
                .map(|k| at(along, f64::from(k) / 16.0))
                .min_by(|x, y| a.point(*x).distance_squared(p).total_cmp(&a.point(*y).distance_squared(p)))?;
            foot(best)
        })
    };
    let mut off = 0.0f64;
    let mut places = [0.0; 5];
    for (place, share) in places.iter_mut().zip([0.5, 0.3, 0.7, 0.12, 0.88]) {
        let found = near(b.point(at(other, share)), share)?;
        *place = found.0;
        off = off.max(found.1);
    }
    if closed {
        // By the order of places.
        return Some((places[1] < places[2], off));
    }
    if opposite {
        return (along.ends[0] == other.ends[1]).then_some((false, off));
    }
    Some((true, off))
}
