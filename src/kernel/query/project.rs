//! A curve in space, laid on a surface: the uv curve whose image is nearest to it.
//!
//! Points are inverted one after the other so that the branch is kept across seams (uv is
//! continuous, and may run past the domain of a closed surface); next to a pole the parameter that
//! has no meaning there is taken from the curve's side. The result is fitted to a tolerance in
//! model space ([`super::fit`]); on planes the inverse is affine and the result exact.

use glam::{DVec2, DVec3};

use super::carrier::Carrier;
use super::fit::{Sample, Target, fit};
use crate::kernel::nurbs::{NurbsCurve2, NurbsCurve3};
use crate::kernel::primitives::Shape;

/// A curve laid on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Projection {
    /// The uv curve.
    pub curve: NurbsCurve2,
    /// How far its image may be from that of the exact projection (model units, sampled).
    pub deviation: f64,
    /// How far the curve in space lies off the surface (model units, sampled).
    pub distance: f64,
}

/// Lays `curve` on `carrier`, starting next to `near` if given, to `tolerance` (model units). `None`
/// when numbers overflow.
pub fn project(
    carrier: &Carrier,
    curve: &NurbsCurve3,
    near: Option<DVec2>,
    tolerance: f64,
) -> Option<Projection> {
    if let Carrier::Analytic(surface) = carrier
        && surface.shape == Shape::Plane
    {
        let local = surface.model_from_local.inverse();
        let height =
            |p: &DVec3| surface.model_from_local.transform_vector3(DVec3::Z * local.transform_point3(*p).z);
        let distance = curve.points().iter().map(|p| height(p).length()).fold(0.0, f64::max);
        let flat = curve.map_points(|p| local.transform_point3(p).truncate());
        return Some(Projection { curve: flat, deviation: 0.0, distance });
    }
    let mut breaks = curve.knots().breaks();
    // Long splines are smooth across their knots: only breaks of low continuity must be kept.
    if breaks.len() > 3 {
        let knots = curve.knots().as_slice();
        let degree = curve.degree();
        let (start, end) = curve.domain();
        breaks.retain(|b| {
            *b == start || *b == end || knots.iter().filter(|k| *k == b).count() + 1 >= degree.max(2)
        });
    }
    let start = match near {
        Some(near) => Some(near),
        // A point inside the curve is less likely to sit on a seam or pole than its end.
        None => {
            let (a, b) = (breaks[0], breaks[1]);
            let mut uv = carrier.locate(curve.point(a + 0.37 * (b - a)), None);
            for k in (0..4).rev() {
                uv = carrier.locate(curve.point(a + 0.37 * (b - a) * f64::from(k) / 4.0), Some(uv));
            }
            Some(uv)
        }
    };
    // What lies off the surface is not known better than that.
    let (first, last) = curve.domain();
    let off = (0..5).map(|k| {
        let p = curve.point(first + (last - first) * 0.25 * f64::from(k));
        (carrier.point(carrier.locate(p, None)) - p).length()
    });
    let tolerance = tolerance.max(1e-2 * off.fold(0.0, f64::max));
    let mut target = Inversion { carrier, curve, distance: 0.0 };
    let (fitted, deviation) = fit(&mut target, &breaks, start, tolerance)?;
    let distance = target.distance;
    Some(Projection { curve: fitted, deviation, distance })
}

struct Inversion<'a> {
    carrier: &'a Carrier,
    curve: &'a NurbsCurve3,
    distance: f64,
}

impl Inversion<'_> {
    /// Parameters at `t`; what a pole leaves open is taken a small step inside the curve.
    fn locate(&self, t: f64, near: Option<DVec2>) -> DVec2 {
        let uv = self.carrier.locate(self.curve.point(t), near);
        let singular = self.carrier.is_singular(uv);
        if !singular[0] && !singular[1] {
            return uv;
        }
        let (start, end) = self.curve.domain();
        let step = 1e-4 * (end - start);
        let inner = if t + step <= end { t + step } else { t - step };
        let beside = self.carrier.locate(self.curve.point(inner), near);
        DVec2::new(if singular[0] { beside.x } else { uv.x }, if singular[1] { beside.y } else { uv.y })
    }
}

impl Target for Inversion<'_> {
    fn sample(&mut self, t: f64, near: Option<DVec2>, side: i32) -> Sample {
        let (start, end) = self.curve.domain();
        let uv = self.locate(t, near);
        // A one-sided derivative at a corner: evaluated a hair inside.
        let hair = 1e-9 * (end - start);
        let inside = (t + f64::from(side) * hair).clamp(start, end);
        let d = self.curve.derivatives(inside, 1);
        let [p, du, dv] = self.carrier.jet(uv);
        self.distance = self.distance.max((p - d[0]).length().min((p - self.curve.point(t)).length()));
        let singular = self.carrier.is_singular(uv);
        // Along a pole's own direction there is no derivative.
        let du = if singular[0] { DVec3::ZERO } else { du };
        let dv = if singular[1] { DVec3::ZERO } else { dv };
        Sample { uv, derivative: tangent(du, dv, d[1]) }
    }

    fn distance(&mut self, a: DVec2, b: DVec2) -> f64 {
        (self.carrier.point(a) - self.carrier.point(b)).length()
    }
}

