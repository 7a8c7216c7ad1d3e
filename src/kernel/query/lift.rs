//! The image of a uv curve on a surface as a spline in space: what other systems want beside a pcurve.
//!
//! On planes, and along isoparametric lines, the image is itself a spline and comes out exact. Elsewhere
//! it is a rational curve of degree `p (m + n)` per patch, which nobody wants; cubic Hermite pieces are
//! halved until they are near enough. The parameter is the pcurve's own: `curve(t)` is the image of
//! `pcurve(t)`.

use glam::{DVec2, DVec3};

use super::carrier::SplineCarrier;
use crate::kernel::nurbs::{Direction, KnotVector, NurbsCurve2, NurbsCurve3, NurbsSurface};

/// Pieces of one curve at most; beyond it the deviation reached is reported.
const MOST_PIECES: usize = 1000;
/// Halvings of one piece at most: enough to close in on a kink of the surface.
const DEPTH: u32 = 24;
/// A patch whose corners miss a parallelogram by this part of its size is a plane.
const FLAT: f64 = 1e-14;

/// A pcurve lifted into space.
#[derive(Debug, Clone, PartialEq)]
pub struct Lift {
    /// The curve in space, over the pcurve's parameters.
    pub curve: NurbsCurve3,
    /// Largest distance found between points of equal parameter (model units); 0 where exact.
    pub deviation: f64,
}

/// Lifts `pcurve` onto the surface of `carrier` to `tolerance` (model units). `None` when numbers overflow.
pub fn lift(carrier: &SplineCarrier, pcurve: &NurbsCurve2, tolerance: f64) -> Option<Lift> {
    let surface = carrier.surface();
    if let Some(curve) = on_plane(surface, pcurve).or_else(|| along_iso_line(carrier, pcurve)) {
        return Some(Lift { curve, deviation: 0.0 });
    }
    let (pieces, deviation) = fit(&Image { carrier, pcurve }, tolerance);
    let curve = spline(&pieces, 0.1 * tolerance)?;
    Some(Lift { curve, deviation })
}

/// On one bilinear patch over a parallelogram the map is affine.
fn on_plane(surface: &NurbsSurface, pcurve: &NurbsCurve2) -> Option<NurbsCurve3> {
    if surface.degrees() != (1, 1) || surface.counts() != (2, 2) || surface.is_rational() {
        return None;
    }
    let ((u0, u1), (v0, v1)) = (surface.knots_u().domain(), surface.knots_v().domain());
    let p = surface.points();
    let (x, y) = (p[2] - p[0], p[1] - p[0]);
    if !((p[3] - p[2] - y).length() <= FLAT * x.length().max(y.length())) {
        return None;
    }
    Some(pcurve.map_points(|uv: DVec2| p[0] + x * ((uv.x - u0) / (u1 - u0)) + y * ((uv.y - v0) / (v1 - v0))))
}

/// A straight pcurve along u or v inside the domain is a part of an isoparametric curve.
fn along_iso_line(carrier: &SplineCarrier, pcurve: &NurbsCurve2) -> Option<NurbsCurve3> {
    let surface = carrier.surface();
    let &[a, b] = pcurve.points() else { return None };
    if pcurve.degree() != 1 || pcurve.is_rational() {
        return None;
    }
    let (direction, value, from, to) = match (a.x == b.x, a.y == b.y) {
        (true, false) => (Direction::U, a.x, a.y, b.y),
        (false, true) => (Direction::V, a.y, a.x, b.x),
        _ => return None,
    };
    let within = |knots: &KnotVector, x: f64| {
        let (start, end) = knots.domain();
        // Rounding past the end is not beyond it.
        let slack = 1e-12 * (end - start);
        (x >= start - slack && x <= end + slack).then(|| x.clamp(start, end))
    };
    let value = within(surface.knots(direction), value)?;
    let along = if direction == Direction::U { surface.knots_v() } else { surface.knots_u() };
    let (from, to) = (within(along, from)?, within(along, to)?);
    let curve = surface.iso_curve(direction, value).restricted(from.min(to), from.max(to)).ok()?;
    let curve = if to < from { curve.reversed() } else { curve };
    // The iso curve's own parameters, stretched over the pcurve's.
    let ((s0, s1), (t0, t1)) = (curve.domain(), pcurve.domain());
    let knots = curve.knots().as_slice().iter().map(|s| match *s {
        s if s == s1 => t1,
        s => t0 + (t1 - t0) * ((s - s0) / (s1 - s0)),
    });
    let knots = KnotVector::new(curve.degree(), knots.collect()).ok()?;
    NurbsCurve3::new(knots, curve.points().to_vec(), curve.weights().to_vec()).ok()
}

