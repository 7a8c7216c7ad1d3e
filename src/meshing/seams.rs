//! Which stretches of outlines run along each other, and their common vertices.
//!
//! `stretches` cuts runs and finds vertices, `pairing` puts stretches that run along each other together. A
//! seam is divided by its first stretch; the others take its vertices, at their own nearest parameters. So the vertices
//! are a function of the seam, not of a face. Where the two sides lie apart, vertices are put in the middle: that is
//! the nearest a closed mesh can be to both.

use glam::DVec3;

use super::pairing::Pairing;
use super::stretches::{Cut, NOTHING, Reaches, Runs, add_cuts, cut, rough_part};
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

impl Stretch {
    /// Parameter of its `run` near the point `p`, which lies at `share` of the seam's first stretch; looked for along the
    /// whole run where it is farther off than `most`.
    fn foot(&self, run: &Run, p: DVec3, share: f64, most: f64) -> f64 {
        let (from, to) = self.range;
        let share = if self.forward { share } else { 1.0 - share };
        let s = run.project(p, from + (to - from) * share, self.range);
        // The two may be run through at other speeds: the guess may have been too far away.
        let off = run.point(s).distance(p);
        if off <= most {
            return s;
        }
        let Some((nearest, _)) = run.nearest_within(p, off).filter(|n| n.1 < 0.999 * off) else { return s };
        let near = run.project(p, nearest.clamp(from, to), self.range);
        if run.point(near).distance(p) < off { near } else { s }
    }
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
    /// How near things were to be to meet.
    reach: f64,
}

/// Where gaps leave less than this share of the tolerance it cannot be kept.
const HOPELESS: f64 = 0.1;
/// Share of the tolerance that chords keep then.
const LEAST_SHARE: f64 = 0.3;
/// How much farther apart two borders may be if they are the only ones left between the same two vertices.
const LAST_TWO: f64 = 5.0;
/// Feet farther off than this part of a step are looked for along the whole run.
const FAR: f64 = 0.05;
/// Vertices are put between the stretches where these are farther apart than this part of the tolerance.
const MIDDLE: f64 = 0.005;
/// Feet within this part of the tolerance are not looked for any nearer.
const NO_GAP: f64 = 5e-4;
/// Runs whose control points are within this part of it are one.
const ALIKE: f64 = 1e-4;
/// Runs of so many pieces at most are compared at fewer places first.
const FEW_PIECES: usize = 4;
/// Places between the ends at which stretches of a seam are compared.
const GAP_SAMPLES: usize = 23;

impl Seams {
    /// Finds the seams of `faces`; ends and middles within `reach` (model units) meet. Borders that have found no neighbour
    /// so look for one within `farthest`: what is one edge in the model stays one, however fine the mesh. Bodies that are
    /// closed by what meets within `least` are left at that: what is thin stays a body, however coarse the mesh.
    pub fn new(faces: &[Option<Tessellator>], least: f64, reach: f64, farthest: f64) -> Self {
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
        let last_two = reach.max((1.0 - LEAST_SHARE) * tolerance);
        let mut reaches = Reaches { base: reach, last_two, of: vec![reach; runs.len()] };
        if least < reach {
            let near = Reaches { base: least, last_two: least, of: vec![least; runs.len()] };
            let (found, of) = Self::between(&runs, &cuts, &near);
            let single = found.single(&of, &lengths, least);
            if !single.contains(&true) {
                return found;
            }
            let open = found.open_bodies(faces.len(), &runs, &single);
            let of = runs.iter().map(|(at, _)| if open[at.face] { reach } else { least });
            reaches.of = of.collect();
        }
        let (mut found, mut of) = Self::between(&runs, &cuts, &reaches);
        let mut single = found.single(&of, &lengths, reach);
        // Runs that have found their like from end to end need no cuts, whatever else ends on them.
        if add_cuts(&runs, &single, &lengths, &reaches.of, &mut cuts) {
            (found, of) = Self::between(&runs, &cuts, &reaches);
            single = found.single(&of, &lengths, reach);
        }
        if farthest >= reach && single.contains(&true) {
            for k in (0..runs.len()).filter(|k| single[*k]) {
                reaches.of[k] = farthest;
                // Where they were cut is where nothing farther away was known.
                cuts[k] = vec![0.0, runs[k].1.range()];
            }
            reaches.last_two = reaches.last_two.max(LAST_TWO * farthest);
            (found, of) = Self::between(&runs, &cuts, &reaches);
            single = found.single(&of, &lengths, reach);
            if add_cuts(&runs, &single, &lengths, &reaches.of, &mut cuts) {
                found = Self::between(&runs, &cuts, &reaches).0;
            }
        }
        found
    }