/// `(u', v')` with `u' du + v' dv` nearest to `d`; a direction without length gets 0.
fn tangent(du: DVec3, dv: DVec3, d: DVec3) -> DVec2 {
    let (a, b, c) = (du.dot(du), du.dot(dv), dv.dot(dv));
    let (x, y) = (du.dot(d), dv.dot(d));
    let det = a * c - b * b;
    let result = if det > 1e-12 * a * c && det > 0.0 {
        DVec2::new(c * x - b * y, a * y - b * x) / det
    } else if a >= c {
        DVec2::new(if a > 0.0 { x / a } else { 0.0 }, 0.0)
    } else {
        DVec2::new(0.0, y / c)
    };
    if result.is_finite() { result } else { DVec2::ZERO }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::primitives::{AnalyticSurface, arc, revolution};
    use glam::DAffine3;
    use std::f64::consts::TAU;

    fn worst(carrier: &Carrier, projection: &Projection, curve: &NurbsCurve3) -> f64 {
        let ((a, b), (c, d)) = (projection.curve.domain(), curve.domain());
        let lifted: Vec<DVec3> = (0..=2000)
            .map(|k| carrier.point(projection.curve.point(a + (b - a) * f64::from(k) / 2000.0)))
            .collect();
        (0..=100)
            .map(|k| curve.point(c + (d - c) * f64::from(k) / 100.0))
            .map(|p| {
                lifted
                    .windows(2)
                    .map(|w| {
                        let e = w[1] - w[0];
                        let s = ((p - w[0]).dot(e) / e.length_squared().max(1e-300)).clamp(0.0, 1.0);
                        (w[0] + e * s - p).length()
                    })
                    .fold(f64::INFINITY, f64::min)
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn slanted_circles_on_a_cylinder_and_on_its_spline() {
        let cylinder =
            AnalyticSurface { shape: Shape::Cylinder { radius: 2.0 }, model_from_local: DAffine3::IDENTITY };
        // The plane z = x cuts an ellipse out of the cylinder.
        let curve =
            arc(DVec3::ZERO, DVec3::new(2.0, 0.0, 2.0), DVec3::new(0.0, 2.0, 0.0), 1.0, 1.0 + TAU).unwrap();
        let spline = cylinder.spline(DVec2::new(0.0, -3.0), DVec2::new(TAU, 3.0)).unwrap();
        for carrier in [Carrier::Analytic(cylinder), Carrier::spline(spline)] {
            let projection = project(&carrier, &curve, None, 1e-8).unwrap();
            assert!(projection.deviation <= 1e-8 && projection.distance < 1e-9, "{projection:?}");
            let (a, b) = projection.curve.domain();
            let turn = projection.curve.point(b).x - projection.curve.point(a).x;
            assert!((turn - TAU).abs() < 1e-7, "the seam is crossed without a jump: {turn}");
            // The polygon that measures has an error of its own.
            assert!(worst(&carrier, &projection, &curve) < 5e-6);
        }
    }

    #[test]
    fn meridians_through_a_pole_stay_straight() {
        let meridian = arc(DVec3::ZERO, DVec3::X, DVec3::Z, 0.3, 0.5 * std::f64::consts::PI).unwrap();
        let half = arc(DVec3::ZERO, DVec3::X, DVec3::Z, -1.5, 1.5).unwrap();
        let ball = revolution(&half, DVec3::ZERO, DVec3::Z, 0.0, TAU).unwrap();
        let sphere =
            AnalyticSurface { shape: Shape::Sphere { radius: 1.0 }, model_from_local: DAffine3::IDENTITY };
        let up = project(&Carrier::Analytic(sphere), &meridian, Some(DVec2::new(0.1, 0.3)), 1e-9).unwrap();
        assert_eq!(up.curve.degree(), 1);
        assert!(up.curve.points().iter().all(|p| p.x.abs() < 1e-9), "{up:?}");
        let part = arc(DVec3::ZERO, DVec3::X, DVec3::Z, -0.3, 1.2).unwrap();
        let on_spline = project(&Carrier::spline(ball), &part, None, 1e-9).unwrap();
        assert!(on_spline.distance < 1e-9 && on_spline.deviation <= 1e-9);
    }
}
