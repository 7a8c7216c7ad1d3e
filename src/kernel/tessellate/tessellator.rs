//! From a face to its mesh: outline, chords, triangulation, refinement.
//!
//! [`Tessellator`] keeps the steps apart, because faces that share edges must agree on their chords first: the caller may
//! take each run's chords from elsewhere ([`Tessellator::mesh`]) and is told which of them the face cannot live with.

use glam::{DVec2, DVec3};

use super::bends::Bends;
use super::chords::{ChordLimits, EdgeSample, divide, divide_part};
use super::closing::close;
use super::decimate::decimate;
use super::finish::{finish, folded};
use super::flatness::Flatness;
use super::mesh::{FaceMesh, Quality};
use super::options::{TessellateError, TessellationOptions};
use super::outline::{Ground, Outline, Run};
use super::patience::Patience;
use super::places::Places;
use super::placing::{Middles, Vertices};
use super::plane::Plane;
use super::refine::Refinement;
use super::triangulate::{Crossings, Region};
use super::untangle::untangle;
use crate::kernel::face::Face;

/// Vertices along every run of a face, `[chain][run]`, both ends of each included.
pub type Boundary = Vec<Vec<Vec<EdgeSample>>>;

/// A chord that is too long for a face: between samples `index` and `index + 1` of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct LongChord {
    /// Chain of the outline.
    pub chain: usize,
    /// Run of the chain.
    pub run: usize,
    /// Sample that it starts from.
    pub index: usize,
    /// Whether it crosses another or makes triangles fold.
    pub crossed: bool,
}

/// A face ready to be meshed.
pub struct Tessellator<'a> {
    pub(super) face: &'a Face,
    pub(super) ground: Ground<'a>,
    outline: Outline,
    plane: Option<Plane>,
    flatness: Option<Flatness<'a>>,
    /// How the surface bends, unless it is a plane.
    pub(super) bends: Option<Bends>,
    /// Places in the triangulation.
    places: Places,
    pub(super) options: TessellationOptions,
    pub(super) tolerance: f64,
}

/// Share of the tolerance within which a face counts as plane.
const FLAT: f64 = 1e-3;
/// Chords keep to this share, because triangles beside them bend as much and more.
pub const CHORD_SHARE: f64 = 0.95;
/// Chords whose proven error is above this share are too long for triangles beside them.
const CHORD_LIMIT: f64 = 0.985;
/// Runs shorter than this part of the tolerance are one point.
const NOTHING: f64 = 1e-6;
/// What is missing between crossing chords is filled where it is thinner than this part of the tolerance.
const SLIVER: f64 = 0.1;

impl<'a> Tessellator<'a> {
    /// Lifts the outline of `face`.
    ///
    /// # Errors
    /// Bad options, or nothing inside the loops.
    pub fn new(face: &'a Face, options: &TessellationOptions) -> Result<Self, TessellateError> {
        options.check()?;
        if face.patches.is_empty() {
            return Err(TessellateError::Empty);
        }
        let ground = Ground::new(face);
        for patch in ground.patches() {
            let bounds = patch.bounds();
            if !(bounds.min.is_finite() && bounds.max.is_finite()) {
                return Err(TessellateError::NotFinite { u: patch.uv_min.x, v: patch.uv_min.y });
            }
        }
        let outline = Outline::new(face, &ground, 1e-3 * options.tolerance);
        let outline = if options.simplify { outline.joined() } else { outline };
        let plane = Plane::of(&ground, FLAT * options.tolerance);
        let flatness = (options.conservative && plane.is_none()).then(|| Flatness::new(&ground));
        let bent = plane.is_none().then(|| Bends::new(&ground, &face.domain, options.balanced));
        let places = match &bent {
            Some((bends, speed)) => {
                let factors = scale(bends, *speed, face.domain.size(), options.tolerance);
                let step = (*speed / factors).min_element();
                Places::new(&ground, factors, &face.domain, step, options.tolerance)
            }
            None => Places::even(DVec2::ONE, &face.domain),
        };
        Ok(Self {
            face,
            ground,
            bends: bent.map(|b| b.0),
            places,
            outline,
            plane,
            flatness,
            options: options.clone(),
            tolerance: options.tolerance,
        })
    }

