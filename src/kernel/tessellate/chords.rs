//! Trim curves to chords (P2, section 5.1).
//!
//! [`CurveDivision::Even`] integrates the number of chords that curvature, angle and length ask for along each smooth
//! stretch of a run and puts the vertices at even shares of it; every chord is then proved by its hull
//! ([`super::line_error::within`]) and divided further where that fails. The paper's two divisions work piece by piece.
//! The vertices depend on the run alone, so that faces which share it share them.

use glam::{DVec2, DVec3};

use super::balance::balanced;
use super::line_error::{farthest_point, line_error, part_within, point_error};
use super::options::{CurveDivision, CurveError, TessellationOptions};
use super::outline::Run;
use crate::kernel::bezier::BezierCurve3;

/// A vertex on a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeSample {
    /// Parameter on the run.
    pub s: f64,
    /// Native parameters of the face.
    pub uv: DVec2,
    /// Position that all faces at this edge share.
    pub point: DVec3,
    /// How far it was put off the curve, so that chords may be longer.
    pub off: DVec3,
}

/// What chords must keep to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChordLimits {
    /// Largest distance from the curve.
    pub tolerance: f64,
    /// Largest turn of the tangent along one chord, radians.
    pub angle: f64,
    /// Longest chord.
    pub length: f64,
    /// Whether vertices may be put off the curve for longer chords.
    pub balanced: bool,
}

/// Turn of a chord without a limit: a circle keeps three of them and two half circles two each.
const WIDEST_TURN: f64 = 2.0;
/// Joints that turn by more than this are corners, which keep a vertex (cosine).
const SMOOTH: f64 = 0.99;
/// Samples of the curvature of a stretch, about.
const PROBES: usize = 64;
/// Numbers of chords, each a fortieth more than the one before, that are tried before each goes as far as it can.
const ROUNDS: usize = 9;
/// Halvings of the step of such a chord.
const HALVINGS: usize = 40;
/// Runs within this part of the tolerance are points.
const NOTHING: f64 = 1e-6;
/// Most vertices on one stretch.
const MOST: f64 = 2e6;

impl ChordLimits {
    /// The limits that `options` set for curves.
    pub fn new(options: &TessellationOptions) -> Self {
        Self {
            tolerance: options.tolerance,
            angle: options.max_angle.unwrap_or(WIDEST_TURN).min(WIDEST_TURN),
            length: options.max_edge.unwrap_or(f64::INFINITY),
            balanced: options.balanced && !options.simplify,
        }
    }
}

/// Vertices of `run`, both ends included, `s` rising.
pub fn divide(run: &Run, limits: &ChordLimits, options: &TessellationOptions) -> Vec<EdgeSample> {
    let on_curve = |places: Vec<f64>| places.into_iter().map(|s| (s, DVec3::ZERO)).collect();
    let mut places: Vec<Place> = match options.curve_division {
        _ if is_nothing(run, NOTHING * limits.tolerance) => on_curve(vec![0.0, run.range()]),
        CurveDivision::Even => even(run, limits),
        other => on_curve(by_pieces(run, limits, other, options.curve_error)),
    };
    places.dedup_by(|b, a| a.0 == b.0);
    let sample = |(s, off): Place| EdgeSample { s, uv: run.uv(s), point: run.point(s) + off, off };
    places.into_iter().map(sample).collect()
}

/// The same for the part of a run between two parameters, `s` of the whole run.
pub fn divide_part(
    run: &Run,
    (from, to): (f64, f64),
    limits: &ChordLimits,
    options: &TessellationOptions,
) -> Vec<EdgeSample> {
    if from == 0.0 && to == run.range() {
        return divide(run, limits, options);
    }
    let (part, places) = run.part(from, to);
    let whole = |s: f64| {
        let k = (s as usize).min(places.len() - 2);
        places[k] + (places[k + 1] - places[k]) * (s - k as f64)
    };
    let mut samples = divide(&part, limits, options);
    let last = samples.len() - 1;
    for (k, sample) in samples.iter_mut().enumerate() {
        sample.s = if k == last { to } else { whole(sample.s) };
    }
    samples
}

/// Whether a run stays within `reach` of its start: a pole, whose curve is rounding.
fn is_nothing(run: &Run, reach: f64) -> bool {
    let start = run.point(0.0);
    run.pieces.iter().flat_map(|p| &p.space.points).all(|p| p.distance(start) <= reach)
}

/// A parameter on a run, and how far a vertex is put off it.
pub(super) type Place = (f64, DVec3);