    /// For each run whether part of it is alone, but for those that are hardly anything.
    fn single(&self, of: &[usize], lengths: &[f64], reach: f64) -> Vec<bool> {
        let mut single = vec![false; lengths.len()];
        for (stretch, run) in self.stretches.iter().zip(of) {
            single[*run] |= lengths[*run] > reach && self.seams[stretch.seam].stretches.len() == 1;
        }
        single
    }

    /// For each face whether a face that it hangs together with has a border that is alone.
    fn open_bodies(&self, faces: usize, runs: &Runs, single: &[bool]) -> Vec<bool> {
        let mut body: Vec<usize> = (0..faces).collect();
        fn first(body: &mut [usize], mut face: usize) -> usize {
            while body[face] != face {
                body[face] = body[body[face]];
                face = body[face];
            }
            face
        }
        for seam in &self.seams {
            for pair in seam.stretches.windows(2) {
                let [a, b] = [0, 1].map(|k| first(&mut body, self.stretches[pair[k]].address.face));
                body[a.max(b)] = a.min(b);
            }
        }
        let mut open = vec![false; faces];
        for ((at, _), _) in runs.iter().zip(single).filter(|(_, single)| **single) {
            open[first(&mut body, at.face)] = true;
        }
        (0..faces).map(|face| open[first(&mut body, face)]).collect()
    }

    /// The seams of `runs` divided at `cuts`, and the run of each stretch.
    fn between(runs: &Runs, cuts: &[Vec<f64>], reaches: &Reaches) -> (Self, Vec<usize>) {
        let Cut { mut stretches, runs: of, lengths, vertices } = cut(runs, cuts, reaches);
        let pairing = Pairing {
            runs: of.iter().map(|k| runs[*k].1).collect(),
            reaches: of.iter().map(|k| reaches.of[*k]).collect(),
            lengths,
            last_two: reaches.last_two,
            stretches: &mut stretches,
        };
        let seams = pairing.seams();
        (Self { stretches, seams, vertices, reach: reaches.base }, of)
    }

    /// The vertices of a seam on its first stretch, for `part` of the tolerance; on its curve if they are to be `plain`. `gap`
    /// is what [`Seams::gap`] says.
    pub fn divide(
        &self,
        seam: usize,
        faces: &[Option<Tessellator>],
        part: f64,
        plain: bool,
        gap: f64,
    ) -> Vec<EdgeSample> {
        let stretch = &self.stretches[self.seams[seam].stretches[0]];
        let Some((face, run)) = run_of(faces, &stretch.address) else { return Vec::new() };
        // What gaps use up of the tolerance is not there for chords.
        let rest = 1.0 - gap / face.tolerance();
        // Beyond the tolerance nothing keeps it: then chords need not be short for it.
        let rest = if rest < HOPELESS { LEAST_SHARE } else { rest };
        let mut samples = face.divide_part(run, stretch.range, part * rest, plain);
        let [start, end] = stretch.ends;
        let at = self.vertices[start];
        if start == end && samples.iter().all(|s| s.point.distance(at) <= NOTHING * self.reach) {
            // A side that is as good as a point is one.
            samples = vec![samples[0], samples[samples.len() - 1]];
        }
        let last = samples.len() - 1;
        (samples[0].point, samples[last].point) = (at, self.vertices[end]);
        self.settle(seam, faces, gap, &mut samples);
        samples
    }

    /// Whether the stretches of a seam are so far apart that vertices are put between them.
    pub fn is_apart(&self, seam: usize, faces: &[Option<Tessellator>], gap: f64) -> bool {
        let owner = &self.stretches[self.seams[seam].stretches[0]];
        run_of(faces, &owner.address).is_some_and(|(face, _)| gap > MIDDLE * face.tolerance())
    }

