//! Exact split of rational Bezier curves into pieces that are monotone in u and in v.
//!
//! A coordinate x = X / W turns where X'W - XW' vanishes, a polynomial of degree 2n - 2 (n - 1 for equal
//! weights) whose Bernstein coefficients are sums of positive factors times differences of control
//! points, so they neither depend on the origin nor cancel needlessly. Every root is a split, even one without a change of
//! sign: a split too many does no harm. Straight curves of any degree become lines.

use glam::DVec2;

use super::bernstein::binomial_row;
use super::roots;

/// Splits curves; keeps its scratch memory.
#[derive(Debug, Default)]
pub struct MonotoneSplitter {
    coefficients: Vec<f64>,
    cuts: Vec<f64>,
    net: Vec<(DVec2, f64)>,
    points: Vec<DVec2>,
    weights: Vec<f64>,
}

/// Splits closer than this to another or to an end are left out: what lies between is below rounding.
const SHORTEST: f64 = 1e-9;

impl MonotoneSplitter {
    /// Gives the monotone pieces of the curve (not premultiplied `points`, positive `weights`) to `emit`, in
    /// order, each starting bit for bit where the one before ended. Curves within `straight` of the segment
    /// between their ends, in either coordinate, are emitted as lines.
    pub fn split(
        &mut self,
        points: &[DVec2],
        weights: &[f64],
        straight: f64,
        mut emit: impl FnMut(&[DVec2], &[f64]),
    ) {
        let last = points.len() - 1;
        if last == 1 || is_straight(points, straight) {
            emit(&[points[0], points[last]], &[1.0, 1.0]);
            return;
        }
        self.find_cuts(points, weights);
        if self.cuts.is_empty() {
            emit(points, weights);
            return;
        }
        let rational = weights.iter().any(|w| *w != weights[0]);
        self.net.clear();
        self.net.extend(
            points.iter().zip(weights).map(|(p, w)| if rational { (*p * *w, *w) } else { (*p, 1.0) }),
        );
        let mut done = 0.0;
        for k in 0..self.cuts.len() {
            let t = (self.cuts[k] - done) / (1.0 - done);
            done = self.cuts[k];
            self.cut_off(t, rational);
            if k == 0 {
                self.points[0] = points[0];
            }
            send(&self.points, &self.weights, straight, &mut emit);
        }
        self.points.clear();
        self.weights.clear();
        for (p, w) in &self.net {
            self.points.push(if rational { *p / *w } else { *p });
            self.weights.push(*w);
        }
        self.points[last] = points[last];
        send(&self.points, &self.weights, straight, &mut emit);
    }

    /// Parameters inside (0, 1) at which the curve may turn in u or v, in order.
    pub fn find_cuts(&mut self, points: &[DVec2], weights: &[f64]) -> &[f64] {
        self.cuts.clear();
        for axis in 0..2 {
            derivative_sign(points, weights, axis, &mut self.coefficients);
            roots::append(&self.coefficients, &mut self.cuts);
        }
        self.cuts.retain(|t| *t > SHORTEST && *t < 1.0 - SHORTEST);
        self.cuts.sort_unstable_by(f64::total_cmp);
        self.cuts.dedup_by(|b, a| *b - *a < SHORTEST);
        &self.cuts
    }

    /// Moves the part of `net` left of `t` to `points` and `weights`; `net` keeps the right part.
    fn cut_off(&mut self, t: f64, rational: bool) {
        let net = &mut self.net;
        self.points.clear();
        self.weights.clear();
        for k in (0..net.len()).rev() {
            let (p, w) = net[0];
            self.points.push(if rational { p / w } else { p });
            self.weights.push(w);
            for i in 0..k {
                net[i] = (net[i].0.lerp(net[i + 1].0, t), net[i].1 + (net[i + 1].1 - net[i].1) * t);
            }
        }
    }
}

fn send(points: &[DVec2], weights: &[f64], straight: f64, emit: &mut impl FnMut(&[DVec2], &[f64])) {
    if is_straight(points, straight) {
        emit(&[points[0], points[points.len() - 1]], &[1.0, 1.0]);
    } else {
        emit(points, weights);
    }
}

/// Whether all control points lie within `tolerance` of the segment between the ends.
fn is_straight(points: &[DVec2], tolerance: f64) -> bool {
    let (start, end) = (points[0], points[points.len() - 1]);
    let chord = end - start;
    let squared = chord.length_squared();
    points[1..points.len() - 1].iter().all(|p| {
        let along = if squared > 0.0 { ((*p - start).dot(chord) / squared).clamp(0.0, 1.0) } else { 0.0 };
        (start + chord * along).distance_squared(*p) <= tolerance * tolerance
    })
}

