//! Stretches along which two curves run side by side.
//!
//! Where partners change, some curve ends: so the first curve is broken at the feet of the second one's ends, and
//! each stretch between is accepted or refused as a whole by a few points on it. Near is not enough: the
//! curves must run in parallel, much longer than they are apart, and where there is any distance between
//! them, their faces must not lie on top of each other (as the two skins of a thin sheet do).

use super::lifted::LiftedCurve;
use super::nearest::{Nearest, nearest};
use super::scale::{SLENDER, Scale};

/// Cosine of the largest angle between two sides of an edge.
const PARALLEL: f64 = 0.9;
/// Cosine between the directions into two faces, above which they are two skins and not neighbours.
const SKINS: f64 = 0.9;
/// The same where nothing is between them: sharp edges, as of a wing, are edges still.
const ONE_SKIN: f64 = 0.9998;
/// Where stretches are looked at, the middle first.
const LOOKS: [f64; 5] = [0.5, 0.15, 0.85, 0.35, 0.65];

/// A stretch of curve `a` along a stretch of curve `b`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Numbers of the two curves.
    pub curves: [u32; 2],
    /// Parameters on each, rising.
    pub ranges: [(f64, f64); 2],
    /// Whether they run the same way.
    pub forward: bool,
    /// Largest distance seen.
    pub distance: f64,
    /// Whether they are so close that more than two may meet here.
    pub tight: bool,
}

/// The stretches of `a` (number `ids[0]`) and `b` side by side.
pub fn overlaps(a: &LiftedCurve, b: &LiftedCurve, ids: [u32; 2], scale: &Scale) -> Vec<Overlap> {
    let join = Scale::join(a, b);
    let reach = scale.reach(a).min(scale.reach(b)).max(join);
    let bodies_differ = matches!((a.part, b.part), (Some(x), Some(y)) if x != y);
    let reach = if bodies_differ || a.address.face == b.address.face { join } else { reach };
    let mut stops = vec![a.domain().0, a.domain().1];
    for end in b.ends() {
        // Many curves that only meet in an end, as the blades of a fan do, are told apart without a look at the surfaces.
        if a.ends().contains(&end) || a.is_beyond(end, reach) {
            continue;
        }
        let foot = nearest(a, end, a.domain());
        if foot.distance <= reach {
            stops.push(foot.at.t);
        }
    }
    stops.sort_by(f64::total_cmp);
    let mut kept: Vec<f64> = Vec::with_capacity(4);
    for t in stops {
        if kept.last().is_none_or(|last| a.length_to(t) - a.length_to(*last) > 1e-9 * a.length()) {
            kept.push(t);
        }
    }
    // The very end stays the end.
    if let Some(last) = kept.last_mut().filter(|_| a.domain().1 > a.domain().0) {
        *last = a.domain().1;
    }
    kept.windows(2).filter_map(|w| stretch(a, b, (w[0], w[1]), ids, (join, reach))).collect()
}

fn stretch(
    a: &LiftedCurve,
    b: &LiftedCurve,
    range: (f64, f64),
    curves: [u32; 2],
    (join, reach): (f64, f64),
) -> Option<Overlap> {
    let length = a.length_to(range.1) - a.length_to(range.0);
    let limit = reach.min(SLENDER * length).max(join.min(0.5 * length));
    let mut distance = 0.0_f64;
    let mut middle: Option<(Nearest, f64)> = None;
    for part in LOOKS {
        let t = range.0 + (range.1 - range.0) * part;
        if a.in_table(t).is_some_and(|point| b.is_beyond(point, limit)) {
            return None;
        }
        let here = a.at(t);
        let foot = nearest(b, here.point, b.domain());
        let cosine = here.tangent.dot(foot.at.tangent) / (here.tangent.length() * foot.at.tangent.length());
        if !(foot.distance <= limit && cosine.abs() >= PARALLEL) {
            return None;
        }
        distance = distance.max(foot.distance);
        if middle.is_none() {
            middle = Some((foot, cosine));
            let limit = if foot.distance > join { SKINS } else { ONE_SKIN };
            if cosine_between(a, t, b, foot.at.t).is_some_and(|c| c > limit) {
                return None;
            }
        }
    }
    let (middle, cosine) = middle?;
    let forward = cosine > 0.0;
    let other = image(a, b, range, middle.at.t, forward)?;
    let other_length = b.length_to(other.1) - b.length_to(other.0);
    let alike = other_length <= 2.0 * length + 2.0 * join && length <= 2.0 * other_length + 2.0 * join;
    alike.then_some(Overlap { curves, ranges: [range, other], forward, distance, tight: distance <= join })
}

/// The range of `b` beside `range` of `a`, given the parameter beside its middle.
fn image(
    a: &LiftedCurve,
    b: &LiftedCurve,
    range: (f64, f64),
    middle: f64,
    forward: bool,
) -> Option<(f64, f64)> {
    let (first, last) = b.domain();
    let ends = [range.0, range.1].map(|t| a.at(t).point);
    let [before, after] = if forward { [ends[0], ends[1]] } else { [ends[1], ends[0]] };
    // Searched on either side of the middle: right for closed curves too.
    let low = nearest(b, before, (first, middle)).at.t;
    let high = nearest(b, after, (middle, last)).at.t;
    (low < high).then_some((low, high))
}

/// Cosine of the angle between the two faces.
fn cosine_between(a: &LiftedCurve, t: f64, b: &LiftedCurve, s: f64) -> Option<f64> {
    Some(a.inward(t)?.dot(b.inward(s)?))
}
