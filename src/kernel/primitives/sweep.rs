//! Surfaces swept by a curve, as exact NURBS: along a vector, about an axis, and ruled between two curves.

use glam::{DAffine3, DVec3};

use super::conic::{arc, arc_frame};
use crate::kernel::nurbs::{KnotVector, NurbsCurve3, NurbsError, NurbsSurface};

/// A curve that sweeps, in a form that can be cut to a range as OpenCASCADE cuts it.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// A spline, or a line over its length: its parameters do not change when it is cut.
    Spline(NurbsCurve3),
    /// An arc over its angles: cutting it splits it anew.
    Arc {
        /// Centre.
        centre: DVec3,
        /// Radius vector at angle 0.
        x: DVec3,
        /// Radius vector at a right angle.
        y: DVec3,
        /// First angle.
        start: f64,
        /// Last angle.
        end: f64,
    },
}

impl Profile {
    /// The arc's range of angles; `None` for splines.
    pub fn arc(&self) -> Option<(f64, f64)> {
        match self {
            Self::Spline(_) => None,
            Self::Arc { start, end, .. } => Some((*start, *end)),
        }
    }

    /// Moved by an affine map.
    pub fn moved(&self, by: DAffine3) -> Self {
        match self {
            Self::Spline(curve) => Self::Spline(curve.map_points(|p| by.transform_point3(p))),
            Self::Arc { centre, x, y, start, end } => Self::Arc {
                centre: by.transform_point3(*centre),
                x: by.transform_vector3(*x),
                y: by.transform_vector3(*y),
                start: *start,
                end: *end,
            },
        }
    }

    /// All of it as a spline.
    ///
    /// # Errors
    /// When an arc is empty or not finite.
    pub fn spline(&self) -> Result<NurbsCurve3, NurbsError> {
        match self {
            Self::Spline(curve) => Ok(curve.clone()),
            Self::Arc { centre, x, y, start, end } => arc(*centre, *x, *y, *start, *end),
        }
    }

    /// The part over `range` where that changes parameters (arcs); all of a spline.
    ///
    /// # Errors
    /// When the range is empty.
    pub fn cut(&self, range: (f64, f64)) -> Result<NurbsCurve3, NurbsError> {
        match self {
            Self::Spline(curve) => Ok(curve.clone()),
            Self::Arc { centre, x, y, .. } => arc(*centre, *x, *y, range.0, range.1),
        }
    }
}

/// A surface made by sweeping a profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// What sweeps.
    pub profile: Profile,
    /// How.
    pub motion: Motion,
    /// Model space from the space of the sweep.
    pub model_from_local: DAffine3,
}

/// How a profile sweeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// u along the profile, v the way along the vector, a length.
    Extrusion {
        /// From the profile to its copy.
        direction: DVec3,
    },
    /// u the angle about an axis, from 0; v along the profile.
    Revolution {
        /// A point of the axis.
        origin: DVec3,
        /// Its direction; angles are right-handed about it.
        axis: DVec3,
        /// Last angle.
        sweep: f64,
    },
}

impl Sweep {
    /// For u and v: the range of angles where the parameter is that of an arc.
    pub fn arcs(&self) -> [Option<(f64, f64)>; 2] {
        match self.motion {
            Motion::Extrusion { .. } => [self.profile.arc(), None],
            Motion::Revolution { sweep, .. } => [Some((0.0, sweep)), self.profile.arc()],
        }
    }

    /// The whole surface.
    ///
    /// # Errors
    /// When ranges are empty or numbers overflow.
    pub fn spline(&self) -> Result<NurbsSurface, NurbsError> {
        self.over(self.arcs())
    }

    /// The surface with its arcs cut to `ranges` of angles (ignored where there is no arc).
    ///
    /// # Errors
    /// When ranges are empty or numbers overflow.
    pub fn over(&self, ranges: [Option<(f64, f64)>; 2]) -> Result<NurbsSurface, NurbsError> {
        let surface = match self.motion {
            Motion::Extrusion { direction } => {
                let profile = match ranges[0] {
                    Some(range) => self.profile.cut(range)?,
                    None => self.profile.spline()?,
                };
                extrusion(&profile, direction)?
            }
            Motion::Revolution { origin, axis, sweep } => {
                let profile = match ranges[1] {
                    Some(range) => self.profile.cut(range)?,
                    None => self.profile.spline()?,
                };
                let (start, end) = ranges[0].unwrap_or((0.0, sweep));
                revolution(&profile, origin, axis, start, end)?
            }
        };
        let place = self.model_from_local;
        Ok(if place == DAffine3::IDENTITY {
            surface
        } else {
            surface.map_points(|p| place.transform_point3(p))
        })
    }
}