    /// The face's outline in space.
    pub fn outline(&self) -> &Outline {
        &self.outline
    }

    /// Starts a chain that is one closed run at `s` of it.
    pub fn start_at(&mut self, chain: usize, s: f64) {
        if let Some([run]) = self.outline.chains.get_mut(chain).map(Vec::as_mut_slice)
            && s > 0.0
            && s < run.range()
        {
            let (mut turned, _) = run.part(s, run.range());
            turned.pieces.extend(run.part(0.0, s).0.pieces);
            *run = turned;
        }
    }

    /// Whether triangles leave enough of the tolerance to chords that pass through their curves: on planes, and where straight
    /// lines run along one of the parameters, all the way at one normal.
    pub fn leaves_room(&self) -> bool {
        /// Part of the tolerance that twisting may take.
        const TWISTED: f64 = 0.1;
        let size = self.face.domain.size();
        let twist = self.bends.as_ref().map_or(0.0, |b| 0.25 * b.twist * size.x * size.y);
        let patches = || self.ground.patches().iter();
        let ruled = patches().all(|p| p.degree_u == 1) || patches().all(|p| p.degree_v == 1);
        self.plane.is_some() || ruled && twist <= TWISTED * self.tolerance
    }

    /// The tolerance that was asked for.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Chords of every run by the face's own choice: a function of the run alone.
    pub fn own_boundary(&self) -> Boundary {
        let runs = self.outline.chains.iter();
        let mut boundary: Boundary = runs
            .map(|chain| chain.iter().map(|run| self.divide(run, 1.0, !self.leaves_room())).collect())
            .collect();
        // Runs that are nothing but rounding (poles) are one point.
        for runs in &mut boundary {
            let count = runs.len();
            for k in 0..count {
                let (first, last) = (runs[k][0].point, runs[k].len() - 1);
                if last == 1 && first.distance(runs[k][1].point) <= NOTHING * self.tolerance {
                    runs[k][1].point = first;
                    runs[(k + 1) % count][0].point = first;
                }
            }
        }
        if self.options.simplify {
            // The same inside of joined runs.
            for samples in boundary.iter_mut().flatten() {
                for k in 1..samples.len() {
                    if samples[k].point.distance(samples[k - 1].point) <= NOTHING * self.tolerance {
                        let of = if k + 1 == samples.len() { k } else { k - 1 };
                        let point = samples[of].point;
                        (samples[k].point, samples[k - 1].point) = (point, point);
                    }
                }
            }
        }
        boundary
    }

    /// Chords of one run, for a part of the tolerance; between points of the run where they are to be `plain`.
    pub fn divide(&self, run: &Run, part: f64, plain: bool) -> Vec<EdgeSample> {
        let mut limits = ChordLimits::new(&self.options);
        limits.balanced &= !plain;
        limits.tolerance *= CHORD_SHARE * part;
        divide(run, &limits, &self.options)
    }

    /// The same for the part of a run between two parameters.
    pub fn divide_part(&self, run: &Run, range: (f64, f64), part: f64, plain: bool) -> Vec<EdgeSample> {
        let mut limits = ChordLimits::new(&self.options);
        limits.balanced &= !plain;
        limits.tolerance *= CHORD_SHARE * part;
        divide_part(run, range, &limits, &self.options)
    }