/// Bernstein coefficients of a polynomial with the sign of the derivative of one coordinate.
fn derivative_sign(points: &[DVec2], weights: &[f64], axis: usize, result: &mut Vec<f64>) {
    result.clear();
    let n = points.len() - 1;
    if weights.iter().all(|w| *w == weights[0]) {
        result.extend(points.windows(2).map(|p| p[1][axis] - p[0][axis]));
        return;
    }
    let (binomial, scale) = (binomial_row(n), binomial_row(2 * n - 2));
    for k in 0..=2 * n - 2 {
        let mut sum = 0.0;
        // Pairs i > j with i + j = k + 1.
        for i in k / 2 + 1..=n.min(k + 1) {
            let j = k + 1 - i;
            let factor = (i - j) as f64 * binomial[i] * binomial[j] / scale[k];
            sum += factor * weights[i] * weights[j] * (points[i][axis] - points[j][axis]);
        }
        result.push(sum);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::bezier::BezierCurve2;
    use proptest::prelude::*;

    fn pieces(curve: &BezierCurve2) -> Vec<BezierCurve2> {
        let mut pieces = Vec::new();
        MonotoneSplitter::default().split(&curve.points, &curve.weights, 1e-9, |p, w| {
            pieces.push(BezierCurve2 { points: p.to_vec(), weights: w.to_vec() });
        });
        pieces
    }

    fn curve() -> impl Strategy<Value = BezierCurve2> {
        (1usize..14).prop_flat_map(|n| {
            let point = (0.0f64..1.0, 0.0f64..1.0).prop_map(|(x, y)| DVec2::new(x, y));
            (prop::collection::vec(point, n + 1), prop::collection::vec(-4.6f64..4.6, n + 1), any::<bool>())
                .prop_map(|(points, logs, rational)| {
                    let weights = logs.iter().map(|l| if rational { l.exp() } else { 1.0 }).collect();
                    BezierCurve2 { points, weights }
                })
        })
    }

    proptest! {
        #[test]
        fn pieces_are_monotone_and_cover_the_curve(curve in curve()) {
            let pieces = pieces(&curve);
            prop_assert_eq!(pieces[0].start(), curve.start());
            prop_assert_eq!(pieces[pieces.len() - 1].end(), curve.end());
            for pair in pieces.windows(2) {
                prop_assert_eq!(pair[0].end(), pair[1].start());
            }
            for piece in &pieces {
                let direction = piece.end() - piece.start();
                let mut before = piece.start();
                for k in 1..=50 {
                    let p = piece.point(f64::from(k) / 50.0);
                    let step = (p - before) * direction;
                    prop_assert!(step.min_element() > -1e-9, "{:?}", step);
                    before = p;
                }
            }
            // Every point of the curve lies on some piece's box.
            for k in 0..=40 {
                let p = curve.point(f64::from(k) / 40.0);
                let inside = pieces.iter().any(|c| {
                    let (a, b) = (c.start().min(c.end()), c.start().max(c.end()));
                    (p - a).min_element() > -1e-7 && (b - p).min_element() > -1e-7
                });
                prop_assert!(inside);
            }
        }
    }

    #[test]
    fn quarter_circles_need_no_split_and_a_half_circle_one() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let quarter =
            BezierCurve2 { points: vec![DVec2::X, DVec2::ONE, DVec2::Y], weights: vec![1.0, half, 1.0] };
        assert_eq!(pieces(&quarter), vec![quarter]);
        let points = vec![DVec2::X, DVec2::new(1.0, 2.0), DVec2::new(-1.0, 2.0), -DVec2::X];
        let arch = BezierCurve2 { points, weights: vec![1.0, 1.0 / 3.0, 1.0 / 3.0, 1.0] };
        let parts = pieces(&arch);
        assert_eq!(parts.len(), 2);
        assert!((parts[0].end() - DVec2::Y).length() < 1e-12);
    }

    #[test]
    fn straight_curves_of_any_degree_become_lines_even_when_they_run_back() {
        let at = |t: f64| DVec2::new(0.1 + 0.3 * t, 0.2 + 0.5 * t);
        let points = [0.0, 0.8, 0.1, 0.9, 1.0].map(at).to_vec();
        let parts = pieces(&BezierCurve2 { points, weights: vec![1.0, 5.0, 0.1, 1.0, 2.0] });
        assert_eq!(parts.len(), 1);
        assert_eq!(parts[0].degree(), 1);
    }

    #[test]
    fn a_cusp_is_a_split() {
        let points = vec![DVec2::ZERO, DVec2::ONE, DVec2::X, DVec2::Y];
        let cusp = BezierCurve2::polynomial(points.clone());
        let parts = pieces(&cusp);
        assert!(parts.len() >= 2, "{}", parts.len());
    }
}
