//! How far two stretches of exact curves are apart: the largest and mean distance, with an estimate of the error.
//!
//! The squared distance `F(t)` of `a(t)` to the other curve is smooth, and its derivative is known without
//! differences: `F' = 2 (a - foot) . a'`. Intervals are bisected, at least twice, until the cubic through both ends (values and
//! slopes) foretells the middle; what it misses there, times `1/16` for the halves and a margin of 4, stands for
//! the error of the halves' cubics (it falls with the fourth power of the length). Intervals that cannot exceed
//! the largest value found by that are left. Every distance told is one that was measured between two points.

use super::gap::{Gap, GapEnd, GapSense};
use super::lifted::{CurvePoint, LiftedCurve};
use super::nearest::{nearest, nearest_from};

/// Relative accuracy of squared distances.
const ACCURACY: f64 = 1e-3;
/// Intervals are halved this often before a cubic is believed: rounded control points, of which real files are
/// full, make gaps of several humps to a polynomial piece, and one between two points is seen by neither.
const LEAST_DEPTH: u32 = 2;
/// Nodes of a curve's table for each interval to begin with.
const NODES: usize = 4;
/// Intervals to begin with at most, besides polynomial pieces.
const MOST_STOPS: usize = 32;
/// Points measured in one sweep at most.
const BUDGET: usize = 600;
/// Apart mainly along the normal: what is across is less than this part of the distance.
const STEP_RATIO: f64 = 0.3;

/// A foot is off by no more than this part of the distance; the distance is then right to its square.
const SLIP: f64 = 1e-3;
/// Ends of a closed curve are no further apart than this part of its length.
const CLOSED: f64 = 1e-6;

/// A stretch of a curve.
#[derive(Debug, Clone, Copy)]
pub struct Stretch<'a> {
    /// The curve.
    pub curve: &'a LiftedCurve,
    /// First and last parameter, rising.
    pub range: (f64, f64),
}

impl Stretch<'_> {
    /// Whether it is the whole of a curve that ends where it begins.
    fn is_closed(&self) -> bool {
        let [start, end] = self.curve.ends();
        self.range == self.curve.domain() && (end - start).length() <= CLOSED * self.curve.length()
    }
}

/// A measured point.
#[derive(Debug, Clone, Copy)]
struct Probe {
    from: CurvePoint,
    to: CurvePoint,
    distance: f64,
    /// Half the derivative of the squared distance.
    slope: f64,
}

struct Sweep<'a> {
    a: Stretch<'a>,
    b: Stretch<'a>,
    /// Distances below this are rounding.
    noise: f64,
    /// The largest distance found.
    best: Probe,
    /// No distance exceeds this.
    bound: f64,
    integral: f64,
    probes: usize,
}

/// The gap between two stretches, uses number `sides` of their edge; `forward` when they run the same way.
pub fn gap(a: Stretch<'_>, b: Stretch<'_>, forward: bool, sides: [usize; 2]) -> Gap {
    let there = Sweep::run(a, b, forward, None);
    let back = Sweep::run(b, a, forward, Some(there.best.distance));
    let there_is_best = there.best.distance >= back.best.distance;
    let best = if there_is_best { there.best } else { back.best };
    let bound = there.bound.max(back.bound).max(best.distance);
    let length = a.curve.length_to(a.range.1) - a.curve.length_to(a.range.0);
    let mean = if length > 0.0 { (there.integral / length).min(best.distance) } else { best.distance };
    let (mut first, mut second) = (best.from, best.to);
    if !there_is_best {
        std::mem::swap(&mut first, &mut second);
    }
    let Parts { sense, across, step, along } = parts(a.curve, &first, b.curve, &second, there.noise);
    let end = |side: usize, p: &CurvePoint| GapEnd { side, t: p.t, uv: p.uv, point: p.point };
    Gap {
        maximum: best.distance,
        error_bound: bound - best.distance + there.noise,
        mean,
        between: [end(sides[0], &first), end(sides[1], &second)],
        sense,
        across,
        step,
        along,
        angle: angle(a, b, forward, 2.0 * best.distance + there.noise),
    }
}