    /// The mesh within `boundary`, and the chords of it that are too long for this face.
    ///
    /// # Errors
    /// See [`TessellateError`].
    pub fn mesh(
        &self,
        boundary: &Boundary,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<(FaceMesh, Vec<LongChord>), TessellateError> {
        let (mesh, long) = self.attempt(boundary, false, cancelled)?;
        Ok((mesh.unwrap_or_default(), long))
    }

    /// The same; of a `draft` there is no mesh where chords are found to be too long on the way, which saves what comes after.
    ///
    /// # Errors
    /// See [`TessellateError`].
    pub fn attempt(
        &self,
        boundary: &Boundary,
        draft: bool,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<(Option<FaceMesh>, Vec<LongChord>), TessellateError> {
        let flatness = self.flatness.as_ref();
        let refinement = Refinement {
            ground: &self.ground,
            flatness,
            plane: self.plane.as_ref(),
            options: &self.options,
            places: &self.places,
            domain: self.face.domain,
            middles: Middles::default(),
            patience: Patience::new(boundary.iter().flatten().map(Vec::len).sum()),
        };
        let mut long = Vec::new();
        let count: usize = boundary.iter().flatten().map(Vec::len).sum();
        let mut vertices = Vertices::with_capacity(if self.plane.is_some() { count } else { 2 * count });
        let mut quality = Quality::default();
        let mut loops: Vec<Vec<u32>> = Vec::new();
        // For each vertex of the boundary the next one, and the chord between them.
        let mut ways: Vec<(u32, LongChord)> = Vec::new();
        for (chain, runs) in boundary.iter().enumerate() {
            let mut ring = Vec::new();
            for (run, samples) in runs.iter().enumerate() {
                for (index, pair) in samples.windows(2).enumerate() {
                    // A chord of no length may go back and forth by rounding, across others.
                    if pair[0].point == pair[1].point && self.is_rounding(pair[0].uv, pair[1].uv) {
                        continue;
                    }
                    let owner = LongChord { chain, run, index, crossed: false };
                    for sample in self.along(pair) {
                        let number = vertices.uvs.len() as u32;
                        ring.push((number, owner));
                        refinement.add_sample(&mut vertices, &sample);
                        let last = vertices.positions.len() - 1;
                        let gap = (sample.point - sample.off).distance(vertices.on_surface[last]);
                        quality.gap = quality.gap.max(gap);
                        if !(sample.point.is_finite() && vertices.on_surface[last].is_finite()) {
                            return Err(TessellateError::NotFinite { u: sample.uv.x, v: sample.uv.y });
                        }
                    }
                }
            }
            ways.extend(ring.iter().enumerate().map(|(k, way)| (ring[(k + 1) % ring.len()].0, way.1)));
            loops.push(ring.into_iter().map(|r| r.0).collect());
        }
        let owner = |[a, b]: [u32; 2]| ways.get(a as usize).filter(|way| way.0 == b).map(|way| &way.1);
        let either = |[a, b]: [u32; 2]| owner([a, b]).or_else(|| owner([b, a]));
        if self.plane.is_none() {
            self.align(&mut vertices.uvs);
        }
        let places: Vec<DVec2> = match &self.plane {
            Some(plane) => vertices.positions.iter().map(|p| plane.coordinates(*p)).collect(),
            None => vertices.uvs.iter().map(|uv| self.places.of(*uv)).collect(),
        };
        let (mut region, crossings) = triangulated(&places, &loops)?;
        quality.crossings = crossings.places.len();
        for (a, b) in &crossings.pairs {
            for chord in [*a, *b, [a[1], a[0]], [b[1], b[0]]] {
                long.extend(owner(chord).map(|c| LongChord { crossed: true, ..*c }));
            }
        }
        if draft && !long.is_empty() {
            return Ok((None, sorted(long)));
        }
        for place in &crossings.places {
            self.add_crossing(*place, &refinement, &mut vertices);
        }
        vertices.fixed = vertices.uvs.len();
        if !(self.plane.is_some() && self.options.max_edge.is_none()) {
            self.sow(&refinement, &mut region, &mut vertices)?;
            let refined = refinement.run(&mut region, &mut vertices, draft, cancelled)?;
            quality.error = refined.error;
            quality.over_tolerance = refined.over;
            for chord in refined.stubborn {
                long.extend(either(chord));
            }
            if refined.unfinished && !long.is_empty() {
                return Ok((None, sorted(long)));
            }
        } else {
            quality.error = FLAT * self.tolerance + quality.gap;
        }
        quality.evaluations = vertices.uvs.len();
        let mut triangles: Vec<[u32; 3]> = region.triangles().collect();
        if self.plane.is_none() {
            let within = |t: [u32; 3]| refinement.hold(&vertices, std::iter::once(t));
            untangle(&mut triangles, &vertices, within);
            let in_the_way = |triangles: &[[u32; 3]]| -> Vec<LongChord> {
                // Where the surface itself is folded no chords help.
                let chords =
                    if refinement.patience.has_folds() { folded(&vertices, triangles) } else { Vec::new() };
                chords
                    .into_iter()
                    .filter_map(|c| either(c).map(|c| LongChord { crossed: true, ..*c }))
                    .collect()
            };
            if draft {
                long.extend(in_the_way(&triangles));
                if !long.is_empty() {
                    return Ok((None, sorted(long)));
                }
            }
            decimate(&mut triangles, &vertices, &refinement, cancelled);
            long.extend(in_the_way(&triangles));
        }
        if crossings.through || !crossings.pairs.is_empty() {
            close(&mut triangles, &loops, |v| vertices.positions[v as usize], SLIVER * self.tolerance);
        }
        let mesh = finish(vertices, triangles, loops, quality);
        if mesh.triangles.len() > self.options.triangle_limit {
            return Err(TessellateError::TooManyTriangles { limit: self.options.triangle_limit });
        }
        Ok((Some(mesh), sorted(long)))
    }

    /// Chords whose straight line in parameters leaves the chord by more than the tolerance. Where the run itself is straight in
    /// parameters that line is the run, which its division has held against the chord.
    pub fn long_chords(&self, boundary: &Boundary) -> Vec<LongChord> {
        let Some(flatness) = &self.flatness else { return Vec::new() };
        let mut long = Vec::new();
        for (chain, runs) in boundary.iter().enumerate() {
            for (run, samples) in runs.iter().enumerate() {
                let source = self.outline.chains.get(chain).and_then(|runs| runs.get(run));
                for (index, pair) in samples.windows(2).enumerate() {
                    if source.is_some_and(|run| run.is_straight(pair[0].s, pair[1].s)) {
                        continue;
                    }
                    let uv = [pair[0].uv, pair[1].uv];
                    let p = [0, 1].map(|k| self.ground.point(uv[k]) + pair[k].off);
                    if flatness.chord(uv, p, CHORD_LIMIT * self.tolerance) > CHORD_LIMIT * self.tolerance
                        && p[0].distance(p[1]) > 1e-3 * self.tolerance
                    {
                        long.push(LongChord { chain, run, index, crossed: false });
                    }
                }
            }
        }
        long
    }

    /// The first vertex of a chord; and where the chord is one point (a pole) others at the same position, so that the
    /// triangles that end there are no wider than others.
    fn along(&self, pair: &[EdgeSample]) -> Vec<EdgeSample> {
        /// Vertices along a pole at most, and the angle between two.
        const MOST: f64 = 256.0;
        const WIDEST: f64 = 0.8;
        let (a, b) = (pair[0], pair[1]);
        let step = self.places.step(a.uv, b.uv).length();
        if a.point != b.point || self.plane.is_some() || !(step > 1.0) {
            return vec![a];
        }
        let count = step.min(self.sweep(a.uv, b.uv) / WIDEST).min(MOST).ceil().max(1.0) as usize;
        let at = |k: usize| a.uv.lerp(b.uv, k as f64 / count as f64);
        (0..count).map(|k| EdgeSample { uv: at(k), ..a }).collect()
    }

    /// The angle that the surface sweeps round a pole between two places on its border.
    fn sweep(&self, a: DVec2, b: DVec2) -> f64 {
        const STEPS: usize = 24;
        let inward = 1e-3 * (0.5 * (self.face.domain.min + self.face.domain.max) - 0.5 * (a + b));
        let pole = self.ground.point(a);
        let direction = |k: usize| self.ground.point(a.lerp(b, k as f64 / STEPS as f64) + inward) - pole;
        (0..STEPS).map(|k| direction(k).angle_between(direction(k + 1))).filter(|x| x.is_finite()).sum()
    }

    /// Whether a step in parameters is rounding.
    fn is_rounding(&self, from: DVec2, to: DVec2) -> bool {
        /// Part of the domain, and of what one triangle spans.
        const PART: f64 = 1e-6;
        let of_domain = ((to - from) / self.face.domain.size()).abs().max_element();
        of_domain < PART && (self.plane.is_some() || self.places.step(from, to).length() < PART)
    }

    /// Makes parameters of boundary vertices that differ by rounding alone the same, u and v apart: chords along
    /// lines of constant parameters shall be collinear.
    fn align(&self, uvs: &mut [DVec2]) {
        /// Part of the domain that is rounding.
        const ROUNDING: f64 = 1e-10;
        for axis in 0..2 {
            let mut order: Vec<usize> = (0..uvs.len()).collect();
            order.sort_by(|a, b| uvs[*a][axis].total_cmp(&uvs[*b][axis]).then(a.cmp(b)));
            let mut common = f64::NEG_INFINITY;
            let mut before = f64::NEG_INFINITY;
            for k in order {
                let x = uvs[k][axis];
                if !(self.places.part(axis, before, x) <= ROUNDING) {
                    common = x;
                }
                before = x;
                uvs[k][axis] = common;
            }
        }
    }

    /// A vertex where two chords cross.
    fn add_crossing(&self, place: DVec2, refinement: &Refinement, vertices: &mut Vertices) {
        match &self.plane {
            None => refinement.add(vertices, refinement.places.native(place)),
            Some(plane) => {
                let p = plane.origin + plane.x * place.x + plane.y * place.y;
                vertices.uvs.push(self.face.domain.min);
                vertices.on_surface.push(p);
                vertices.positions.push(p);
                vertices.upright.push(p);
                vertices.gaps.push(0.0);
                vertices.normals.push(plane.normal());
            }
        }
    }
}

/// The triangulation of `loops`. The crate that makes it has been seen to give up, by a panic, on loops that cross
/// themselves hundreds of times: that is the face's misfortune, not the program's.
fn triangulated(places: &[DVec2], loops: &[Vec<u32>]) -> Result<(Region, Crossings), TessellateError> {
    std::panic::catch_unwind(|| Region::new(places, loops)).map_err(|_| TessellateError::Tangled)
}

/// In order, each once.
fn sorted(mut chords: Vec<LongChord>) -> Vec<LongChord> {
    chords.sort_unstable();
    chords.dedup();
    chords
}

/// Factors that make the parameters even in what they do to the error: lengths of about one in either direction
/// are what one triangle can span.
fn scale(bends: &Bends, speed: DVec2, size: DVec2, tolerance: f64) -> DVec2 {
    let bend = bends.mean();
    let reach = |axis: usize| {
        let flat = (8.0 * tolerance / bend[axis].max(f64::MIN_POSITIVE)).sqrt();
        flat.min(size[axis])
    };
    let step = DVec2::new(reach(0), reach(1));
    let length = step * speed;
    // Triangles much longer than wide are hard on everything downstream.
    const LONGEST: f64 = 300.0;
    let limit = LONGEST * length.min_element();
    let step = DVec2::new(
        if length.x > limit && speed.x > 0.0 { limit / speed.x } else { step.x },
        if length.y > limit && speed.y > 0.0 { limit / speed.y } else { step.y },
    );
    let scale = 1.0 / step;
    if scale.is_finite() && scale.min_element() > 0.0 { scale } else { 1.0 / size }
}

/// Positions of a boundary as closed polygons.
pub fn polygons(boundary: &Boundary) -> Vec<Vec<DVec3>> {
    let ring = |runs: &Vec<Vec<EdgeSample>>| {
        runs.iter().flat_map(|r| r[..r.len().saturating_sub(1)].iter().map(|s| s.point)).collect()
    };
    boundary.iter().map(ring).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chord_through_a_vertex_leaves_no_edge_open() {
        // From 1 the way goes back along the chord from 0: in parameters 2 lies on it, in space a bit beside it.
        let uvs = [(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 3.0), (0.0, 3.0)].map(|p| DVec2::new(p.0, p.1));
        let ring = vec![vec![0, 1, 2, 3, 4]];
        let (region, crossings) = triangulated(&uvs, &ring).expect("triangles");
        assert!(crossings.through && crossings.pairs.is_empty());
        for (beside, more) in [(1e-4, 1), (0.0, 0)] {
            let mut triangles: Vec<[u32; 3]> = region.triangles().collect();
            let before = triangles.len();
            let at = |v: u32| uvs[v as usize].extend(if v == 2 { beside } else { 0.0 });
            close(&mut triangles, &ring, at, 1e-3);
            assert_eq!(triangles.len(), before + more);
            assert!(more == 0 || triangles[before].iter().all(|v| *v < 3));
        }
    }
}