fn even(run: &Run, limits: &ChordLimits) -> Vec<Place> {
    let mut places = vec![(0.0, DVec3::ZERO)];
    let mut first = 0;
    for k in 0..run.pieces.len() {
        let last = k + 1 == run.pieces.len();
        if last || !is_smooth(&run.pieces[k].space, &run.pieces[k + 1].space) {
            stretch(run, first, k + 1, limits, &mut places);
            first = k + 1;
        }
    }
    places
}

fn is_smooth(a: &BezierCurve3, b: &BezierCurve3) -> bool {
    let (x, y) = (a.tangent(1.0).1, b.tangent(0.0).1);
    x.dot(y) >= SMOOTH * x.length() * y.length()
}

/// Number of chords that each of `probes` parts of a piece asks for.
fn demand(curve: &BezierCurve3, limits: &ChordLimits, probes: usize) -> impl Iterator<Item = f64> {
    let step = 1.0 / probes as f64;
    (0..probes).map(move |k| {
        let jet = curve.jet((k as f64 + 0.5) * step);
        let speed = jet.d1.length();
        let bend = if speed > 0.0 { jet.d2.cross(jet.d1).length() / speed } else { jet.d2.length() };
        let sagitta = (bend / (8.0 * limits.tolerance)).sqrt();
        let turn = if speed > 0.0 { bend / speed / limits.angle } else { 0.0 };
        sagitta.max(turn).max(speed / limits.length) * step
    })
}

/// Divides the pieces `first..end` of a run, a smooth stretch.
fn stretch(run: &Run, first: usize, end: usize, limits: &ChordLimits, places: &mut Vec<Place>) {
    let line = |k: usize| run.pieces[k].space.degree() == 1;
    if end == first + 1 && line(first) && limits.length.is_infinite() {
        places.push((end as f64, DVec3::ZERO));
        return;
    }
    let simple = run.pieces[first..end].iter().all(|p| p.space.degree() <= 3);
    let probes = (PROBES / (end - first)).clamp(4, if simple { 8 } else { 16 });
    let demands: Vec<f64> =
        run.pieces[first..end].iter().flat_map(|p| demand(&p.space, limits, probes)).collect();
    let total: f64 = demands.iter().sum();
    let total = if total.is_finite() { total.min(MOST) } else { 1.0 };
    // Chords may be a percent too long for their share of the tolerance: the proof below decides.
    let strict = limits.length.is_finite() || limits.angle < WIDEST_TURN;
    let least = (total - if strict { 0.0 } else { 0.01 }).ceil().max(1.0) as usize;
    let offset = first as f64;
    if limits.balanced && least > 2 {
        let cuts = |weights: &[f64]| -> Vec<f64> {
            weighted_shares(&demands, weights, probes).into_iter().map(|c| offset + c).collect()
        };
        if let Some(found) = balanced(run, total, least, limits, &cuts) {
            places.extend(found);
            return;
        }
    }
    let mut before = 0;
    for round in 0..ROUNDS {
        let count = least + (least * round).div_ceil(40);
        let cuts = shares(&demands, count, probes);
        let fits = |c: &[f64]| {
            let (from, to) = (offset + c[0], offset + c[1]);
            run.point(from).distance(run.point(to)) <= limits.length
                && is_within(run, from, to, limits.tolerance)
        };
        if count > before && cuts.windows(2).all(fits) {
            places.extend(cuts[1..].iter().map(|c| (offset + c, DVec3::ZERO)));
            return;
        }
        before = count;
    }
    let mut ends = Vec::new();
    farthest(run, (offset, end as f64), limits, &mut ends);
    places.extend(ends.into_iter().map(|s| (s, DVec3::ZERO)));
}

/// Divides where even shares do not do (polylines, say, have no curvature but in their corners): each chord goes as far as it
/// can.
fn farthest(run: &Run, (start, end): (f64, f64), limits: &ChordLimits, places: &mut Vec<f64>) {
    let mut from = start;
    while from < end {
        let fits = |to: f64| {
            run.point(from).distance(run.point(to)) <= limits.length
                && is_within(run, from, to, limits.tolerance)
        };
        // Doubling steps, then halving the last: ends at joints where it can.
        let mut good = from;
        let mut step = 0.25;
        let mut bad = end;
        loop {
            let to = (from + step).min(end);
            if !fits(to) {
                bad = to;
                break;
            }
            good = to;
            if to >= end {
                break;
            }
            step *= 2.0;
        }
        for _ in 0..HALVINGS {
            if good >= end || good > from && bad - good < 0.05 * (good - from) {
                break;
            }
            let middle = 0.5 * (good + bad);
            let joint = middle.round();
            let to = if joint > good && joint < bad { joint } else { middle };
            if fits(to) {
                good = to;
            } else {
                bad = to;
            }
        }
        if !(good > from) {
            good = bad;
        }
        places.push(good);
        from = good;
        if places.len() as f64 > MOST {
            places.push(end);
            break;
        }
    }
}