/// The function that is fitted.
struct Image<'a> {
    carrier: &'a SplineCarrier,
    pcurve: &'a NurbsCurve2,
}

impl Image<'_> {
    fn point(&self, t: f64) -> DVec3 {
        self.carrier.point(self.pcurve.point(t))
    }

    /// Point, and the derivative from one side (-1 or 1): the pcurve may have a corner at `t`.
    fn sample(&self, t: f64, side: f64) -> Sample {
        let (start, end) = self.pcurve.domain();
        let hair = 1e-9 * (end - start);
        let d = self.pcurve.derivatives((t + side * hair).clamp(start, end), 1);
        let [_, du, dv] = self.carrier.jet(d[0]);
        Sample { point: self.point(t), slope: du * d[1].x + dv * d[1].y }
    }
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    point: DVec3,
    slope: DVec3,
}

/// One cubic.
#[derive(Debug, Clone, Copy)]
struct Piece {
    a: f64,
    b: f64,
    start: Sample,
    end: Sample,
}

impl Piece {
    fn inner(&self) -> [DVec3; 2] {
        let third = (self.b - self.a) / 3.0;
        [self.start.point + self.start.slope * third, self.end.point - self.end.slope * third]
    }

    fn deviation(&self, image: &Image<'_>) -> f64 {
        let [p, q] = self.inner();
        [0.25, 0.5, 0.75].iter().fold(0.0_f64, |worst, s| {
            let r = 1.0 - s;
            let here = self.start.point * (r * r * r)
                + p * (3.0 * r * r * s)
                + q * (3.0 * r * s * s)
                + self.end.point * (s * s * s);
            worst.max((here - image.point(self.a + s * (self.b - self.a))).length())
        })
    }
}

/// Cubics over the whole curve, in order, and their largest deviation.
fn fit(image: &Image<'_>, tolerance: f64) -> (Vec<Piece>, f64) {
    let mut done: Vec<Piece> = Vec::new();
    let mut worst = 0.0_f64;
    // Kept in reverse, so that the last one is the next along the curve.
    let mut open: Vec<(Piece, u32)> = Vec::new();
    let breaks = image.pcurve.knots().breaks();
    for span in breaks.windows(2).rev() {
        let (start, end) = (image.sample(span[0], 1.0), image.sample(span[1], -1.0));
        open.push((Piece { a: span[0], b: span[1], start, end }, 0));
    }
    while let Some((piece, depth)) = open.pop() {
        let deviation = piece.deviation(image);
        let middle = 0.5 * (piece.a + piece.b);
        let may_halve =
            depth < DEPTH && done.len() + open.len() < MOST_PIECES && middle > piece.a && middle < piece.b;
        if deviation > tolerance && may_halve {
            let sample = image.sample(middle, 0.0);
            open.push((Piece { a: middle, start: sample, ..piece }, depth + 1));
            open.push((Piece { b: middle, end: sample, ..piece }, depth + 1));
        } else {
            worst = worst.max(deviation);
            done.push(piece);
        }
    }
    (done, worst)
}

