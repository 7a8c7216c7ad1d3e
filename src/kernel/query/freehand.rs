//! A smooth closed curve near points drawn by hand: cubics with common tangents, as few as the tolerance
//! allows.
//!
//! P. J. Schneider, "An Algorithm for Automatically Fitting Digitized Curves", Graphics Gems, 1990: a cubic with
//! given end tangents is fitted by least squares, its parameters are improved by Newton steps, and where it is
//! still too far away it is split at the worst point. Every point ends within the tolerance of the curve.

use glam::DVec2;

use crate::kernel::nurbs::{KnotVector, NurbsCurve2};

/// Newton rounds on the parameters of one cubic.
const ROUNDS: usize = 8;

/// The closed cubic spline within `tolerance` of all `points` (closed back to the first one); `None` for fewer
/// than three different points. Points must be finite. Smooth at the first point too.
pub fn closed_curve(points: &[DVec2], tolerance: f64) -> Option<NurbsCurve2> {
    let mut points = points.to_vec();
    points.dedup();
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    if points.len() < 3 {
        return None;
    }
    let around = (points[1] - points[points.len() - 1]).try_normalize();
    points.push(points[0]);
    let ends = match around {
        Some(tangent) => (tangent, -tangent),
        None => (direction(points[0], points[1]), direction(points[0], points[points.len() - 2])),
    };
    let mut pieces = Vec::new();
    fit(&points, ends, tolerance, &mut pieces);
    let mut knots = vec![0.0; 4];
    let mut control = vec![pieces[0][0]];
    for (number, piece) in pieces.iter().enumerate() {
        control.extend_from_slice(&piece[1..]);
        knots.extend([number as f64 + 1.0; 3]);
    }
    knots.push(pieces.len() as f64);
    let weights = vec![1.0; control.len()];
    NurbsCurve2::new(KnotVector::new(3, knots).ok()?, control, weights).ok()
}

fn direction(from: DVec2, to: DVec2) -> DVec2 {
    (to - from).try_normalize().unwrap_or(DVec2::X)
}

/// Fits cubics through the ends of `points` with the tangents `ends`, both pointing inwards.
fn fit(points: &[DVec2], ends: (DVec2, DVec2), tolerance: f64, pieces: &mut Vec<[DVec2; 4]>) {
    let last = points.len() - 1;
    if last == 1 {
        let third = points[0].distance(points[1]) / 3.0;
        pieces.push([points[0], points[0] + ends.0 * third, points[1] + ends.1 * third, points[1]]);
        return;
    }
    let mut parameters = chord_lengths(points);
    let mut split = last / 2;
    for _ in 0..ROUNDS {
        let cubic = least_squares(points, &parameters, ends);
        let (worst, error) = worst(points, &parameters, &cubic);
        if error <= tolerance {
            pieces.push(cubic);
            return;
        }
        split = worst;
        if error > 16.0 * tolerance {
            break;
        }
        for (t, p) in parameters.iter_mut().zip(points) {
            *t = nearer(&cubic, *p, *t);
        }
        if parameters.windows(2).any(|w| w[1] <= w[0]) {
            break;
        }
    }
    let split = split.clamp(1, last - 1);
    let across = points[split - 1] - points[split + 1];
    let tangent = across.try_normalize().unwrap_or_else(|| direction(points[split], points[split - 1]));
    fit(&points[..=split], (ends.0, tangent), tolerance, pieces);
    fit(&points[split..], (-tangent, ends.1), tolerance, pieces);
}

/// Parameters in 0..=1 in proportion to the length of the way.
fn chord_lengths(points: &[DVec2]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut lengths = vec![0.0];
    for pair in points.windows(2) {
        sum += pair[0].distance(pair[1]);
        lengths.push(sum);
    }
    lengths.iter().map(|l| l / sum).collect()
}