    /// Puts the inner vertices of a seam into the middle between its stretches, where these are apart.
    pub fn settle(&self, seam: usize, faces: &[Option<Tessellator>], gap: f64, samples: &mut [EdgeSample]) {
        let [first, others @ ..] = self.seams[seam].stretches.as_slice() else { return };
        let owner = &self.stretches[*first];
        let Some((face, run)) = run_of(faces, &owner.address) else { return };
        if others.is_empty() || !(gap > MIDDLE * face.tolerance()) || samples.len() < 3 {
            return;
        }
        let last = samples.len() - 1;
        for sample in &mut samples[1..last] {
            let own = run.point(sample.s);
            let share = (sample.s - owner.range.0) / (owner.range.1 - owner.range.0);
            let feet = others.iter().filter_map(|k| {
                let (_, run) = run_of(faces, &self.stretches[*k].address)?;
                Some(run.point(self.stretches[*k].foot(run, own, share, 2.0 * gap)))
            });
            sample.point = feet.fold(Bounds::of([own]), |b, p| b.union(Bounds::of([p]))).centre();
        }
    }

    /// How far the vertices of a seam will be from its stretches, about.
    pub fn gap(&self, seam: usize, faces: &[Option<Tessellator>]) -> f64 {
        let stretches = &self.seams[seam].stretches;
        let mut gap = 0.0f64;
        for (number, which) in stretches.iter().enumerate() {
            let stretch = &self.stretches[*which];
            let Some((face, run)) = run_of(faces, &stretch.address) else { continue };
            let (from, to) = stretch.range;
            for (s, end) in [(from, stretch.ends[0]), (to, stretch.ends[1])] {
                gap = gap.max(run.point(s).distance(self.vertices[end]));
            }
            let owner = &self.stretches[stretches[0]];
            let Some((_, first)) = run_of(faces, &owner.address).filter(|_| number > 0) else { continue };
            let line = |run: &Run| run.pieces.len() == 1 && run.pieces[0].space.degree() == 1;
            let places = if line(run) && line(first) { 1 } else { GAP_SAMPLES };
            let nothing = NO_GAP * face.tolerance();
            let off = |k: usize| {
                let share = k as f64 / (places + 1) as f64;
                let point = first.point(owner.range.0 + (owner.range.1 - owner.range.0) * share);
                let off = run.point(stretch.foot(run, point, share, nothing.max(2.0 * gap))).distance(point);
                // Vertices are put in the middle.
                0.5 * off
            };
            if Self::is_whole(stretch, run)
                && Self::is_whole(owner, first)
                && run.is_like(first, stretch.forward, nothing)
            {
                continue;
            }
            // Few pieces that are one at a third of the places are one between them.
            let few = places > 1 && run.pieces.len().max(first.pieces.len()) <= FEW_PIECES;
            if few && (1..=places).skip(1).step_by(3).all(|k| off(k) <= nothing) {
                continue;
            }
            let found = (1..=places).map(off).fold(0.0, f64::max);
            gap = gap.max(found);
        }
        gap
    }

