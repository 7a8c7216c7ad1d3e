//! Planes, cylinders, cones, spheres and tori: natural parameters (lengths and angles), closed-form
//! inversion, and the exact NURBS over any box of natural parameters.
//!
//! Parameters are those of OpenCASCADE's elementary surfaces; [`AnalyticSurface::spline`] splits angles
//! as it does ([`super::conic`]), so the spline's (u, v) agree with its NURBS conversion of the same box.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DAffine3, DVec2, DVec3};

use super::conic::{arc_frame, arc_parameter};
use crate::kernel::nurbs::{KnotVector, NurbsError, NurbsSurface};

/// The shape in its own frame: axis z, angles from x towards y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// `(u, v, 0)`.
    Plane,
    /// `(r cos u, r sin u, v)`.
    Cylinder {
        /// Radius.
        radius: f64,
    },
    /// `((r + v sin a) cos u, (r + v sin a) sin u, v cos a)`.
    Cone {
        /// Radius at `v = 0`.
        radius: f64,
        /// Half of the opening angle, in `(0, pi/2)`.
        semi_angle: f64,
    },
    /// `(r cos v cos u, r cos v sin u, r sin v)`.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// `((R + r cos v) cos u, (R + r cos v) sin u, r sin v)`.
    Torus {
        /// Distance of the tube's middle from the axis.
        major: f64,
        /// Radius of the tube.
        minor: f64,
    },
}

/// A shape placed in model space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnalyticSurface {
    /// What it is.
    pub shape: Shape,
    /// Model space from the shape's frame. Need not be rigid.
    pub model_from_local: DAffine3,
}

impl AnalyticSurface {
    /// Periods in u and v, where the surface closes.
    pub fn periods(&self) -> [Option<f64>; 2] {
        match self.shape {
            Shape::Plane => [None, None],
            Shape::Torus { .. } => [Some(TAU); 2],
            _ => [Some(TAU), None],
        }
    }

    /// Natural limits of v: the poles of a sphere, all finite v otherwise.
    pub fn limits_v(&self) -> (f64, f64) {
        match self.shape {
            Shape::Sphere { .. } => (-FRAC_PI_2, FRAC_PI_2),
            Shape::Cone { radius, semi_angle } => (-radius / semi_angle.sin(), f64::INFINITY),
            _ => (f64::NEG_INFINITY, f64::INFINITY),
        }
    }

    /// Point, derivative in u, derivative in v at natural parameters.
    pub fn jet(&self, uv: DVec2) -> [DVec3; 3] {
        let (su, cu) = uv.x.sin_cos();
        let (sv, cv) = uv.y.sin_cos();
        let round = |r: f64, z: f64, dr: f64, dz: f64| {
            [
                DVec3::new(r * cu, r * su, z),
                DVec3::new(-r * su, r * cu, 0.0),
                DVec3::new(dr * cu, dr * su, dz),
            ]
        };
        let [p, du, dv] = match self.shape {
            Shape::Plane => [uv.extend(0.0), DVec3::X, DVec3::Y],
            Shape::Cylinder { radius } => round(radius, uv.y, 0.0, 1.0),
            Shape::Cone { radius, semi_angle } => {
                let (s, c) = semi_angle.sin_cos();
                round(radius + uv.y * s, uv.y * c, s, c)
            }
            Shape::Sphere { radius } => round(radius * cv, radius * sv, -radius * sv, radius * cv),
            Shape::Torus { major, minor } => round(major + minor * cv, minor * sv, -minor * sv, minor * cv),
        };
        let m = &self.model_from_local;
        [m.transform_point3(p), m.transform_vector3(du), m.transform_vector3(dv)]
    }

    /// Natural parameters of the point of the surface nearest to `p` (exactly so in a rigid frame),
    /// angles in `[0, 2 pi)` (v of a sphere: latitude). The axis gets `u = 0`.
    pub fn invert(&self, p: DVec3) -> DVec2 {
        let q = self.model_from_local.inverse().transform_point3(p);
        let u = if q.x == 0.0 && q.y == 0.0 { 0.0 } else { q.y.atan2(q.x).rem_euclid(TAU) };
        let rho = q.truncate().length();
        match self.shape {
            Shape::Plane => q.truncate(),
            Shape::Cylinder { .. } => DVec2::new(u, q.z),
            Shape::Cone { radius, semi_angle } => {
                let (s, c) = semi_angle.sin_cos();
                DVec2::new(u, (rho - radius) * s + q.z * c)
            }
            Shape::Sphere { .. } => DVec2::new(u, q.z.atan2(rho)),
            Shape::Torus { major, .. } => DVec2::new(u, q.z.atan2(rho - major).rem_euclid(TAU)),
        }
    }

