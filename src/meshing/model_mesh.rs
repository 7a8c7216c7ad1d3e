//! The meshes of all faces of a model, with common vertices along their seams.
//!
//! Faces are prepared, seams found and divided, chords shortened until every face at them is content, and faces meshed:
//! all in parallel and in a fixed order, so that the same model gives the same mesh bit for bit. After an edit only
//! faces whose own surface or chords changed are meshed again.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use super::seams::{Seams, run_of};
use super::starts;
use crate::kernel::face::Face;
use crate::kernel::tessellate::chords::{CROSSED_STEP, STEP, halve_chord, is_common};
use crate::kernel::tessellate::{
    Boundary, EdgeSample, FaceMesh, LongChord, TessellateError, TessellationOptions, Tessellator,
};
use crate::kernel::view::Bounds;

/// Meshes of the faces of a model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ModelMesh {
    /// Mesh of each face in order, or why it has none. The triangles' sense is that of `du x dv`.
    pub faces: Vec<Result<FaceMesh, TessellateError>>,
    /// Chords of each face, by which unchanged faces are known again.
    boundaries: Vec<Boundary>,
    /// Number of seams, shared ones and borders.
    pub seams: usize,
}

impl ModelMesh {
    /// Meshes made apart, one for each face, taken together.
    pub fn of(faces: Vec<Result<FaceMesh, TessellateError>>) -> Self {
        Self { faces, ..Self::default() }
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.faces.iter().flatten().map(|m| m.triangles.len()).sum()
    }
}

/// How a long job is followed and called off.
pub struct Work<'a> {
    /// Told the part done, 0 to 1.
    pub progress: &'a (dyn Fn(f64) + Sync),
    /// Asked now and then whether to give up.
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
}

impl Work<'_> {
    /// Neither followed nor called off.
    pub const QUIET: Work<'static> = Work { progress: &|_| (), cancelled: &|| false };
}

/// Rounds of shortening chords before and after meshing.
const ROUNDS: usize = 8;
/// Rounds in which faces are meshed again for chords that cross or stand in the way.
const MESH_ROUNDS: usize = 10;
/// Steps that a seam's share of the tolerance is shortened by in one round at most.
const MOST_STEPS: i32 = 3;
/// Chords of a seam at most, for each that it had at first, and besides: what these do not mend no more of them will.
const GROWTH: usize = 50;
const FEW: usize = 200;
/// More triangles than this part of the limit that are to be expected are too many.
const SURELY: f64 = 1.25;
/// Share of the tolerance within which outlines meet.
const REACH: f64 = 0.5;
/// The same as a part of the model's size, at most and at least; the most is also how far apart two borders may be that have
/// no other neighbour.
const FARTHEST: f64 = 4e-4;
const NEAREST: f64 = 1e-9;
/// How near the borders of well-made bodies are, as a part of the model's size.
const WELL_MADE: f64 = 1e-6;

/// Chords within this part of the tolerance are points.
const POINT: f64 = 1e-3;

/// The least tolerance that makes sense for a model within `bounds`: numbers there are that far apart, times a few.
pub fn finest(bounds: &Bounds) -> f64 {
    const STEPS: f64 = 16.0;
    let far = bounds.min.abs().max(bounds.max.abs()).max_element();
    if bounds.is_empty() || !far.is_finite() { 0.0 } else { STEPS * f64::EPSILON * far }
}

/// Meshes `faces` (`None` for those that could not be derived) with common vertices.
///
/// # Errors
/// Bad options, too many triangles, or called off; what goes wrong with single faces is told per face.
pub fn mesh_faces(
    faces: &[Option<&Face>],
    options: &TessellationOptions,
    work: &Work,
) -> Result<ModelMesh, TessellateError> {
    remesh_faces(faces, options, &ModelMesh::default(), &|_| true, work)
}

/// The same, taking over the meshes of `previous` (of the same options) for faces that did not change and whose chords
/// are the same.
///
/// # Errors
/// As for [`mesh_faces`].
pub fn remesh_faces(
    faces: &[Option<&Face>],
    options: &TessellationOptions,
    previous: &ModelMesh,
    changed: &(dyn Fn(usize) -> bool + Sync),
    work: &Work,
) -> Result<ModelMesh, TessellateError> {
    // All of it on threads of the pool: else each step would wake them and wait.
    rayon::scope(|_| remesh(faces, options, previous, changed, work))
}