    /// Whether a stretch is its whole run.
    fn is_whole(stretch: &Stretch, run: &Run) -> bool {
        stretch.range == (0.0, run.range())
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
        let Some((face, run)) = run_of(faces, &stretch.address) else { return Vec::new() };
        if self.seams[stretch.seam].stretches[0] == number {
            return first.to_vec();
        }
        let alike = run_of(faces, &owner.address).is_some_and(|(_, other)| {
            Self::is_whole(stretch, run)
                && Self::is_whole(owner, other)
                && run.is_like(other, stretch.forward, ALIKE * face.tolerance())
        });
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
                    if alike && guess > low && guess < to {
                        samples.push(EdgeSample { s: guess, uv: run.uv(guess), ..*source });
                        continue;
                    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::face::Face;
    use crate::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
    use crate::kernel::tessellate::{TessellateError, TessellationOptions};
    use crate::kernel::trim::loop_record::{LoopRecord, LoopRole};
    use crate::meshing::{ModelMesh, Work, measure_face, mesh_edges, mesh_faces};
    use glam::DVec2;

    fn meshed(faces: &[Face], tolerance: f64) -> ModelMesh {
        let all: Vec<Option<&Face>> = faces.iter().map(Some).collect();
        mesh_faces(&all, &TessellationOptions::new(tolerance), &Work::QUIET).expect("a mesh")
    }

    /// Ends of the open edges of a mesh.
    fn open(mesh: &ModelMesh) -> Vec<[DVec3; 2]> {
        let of = |face: u32| mesh.faces[face as usize].as_ref().expect("a mesh");
        let open = mesh_edges(mesh).into_iter().filter(|e| e.is_open());
        open.map(|e| e.ends.map(|v| of(e.face).positions[v as usize])).collect()
    }

    /// `z = x^2 + lift`, from `x = -1` to 1 and from `y = 0` to `side`.
    fn gutter(side: f64, lift: f64) -> Face {
        let u = KnotVector::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).expect("knots");
        let v = KnotVector::new(1, vec![0.0, 0.0, 1.0, 1.0]).expect("knots");
        let row = |x: f64, z: f64| [0.0, side].map(|y| DVec3::new(x, y, z + lift));
        let points = [row(-1.0, 1.0), row(0.0, -1.0), row(1.0, 1.0)].concat();
        let surface = NurbsSurface::new(u, v, points, vec![1.0; 6]).expect("a surface");
        Face::derive(&surface, &[]).expect("a face")
    }

    #[test]
    fn borders_farther_apart_than_the_tolerance_are_one_edge_in_the_middle() {
        for (gap, tolerance) in [(1e-4, 1e-3), (3e-4, 2e-4), (3e-4, 1e-4), (9e-4, 1e-4)] {
            let faces = [gutter(1.0, 0.0), gutter(-1.0, gap)];
            let mesh = meshed(&faces, tolerance);
            assert!(open(&mesh).iter().all(|[a, b]| a.y != 0.0 || b.y != 0.0), "{gap} {tolerance}");
            let seam: Vec<DVec3> = mesh.faces[0].iter().flat_map(|m| &m.positions).copied().collect();
            let seam: Vec<DVec3> = seam.into_iter().filter(|p| p.y == 0.0).collect();
            assert!(seam.len() > 4);
            for p in seam {
                assert!((p.z - p.x * p.x - 0.5 * gap).abs() < 1e-3 * gap, "{p} {gap}");
            }
            // Half the gap is within the tolerance: so is the mesh.
            for (face, m) in faces.iter().zip(&mesh.faces).filter(|_| 0.5 * gap < 0.9 * tolerance) {
                let off = measure_face(face, m.as_ref().expect("a mesh"), 4, 4000).largest();
                assert!(off <= tolerance, "{off} {tolerance}");
            }
        }
    }

    /// The face over two lines, from `a` to `b` and from `c` to `d`.
    fn flat([a, b, c, d]: [DVec3; 4]) -> Face {
        let knots = || KnotVector::new(1, vec![0.0, 0.0, 1.0, 1.0]).expect("knots");
        let surface = NurbsSurface::new(knots(), knots(), vec![a, b, c, d], vec![1.0; 4]).expect("a surface");
        Face::derive(&surface, &[]).expect("a face")
    }

    /// The part of the plane through `z = 0` (and leaning by `lean` along `x`) inside a circle that starts at `angle`, and outside
    /// of it as far as a square round it if there is one.
    fn round(lean: f64, angle: f64, square: bool) -> Face {
        let corner = |x: f64, y: f64| DVec3::new(x, y, lean * (x - 2.0));
        let corners = [corner(-2.0, -2.0), corner(-2.0, 2.0), corner(2.0, -2.0), corner(2.0, 2.0)];
        let line = || KnotVector::new(1, vec![-2.0, -2.0, 2.0, 2.0]).expect("knots");
        let surface = NurbsSurface::new(line(), line(), corners.to_vec(), vec![1.0; 4]).expect("a surface");
        let ring = |corners: &[DVec2], weights: Vec<f64>, knots: Vec<f64>, degree: usize| {
            let points = corners.iter().map(|p| DVec2::from_angle(angle).rotate(*p)).collect();
            let knots = KnotVector::new(degree, knots).expect("knots");
            let curve = NurbsCurve2::new(knots, points, weights).expect("a curve");
            LoopRecord::new(LoopRole::Unknown, vec![curve])
        };
        let at = |x: f64, y: f64| DVec2::new(x, y);
        let corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
        let corners = corners.map(|(x, y)| at(f64::from(x), f64::from(y)));
        let weights = (0..9).map(|k| if k % 2 == 0 { 1.0 } else { 0.5f64.sqrt() }).collect();
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
        let mut loops = vec![ring(&corners, weights, knots, 2)];
        if square {
            let corners = [at(1.4, 1.4), at(-1.4, 1.4), at(-1.4, -1.4), at(1.4, -1.4), at(1.4, 1.4)];
            loops.push(ring(&corners, vec![1.0; 5], vec![0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0], 1));
        }
        Face::derive(&surface, &loops).expect("a face")
    }

    #[test]
    fn closed_edges_that_start_elsewhere_and_lie_apart_are_one() {
        // About 0.001 apart where the two start, 0.004 at most, the starts 0.004 from each other.
        for (lean, start) in [(-1e-3, 0.004), (-1e-3, 1.0), (0.0, 0.5)] {
            let faces = [round(0.0, 0.0, false), round(lean, start, true)];
            let mesh = meshed(&faces, 1e-2);
            let open = open(&mesh).iter().filter(|[a, _]| a.truncate().length() < 1.01).count();
            assert_eq!(open, 0, "{lean} {start}");
        }
    }

    #[test]
    fn tolerances_below_what_numbers_tell_apart_are_refused_and_lines_have_no_triangles() {
        let at = |x: f64, y: f64| DVec3::new(1e15 + x, y, 0.0);
        let far = flat([at(0.0, 0.0), at(0.0, 10.0), at(10.0, 0.0), at(10.0, 10.0)]);
        let options = TessellationOptions::new(0.01);
        let refused = mesh_faces(&[Some(&far)], &options, &Work::QUIET);
        assert!(matches!(refused, Err(TessellateError::TooFine { .. })));
        let line = flat([0.0, 1.0, 1.0, 2.0].map(|x| DVec3::new(x, 0.0, 0.0)));
        let mesh = meshed(&[line], 0.01);
        assert_eq!(mesh.faces[0], Err(TessellateError::Narrow));
    }

    #[test]
    fn bodies_thinner_than_the_tolerance_stay_bodies() {
        for thick in [1e-5, 1e-4] {
            let at = |k: usize| DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, thick * (k >> 2) as f64);
            let sides = [[0, 1, 2, 3], [4, 6, 5, 7], [0, 4, 1, 5], [2, 3, 6, 7], [0, 2, 4, 6], [1, 5, 3, 7]];
            let mesh = meshed(&sides.map(|side| flat(side.map(at))), 1e-3);
            assert_eq!((mesh.triangle_count(), open(&mesh).len()), (12, 0), "{thick}");
        }
    }

    #[test]
    fn sides_of_a_surface_without_loops_meet_where_it_closes() {
        // A square tube, a bit askew, so that sides have corners of their own.
        let u = KnotVector::new(1, vec![0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0]).expect("knots");
        let v = KnotVector::new(1, vec![0.0, 0.0, 1.0, 1.0]).expect("knots");
        let corners = [(0.0, 0.0), (1.0, 0.1), (1.2, 1.0), (0.0, 1.0), (0.0, 0.0)];
        let points = corners.iter().flat_map(|(x, y)| [0.0, 1.0].map(|z| DVec3::new(*x, *y, z)));
        let surface = NurbsSurface::new(u, v, points.collect(), vec![1.0; 10]).expect("a surface");
        let mesh = meshed(&[Face::derive(&surface, &[]).expect("a face")], 1e-3);
        let open = open(&mesh);
        assert!(!open.is_empty());
        assert!(open.iter().all(|[a, b]| a.z == b.z), "{open:?}");
    }
}
