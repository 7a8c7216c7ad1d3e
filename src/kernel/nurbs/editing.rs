//! Shape-preserving changes of curves and surfaces: knot insertion, restriction, clamping, degree
//! elevation, isoparametric curves. The maps are made in `refinement` and `elevation`.

use glam::{DVec2, DVec3};

use super::spline_map::{Row, SplineMap};
use super::{KnotError, KnotVector, NurbsCurve, NurbsCurve3, NurbsError, NurbsSurface};
use crate::kernel::vector::Vector;

/// One of the two parameter directions of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// The first parameter.
    U,
    /// The second parameter.
    V,
}

impl Direction {
    fn name(self) -> &'static str {
        match self {
            Self::U => "u",
            Self::V => "v",
        }
    }

    fn error(self, source: KnotError) -> NurbsError {
        NurbsError::Knots { direction: self.name(), source }
    }
}

impl<V: Vector> NurbsCurve<V> {
    /// The same curve with `knots` put in.
    ///
    /// # Errors
    /// A knot outside the domain, or one repeated more than `degree + 1` times in all.
    pub fn inserted(&self, knots: &[f64]) -> Result<Self, NurbsError> {
        self.mapped(self.knots().insertion(knots))
    }

    /// The part over `[a, b]`, clamped, with the same parametrisation.
    ///
    /// # Errors
    /// When `[a, b]` is empty or leaves the domain.
    pub fn restricted(&self, a: f64, b: f64) -> Result<Self, NurbsError> {
        self.mapped(self.knots().restriction(a, b))
    }

    /// The same curve with clamped ends.
    pub fn clamped(&self) -> Self {
        let (a, b) = self.domain();
        self.restricted(a, b).expect("invariant: the domain of a curve is not empty")
    }

    /// The same curve with its degree raised by `times`; clamped.
    ///
    /// # Errors
    /// When the degree would exceed [`super::knots::MAX_DEGREE`].
    pub fn elevated(&self, times: usize) -> Result<Self, NurbsError> {
        self.mapped(self.knots().elevation(times))
    }

    fn mapped(&self, change: Result<(KnotVector, SplineMap), KnotError>) -> Result<Self, NurbsError> {
        let (knots, map) = change.map_err(|source| NurbsError::Knots { direction: "t", source })?;
        let (points, weights) = map.apply(self.points(), self.weights(), self.is_rational());
        Self::new(knots, points, weights)
    }
}

impl NurbsSurface {
    /// Knots along `direction`.
    pub fn knots(&self, direction: Direction) -> &KnotVector {
        match direction {
            Direction::U => self.knots_u(),
            Direction::V => self.knots_v(),
        }
    }

    /// The same surface with `knots` put in along `direction`.
    ///
    /// # Errors
    /// A knot outside the domain, or one repeated more than `degree + 1` times in all.
    pub fn inserted(&self, direction: Direction, knots: &[f64]) -> Result<Self, NurbsError> {
        self.mapped(direction, self.knots(direction).insertion(knots))
    }

    /// The part over the rectangle `min..max` of parameters, clamped, with the same parametrisation.
    ///
    /// # Errors
    /// When the rectangle is empty or leaves the domain.
    pub fn restricted(&self, min: DVec2, max: DVec2) -> Result<Self, NurbsError> {
        self.mapped(Direction::U, self.knots_u().restriction(min.x, max.x))?
            .mapped(Direction::V, self.knots_v().restriction(min.y, max.y))
    }

    /// The same surface with clamped knots in both directions.
    pub fn clamped(&self) -> Self {
        let ((u0, u1), (v0, v1)) = (self.knots_u().domain(), self.knots_v().domain());
        self.restricted(DVec2::new(u0, v0), DVec2::new(u1, v1))
            .expect("invariant: the domain of a surface is not empty")
    }

    /// The same surface with its degree along `direction` raised by `times`; clamped there.
    ///
    /// # Errors
    /// When the degree would exceed [`super::knots::MAX_DEGREE`].
    pub fn elevated(&self, direction: Direction, times: usize) -> Result<Self, NurbsError> {
        self.mapped(direction, self.knots(direction).elevation(times))
    }

    /// The curve of constant `direction` parameter `value` (clamped to the domain); it runs over the
    /// other parameter.
    pub fn iso_curve(&self, direction: Direction, value: f64) -> NurbsCurve3 {
        let knots = self.knots(direction);
        let (start, end) = knots.domain();
        let value = value.clamp(start, end);
        let arguments = std::iter::repeat_n(value, knots.degree());
        let row = SplineMap { rows: vec![Row::blossom(knots, knots.span(value), arguments)] };
        let (points, weights) = self.applied(direction, &row);
        let along = match direction {
            Direction::U => self.knots_v(),
            Direction::V => self.knots_u(),
        };
        NurbsCurve3::new(along.clone(), points, weights)
            .expect("invariant: convex combinations of valid control points are valid")
    }

    fn applied(&self, direction: Direction, map: &SplineMap) -> (Vec<DVec3>, Vec<f64>) {
        let (_, count_v) = self.counts();
        let rational = self.is_rational();
        match direction {
            Direction::U => map.apply_u(self.points(), self.weights(), rational, count_v),
            Direction::V => map.apply_v(self.points(), self.weights(), rational, count_v),
        }
    }

    fn mapped(
        &self,
        direction: Direction,
        change: Result<(KnotVector, SplineMap), KnotError>,
    ) -> Result<Self, NurbsError> {
        let (knots, map) = change.map_err(|source| direction.error(source))?;
        let (points, weights) = self.applied(direction, &map);
        match direction {
            Direction::U => Self::new(knots, self.knots_v().clone(), points, weights),
            Direction::V => Self::new(self.knots_u().clone(), knots, points, weights),
        }
    }
}
