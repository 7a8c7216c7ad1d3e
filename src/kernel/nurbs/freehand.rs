//! A closed chain of cubic curves through points drawn by hand.
//!
//! The points are cut at sharp corners; each stretch is fitted by one cubic in the sense of least squares with given
//! end tangents, parameters are improved by Newton steps, and where that is not good enough the stretch is cut at
//! its worst point. Source: P. Schneider, "An Algorithm for Automatically Fitting Digitized Curves", Graphics Gems,
//! 1990. Invariant: every curve starts exactly where the one before ends, the last one where the first starts.

use glam::DVec2;

use super::{KnotVector, NurbsCurve2};

/// A turn sharper than this (cosine) between steps of the hand is a corner.
const CORNER: f64 = 0.2;
/// Newton steps that improve the parameters of a stretch.
const REFITS: usize = 6;

/// A closed chain of cubics that passes `points` within `tolerance`; the last point is joined to the first.
/// Empty when fewer than three points are apart by more than the tolerance.
pub fn closed_chain(points: &[DVec2], tolerance: f64) -> Vec<NurbsCurve2> {
    let mut ring: Vec<DVec2> = Vec::new();
    for p in points.iter().filter(|p| p.is_finite()) {
        if ring.last().is_none_or(|q| q.distance(*p) > 0.25 * tolerance) {
            ring.push(*p);
        }
    }
    while ring.len() > 1 && ring[0].distance(ring[ring.len() - 1]) <= 2.0 * tolerance {
        ring.pop();
    }
    if ring.len() < 3 {
        return Vec::new();
    }
    let corners = corners(&ring, 3.0 * tolerance);
    let mut cubics: Vec<[DVec2; 4]> = Vec::new();
    let count = ring.len();
    for (k, from) in corners.iter().enumerate() {
        let next = corners[(k + 1) % corners.len()];
        let steps = if next > *from { next - from } else { next + count - from };
        let stretch: Vec<DVec2> = (0..=steps).map(|s| ring[(from + s) % count]).collect();
        let smooth = corners.len() == 1 && !is_corner(&ring, *from, 3.0 * tolerance);
        let (start, end) = if smooth {
            let across = tangent(&ring, *from, 3.0 * tolerance);
            (across, -across)
        } else {
            let reach = 3.0 * tolerance;
            let backwards: Vec<DVec2> = stretch.iter().rev().copied().collect();
            (heading(&stretch, reach), heading(&backwards, reach))
        };
        fit(&stretch, (start, end), tolerance, &mut cubics);
    }
    let knots = KnotVector::bezier(3, 0.0, 1.0).expect("degree 3 over [0, 1] is valid");
    let curve = |c: &[DVec2; 4]| NurbsCurve2::new(knots.clone(), c.to_vec(), vec![1.0; 4]).ok();
    cubics.iter().filter_map(curve).collect()
}

/// Point a distance ahead (`step` = 1) or behind (`count - 1`) on the ring.
fn ahead(ring: &[DVec2], from: usize, step: usize, reach: f64) -> DVec2 {
    let count = ring.len();
    let mut at = from;
    for _ in 0..count {
        at = (at + step) % count;
        if ring[at].distance(ring[from]) >= reach {
            break;
        }
    }
    ring[at]
}

fn is_corner(ring: &[DVec2], at: usize, reach: f64) -> bool {
    let p = ring[at];
    let before = (p - ahead(ring, at, ring.len() - 1, reach)).normalize_or_zero();
    let after = (ahead(ring, at, 1, reach) - p).normalize_or_zero();
    before.dot(after) < CORNER
}

/// Positions of sharp corners, the sharpest of each neighbourhood; at least one position.
fn corners(ring: &[DVec2], reach: f64) -> Vec<usize> {
    let count = ring.len();
    let turn = |at: usize| {
        let p = ring[at];
        let before = (p - ahead(ring, at, count - 1, reach)).normalize_or_zero();
        before.dot((ahead(ring, at, 1, reach) - p).normalize_or_zero())
    };
    let mut found: Vec<usize> = Vec::new();
    for at in (0..count).filter(|at| is_corner(ring, *at, reach)) {
        match found.last_mut() {
            Some(last) if ring[*last].distance(ring[at]) < 2.0 * reach => {
                if turn(at) < turn(*last) {
                    *last = at;
                }
            }
            _ => found.push(at),
        }
    }
    if found.is_empty() {
        found.push(0);
    }
    found
}