/// `count + 1` parameters at even shares of the demand, the first 0 and the last the number of pieces.
fn shares(demands: &[f64], count: usize, probes: usize) -> Vec<f64> {
    weighted_shares(demands, &vec![1.0; count], probes)
}

/// The same at shares as large as given.
fn weighted_shares(demands: &[f64], weights: &[f64], probes: usize) -> Vec<f64> {
    let total: f64 = demands.iter().sum();
    let all: f64 = weights.iter().sum();
    let count = weights.len();
    let end = demands.len() as f64 / probes as f64;
    let mut cuts = vec![0.0];
    let (mut k, mut before, mut passed) = (0, 0.0, 0.0);
    for weight in &weights[..count - 1] {
        passed += weight;
        let target = total * passed / all;
        while k + 1 < demands.len() && before + demands[k] < target {
            before += demands[k];
            k += 1;
        }
        let part = if demands[k] > 0.0 { ((target - before) / demands[k]).clamp(0.0, 1.0) } else { 0.5 };
        cuts.push((k as f64 + part) / probes as f64);
    }
    cuts.push(end);
    if !total.is_finite() || cuts.windows(2).any(|c| c[1] <= c[0]) {
        return (0..=count).map(|i| end * i as f64 / count as f64).collect();
    }
    cuts
}

/// Whether the part of a run between two parameters lies within `tolerance` of its chord.
pub(super) fn is_within(run: &Run, from: f64, to: f64, tolerance: f64) -> bool {
    is_within_chord(run, (from, to), [run.point(from), run.point(to)], tolerance)
}

/// The same for a chord that starts and ends off the curve.
pub(super) fn is_within_chord(run: &Run, (from, to): (f64, f64), [a, b]: [DVec3; 2], tolerance: f64) -> bool {
    let (first, last) = (from as usize, (to.ceil() as usize).clamp(1, run.pieces.len()));
    (first..last).all(|k| {
        let curve = &run.pieces[k].space;
        let (low, high) = ((from - k as f64).max(0.0), (to - k as f64).min(1.0));
        part_within(curve, (low, high), (a, b), tolerance)
    })
}

/// The paper's way: each piece by itself, halved or divided at the farthest control point.
fn by_pieces(run: &Run, limits: &ChordLimits, division: CurveDivision, error: CurveError) -> Vec<f64> {
    fn part(
        curve: &BezierCurve3,
        (from, to): (f64, f64),
        limits: &ChordLimits,
        choice: (CurveDivision, CurveError),
        depth: u32,
        places: &mut Vec<f64>,
    ) {
        let off = match choice.1 {
            CurveError::Line => line_error(curve),
            CurveError::Point => point_error(curve),
        };
        let turn = curve.tangent(0.0).1.angle_between(curve.tangent(1.0).1);
        let long = curve.start().distance(curve.end()) > limits.length;
        if depth == 0 || !(off > limits.tolerance || turn > limits.angle || long) {
            places.push(to);
            return;
        }
        let t = match choice.0 {
            CurveDivision::ControlPoint if curve.degree() > 1 => {
                farthest_point(curve) as f64 / curve.degree() as f64
            }
            _ => 0.5,
        };
        let middle = from + (to - from) * t;
        let (left, right) = curve.split(t);
        part(&left, (from, middle), limits, choice, depth - 1, places);
        part(&right, (middle, to), limits, choice, depth - 1, places);
    }
    let mut places = vec![0.0];
    for (k, piece) in run.pieces.iter().enumerate() {
        let range = (k as f64, (k + 1) as f64);
        part(&piece.space, range, limits, (division, error), 24, &mut places);
    }
    places
}

/// Whether so many of a run's chords are too long that it is divided anew.
pub fn is_common(long: usize, all: usize) -> bool {
    all > 2 && 3 * long >= all
}

/// What the tolerance of a run that is divided anew shrinks by.
pub const STEP: f64 = 0.8;
/// The same where chords cross others: walls may be much thinner than the tolerance.
pub const CROSSED_STEP: f64 = 0.4;

/// Puts a vertex in the middle of a chord, or near it where pieces of the run meet: creases of the surface lie there.
pub fn halve_chord(run: &Run, samples: &mut Vec<EdgeSample>, index: usize) {
    let (a, b) = (samples[index].s, samples[index + 1].s);
    let middle = 0.5 * (a + b);
    let joint = middle.round();
    let s = if (joint - middle).abs() < 0.3 * (b - a) { joint } else { middle };
    if s > a && s < b {
        samples.insert(index + 1, EdgeSample { s, uv: run.uv(s), point: run.point(s), off: DVec3::ZERO });
    }
}