    /// The exact NURBS over the box `min..max` of natural parameters.
    ///
    /// # Errors
    /// When the box is empty or reaches beyond a pole or apex, or numbers overflow.
    pub fn spline(&self, min: DVec2, max: DVec2) -> Result<NurbsSurface, NurbsError> {
        let knots = |direction| move |source| NurbsError::Knots { direction, source };
        // Profile in the (radius, height) half plane: position, weight.
        let line = |from: DVec2, to: DVec2| -> Result<_, NurbsError> {
            let k = KnotVector::bezier(1, min.y, max.y).map_err(knots("v"))?;
            Ok((k, vec![(from, 1.0), (to, 1.0)]))
        };
        let circle = |middle: f64, r: f64| -> Result<_, NurbsError> {
            let (k, nodes) = arc_frame(min.y, max.y)?;
            Ok((k, nodes.iter().map(|n| (DVec2::new(middle + r * n.x, r * n.y), n.weight)).collect()))
        };
        let (knots_v, profile): (KnotVector, Vec<(DVec2, f64)>) = match self.shape {
            Shape::Plane => {
                let knots_u = KnotVector::bezier(1, min.x, max.x).map_err(knots("u"))?;
                let knots_v = KnotVector::bezier(1, min.y, max.y).map_err(knots("v"))?;
                let corner = |u: f64, v: f64| self.model_from_local.transform_point3(DVec3::new(u, v, 0.0));
                let points = vec![
                    corner(min.x, min.y),
                    corner(min.x, max.y),
                    corner(max.x, min.y),
                    corner(max.x, max.y),
                ];
                return NurbsSurface::new(knots_u, knots_v, points, vec![1.0; 4]);
            }
            Shape::Cylinder { radius } => line(DVec2::new(radius, min.y), DVec2::new(radius, max.y))?,
            Shape::Cone { radius, semi_angle } => {
                let (s, c) = semi_angle.sin_cos();
                let at = |v: f64| DVec2::new((radius + v * s).max(0.0), v * c);
                line(at(min.y), at(max.y))?
            }
            Shape::Sphere { radius } => circle(0.0, radius)?,
            Shape::Torus { major, minor } => circle(major, minor)?,
        };
        let (knots_u, nodes) = arc_frame(min.x, max.x)?;
        let mut points = Vec::with_capacity(nodes.len() * profile.len());
        let mut weights = Vec::with_capacity(points.capacity());
        for node in &nodes {
            for (p, weight) in &profile {
                let local = DVec3::new(p.x * node.x, p.x * node.y, p.y);
                points.push(self.model_from_local.transform_point3(local));
                weights.push(weight * node.weight);
            }
        }
        NurbsSurface::new(knots_u, knots_v, points, weights)
    }

    /// The parameters in the spline over the box `min..max` of the point with natural parameters `uv`.
    pub fn spline_parameters(&self, min: DVec2, max: DVec2, uv: DVec2) -> DVec2 {
        let u = match self.shape {
            Shape::Plane => uv.x,
            _ => arc_parameter(min.x, max.x, uv.x),
        };
        let v = match self.shape {
            Shape::Sphere { .. } | Shape::Torus { .. } => arc_parameter(min.y, max.y, uv.y),
            _ => uv.y,
        };
        DVec2::new(u, v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    const SHAPES: [Shape; 5] = [
        Shape::Plane,
        Shape::Cylinder { radius: 2.0 },
        Shape::Cone { radius: 3.0, semi_angle: 0.4 },
        Shape::Sphere { radius: 1.5 },
        Shape::Torus { major: 4.0, minor: 1.0 },
    ];

    #[test]
    fn splines_and_inversion_agree_with_the_formulas() {
        let frame =
            DAffine3 { matrix3: DMat3::from_rotation_y(0.7), translation: DVec3::new(5.0, -3.0, 2.0) };
        let (min, max) = (DVec2::new(0.3, -1.1), DVec2::new(5.9, 1.3));
        for shape in SHAPES {
            let surface = AnalyticSurface { shape, model_from_local: frame };
            let spline = surface.spline(min, max).unwrap();
            for k in 0..=400 {
                let uv = min + (max - min) * DVec2::new(f64::from(k % 20) / 19.0, f64::from(k / 20) / 20.0);
                let [p, _, _] = surface.jet(uv);
                let st = surface.spline_parameters(min, max, uv);
                assert!((spline.point(st.x, st.y) - p).length() < 1e-12, "{shape:?} {uv}");
                let mut back = surface.invert(p);
                if surface.periods()[1].is_some() && back.y > 3.0 {
                    back.y -= TAU;
                }
                assert!((back - uv).length() < 1e-12, "{shape:?} {uv} {back}");
            }
        }
    }

    #[test]
    fn jets_hold_the_derivatives() {
        let h = 1e-6;
        for shape in SHAPES {
            let surface = AnalyticSurface { shape, model_from_local: DAffine3::IDENTITY };
            let uv = DVec2::new(0.8, 0.5);
            let [_, du, dv] = surface.jet(uv);
            let difference =
                |step: DVec2| (surface.jet(uv + step)[0] - surface.jet(uv - step)[0]) / (2.0 * h);
            assert!((difference(DVec2::new(h, 0.0)) - du).length() < 1e-8);
            assert!((difference(DVec2::new(0.0, h)) - dv).length() < 1e-8);
        }
    }
}
