//! Fitting a uv curve to a function: cubic Hermite pieces, halved until they are near enough.
//!
//! Each piece takes positions and derivatives from the function at its ends, so that the error falls
//! with the fourth power of its length. Where the result is a straight line, a line is returned.

use glam::DVec2;

use crate::kernel::nurbs::{KnotVector, NurbsCurve2};

/// Halvings of one piece at most; beyond it the deviation reached is reported.
const DEPTH: u32 = 10;
/// Pieces of one curve at most.
const MOST_PIECES: usize = 300;
/// Halving must at least do this to the deviation, or it is not the length of the piece that is wrong.
const GAIN: f64 = 0.7;
/// Halvings without gain that are forgiven.
const STALLS: u32 = 3;

/// Position and derivative of the function at one parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Position.
    pub uv: DVec2,
    /// Derivative by the parameter.
    pub derivative: DVec2,
}

/// How a piece came about.
#[derive(Debug, Clone, Copy)]
struct Halvings {
    depth: u32,
    stalls: u32,
    /// Deviation of the piece it is a half of.
    before: f64,
}

/// A curve to fit.
pub trait Target {
    /// The function at `t`, on the branch next to `near`. `side` says from which side derivatives are
    /// meant where the function has a corner: -1 from below, +1 from above.
    fn sample(&mut self, t: f64, near: Option<DVec2>, side: i32) -> Sample;
    /// How far apart two parameter points count (a length in model space).
    fn distance(&mut self, a: DVec2, b: DVec2) -> f64;
}

/// Fits over `breaks` (increasing, two or more; corners of the function must be among them) to
/// `tolerance`. Returns the curve and the largest deviation found.
pub fn fit(
    target: &mut dyn Target,
    breaks: &[f64],
    near: Option<DVec2>,
    tolerance: f64,
) -> Option<(NurbsCurve2, f64)> {
    let mut knots = Vec::new();
    let mut points: Vec<DVec2> = Vec::new();
    let mut worst = 0.0_f64;
    let mut near = near;
    let mut checks = Vec::new();
    for span in breaks.windows(2) {
        let first = target.sample(span[0], near, 1);
        let last = target.sample_towards(first.uv, span[0], span[1]);
        let mut stack = vec![(
            (span[0], first),
            (span[1], last),
            Halvings { depth: 0, stalls: 0, before: f64::INFINITY },
        )];
        while let Some(((a, start), (b, end), history)) = stack.pop() {
            let h = b - a;
            let piece = [
                start.uv,
                start.uv + start.derivative * (h / 3.0),
                end.uv - end.derivative * (h / 3.0),
                end.uv,
            ];
            let mut deviation = 0.0_f64;
            let middle = 0.5 * (a + b);
            let mut at_middle = None;
            for s in [0.25, 0.5, 0.75] {
                let guess = cubic(&piece, s);
                let exact = target.sample(a + s * h, Some(guess), 1);
                deviation = deviation.max(target.distance(guess, exact.uv));
                checks.push(exact.uv);
                if s == 0.5 {
                    at_middle = Some(exact);
                }
            }
            let stalls = history.stalls + u32::from(deviation > GAIN * history.before);
            let hopeful = history.depth < DEPTH && stalls <= STALLS && points.len() < 3 * MOST_PIECES;
            let split = deviation > tolerance && hopeful && middle > a && middle < b;
            if let (true, Some(exact)) = (split || history.depth == 0, at_middle) {
                let next = Halvings { depth: history.depth + 1, stalls, before: deviation };
                stack.push(((middle, exact), (b, end), next));
                stack.push(((a, start), (middle, exact), next));
                continue;
            }
            worst = worst.max(deviation);
            if points.is_empty() {
                points.push(piece[0]);
                knots.extend([a; 4]);
            } else {
                knots.extend([a; 3]);
            }
            points.extend(&piece[1..]);
            near = Some(end.uv);
        }
    }
    let (start, end) = (*points.first()?, *points.last()?);
    knots.extend([*breaks.last()?; 4]);
    if is_straight(target, start, end, &checks, 0.1 * tolerance) {
        return Some((NurbsCurve2::line(start, end), worst));
    }
    let knots = KnotVector::new(3, knots).ok()?;
    let weights = vec![1.0; points.len()];
    Some((NurbsCurve2::new(knots, points, weights).ok()?, worst))
}

impl dyn Target + '_ {
    /// The sample at `end`, on the branch that continuing from `start` reaches.
    fn sample_towards(&mut self, mut uv: DVec2, start: f64, end: f64) -> Sample {
        const STRIDES: usize = 8;
        for k in 1..STRIDES {
            uv = self.sample(start + (end - start) * k as f64 / STRIDES as f64, Some(uv), -1).uv;
        }
        self.sample(end, Some(uv), -1)
    }
}

/// Whether all points lie on the segment, in order.
fn is_straight(target: &mut dyn Target, start: DVec2, end: DVec2, points: &[DVec2], tolerance: f64) -> bool {
    let chord = end - start;
    let length = chord.length_squared();
    if !(length > 0.0) {
        return false;
    }
    points.iter().all(|p| {
        let s = (*p - start).dot(chord) / length;
        (0.0..=1.0).contains(&s) && target.distance(start + chord * s, *p) <= tolerance
    })
}

fn cubic(p: &[DVec2; 4], s: f64) -> DVec2 {
    let r = 1.0 - s;
    p[0] * (r * r * r) + p[1] * (3.0 * r * r * s) + p[2] * (3.0 * r * s * s) + p[3] * (s * s * s)
}