/// Direction of a smooth ring at one of its points.
fn tangent(ring: &[DVec2], at: usize, reach: f64) -> DVec2 {
    let d = ahead(ring, at, 1, reach) - ahead(ring, at, ring.len() - 1, reach);
    d.try_normalize().unwrap_or(DVec2::X)
}

/// Direction in which a stretch sets out.
fn heading(points: &[DVec2], reach: f64) -> DVec2 {
    let far = points.iter().find(|p| p.distance(points[0]) >= reach).or(points.last());
    far.and_then(|p| (*p - points[0]).try_normalize()).unwrap_or(DVec2::X)
}

/// Fits cubics to a stretch with unit tangents at both ends, each pointing inwards.
fn fit(points: &[DVec2], (start, end): (DVec2, DVec2), tolerance: f64, out: &mut Vec<[DVec2; 4]>) {
    let (first, last) = (points[0], points[points.len() - 1]);
    if points.len() == 2 {
        let line = (last - first) / 3.0;
        out.push([first, first + line, last - line, last]);
        return;
    }
    let mut parameters = by_length(points);
    let mut cubic = least_squares(points, &parameters, start, end);
    let mut worst = farthest(points, &parameters, &cubic);
    for _ in 0..REFITS {
        if worst.1 <= tolerance || worst.1 > 16.0 * tolerance {
            break;
        }
        for (t, p) in parameters.iter_mut().zip(points) {
            *t = improved(&cubic, *p, *t);
        }
        cubic = least_squares(points, &parameters, start, end);
        worst = farthest(points, &parameters, &cubic);
    }
    if worst.1 <= tolerance {
        out.push(cubic);
        return;
    }
    let at = worst.0.clamp(1, points.len() - 2);
    let across = (points[at - 1] - points[at + 1]).try_normalize().unwrap_or(DVec2::X);
    fit(&points[..=at], (start, across), tolerance, out);
    fit(&points[at..], (-across, end), tolerance, out);
}

/// Parameters in proportion to the length of the way.
fn by_length(points: &[DVec2]) -> Vec<f64> {
    let mut way = 0.0;
    let mut parameters = vec![0.0];
    for ends in points.windows(2) {
        way += ends[0].distance(ends[1]);
        parameters.push(way);
    }
    parameters.iter().map(|t| t / way.max(f64::MIN_POSITIVE)).collect()
}

fn at(c: &[DVec2; 4], t: f64) -> DVec2 {
    let s = 1.0 - t;
    c[0] * (s * s * s) + c[1] * (3.0 * s * s * t) + c[2] * (3.0 * s * t * t) + c[3] * (t * t * t)
}

/// The cubic with these ends and tangents that is nearest to the points at their parameters.
fn least_squares(points: &[DVec2], parameters: &[f64], start: DVec2, end: DVec2) -> [DVec2; 4] {
    let (first, last) = (points[0], points[points.len() - 1]);
    let (mut c00, mut c01, mut c11, mut x0, mut x1) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (p, t) in points.iter().zip(parameters) {
        let s = 1.0 - t;
        let (b1, b2) = (3.0 * s * s * t, 3.0 * s * t * t);
        let (a, b) = (start * b1, end * b2);
        let rest = *p - first * (s * s * s + b1) - last * (t * t * t + b2);
        c00 += a.dot(a);
        c01 += a.dot(b);
        c11 += b.dot(b);
        x0 += a.dot(rest);
        x1 += b.dot(rest);
    }
    let determinant = c00 * c11 - c01 * c01;
    let chord = first.distance(last);
    let (mut alpha, mut beta) = ((x0 * c11 - x1 * c01) / determinant, (c00 * x1 - c01 * x0) / determinant);
    let least = 1e-3 * chord;
    let way: f64 = points.windows(2).map(|e| e[0].distance(e[1])).sum();
    if !(alpha.is_finite()
        && beta.is_finite()
        && alpha > least
        && beta > least
        && alpha.max(beta) < 3.0 * way)
    {
        (alpha, beta) = (way / 3.0, way / 3.0);
    }
    [first, first + start * alpha, last + end * beta, last]
}