/// `curve(u) + v * direction / |direction|` for `v` from 0 to `|direction|`.
///
/// # Errors
/// When the direction is zero or numbers overflow.
pub fn extrusion(curve: &NurbsCurve3, direction: DVec3) -> Result<NurbsSurface, NurbsError> {
    let knots = |source| NurbsError::Knots { direction: "v", source };
    let knots_v = KnotVector::bezier(1, 0.0, direction.length()).map_err(knots)?;
    let points = curve.points().iter().flat_map(|p| [*p, *p + direction]).collect();
    let weights = curve.weights().iter().flat_map(|w| [*w, *w]).collect();
    NurbsSurface::new(curve.knots().clone(), knots_v, points, weights)
}

/// `curve(v)` turned about the axis through `origin` along `axis` (right-handed) by `u` from `start` to `end`.
///
/// # Errors
/// When the interval is empty, the axis is zero or numbers overflow.
pub fn revolution(
    curve: &NurbsCurve3,
    origin: DVec3,
    axis: DVec3,
    start: f64,
    end: f64,
) -> Result<NurbsSurface, NurbsError> {
    let (knots_u, nodes) = arc_frame(start, end)?;
    let axis = axis.normalize_or_zero();
    let mut points = Vec::with_capacity(nodes.len() * curve.points().len());
    let mut weights = Vec::with_capacity(points.capacity());
    for node in &nodes {
        for (p, w) in curve.points().iter().zip(curve.weights()) {
            let foot = origin + axis * (*p - origin).dot(axis);
            let x = *p - foot;
            points.push(foot + x * node.x + axis.cross(x) * node.y);
            weights.push(w * node.weight);
        }
    }
    NurbsSurface::new(knots_u, curve.knots().clone(), points, weights)
}

/// The ruled surface between two curves over the same knots: `v = 0` on the first, `v = 1` on the second.
///
/// # Errors
/// When the curves do not have the same number of control points.
pub fn ruled(first: &NurbsCurve3, second: &NurbsCurve3) -> Result<NurbsSurface, NurbsError> {
    let knots_v =
        KnotVector::bezier(1, 0.0, 1.0).map_err(|source| NurbsError::Knots { direction: "v", source })?;
    let points = first.points().iter().zip(second.points()).flat_map(|(a, b)| [*a, *b]).collect();
    let weights = first.weights().iter().zip(second.weights()).flat_map(|(a, b)| [*a, *b]).collect();
    NurbsSurface::new(first.knots().clone(), knots_v, points, weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::primitives::{arc, arc_parameter};

    #[test]
    fn a_turned_line_is_a_cone() {
        let line = NurbsCurve3::line(DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 3.0));
        let cone = revolution(&line, DVec3::ZERO, DVec3::Z, 0.0, 5.0).unwrap();
        for k in 0..=20 {
            let (angle, v) = (0.25 * f64::from(k), 0.05 * f64::from(k));
            let p = cone.point(arc_parameter(0.0, 5.0, angle), v);
            let expected = DVec3::new((1.0 + v) * angle.cos(), (1.0 + v) * angle.sin(), 3.0 * v);
            assert!((p - expected).length() < 1e-12);
        }
    }

    #[test]
    fn extruded_and_ruled_surfaces_hold_their_curves() {
        let curve = arc(DVec3::ZERO, DVec3::X, DVec3::Y, 0.0, 2.0).unwrap();
        let tube = extrusion(&curve, DVec3::new(0.0, 3.0, 4.0)).unwrap();
        let band = ruled(&curve, &curve.map_points(|p| p * 2.0)).unwrap();
        for k in 0..=10 {
            let t = 0.2 * f64::from(k);
            assert!((tube.point(t, 5.0) - curve.point(t) - DVec3::new(0.0, 3.0, 4.0)).length() < 1e-12);
            assert!((band.point(t, 0.5) - curve.point(t) * 1.5).length() < 1e-12);
        }
    }
}