impl<'a> Sweep<'a> {
    /// Measures from `a` to `b`. With `known`, a distance found before, only what exceeds it is looked for.
    fn run(a: Stretch<'a>, b: Stretch<'a>, forward: bool, known: Option<f64>) -> Self {
        let noise = 8.0 * (a.curve.ground().rounding() + b.curve.ground().rounding());
        let (start, end) = a.range;
        let ends = if forward { [b.range.0, b.range.1] } else { [b.range.1, b.range.0] };
        let at_end = |t: f64, guess: f64| {
            let x = probe(a.curve, t, b, Some(guess));
            if x.distance <= noise {
                return x;
            }
            let y = probe(a.curve, t, b, None);
            if x.distance <= y.distance { x } else { y }
        };
        let (first, last) = (at_end(start, ends[0]), at_end(end, ends[1]));
        let best = if first.distance >= last.distance { first } else { last };
        let mut sweep = Self { a, b, noise, best, bound: 0.0, integral: 0.0, probes: 2 };
        let floor = known.unwrap_or(0.0);
        let mut stops: Vec<f64> = a.curve.breaks().filter(|t| *t > start && *t < end).collect();
        // Curves that need a finer table have gaps that swing more often.
        let swings = a.curve.nodes().len() / NODES;
        let least = if known.is_some() { 2 } else { swings.clamp(4, MOST_STOPS) };
        stops.extend((1..least).map(|k| start + (end - start) * k as f64 / least as f64));
        stops.sort_by(f64::total_cmp);
        stops.dedup_by(|x, y| *x - *y <= 1e-9 * (end - start));
        let mut probes = vec![first];
        for t in stops {
            let guess = sweep.between(&first, &last, t);
            probes.push(sweep.probe(t, guess));
        }
        probes.push(last);
        let least_depth = if known.is_some() { 1 } else { LEAST_DEPTH };
        let mut stack: Vec<(Probe, Probe, u32)> = probes.windows(2).rev().map(|w| (w[0], w[1], 0)).collect();
        while let Some((p, q, depth)) = stack.pop() {
            let (t0, t1) = (p.from.t, q.from.t);
            let t = 0.5 * (t0 + t1);
            let m = sweep.probe(t, sweep.between(&p, &q, t));
            let f = |x: &Probe| x.distance * x.distance;
            let h = t1 - t0;
            let foretold = 0.5 * (f(&p) + f(&q)) + 0.25 * h * (p.slope - q.slope);
            let miss = (foretold - f(&m)).abs();
            let halves = [(p, m), (m, q)].map(|(p, q)| cubic_top(&p, &q));
            // Slopes of distances that are rounding foretell nothing.
            let lost = [&p, &m, &q].iter().all(|x| x.distance <= sweep.noise);
            let top = if lost { 0.0 } else { halves[0].1.max(halves[1].1) + 0.25 * miss };
            let most = sweep.best.distance.max(floor).max(sweep.noise);
            let foretold_well = miss <= ACCURACY * most * most || top <= most * most;
            let settled = lost || (depth >= least_depth && foretold_well);
            let tired = depth >= 24 || sweep.probes >= BUDGET;
            if settled || tired {
                let half = if halves[0].1 >= halves[1].1 { (p, m, halves[0]) } else { (m, q, halves[1]) };
                if !lost && half.2.1 > most * most {
                    sweep.climb(half.0, half.1, half.2.0);
                }
                sweep.bound = sweep.bound.max(top.max(0.0).sqrt());
                let weighted = |x: &Probe| x.distance * x.from.tangent.length();
                sweep.integral += h / 6.0 * (weighted(&p) + 4.0 * weighted(&m) + weighted(&q));
            } else {
                stack.push((m, q, depth + 1));
                stack.push((p, m, depth + 1));
            }
        }
        sweep
    }

    /// The foot's parameter foretold at `t` from two probes.
    fn between(&self, p: &Probe, q: &Probe, t: f64) -> (f64, f64) {
        let s = (t - p.from.t) / (q.from.t - p.from.t);
        (p.to.t + (q.to.t - p.to.t) * s, p.distance.max(q.distance))
    }

    /// Measures at `t`; `(guess, usual)` are the foot's likely parameter and a distance that is not surprising.
    fn probe(&mut self, t: f64, (guess, usual): (f64, f64)) -> Probe {
        self.probes += 1;
        let mut found = probe(self.a.curve, t, self.b, Some(guess));
        if found.distance > 2.0 * usual + self.noise || !self.rests(&found) {
            let other = probe(self.a.curve, t, self.b, None);
            if other.distance < found.distance {
                found = other;
            }
        }
        if found.distance > self.best.distance {
            self.best = found;
        }
        found
    }

    /// Whether the search for a foot came to rest: at an end, or where the way there is perpendicular to the curve. A
    /// guess on the wrong side of a closed curve leads nowhere in the steps that it has.
    fn rests(&self, found: &Probe) -> bool {
        let foot = &found.to;
        let slip = (foot.point - found.from.point).dot(foot.tangent).abs();
        foot.t == self.b.range.0
            || foot.t == self.b.range.1
            || slip <= (SLIP * found.distance + self.noise) * foot.tangent.length()
    }

    /// Looks for the top between two probes, where the slope changes its sign.
    fn climb(&mut self, mut p: Probe, mut q: Probe, mut t: f64) {
        for _ in 0..8 {
            let m = self.probe(t, self.between(&p, &q, t));
            if m.slope > 0.0 {
                p = m
            } else {
                q = m
            }
            let next = cubic_top(&p, &q).0;
            if (next - t).abs() <= 1e-4 * (q.from.t - p.from.t) || !(next > p.from.t && next < q.from.t) {
                break;
            }
            t = next;
        }
    }
}