/// Position of the point that is farthest from the cubic at its parameter, and how far.
fn farthest(points: &[DVec2], parameters: &[f64], cubic: &[DVec2; 4]) -> (usize, f64) {
    let off = points.iter().zip(parameters).map(|(p, t)| at(cubic, *t).distance(*p));
    off.enumerate().fold((points.len() / 2, 0.0), |worst, now| if now.1 > worst.1 { now } else { worst })
}

/// One Newton step towards the parameter nearest to `p`.
fn improved(c: &[DVec2; 4], p: DVec2, t: f64) -> f64 {
    let s = 1.0 - t;
    let d = [c[1] - c[0], c[2] - c[1], c[3] - c[2]];
    let d1 = (d[0] * (s * s) + d[1] * (2.0 * s * t) + d[2] * (t * t)) * 3.0;
    let d2 = ((d[1] - d[0]) * s + (d[2] - d[1]) * t) * 6.0;
    let offset = at(c, t) - p;
    let next = t - offset.dot(d1) / (d1.dot(d1) + offset.dot(d2));
    if next.is_finite() { next.clamp(0.0, 1.0) } else { t }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_closed(curves: &[NurbsCurve2]) {
        for (k, curve) in curves.iter().enumerate() {
            let next = &curves[(k + 1) % curves.len()];
            assert_eq!(curve.points()[3], next.points()[0], "joint {k}");
        }
    }

    #[test]
    fn a_circle_by_hand_becomes_a_few_cubics_near_it() {
        let points: Vec<DVec2> = (0..200)
            .map(|k| DVec2::from_angle(f64::from(k) * 0.0314) * (80.0 + 0.3 * f64::from(k % 3)))
            .collect();
        let curves = closed_chain(&points, 1.5);
        assert!((2..=12).contains(&curves.len()), "{} curves", curves.len());
        assert_closed(&curves);
        for curve in &curves {
            for k in 0..=20 {
                let r = curve.point(f64::from(k) / 20.0).length();
                assert!((r - 80.3).abs() < 3.0, "{r}");
            }
        }
    }

    #[test]
    fn corners_stay_corners() {
        let side = |a: DVec2, b: DVec2| (0..20).map(move |k| a.lerp(b, f64::from(k) / 20.0));
        let c = [DVec2::ZERO, DVec2::new(60.0, 0.0), DVec2::new(60.0, 40.0), DVec2::new(0.0, 40.0)];
        let points: Vec<DVec2> = (0..4).flat_map(|k| side(c[k], c[(k + 1) % 4])).collect();
        let curves = closed_chain(&points, 1.0);
        assert_closed(&curves);
        for corner in c {
            let near = curves.iter().map(|c| c.points()[0].distance(corner)).fold(f64::INFINITY, f64::min);
            assert!(near < 4.0, "{near} from {corner}");
        }
    }

    #[test]
    fn nonsense_gives_nothing_or_something_valid() {
        assert!(closed_chain(&[], 1.0).is_empty());
        assert!(closed_chain(&[DVec2::ZERO; 50], 1.0).is_empty());
        assert!(closed_chain(&[DVec2::NAN, DVec2::INFINITY, DVec2::X], 1.0).is_empty());
        let line: Vec<DVec2> = (0..50).map(|k| DVec2::new(f64::from(k), 0.0)).collect();
        let curves = closed_chain(&line, 1.0);
        assert_closed(&curves);
        assert!(curves.iter().flat_map(|c| c.points()).all(|p| p.is_finite()));
    }
}
