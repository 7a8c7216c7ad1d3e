//! Vertices inside a face until every triangle is close enough to the surface.
//!
//! Triangles wait in a queue, the worst first. A triangle is divided on the edge that bends most away from the
//! surface, or in its middle where no edge stands out or that edge bounds the face. Chords of the boundary are never divided
//! here, for neighbours share them: those that keep a triangle from its tolerance are handed back.

use std::cmp::Ordering;
use std::collections::{BTreeSet, BinaryHeap};

use glam::{DVec2, DVec3};
use spade::handles::FixedVertexHandle;

use super::flatness::Flatness;
use super::judgement::{Estimate, Found};
use super::line_error::distance_to_segment;
use super::options::{TessellateError, TessellationOptions};
use super::outline::Ground;
use super::patience::Patience;
use super::places::Places;
use super::placing::{Middles, Vertices};
use super::plane::Plane;
use super::seed::Seed;
use super::triangulate::{Chord, Region};
use crate::kernel::trim::UvRect;

/// Everything a refinement looks at.
pub struct Refinement<'a> {
    /// The surface.
    pub ground: &'a Ground<'a>,
    /// Proven bounds, when they are asked for.
    pub flatness: Option<&'a Flatness<'a>>,
    /// The plane of a flat surface, on which only length counts; places in the triangulation lie on it.
    pub plane: Option<&'a Plane>,
    /// The tolerance and the other limits.
    pub options: &'a TessellationOptions,
    /// Places in the triangulation; for planes the place is found by position.
    pub places: &'a Places,
    /// Rectangle of the face.
    pub domain: UvRect,
    /// Points of the surface in the middles of edges, by the numbers of their ends: most edges bound two triangles.
    pub middles: Middles,
    /// How much more is tried.
    pub patience: Patience,
}

/// Triangles round a vertex that are estimated before any is proved.
const MOST_AROUND: usize = 16;

/// What came of a refinement.
#[derive(Debug, Clone, Default)]
pub struct Refined {
    /// Largest error of the triangles that were within the tolerance.
    pub error: f64,
    /// Triangles that stayed over the tolerance.
    pub over: usize,
    /// Chords of the boundary that kept them there.
    pub stubborn: BTreeSet<Chord>,
    /// Whether it was given up for them.
    pub unfinished: bool,
}

impl Refined {
    /// Leaves a triangle as it is.
    fn give_up(&mut self, task: &Task) {
        self.over += usize::from(task.over);
        self.error = self.error.max(task.error);
    }
}

/// A triangle to look at.
struct Task {
    /// Its worst measure over its limit: above 1 it must be divided.
    excess: f64,
    corners: [FixedVertexHandle; 3],
    divide: Divide,
    error: f64,
    /// Whether it is the tolerance that it is over.
    over: bool,
    /// How much nearer to the surface its corners are put before it is divided.
    lower: [f64; 3],
    cause: Cause,
}

/// What a triangle is divided for.
#[derive(Clone, Copy, PartialEq)]
enum Cause {
    Distance,
    /// It looks away from the surface.
    Fold,
    /// Its edges or angles.
    Size,
}

#[derive(Clone, Copy, PartialEq)]
enum Divide {
    Edge(usize),
    /// On an edge, at this share of it.
    At(usize, f64),
    Middle,
}

