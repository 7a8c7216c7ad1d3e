//! Loop simplification: fewer vertices for chords that run on straight (P2, section 5.1).
//!
//! Trim curves are cut at the spans of the surface and at their own ends, which leaves vertices that the tolerance does
//! not need. [`simplify`] is P2's way: vertices are dropped greedily as long as all dropped ones stay within the given distance
//! of the new chord, for which the curves must have been divided by a part of the tolerance only; where they bend that adds
//! more vertices than it saves. [`simplify_along`] gives nothing away: a new chord is held against the curves themselves.

use super::chords::{EdgeSample, is_within};
use super::line_error::distance_to_segment;
use super::outline::Run;

/// Keeps the ends and as few vertices between as `tolerance` allows.
pub fn simplify(samples: &[EdgeSample], tolerance: f64, longest: f64) -> Vec<EdgeSample> {
    let mut kept: Vec<EdgeSample> = samples.first().copied().into_iter().collect();
    let mut from = 0;
    while from + 1 < samples.len() {
        let mut to = from + 1;
        while to + 1 < samples.len() {
            let (a, b) = (samples[from].point, samples[to + 1].point);
            let fits = a.distance(b) <= longest
                && samples[from + 1..=to].iter().all(|s| distance_to_segment(s.point, a, b) <= tolerance);
            if !fits {
                break;
            }
            to += 1;
        }
        kept.push(samples[to]);
        from = to;
    }
    kept
}

/// Keeps the ends and as few vertices of `run` between as have it within `tolerance` of its chords. Chords that the samples
/// have already stay, whatever their error.
pub fn simplify_along(run: &Run, samples: &[EdgeSample], tolerance: f64, longest: f64) -> Vec<EdgeSample> {
    let mut kept: Vec<EdgeSample> = samples.first().copied().into_iter().collect();
    let mut from = 0;
    while from + 1 < samples.len() {
        let fits = |to: usize| {
            let (a, b) = (samples[from], samples[to]);
            // A loop's ends are one point: no chord.
            a.point != b.point && a.point.distance(b.point) <= longest && is_within(run, a.s, b.s, tolerance)
        };
        let mut to = from + 1;
        while to + 1 < samples.len() && fits(to + 1) {
            to += 1;
        }
        kept.push(samples[to]);
        from = to;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};

    #[test]
    fn straight_stretches_lose_their_vertices_and_corners_stay() {
        let at = |k: usize| {
            if k <= 10 { DVec3::new(k as f64, 0.0, 0.0) } else { DVec3::new(10.0, (k - 10) as f64, 0.0) }
        };
        let samples: Vec<EdgeSample> = (0..=20)
            .map(|k| EdgeSample { s: k as f64, uv: DVec2::ZERO, point: at(k), off: DVec3::ZERO })
            .collect();
        let kept = simplify(&samples, 0.1, f64::INFINITY);
        assert_eq!(kept.iter().map(|s| s.s).collect::<Vec<_>>(), [0.0, 10.0, 20.0]);
        assert_eq!(simplify(&samples, 0.1, 4.0).len(), 7);
    }
}
