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

/// Samples of a run for its box.
const BOX_SAMPLES: usize = 8;
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
        let lengths: Vec<f64> = runs.iter().map(|(_, run)| rough_length(run)).collect();
        let cuts = cuts(&runs, &lengths, reach);
        let mut stretches = Vec::new();
        let mut ends: Vec<(DVec3, f64)> = Vec::new();
        for ((address, run), cuts) in runs.iter().zip(&cuts) {
            for pair in cuts.windows(2) {
                let own = SHARE * rough_part(run, pair[0], pair[1]);
                stretches.push(Stretch {
                    address: *address,
                    range: (pair[0], pair[1]),
                    ends: [ends.len(), ends.len() + 1],
                    seam: usize::MAX,
                    forward: true,
                });
                ends.extend([pair[0], pair[1]].map(|s| (run.point(s), own.min(reach))));
            }
        }
        let (names, vertices) = clusters(&ends);
        for stretch in &mut stretches {
            stretch.ends = stretch.ends.map(|e| names[e]);
        }
        let mut result = Self { stretches, seams: Vec::new(), vertices };
        let of = |s: &Stretch| {
            let at = runs.binary_search_by(|r| r.0.cmp(&s.address)).unwrap_or(0);
            runs[at].1
        };
        result.pair(reach, &of);
        result
    }

    /// Puts stretches between the same vertices together where their middles meet.
    fn pair<'a>(&mut self, reach: f64, run: &dyn Fn(&Stretch) -> &'a Run) {
        let mut groups: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for (k, stretch) in self.stretches.iter().enumerate() {
            let [a, b] = stretch.ends;
            groups.entry([a.min(b), a.max(b)]).or_default().push(k);
        }
        let mut firsts: Vec<Vec<usize>> = Vec::new();
        for group in groups.into_values() {
            let mut own: Vec<Vec<usize>> = Vec::new();
            for k in group {
                let stretch = self.stretches[k];
                let found = own.iter_mut().find_map(|seam| {
                    let first = self.stretches[seam[0]];
                    beside(run(&first), &first, run(&stretch), &stretch, reach).map(|forward| (seam, forward))
                });
                match found {
                    Some((seam, forward)) => {
                        seam.push(k);
                        self.stretches[k].forward = forward;
                    }
                    None => own.push(vec![k]),
                }
            }
            firsts.extend(own);
        }
        firsts.sort_by_key(|s| s[0]);
        for (number, seam) in firsts.into_iter().enumerate() {
            seam.iter().for_each(|k| self.stretches[*k].seam = number);
            self.seams.push(Seam { stretches: seam });
        }
    }

    /// The vertices of a seam on its first stretch, for `part` of the tolerance.
    pub fn divide(&self, seam: usize, faces: &[Option<Tessellator>], part: f64) -> Vec<EdgeSample> {
        let stretch = &self.stretches[self.seams[seam].stretches[0]];
        let Some((face, run)) = run_of(faces, &stretch.address) else { return Vec::new() };
        let mut samples = face.divide_part(run, stretch.range, part);
        let last = samples.len() - 1;
        samples[0].point = self.vertices[stretch.ends[0]];
        samples[last].point = self.vertices[stretch.ends[1]];
        samples
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
                    let guess = (from + (to - from) * share).max(low);
                    let mut s = run.project(source.point, guess, (low, to));
                    if run.point(s).distance(source.point) > run.point(guess).distance(samples[k - 1].point) {
                        s = run.nearest(source.point).0;
                    }
                    // Vertices keep their order even where the curves do not follow each other.
                    if s > low && s < to { s } else { low + (to - low) / (count - k) as f64 }
                }
            };
            samples.push(EdgeSample { s, uv: run.uv(s), point: source.point });
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

fn rough_part(run: &Run, from: f64, to: f64) -> f64 {
    let count = BOX_SAMPLES * run.pieces.len();
    let at = |k: usize| run.point(from + (to - from) * k as f64 / count as f64);
    (0..count).map(|k| at(k).distance(at(k + 1))).sum()
}

fn rough_length(run: &Run) -> f64 {
    rough_part(run, 0.0, run.range())
}

/// Parameters of each run at its ends and where ends of others lie on it.
fn cuts(runs: &Runs, lengths: &[f64], reach: f64) -> Vec<Vec<f64>> {
    let boxes: Vec<Bounds> = runs
        .iter()
        .map(|(_, run)| Bounds::of(run.pieces.iter().flat_map(|p| p.space.points.iter().copied())))
        .collect();
    let tree = BoundsTree::new(&boxes);
    let mut cuts: Vec<Vec<f64>> = runs.iter().map(|(_, run)| vec![0.0, run.range()]).collect();
    let mut points: Vec<DVec3> = runs.iter().flat_map(|(_, run)| run.ends()).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z)));
    points.dedup();
    for point in points {
        tree.within(point, reach, |k| {
            let run = runs[k].1;
            let near = reach.min(SHARE * lengths[k]);
            let away = |s: f64| run.point(s).distance(point) > 2.0 * near;
            if away(0.0) && away(run.range()) {
                let (s, off) = run.nearest(point);
                if off <= near && cuts[k].iter().all(|c| away(*c)) {
                    cuts[k].push(s);
                }
            }
        });
    }
    cuts.iter_mut().for_each(|c| c.sort_by(f64::total_cmp));
    cuts
}

/// Names the clusters of ends that lie within reach of each other. Reach is less than the length of either stretch.
fn clusters(ends: &[(DVec3, f64)]) -> (Vec<usize>, Vec<DVec3>) {
    let mut parent: Vec<usize> = (0..ends.len()).collect();
    fn root(parent: &mut [usize], mut k: usize) -> usize {
        while parent[k] != k {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        k
    }
    let boxes: Vec<Bounds> = ends.iter().map(|(p, _)| Bounds { min: *p, max: *p }).collect();
    let tree = BoundsTree::new(&boxes);
    for (k, (p, reach)) in ends.iter().enumerate() {
        let mut near = Vec::new();
        tree.within(*p, *reach, |other| near.push(other));
        near.sort_unstable();
        for other in near {
            if ends[other].0.distance(*p) <= reach.min(ends[other].1) {
                let (a, b) = (root(&mut parent, k), root(&mut parent, other));
                parent[a.max(b)] = a.min(b);
            }
        }
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

/// Whether `b` runs along `a`; then whether in the same direction.
fn beside(a: &Run, along: &Stretch, b: &Run, other: &Stretch, reach: f64) -> Option<bool> {
    let at = |stretch: &Stretch, share: f64| stretch.range.0 + (stretch.range.1 - stretch.range.0) * share;
    let near = |p: DVec3| {
        let (low, high) = along.range;
        let best = (0..=16)
            .map(|k| low + (high - low) * f64::from(k) / 16.0)
            .min_by(|x, y| a.point(*x).distance_squared(p).total_cmp(&a.point(*y).distance_squared(p)))?;
        let s = a.project(p, best, along.range);
        (a.point(s).distance(p) <= reach).then_some(s)
    };
    let places = [0.3, 0.5, 0.7].map(|share| near(b.point(at(other, share))));
    let (first, _, last) = (places[0]?, places[1]?, places[2]?);
    if along.ends[0] != along.ends[1] && along.ends != other.ends {
        return (along.ends[0] == other.ends[1]).then_some(false);
    }
    if along.ends[0] != along.ends[1] {
        return Some(true);
    }
    // Closed: by the order of places.
    Some(first < last)
}