impl PartialEq for Task {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Task {}
impl PartialOrd for Task {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Task {
    fn cmp(&self, other: &Self) -> Ordering {
        let order = |t: &Self| t.corners.map(|c| c.index());
        self.excess.total_cmp(&other.excess).then_with(|| order(other).cmp(&order(self)))
    }
}

/// Edges that bring in less than this share of the allowed error are not divided for it.
const STANDS_OUT: f64 = 0.55;
/// A boundary chord that alone brings in this share of the allowed error is at fault itself.
const AT_FAULT: f64 = 0.985;
/// Vertices stay away from chords by this multiple of what the chord bends.
const NEAR: f64 = 1.5;
/// Lattice vertices keep this part of their spacing from others and from chords.
const CLEAR: f64 = 0.45;
/// Triangles with corners off the surface may be this part of the tolerance worse than these.
const LEAST: f64 = 0.5;
/// Edges shorter than this part of the face's parameters are not divided.
const SHORTEST: f64 = 1e-7;

impl Refinement<'_> {
    /// Divides triangles of `region` until all limits hold. A `draft` is given up before bounds are asked for where chords of
    /// the boundary are in the way.
    ///
    /// # Errors
    /// Too many triangles, or called off.
    pub fn run(
        &self,
        region: &mut Region,
        vertices: &mut Vertices,
        draft: bool,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<Refined, TessellateError> {
        let mut refined = Refined::default();
        // Bounds are dear: they wait until points of the surface have nothing more to say.
        let passes: &[bool] =
            if self.flatness.is_some() && self.plane.is_none() { &[false, true] } else { &[true] };
        for prove in passes {
            (refined.error, refined.over) = (0.0, 0);
            self.pass(region, vertices, &mut refined, *prove, cancelled)?;
            if draft && !refined.stubborn.is_empty() {
                refined.unfinished = true;
                break;
            }
        }
        Ok(refined)
    }

    /// Divides triangles that are over a limit, by estimates or proven errors.
    fn pass(
        &self,
        region: &mut Region,
        vertices: &mut Vertices,
        refined: &mut Refined,
        prove: bool,
        cancelled: &dyn Fn() -> bool,
    ) -> Result<(), TessellateError> {
        let mut queue: BinaryHeap<Task> = BinaryHeap::new();
        let first: Vec<_> = region.corners().collect();
        for corners in first {
            self.judge(region, vertices, corners, &mut queue, refined, prove);
        }
        let mut steps = 0usize;
        let mut around = Vec::new();
        while let Some(task) = queue.pop() {
            steps += 1;
            if steps.is_multiple_of(256) && cancelled() {
                return Err(TessellateError::Cancelled);
            }
            let Some(bounds) = region.standing(task.corners) else { continue };
            let numbers = task.corners.map(|c| region.number(c));
            match task.cause {
                // As far as distance goes it may be as near as asked.
                Cause::Fold if !self.patience.has_folds() => {
                    self.judge(region, vertices, task.corners, &mut queue, refined, prove);
                    continue;
                }
                Cause::Fold => self.patience.fold(),
                Cause::Distance if !self.patience.divide(self.ground, self.options.tolerance) => {
                    refined.give_up(&task);
                    continue;
                }
                Cause::Distance | Cause::Size => {}
            }
            if self.lower(region, vertices, &task, &mut around) {
                for corners in around.drain(..) {
                    self.judge(region, vertices, corners, &mut queue, refined, prove);
                }
                continue;
            }
            let uv = numbers.map(|n| vertices.uvs[n as usize]);
            let at = match task.divide {
                Divide::At(k, t) if !bounds[k] && self.places.is_even() => uv[k].lerp(uv[(k + 1) % 3], t),
                Divide::Edge(k) | Divide::At(k, _) if !bounds[k] => {
                    self.places.middle([uv[k], uv[(k + 1) % 3]])
                }
                _ => self.places.middle(uv),
            };
            if let Some(k) = self.too_near_a_chord(vertices, &numbers, &bounds, at) {
                refined.stubborn.insert([numbers[k], numbers[(k + 1) % 3]]);
                refined.give_up(&task);
                continue;
            }
            let mut done = self.put(region, vertices, at, task.corners[0]);
            if done.is_none() && task.divide != Divide::Middle {
                done = self.put(region, vertices, self.places.middle(uv), task.corners[0]);
            }
            match done {
                Some(around) => {
                    for corners in around {
                        self.judge(region, vertices, corners, &mut queue, refined, prove);
                    }
                }
                None => refined.give_up(&task),
            }
            if region.len() > self.options.triangle_limit {
                return Err(TessellateError::TooManyTriangles { limit: self.options.triangle_limit });
            }
        }
        Ok(())
    }

    /// Puts lattice vertices inside, those that keep their distance from vertices and chords.
    pub(super) fn sow(&self, region: &mut Region, vertices: &mut Vertices, seeds: &[Seed]) {
        let Some(mut hint) = region.corners().next().map(|c| c[0]) else { return };
        for seed in seeds {
            let clear = 1.0 / (seed.spacing * CLEAR);
            let Some(corners) = region.around(self.places.of(seed.uv), hint) else { continue };
            hint = corners[0];
            let Some(bounds) = region.standing(corners) else { continue };
            let at = corners.map(|c| (vertices.uvs[region.number(c) as usize] - seed.uv) * clear);
            let near = (0..3).any(|k| {
                let (a, b) = (at[k], at[(k + 1) % 3]);
                let along = (b - a) * (-a.dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                a.length_squared() < 1.0 || bounds[k] && (a + along).length_squared() < 1.0
            });
            if !near && let Some(around) = self.put(region, vertices, seed.uv, hint) {
                hint = around.first().map_or(hint, |t| t[0]);
            }
        }
    }

    /// The boundary chord of a triangle that a new vertex would lie so near to, for how much it bends, that the
    /// triangle between them could fold over.
    fn too_near_a_chord(
        &self,
        vertices: &Vertices,
        numbers: &[u32; 3],
        bounds: &[bool; 3],
        at: DVec2,
    ) -> Option<usize> {
        if self.plane.is_some() {
            return None;
        }
        let p = self.ground.point(at);
        (0..3).filter(|k| bounds[*k]).find(|k| {
            let [a, b] = [numbers[*k], numbers[(k + 1) % 3]].map(|n| n as usize);
            let middle = self.ground.point(0.5 * (vertices.uvs[a] + vertices.uvs[b]));
            let (from, to) = (vertices.positions[a], vertices.positions[b]);
            let sagitta = distance_to_segment(middle, from, to);
            distance_to_segment(p, from, to) < NEAR * sagitta
        })
    }

    fn put(
        &self,
        region: &mut Region,
        vertices: &mut Vertices,
        uv: DVec2,
        hint: FixedVertexHandle,
    ) -> Option<Vec<[FixedVertexHandle; 3]>> {
        let number = vertices.uvs.len() as u32;
        let place =
            self.plane.map_or_else(|| self.places.of(uv), |plane| plane.coordinates(self.ground.point(uv)));
        let mut around = region.insert(place, number, hint)?;
        self.add_balanced(vertices, uv);
        if self.options.balanced && self.plane.is_none() {
            self.settle(region, vertices, number, &mut around);
        }
        Some(around)
    }

    /// Puts corners of a triangle that are too high for how the surface bends nearer to it, and the triangles there into
    /// `around`; whether there were any.
    fn lower(
        &self,
        region: &Region,
        vertices: &mut Vertices,
        task: &Task,
        around: &mut Vec<[FixedVertexHandle; 3]>,
    ) -> bool {
        for (corner, less) in task.corners.iter().zip(task.lower).filter(|c| c.1 > 0.0) {
            let k = region.number(*corner) as usize;
            let most = vertices.upright[k].distance(vertices.on_surface[k]) - less;
            if vertices.lower(k, most.max(0.0)) {
                around.extend(region.star(*corner));
            }
        }
        !around.is_empty()
    }

    /// Measures a triangle; queues it when it is over a limit.
    fn judge(
        &self,
        region: &Region,
        vertices: &Vertices,
        corners: [FixedVertexHandle; 3],
        queue: &mut BinaryHeap<Task>,
        refined: &mut Refined,
        prove: bool,
    ) {
        let numbers = corners.map(|c| region.number(c));
        let uv = numbers.map(|n| vertices.uvs[n as usize]);
        let allowed = self.allowed(vertices, &numbers);
        let normals = numbers.map(|n| vertices.normals[n as usize]);
        let Found { error, shares, crease, lower, folded } = self.error(vertices, numbers, allowed, prove);
        let mut excess = error / allowed;
        let mut cause = if folded { Cause::Fold } else { Cause::Distance };
        let Some(bounds) = region.standing(corners) else { return };
        let mut divide = self.weakest(&bounds, shares, allowed, (vertices, &numbers), refined, excess > 1.0);
        if let Some((k, t)) = crease
            && excess > 1.0
        {
            if !bounds[k] {
                divide = Some(Divide::At(k, t));
            } else {
                refined.stubborn.insert([numbers[k], numbers[(k + 1) % 3]]);
            }
        }
        let corners_at = numbers.map(|n| vertices.positions[n as usize]);
        let lengths = [0, 1, 2].map(|k| corners_at[k].distance(corners_at[(k + 1) % 3]));
        if let Some(longest) = self.options.max_edge {
            let worst = free_longest(&lengths, &bounds);
            if let Some(k) = worst
                && lengths[k] / longest > excess.max(1.0)
            {
                (excess, divide, cause) = (lengths[k] / longest, Some(Divide::Edge(k)), Cause::Size);
            }
        }
        if let Some(limit) = self.options.max_angle
            && !self.plane.is_some()
        {
            let angles = [0, 1, 2].map(|k| normals[k].angle_between(normals[(k + 1) % 3]));
            for k in (0..3).filter(|k| bounds[*k] && angles[*k] > limit) {
                refined.stubborn.insert([numbers[k], numbers[(k + 1) % 3]]);
            }
            let angle = angles.into_iter().fold(0.0, f64::max);
            if angle / limit > excess.max(1.0) {
                (excess, cause) = (angle / limit, Cause::Size);
                divide = Some(free_longest(&lengths, &bounds).map_or(Divide::Middle, Divide::Edge));
            }
        }
        if !(excess > 1.0) {
            refined.error = refined.error.max(error);
            return;
        }
        let shorter = |axis: usize| {
            let part = |k: usize| self.places.part(axis, uv[k][axis], uv[(k + 1) % 3][axis]);
            (0..3).all(|k| part(k) < SHORTEST)
        };
        let small = shorter(0) && shorter(1);
        let over = !(error <= allowed);
        let task = |divide| Task { excess, corners, divide, error, over, lower, cause };
        match divide {
            Some(divide) if !small => queue.push(task(divide)),
            _ => refined.give_up(&task(Divide::Middle)),
        }
    }

    /// Where to divide a triangle; `None` when only boundary chords are at fault.
    fn weakest(
        &self,
        bounds: &[bool; 3],
        shares: [f64; 3],
        allowed: f64,
        (vertices, numbers): (&Vertices, &[u32; 3]),
        refined: &mut Refined,
        over: bool,
    ) -> Option<Divide> {
        let free = (0..3).filter(|k| !bounds[*k]);
        let best = free.max_by(|a, b| shares[*a].total_cmp(&shares[*b]));
        let bound_worst = (0..3).filter(|k| bounds[*k]).max_by(|a, b| shares[*a].total_cmp(&shares[*b]));
        if over {
            // As a triangle shrinks towards a chord its error tends to the chord's, which dividing does not change.
            let mut stuck = false;
            for k in (0..3).filter(|k| bounds[*k]) {
                let n = [numbers[k], numbers[(k + 1) % 3]];
                let off = match self.flatness {
                    Some(flatness) => flatness.chord(
                        n.map(|n| vertices.uvs[n as usize]),
                        n.map(|n| vertices.upright[n as usize]),
                        AT_FAULT * allowed,
                    ),
                    None => shares[k],
                };
                if off > AT_FAULT * allowed {
                    refined.stubborn.insert(n);
                    stuck = true;
                }
            }
            if stuck && best.is_none_or(|b| shares[b] < AT_FAULT * allowed) {
                return None;
            }
        }
        match best {
            Some(k) if shares[k] > STANDS_OUT * shares.iter().sum::<f64>().min(2.0 * allowed) => {
                Some(Divide::Edge(k))
            }
            Some(k) if bound_worst.is_none() && shares[k] > allowed => Some(Divide::Edge(k)),
            _ => Some(Divide::Middle),
        }
    }

    /// Whether all of some triangles keep the tolerance and the other limits. What is cheap to know comes first.
    pub fn hold(&self, vertices: &Vertices, triangles: impl Iterator<Item = [u32; 3]> + Clone) -> bool {
        let longest = self.options.max_edge.unwrap_or(f64::INFINITY);
        let widest = self.options.max_angle.unwrap_or(f64::INFINITY);
        let limits = longest.is_finite() || widest.is_finite();
        let within = |t: [u32; 3]| {
            [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])].iter().all(|(a, b)| {
                let (a, b) = (*a as usize, *b as usize);
                vertices.positions[a].distance(vertices.positions[b]) <= longest
                    && vertices.normals[a].angle_between(vertices.normals[b]) <= widest
            })
        };
        if limits && !triangles.clone().all(within) {
            return false;
        }
        let mut estimates = [Estimate::default(); MOST_AROUND];
        let mut count = 0;
        for (estimate, t) in estimates.iter_mut().zip(triangles.clone()) {
            let allowed = self.allowed(vertices, &t);
            *estimate = self.estimate(vertices, t, allowed, true);
            if !(estimate.error <= allowed) {
                return false;
            }
            count += 1;
        }
        triangles.enumerate().all(|(k, t)| {
            let allowed = self.allowed(vertices, &t);
            let estimate = if k < count { estimates[k] } else { self.estimate(vertices, t, allowed, true) };
            self.proven(vertices, t, &estimate, allowed).error <= allowed
        })
    }

    /// The tolerance; more at corners so far off the surface that no triangle there could keep it.
    fn allowed(&self, vertices: &Vertices, numbers: &[u32; 3]) -> f64 {
        let tolerance = self.options.tolerance;
        let gap = numbers.iter().map(|n| vertices.gaps[*n as usize]).fold(0.0, f64::max);
        tolerance.max(gap + LEAST * tolerance)
    }

    /// Whether a triangle could keep the tolerance with the surface's point `p` over it, as far as its plane goes.
    pub fn reaches(&self, vertices: &Vertices, triangle: &[u32; 3], p: DVec3) -> bool {
        let [a, b, c] = triangle.map(|n| vertices.upright[n as usize]);
        let normal = (b - a).cross(c - a);
        (p - a).dot(normal).abs() <= self.allowed(vertices, triangle) * normal.length()
    }
}

fn free_longest(lengths: &[f64; 3], bounds: &[bool; 3]) -> Option<usize> {
    (0..3).filter(|k| !bounds[*k]).max_by(|a, b| lengths[*a].total_cmp(&lengths[*b]))
}