fn probe(a: &LiftedCurve, t: f64, b: Stretch<'_>, guess: Option<f64>) -> Probe {
    let from = a.at(t);
    let mut found = match guess {
        Some(guess) => nearest_from(b.curve, from.point, b.range, guess),
        None => nearest(b.curve, from.point, b.range),
    };
    // A closed curve goes on where it ends.
    let (first, last) = b.range;
    if (found.at.t == first || found.at.t == last) && b.is_closed() {
        let other = nearest_from(b.curve, from.point, b.range, first + last - found.at.t);
        if other.distance < found.distance {
            found = other;
        }
    }
    let slope = (from.point - found.at.point).dot(from.tangent);
    Probe { from, to: found.at, distance: found.distance, slope }
}

/// Where the cubic of the squared distance between two probes is largest, and its value there.
fn cubic_top(p: &Probe, q: &Probe) -> (f64, f64) {
    let h = q.from.t - p.from.t;
    let (f0, f1) = (p.distance * p.distance, q.distance * q.distance);
    let (d0, d1) = (2.0 * h * p.slope, 2.0 * h * q.slope);
    let (c2, c3) = (3.0 * (f1 - f0) - 2.0 * d0 - d1, 2.0 * (f0 - f1) + d0 + d1);
    let value = |s: f64| f0 + s * (d0 + s * (c2 + s * c3));
    let mut best = if f0 >= f1 { (p.from.t, f0) } else { (q.from.t, f1) };
    let discriminant = c2 * c2 - 3.0 * c3 * d0;
    if discriminant >= 0.0 {
        // Roots of d0 + 2 c2 s + 3 c3 s^2, without cancellation.
        let w = -(c2 + discriminant.sqrt().copysign(c2));
        for s in [w / (3.0 * c3), d0 / w] {
            if s > 0.0 && s < 1.0 && value(s) > best.1 {
                best = (p.from.t + h * s, value(s));
            }
        }
    }
    best
}

/// The way from one side to the other, taken apart.
struct Parts {
    sense: GapSense,
    /// Across the edge, overlaps positive.
    across: f64,
    /// Along the normal.
    step: f64,
    /// Along the edge: where one side ends before the other.
    along: f64,
}

/// How two points of two sides lie to each other.
fn parts(a: &LiftedCurve, p: &CurvePoint, b: &LiftedCurve, q: &CurvePoint, noise: f64) -> Parts {
    let apart = q.point - p.point;
    let distance = apart.length();
    if distance <= noise {
        return Parts { sense: GapSense::Closed, across: 0.0, step: 0.0, along: 0.0 };
    }
    let axis = match (a.inward(p.t), b.inward(q.t)) {
        // From the middle of a's face to the middle of b's is against this.
        (Some(x), Some(y)) => (x - y).try_normalize().or(Some(x)),
        (Some(x), None) => Some(x),
        (None, Some(y)) => Some(-y),
        (None, None) => None,
    };
    let Some(axis) = axis else {
        return Parts { sense: GapSense::Opening, across: -distance, step: 0.0, along: 0.0 };
    };
    let across = apart.dot(axis);
    let rest = apart - axis * across;
    // A foot inside the stretches is perpendicular to them; beside an end it need not be.
    let tangent = (p.tangent - axis * axis.dot(p.tangent)).try_normalize();
    let along = tangent.map_or(0.0, |t| rest.dot(t).abs());
    let step = (rest.length_squared() - along * along).max(0.0).sqrt();
    let sense = if step >= STEP_RATIO.hypot(1.0).recip() * distance {
        GapSense::Step
    } else if across > STEP_RATIO * distance {
        GapSense::Overlap
    } else {
        GapSense::Opening
    };
    Parts { sense, across, step, along }
}

/// Largest angle between the tangent planes at a few points along, `usual` being a distance between
/// the sides that is no surprise.
fn angle(a: Stretch<'_>, b: Stretch<'_>, forward: bool, usual: f64) -> f64 {
    let at = |s: f64| {
        let t = a.range.0 + (a.range.1 - a.range.0) * s;
        let across = if forward { s } else { 1.0 - s };
        let guess = b.range.0 + (b.range.1 - b.range.0) * across;
        let point = a.curve.at(t).point;
        let mut foot = nearest_from(b.curve, point, b.range, guess);
        if foot.distance > usual {
            foot = nearest(b.curve, point, b.range);
        }
        let (x, y) = (a.curve.inward(t)?, b.curve.inward(foot.at.t)?);
        Some(2.0 * (x + y).length().atan2((x - y).length()))
    };
    [0.02, 0.26, 0.5, 0.74, 0.98].into_iter().filter_map(at).fold(0.0, f64::max)
}