/// The cubic with these end tangents nearest to the points at their parameters.
fn least_squares(points: &[DVec2], parameters: &[f64], ends: (DVec2, DVec2)) -> [DVec2; 4] {
    let (first, last) = (points[0], points[points.len() - 1]);
    let (mut c00, mut c01, mut c11, mut x0, mut x1) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (p, &t) in points.iter().zip(parameters) {
        let s = 1.0 - t;
        let (b0, b1, b2, b3) = (s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t);
        let (a0, a1) = (ends.0 * b1, ends.1 * b2);
        let rest = *p - first * (b0 + b1) - last * (b2 + b3);
        c00 += a0.dot(a0);
        c01 += a0.dot(a1);
        c11 += a1.dot(a1);
        x0 += a0.dot(rest);
        x1 += a1.dot(rest);
    }
    let determinant = c00 * c11 - c01 * c01;
    let chord = first.distance(last);
    let (mut alpha, mut beta) = ((x0 * c11 - x1 * c01) / determinant, (c00 * x1 - c01 * x0) / determinant);
    // Against the tangents or tiny: the usual guess is better than loops and cusps.
    let least = 1e-6 * chord;
    if !(alpha > least && beta > least) {
        (alpha, beta) = (chord / 3.0, chord / 3.0);
    }
    [first, first + ends.0 * alpha, last + ends.1 * beta, last]
}

fn point(c: &[DVec2; 4], t: f64) -> DVec2 {
    let s = 1.0 - t;
    c[0] * (s * s * s) + c[1] * (3.0 * s * s * t) + c[2] * (3.0 * s * t * t) + c[3] * (t * t * t)
}

fn worst(points: &[DVec2], parameters: &[f64], cubic: &[DVec2; 4]) -> (usize, f64) {
    let distances = points.iter().zip(parameters).map(|(p, t)| point(cubic, *t).distance(*p));
    distances.enumerate().fold((0, 0.0), |worst, (k, d)| if d > worst.1 { (k, d) } else { worst })
}

/// One Newton step towards the parameter of the cubic's point nearest to `p`.
fn nearer(c: &[DVec2; 4], p: DVec2, t: f64) -> f64 {
    let (d, e) =
        ([c[1] - c[0], c[2] - c[1], c[3] - c[2]], [c[2] - 2.0 * c[1] + c[0], c[3] - 2.0 * c[2] + c[1]]);
    let s = 1.0 - t;
    let first = 3.0 * (d[0] * (s * s) + d[1] * (2.0 * s * t) + d[2] * (t * t));
    let second = 6.0 * (e[0] * s + e[1] * t);
    let off = point(c, t) - p;
    let slope = first.dot(first) + off.dot(second);
    if slope.abs() > 0.0 { (t - off.dot(first) / slope).clamp(0.0, 1.0) } else { t }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_is_within_the_tolerance_and_pieces_are_few() {
        let flower = |t: f64| DVec2::from_angle(t) * (1.0 + 0.2 * (5.0 * t).cos());
        let points: Vec<DVec2> =
            (0..300).map(|k| flower(f64::from(k) * std::f64::consts::TAU / 300.0)).collect();
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let curve = closed_curve(&points, tolerance).expect("a curve");
            let (a, b) = curve.domain();
            assert_eq!(curve.point(a), curve.point(b));
            let near: Vec<DVec2> =
                (0..=20_000).map(|k| curve.point(a + (b - a) * f64::from(k) / 20_000.0)).collect();
            for p in &points {
                let off = near.iter().map(|q| q.distance(*p)).fold(f64::INFINITY, f64::min);
                assert!(off < tolerance + 1e-3 * tolerance + 1e-6, "{off}");
            }
            let pieces = (curve.points().len() - 1) / 3;
            assert!(pieces < 60, "{pieces} pieces for {tolerance}");
            let (out, back) = (
                curve.points()[1] - curve.points()[0],
                curve.points()[curve.points().len() - 2] - curve.points()[0],
            );
            assert!(out.normalize().dot(back.normalize()) < -0.999, "smooth where it closes");
        }
    }

    #[test]
    fn corners_repeats_and_too_few_points_are_borne() {
        let p = DVec2::new;
        assert_eq!(closed_curve(&[p(0.0, 0.0), p(1.0, 0.0), p(0.0, 0.0)], 0.1), None);
        let square = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0), p(0.0, 0.0)];
        assert!(closed_curve(&square, 1e-6).is_some());
        let back = [p(0.0, 0.0), p(1.0, 0.0), p(2.0, 0.0), p(1.0, 0.0)];
        assert!(closed_curve(&back, 1e-3).is_some());
    }
}