fn remesh(
    faces: &[Option<&Face>],
    options: &TessellationOptions,
    previous: &ModelMesh,
    changed: &(dyn Fn(usize) -> bool + Sync),
    work: &Work,
) -> Result<ModelMesh, TessellateError> {
    options.check()?;
    // Loops that share edges with others keep their curves' ends.
    let options = &TessellationOptions { simplify: false, ..options.clone() };
    let prepared: Vec<Result<Tessellator, TessellateError>> = faces
        .par_iter()
        .map(|face| match face {
            Some(face) => Tessellator::new(face, options),
            None => Err(TessellateError::Empty),
        })
        .collect();
    let mut failed: Vec<Option<TessellateError>> = Vec::with_capacity(faces.len());
    let mut prepared: Vec<Option<Tessellator>> = prepared
        .into_iter()
        .map(|p| match p {
            Ok(tessellator) => {
                failed.push(None);
                Some(tessellator)
            }
            Err(error) => {
                failed.push(Some(error));
                None
            }
        })
        .collect();
    (work.progress)(0.1);
    let bounds = faces.iter().flatten().fold(Bounds::EMPTY, |b, f| b.union(f.bounds));
    let size = bounds.diagonal();
    let finest = finest(&bounds);
    if options.tolerance < finest {
        return Err(TessellateError::TooFine { tolerance: options.tolerance, finest });
    }
    let farthest = FARTHEST * size;
    let reach = (REACH * options.tolerance).min(farthest).max(NEAREST * size);
    starts::meet(&mut prepared, reach, farthest);
    let seams = Seams::new(&prepared, WELL_MADE * size, reach, farthest);
    let too_many = TessellateError::TooManyTriangles { limit: options.triangle_limit };
    let Some(mut division) = Division::new(&seams, &prepared, options.triangle_limit) else {
        return Err(too_many);
    };
    (work.progress)(0.25);
    let mut boundaries = division.boundaries();
    let mut open: Vec<usize> = (0..faces.len()).collect();
    for _ in 0..ROUNDS {
        if (work.cancelled)() {
            return Err(TessellateError::Cancelled);
        }
        let long = division.long_chords(&open, &boundaries);
        if long.is_empty() {
            break;
        }
        open = division.shorten(&long, 1).into_iter().collect();
        division.renew(&open, &mut boundaries);
    }
    (work.progress)(0.35);
    let mut meshes: Vec<Option<Result<FaceMesh, TessellateError>>> =
        failed.into_iter().map(|e| e.map(Err)).collect();
    for (face, mesh) in meshes.iter_mut().enumerate() {
        let same = !changed(face) && previous.boundaries.get(face).is_some_and(|b| *b == boundaries[face]);
        if mesh.is_none() && same {
            *mesh = previous.faces.get(face).cloned();
        }
    }
    let waiting = |face: &usize| meshes[*face].is_none();
    let expected: f64 = (0..faces.len())
        .filter(waiting)
        .filter_map(|face| Some(prepared[face].as_ref()?.expected(&boundaries[face])))
        .sum();
    if expected > SURELY * options.triangle_limit as f64 {
        return Err(too_many);
    }
    let done = AtomicUsize::new(0);
    let triangles = AtomicUsize::new(0);
    // Faces whose chords cannot be shortened any more.
    let mut final_try = vec![false; faces.len()];
    for round in 0..=MESH_ROUNDS {
        let found: Vec<_> = meshes
            .par_iter()
            .enumerate()
            .map(|(face, mesh)| {
                let tessellator = prepared[face].as_ref()?;
                if mesh.is_some() {
                    return None;
                }
                if (work.cancelled)() {
                    return Some(Err(TessellateError::Cancelled));
                }
                let draft = round < MESH_ROUNDS && !final_try[face];
                let result = tessellator.attempt(&boundaries[face], draft, &|| {
                    (work.cancelled)() || triangles.load(Ordering::Relaxed) > options.triangle_limit
                });
                if let Ok((Some(mesh), _)) = &result {
                    triangles.fetch_add(mesh.triangles.len(), Ordering::Relaxed);
                }
                if round == 0 {
                    let part = done.fetch_add(1, Ordering::Relaxed) as f64 / faces.len() as f64;
                    (work.progress)(0.35 + 0.6 * part);
                }
                Some(result)
            })
            .collect();
        let mut long = Vec::new();
        for (face, result) in found.into_iter().enumerate() {
            match result {
                None => {}
                Some(Ok((mesh, chords))) => {
                    if !final_try[face] {
                        long.extend(chords.into_iter().map(|chord| (face, chord)));
                    }
                    meshes[face] = mesh.map(Ok);
                }
                Some(Err(TessellateError::Cancelled)) if (work.cancelled)() => {
                    return Err(TessellateError::Cancelled);
                }
                Some(Err(TessellateError::Cancelled)) => {
                    return Err(TessellateError::TooManyTriangles { limit: options.triangle_limit });
                }
                Some(Err(error @ TessellateError::TooManyTriangles { .. })) => return Err(error),
                Some(Err(error)) => meshes[face] = Some(Err(error)),
            }
        }
        let count: usize = meshes.iter().flatten().flatten().map(|m| m.triangles.len()).sum();
        if count > options.triangle_limit {
            return Err(TessellateError::TooManyTriangles { limit: options.triangle_limit });
        }
        triangles.store(count, Ordering::Relaxed);
        if long.is_empty() && meshes.iter().zip(&prepared).all(|(m, p)| m.is_some() || p.is_none())
            || round == MESH_ROUNDS
        {
            break;
        }
        let shortened = division.shorten(&long, 1 + round as i32);
        for (face, mesh) in meshes.iter().enumerate() {
            final_try[face] |= mesh.is_none() && !shortened.contains(&face);
        }
        for face in shortened {
            final_try[face] = false;
            boundaries[face] = division.boundary(face);
            if prepared[face].is_some() {
                if let Some(Ok(mesh)) = &meshes[face] {
                    triangles.fetch_sub(
                        mesh.triangles.len().min(triangles.load(Ordering::Relaxed)),
                        Ordering::Relaxed,
                    );
                }
                meshes[face] = None;
            }
        }
    }
    (work.progress)(1.0);
    // A face that comes out without triangles is said to have none, not passed over.
    let faces = meshes
        .into_iter()
        .map(|m| m.unwrap_or(Err(TessellateError::Empty)))
        .map(|m| m.and_then(|m| if m.area() > 0.0 { Ok(m) } else { Err(TessellateError::Narrow) }))
        .collect();
    Ok(ModelMesh { faces, boundaries, seams: seams.seams.len() })
}

