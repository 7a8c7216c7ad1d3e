//! The surfaces of the demo scene: planes, exact surfaces of revolution, spheres and tori, and
//! free-form sheets of high degree.

use glam::{DVec2, DVec3};

use super::outline::quarter_arcs;
use crate::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};

/// The rectangle `origin + u * x + v * y` over the uv box from `min` to `max`.
pub fn plane(origin: DVec3, x: DVec3, y: DVec3, min: DVec2, max: DVec2) -> NurbsSurface {
    let at = |u: f64, v: f64| origin + x * u + y * v;
    let points = vec![at(min.x, min.y), at(min.x, max.y), at(max.x, min.y), at(max.x, max.y)];
    let knots = |a, b| KnotVector::bezier(1, a, b).expect("the box is not empty");
    surface(knots(min.x, max.x), knots(min.y, max.y), points, vec![1.0; 4])
}

/// `profile` (radius, height) turned once around the z axis: u is four quarter turns, 0 to 4, and
/// v the parameter of the profile. Exact; closed in u with its seam in the plane y = 0, x > 0.
pub fn revolved(profile: &NurbsCurve2) -> NurbsSurface {
    let (knots, ring) = quarter_arcs();
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for (direction, weight) in ring {
        for (p, w) in profile.points().iter().zip(profile.weights()) {
            points.push(DVec3::new(direction.x * p.x, direction.y * p.x, p.y));
            weights.push(weight * w);
        }
    }
    surface(knots, profile.knots().clone(), points, weights)
}

/// The exact sphere around the origin: u 0 to 4 around, v 0 to 2 from the south to the north pole.
pub fn sphere(radius: f64) -> NurbsSurface {
    let (_, ring) = quarter_arcs();
    let knots = KnotVector::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0]).expect("sorted");
    // Half a circle from (0, -1) over (1, 0) to (0, 1).
    let half = [6, 7, 0, 1, 2].map(|i: usize| ring[i]);
    let points = half.iter().map(|(p, _)| *p * radius).collect();
    let weights = half.iter().map(|(_, w)| *w).collect();
    revolved(&NurbsCurve2::new(knots, points, weights).expect("finite"))
}

/// The exact torus around the z axis: u 0 to 4 around the axis, v 0 to 4 around the tube.
pub fn torus(major: f64, minor: f64) -> NurbsSurface {
    let (knots, ring) = quarter_arcs();
    let points = ring.iter().map(|(p, _)| DVec2::new(major, 0.0) + *p * minor).collect();
    let weights = ring.iter().map(|(_, w)| *w).collect();
    revolved(&NurbsCurve2::new(knots, points, weights).expect("finite"))
}

/// Parameters of [`sphere`] (and of any [`revolved`] surface, by u) in `direction` from the origin.
pub fn sphere_parameters(direction: DVec3) -> DVec2 {
    let longitude = direction.y.atan2(direction.x).rem_euclid(std::f64::consts::TAU);
    let latitude = direction.z.atan2(direction.truncate().length());
    DVec2::new(quarter_parameter(longitude), 1.0 + quarter_parameter_signed(latitude))
}

/// The parameter of [`quarter_arcs`] at `angle` radians, 0 or more: the arc `(1, cos 45, 1)` is
/// linear in the tangent of half the angle from its middle.
pub fn quarter_parameter(angle: f64) -> f64 {
    let quarter = std::f64::consts::FRAC_PI_2;
    let arc = (angle / quarter).floor();
    let from_middle = angle - (arc + 0.5) * quarter;
    arc + 0.5 + 0.5 * (0.5 * from_middle).tan() / (0.25 * quarter).tan()
}

fn quarter_parameter_signed(angle: f64) -> f64 {
    quarter_parameter(angle.abs()).copysign(angle)
}

/// The Bezier sheet of degree `(degree_u, degree_v)` over the unit square with control points
/// `at(s, t)` at `s = i / degree_u`, `t = j / degree_v`.
pub fn sheet(degree_u: usize, degree_v: usize, at: impl Fn(f64, f64) -> DVec3) -> NurbsSurface {
    let knots = |degree| KnotVector::bezier(degree, 0.0, 1.0).expect("degree is in range");
    let mut points = Vec::new();
    for i in 0..=degree_u {
        for j in 0..=degree_v {
            points.push(at(i as f64 / degree_u as f64, j as f64 / degree_v as f64));
        }
    }
    let weights = vec![1.0; points.len()];
    surface(knots(degree_u), knots(degree_v), points, weights)
}

/// [`NurbsSurface::new`] for data that the demo scene makes itself.
pub fn surface(u: KnotVector, v: KnotVector, points: Vec<DVec3>, weights: Vec<f64>) -> NurbsSurface {
    NurbsSurface::new(u, v, points, weights).expect("demo surfaces are well formed")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_and_tori_are_exact_and_their_parameters_known() {
        let (ball, ring) = (sphere(3.0), torus(5.0, 2.0));
        for i in 0..=16 {
            for j in 0..=8 {
                let (u, v) = (i as f64 * 0.25, j as f64 * 0.25);
                let p = ball.point(u, v);
                assert!((p.length() - 3.0).abs() < 1e-13);
                if i < 16 && j > 0 && j < 8 {
                    assert!(sphere_parameters(p).distance(DVec2::new(u, v)) < 1e-12);
                }
                let q = ring.point(u, 2.0 * v);
                let from_tube = DVec2::new(q.truncate().length() - 5.0, q.z);
                assert!((from_tube.length() - 2.0).abs() < 1e-13);
            }
        }
    }
}
