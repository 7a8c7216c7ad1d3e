//! The point of a stretch of a lifted curve that is nearest to a given one.
//!
//! The table of the curve gives the start, secant steps on the derivative of the squared distance the rest.
//! The distance is good to rounding where the points are close, and to second order of the parameter elsewhere.

use glam::DVec3;

use super::lifted::{CurvePoint, LiftedCurve};

/// Steps at most; secant steps converge in three to six.
const STEPS: usize = 24;
/// An offset along the curve below this part of the distance changes the distance by less than rounding.
const SIDEWAYS: f64 = 1e-6;

/// A nearest point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The point of the curve.
    pub at: CurvePoint,
    /// Its distance.
    pub distance: f64,
}

/// The point of `curve` over `range` nearest to `p`.
pub fn nearest(curve: &LiftedCurve, p: DVec3, range: (f64, f64)) -> Nearest {
    let (mut start, mut least) = (range.0, f64::INFINITY);
    for pair in curve.nodes().windows(2) {
        let (low, high) = (pair[0].t.max(range.0), pair[1].t.min(range.1));
        if low > high {
            continue;
        }
        let chord = pair[1].point - pair[0].point;
        let length = chord.length_squared();
        let s = if length > 0.0 { ((p - pair[0].point).dot(chord) / length).clamp(0.0, 1.0) } else { 0.5 };
        let distance = (pair[0].point + chord * s - p).length_squared();
        if distance < least {
            least = distance;
            start = (pair[0].t + (pair[1].t - pair[0].t) * s).clamp(low, high);
        }
    }
    nearest_from(curve, p, range, start)
}

/// The same, searched from the parameter `start` alone.
pub fn nearest_from(curve: &LiftedCurve, p: DVec3, range: (f64, f64), start: f64) -> Nearest {
    let (a, b) = range;
    let mut t = start.clamp(a, b);
    let mut at = curve.at(t);
    let mut best = Nearest { at, distance: (at.point - p).length() };
    let mut before: Option<(f64, f64)> = None;
    let quiet = 0.25 * curve.ground().rounding();
    for _ in 0..STEPS {
        let slope = (at.point - p).dot(at.tangent);
        let speed = at.tangent.length_squared();
        // How far along the curve the foot is still off; what is left below rounding is noise without an end.
        let off = quiet.max(SIDEWAYS * best.distance);
        if !(speed > 0.0) || slope * slope <= off * off * speed {
            break;
        }
        let newton = slope / speed;
        let step = match before {
            Some((t0, slope0)) if slope != slope0 => {
                let secant = slope * (t - t0) / (slope - slope0);
                // Where the curve bends away the secant may point uphill.
                if secant * newton > 0.0 && secant.abs() < 4.0 * newton.abs() { secant } else { newton }
            }
            _ => newton,
        };
        let step = step.clamp(-0.5 * (b - a), 0.5 * (b - a));
        before = Some((t, slope));
        let next = (t - step).clamp(a, b);
        if next == t || (next - t).abs() <= 1e-16 * (a.abs().max(b.abs())) {
            break;
        }
        t = next;
        at = curve.at(t);
        let distance = (at.point - p).length();
        if distance < best.distance {
            best = Nearest { at, distance };
        }
    }
    best
}
