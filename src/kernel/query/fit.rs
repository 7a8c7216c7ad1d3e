//! Fitting a uv curve to a function: cubic Hermite pieces, halved until they are near enough.
//!
//! Each piece takes positions and derivatives from the function at its ends, so that the error falls
//! with the fourth power of its length. Where the result is a straight line, a line is returned.

use glam::DVec2;

use crate::kernel::nurbs::{KnotVector, NurbsCurve2};

/// Halvings of one piece at most; beyond it the deviation reached is reported.
const DEPTH: u32 = 16;
/// Pieces of one curve at most.
const MOST_PIECES: usize = 1000;
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

impl Halvings {
    const NONE: Self = Self { depth: 0, stalls: 0, before: f64::INFINITY };
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
    let mut near = near;
    let mut checks = Vec::new();
    let mut pieces = Vec::new();
    for span in breaks.windows(2) {
        let start = target.sample(span[0], near, 1);
        let end = target.sample_towards(start.uv, span[0], span[1]);
        near = Some(end.uv);
        pieces.push(Piece { a: span[0], b: span[1], start, end, history: Halvings::NONE, settled: None });
    }
    // All pieces are halved once before any is halved twice: should their number run out, no part of the
    // curve is left much coarser than the rest.
    while pieces.iter().any(|p| p.settled.is_none()) {
        let mut count = pieces.len();
        let mut next = Vec::with_capacity(2 * count);
        for mut piece in pieces {
            if piece.settled.is_some() {
                next.push(piece);
                continue;
            }
            match piece.refine(target, tolerance, count < MOST_PIECES, &mut checks) {
                Some(halves) => {
                    count += 1;
                    next.extend(halves);
                }
                None => next.push(piece),
            }
        }
        pieces = next;
    }
    let worst = pieces.iter().filter_map(|p| p.settled).fold(0.0, f64::max);
    let mut knots = Vec::with_capacity(3 * pieces.len() + 5);
    let mut points = Vec::with_capacity(3 * pieces.len() + 1);
    for piece in &pieces {
        let nodes = piece.nodes();
        if points.is_empty() {
            points.push(nodes[0]);
            knots.push(piece.a);
        }
        knots.extend([piece.a; 3]);
        points.extend(&nodes[1..]);
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

/// One cubic of the fit.
struct Piece {
    a: f64,
    b: f64,
    start: Sample,
    end: Sample,
    history: Halvings,
    /// Its deviation, once it is not to be halved any more.
    settled: Option<f64>,
}

impl Piece {
    /// Bezier control points.
    fn nodes(&self) -> [DVec2; 4] {
        let third = (self.b - self.a) / 3.0;
        [
            self.start.uv,
            self.start.uv + self.start.derivative * third,
            self.end.uv - self.end.derivative * third,
            self.end.uv,
        ]
    }

    /// Measures the piece: its halves when it needs halving and `may_split`, else it is settled.
    fn refine(
        &mut self,
        target: &mut dyn Target,
        tolerance: f64,
        may_split: bool,
        checks: &mut Vec<DVec2>,
    ) -> Option<[Self; 2]> {
        let (h, nodes) = (self.b - self.a, self.nodes());
        let mut deviation = 0.0_f64;
        let mut at_middle = self.start;
        for s in [0.25, 0.5, 0.75] {
            let guess = cubic(&nodes, s);
            let exact = target.sample(self.a + s * h, Some(guess), 1);
            deviation = deviation.max(target.distance(guess, exact.uv));
            checks.push(exact.uv);
            if s == 0.5 {
                at_middle = exact;
            }
        }
        let Halvings { depth, stalls, before } = self.history;
        let stalls = stalls + u32::from(deviation > GAIN * before);
        let middle = self.a + 0.5 * h;
        let hopeful = depth < DEPTH && stalls <= STALLS && may_split && middle > self.a && middle < self.b;
        if !(hopeful && (depth == 0 || deviation > tolerance)) {
            self.settled = Some(deviation);
            return None;
        }
        let history = Halvings { depth: depth + 1, stalls, before: deviation };
        let half = |a, b, start, end| Self { a, b, start, end, history, settled: None };
        Some([half(self.a, middle, self.start, at_middle), half(middle, self.b, at_middle, self.end)])
    }
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
