//! Non-uniform rational B-splines of any degree: knot vectors, curves and surfaces.

pub mod basis;
pub mod coarsening;
mod curve;
pub mod decomposition;
pub mod editing;
pub mod elevation;
pub mod freehand;
pub mod knots;
pub mod refinement;
mod serial;
pub mod shape;
mod spline_map;
pub mod surface;

pub use basis::Basis;
pub use coarsening::Coarse;
pub use curve::{NurbsCurve, NurbsCurve2, NurbsCurve3};
pub use editing::Direction;
pub use knots::{KnotError, KnotVector};
pub use shape::DegenerateEdges;
pub use surface::{NurbsSurface, SurfaceJet};

/// Why control data do not form a NURBS curve or surface.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NurbsError {
    /// The knot vector is not valid.
    #[error("knots in {direction}: {source}")]
    Knots {
        /// `"t"`, `"u"` or `"v"`.
        direction: &'static str,
        /// What is wrong with it.
        source: KnotError,
    },
    /// Numbers of control points, weights and knots do not fit together.
    #[error("expected {expected} {what}, found {found}")]
    Count {
        /// What was counted.
        what: &'static str,
        /// Number that degree and knots call for.
        expected: usize,
        /// Number given.
        found: usize,
    },
    /// A control point has a coordinate that is not finite.
    #[error("control point {index} is not finite")]
    Point {
        /// Position in the list of control points.
        index: usize,
    },
    /// A weight is zero, negative or not finite.
    #[error("weight {index} is {value}; weights must be positive and finite")]
    Weight {
        /// Position in the list of weights.
        index: usize,
        /// The weight.
        value: f64,
    },
}

/// Checks points and weights; shared by curves and surfaces.
pub(crate) fn check_points<V: super::vector::Vector>(
    points: &[V],
    weights: &[f64],
    expected: usize,
) -> Result<(), NurbsError> {
    if points.len() != expected {
        return Err(NurbsError::Count { what: "control points", expected, found: points.len() });
    }
    if weights.len() != expected {
        return Err(NurbsError::Count { what: "weights", expected, found: weights.len() });
    }
    if let Some(index) = points.iter().position(|p| !p.is_finite()) {
        return Err(NurbsError::Point { index });
    }
    match weights.iter().position(|w| !(w.is_finite() && *w > 0.0)) {
        Some(index) => Err(NurbsError::Weight { index, value: weights[index] }),
        None => Ok(()),
    }
}