/// The pieces as one spline: with a double knot where two meet smoothly (to `slack`), a triple one at corners.
fn spline(pieces: &[Piece], slack: f64) -> Option<NurbsCurve3> {
    let (first, last) = (pieces.first()?, pieces.last()?);
    let mut knots = vec![first.a; 4];
    let mut points = vec![first.start.point];
    for (k, piece) in pieces.iter().enumerate() {
        points.extend(piece.inner());
        if let Some(next) = pieces.get(k + 1) {
            let (h, g) = (piece.b - piece.a, next.b - next.a);
            let [_, before] = piece.inner();
            let [after, _] = next.inner();
            let smooth = (before * g + after * h) / (h + g);
            let corner = !((smooth - piece.end.point).length() <= slack);
            if corner {
                points.push(piece.end.point);
            }
            knots.extend(std::iter::repeat_n(piece.b, if corner { 3 } else { 2 }));
        }
    }
    points.push(last.end.point);
    knots.extend([last.b; 4]);
    let weights = vec![1.0; points.len()];
    NurbsCurve3::new(KnotVector::new(3, knots).ok()?, points, weights).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::primitives::{arc, revolution};
    use std::f64::consts::TAU;

    fn worst(carrier: &SplineCarrier, pcurve: &NurbsCurve2, lift: &Lift) -> f64 {
        let (a, b) = pcurve.domain();
        assert_eq!(lift.curve.domain(), (a, b));
        (0..=500)
            .map(|k| a + (b - a) * f64::from(k) / 500.0)
            .map(|t| (lift.curve.point(t) - carrier.point(pcurve.point(t))).length())
            .fold(0.0, f64::max)
    }

    fn ball() -> SplineCarrier {
        let half = arc(DVec3::ZERO, DVec3::X, DVec3::Z, -1.5, 1.5).unwrap();
        SplineCarrier::new(revolution(&half, DVec3::ZERO, DVec3::Z, 0.0, TAU).unwrap())
    }

    #[test]
    fn planes_and_iso_lines_are_exact() {
        let knots = |a, b| KnotVector::bezier(1, a, b).unwrap();
        let corners = [DVec3::ZERO, DVec3::new(0.0, 2.0, 1.0), DVec3::X, DVec3::new(1.0, 2.0, 1.0)];
        let plane = NurbsSurface::new(knots(0.0, 4.0), knots(-1.0, 1.0), corners.to_vec(), vec![1.0; 4]);
        let plane = SplineCarrier::new(plane.unwrap());
        let bent = KnotVector::bezier(2, 3.0, 5.0).unwrap();
        let nodes = vec![DVec2::new(0.5, 0.0), DVec2::new(3.0, 1.0), DVec2::new(1.0, -0.5)];
        let bent = NurbsCurve2::new(bent, nodes, vec![1.0, 0.4, 1.0]).unwrap();
        let lifted = lift(&plane, &bent, 1e-9).unwrap();
        assert_eq!((lifted.deviation, lifted.curve.weights()), (0.0, bent.weights()));
        assert!(worst(&plane, &bent, &lifted) < 1e-15);
        let ball = ball();
        for (a, b) in [((1.0, -0.7), (5.0, -0.7)), ((2.0, 1.1), (2.0, -0.3))] {
            let line = NurbsCurve2::line(a.into(), b.into());
            let lifted = lift(&ball, &line, 1e-9).unwrap();
            assert_eq!((lifted.deviation, lifted.curve.degree()), (0.0, 2));
            assert!(worst(&ball, &line, &lifted) < 1e-13);
        }
    }

    #[test]
    fn slanted_lines_corners_and_turns_past_the_seam_follow_their_image() {
        let ball = ball();
        let polyline = KnotVector::new(1, vec![0.0, 0.0, 1.0, 2.0, 2.0]).unwrap();
        let corners = vec![DVec2::new(1.0, 0.0), DVec2::new(2.0, 1.0), DVec2::new(3.0, -0.5)];
        let polyline = NurbsCurve2::new(polyline, corners, vec![1.0; 3]).unwrap();
        let over = NurbsCurve2::line(DVec2::new(5.0, -0.5), DVec2::new(8.0, 0.5));
        for pcurve in [polyline, over] {
            let lifted = lift(&ball, &pcurve, 1e-7).unwrap();
            assert!(lifted.deviation <= 1e-7 && worst(&ball, &pcurve, &lifted) < 1.2e-7);
            assert!(lifted.curve.points().len() < 200, "{}", lifted.curve.points().len());
        }
    }
}