/// The vertices of all seams while they are worked out.
struct Division<'s, 'f, 'a> {
    seams: &'s Seams,
    faces: &'f [Option<Tessellator<'a>>],
    /// How far the vertices of each seam are off its stretches.
    gaps: Vec<f64>,
    /// Samples of each seam on its first stretch.
    samples: Vec<Vec<EdgeSample>>,
    /// Samples that each seam may have.
    most: Vec<usize>,
    /// Part of the tolerance that each seam is divided for.
    parts: Vec<f64>,
    /// Seams whose vertices lie on their curves, because others would cross.
    plain: Vec<bool>,
    /// Stretches of each face's runs, in order.
    stretches: BTreeMap<(usize, usize, usize), Vec<usize>>,
}

impl<'s, 'f, 'a> Division<'s, 'f, 'a> {
    /// Divides all seams; `None` where that takes more than `limit` chords, each of which has a triangle.
    fn new(seams: &'s Seams, faces: &'f [Option<Tessellator<'a>>], limit: usize) -> Option<Self> {
        let mut stretches: BTreeMap<(usize, usize, usize), Vec<usize>> = BTreeMap::new();
        for (k, stretch) in seams.stretches.iter().enumerate() {
            let a = stretch.address;
            stretches.entry((a.face, a.chain, a.run)).or_default().push(k);
        }
        let chords = AtomicUsize::new(0);
        let gaps: Vec<f64> =
            (0..seams.seams.len()).into_par_iter().map(|seam| seams.gap(seam, faces)).collect();
        let room = |k: &usize| {
            faces[seams.stretches[*k].address.face].as_ref().is_some_and(Tessellator::leaves_room)
        };
        let all = seams.seams.iter().enumerate();
        let plain: Vec<bool> =
            all.map(|(k, s)| seams.is_apart(k, faces, gaps[k]) || !s.stretches.iter().all(room)).collect();
        let divide = |seam: usize| {
            let samples = seams.divide(seam, faces, 1.0, plain[seam], gaps[seam]);
            let own = samples.len().saturating_sub(1);
            // Stretches that are points have no triangles.
            (own == 1 || chords.fetch_add(own, Ordering::Relaxed) + own <= limit).then_some(samples)
        };
        let samples: Vec<Vec<EdgeSample>> =
            (0..seams.seams.len()).into_par_iter().map(divide).collect::<Option<_>>()?;
        let most = samples.iter().map(|samples| GROWTH * samples.len() + FEW).collect();
        let parts = vec![1.0; seams.seams.len()];
        Some(Self { seams, faces, gaps, samples, most, parts, plain, stretches })
    }

    /// The chords of a face.
    fn boundary(&self, face: usize) -> Boundary {
        let Some(tessellator) = &self.faces[face] else { return Boundary::new() };
        let run = |chain: usize, run: usize| {
            let mut samples: Vec<EdgeSample> = Vec::new();
            for number in self.stretches.get(&(face, chain, run)).into_iter().flatten() {
                let seam = self.seams.stretches[*number].seam;
                let own = self.seams.transfer(*number, &self.samples[seam], self.faces);
                samples.extend(own.into_iter().skip(usize::from(!samples.is_empty())));
            }
            samples
        };
        let chains = tessellator.outline().chains.iter().enumerate();
        chains.map(|(c, runs)| (0..runs.len()).map(|r| run(c, r)).collect()).collect()
    }

    fn boundaries(&self) -> Vec<Boundary> {
        (0..self.faces.len()).into_par_iter().map(|face| self.boundary(face)).collect()
    }

    /// The chords of `faces` anew.
    fn renew(&self, faces: &[usize], boundaries: &mut [Boundary]) {
        let own: Vec<Boundary> = faces.par_iter().map(|face| self.boundary(*face)).collect();
        faces.iter().zip(own).for_each(|(face, own)| boundaries[*face] = own);
    }

    /// Chords that are too long for one of `faces`.
    fn long_chords(&self, faces: &[usize], boundaries: &[Boundary]) -> Vec<(usize, LongChord)> {
        let of = |face: &usize| {
            let Some(tessellator) = &self.faces[*face] else { return Vec::new() };
            let long = tessellator.long_chords(&boundaries[*face]);
            long.into_iter().map(|chord| (*face, chord)).collect()
        };
        let all: Vec<Vec<_>> = faces.par_iter().map(of).collect();
        all.into_iter().flatten().collect()
    }

    /// Shortens chords of seams, those of a whole seam by so many steps; gives the faces at them.
    fn shorten(&mut self, long: &[(usize, LongChord)], steps: i32) -> BTreeSet<usize> {
        let mut wanted: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        let mut crossed: BTreeSet<usize> = BTreeSet::new();
        for (face, chord) in long {
            let mut index = chord.index;
            for number in self.stretches.get(&(*face, chord.chain, chord.run)).into_iter().flatten() {
                let stretch = &self.seams.stretches[*number];
                let chords = self.samples[stretch.seam].len().saturating_sub(1);
                if index < chords {
                    let at = if stretch.forward { index } else { chords - 1 - index };
                    wanted.entry(stretch.seam).or_default().insert(at);
                    if chord.crossed {
                        crossed.insert(stretch.seam);
                    }
                    break;
                }
                index -= chords;
            }
        }
        let mut faces = BTreeSet::new();
        for (seam, mut chords) in wanted {
            let first = &self.seams.stretches[self.seams.seams[seam].stretches[0]];
            // A side that is a point has nothing to be divided.
            if let Some((face, run)) = run_of(self.faces, &first.address) {
                let samples = &self.samples[seam];
                chords.retain(|k| {
                    let [a, b] = [samples[*k], samples[*k + 1]];
                    let middle = run.point(0.5 * (a.s + b.s));
                    middle.distance(a.point).max(middle.distance(b.point)) > POINT * face.tolerance()
                });
            }
            if chords.is_empty() || self.samples[seam].len() > self.most[seam] {
                continue;
            }
            faces.extend(
                self.seams.seams[seam].stretches.iter().map(|k| self.seams.stretches[*k].address.face),
            );
            self.plain[seam] |= crossed.contains(&seam);
            let plain = self.plain[seam];
            if plain && self.samples[seam].iter().any(|s| s.off != DVec3::ZERO) {
                self.samples[seam] =
                    self.seams.divide(seam, self.faces, self.parts[seam], true, self.gaps[seam]);
            } else if is_common(chords.len(), self.samples[seam].len().saturating_sub(1)) {
                let again = STEP.powi(steps.min(MOST_STEPS));
                self.parts[seam] *= if crossed.contains(&seam) { CROSSED_STEP.min(again) } else { again };
                self.samples[seam] =
                    self.seams.divide(seam, self.faces, self.parts[seam], plain, self.gaps[seam]);
            } else if let Some((_, run)) = run_of(self.faces, &first.address) {
                for chord in chords.into_iter().rev() {
                    halve_chord(run, &mut self.samples[seam], chord);
                }
                self.seams.settle(seam, self.faces, self.gaps[seam], &mut self.samples[seam]);
            }
        }
        faces
    }
}
