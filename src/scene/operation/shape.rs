//! Shapes that loops can be made of.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::address::Subject;
use super::error::{OperationError, Place, Problem};
use super::limits;
use crate::kernel::nurbs::NurbsCurve2;
use crate::kernel::primitives::outline;
use crate::kernel::query::freehand;

/// The shape of a new loop, in native surface parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields are explained at each case")]
pub enum Shape {
    /// Between two opposite corners.
    Rectangle { from: DVec2, to: DVec2 },
    /// An exact circle of the uv plane: one rational curve.
    Circle { centre: DVec2, radius: f64 },
    /// An exact ellipse: one rational curve. `radii` along its axes, turned by `degrees`.
    Ellipse {
        centre: DVec2,
        radii: DVec2,
        #[serde(default)]
        degrees: f64,
    },
    /// Straight lines through `points` and back to the first; three or more.
    Polyline { points: Vec<DVec2> },
    /// A smooth closed curve near `points` drawn by hand, within `tolerance` as a fraction of the domain
    /// (1/1000).
    Freehand {
        points: Vec<DVec2>,
        #[serde(default = "hand")]
        tolerance: f64,
    },
}

/// Steadiness of a hand, as a fraction of the domain.
fn hand() -> f64 {
    1e-3
}

impl Shape {
    /// What to call it.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Rectangle { .. } => "rectangle",
            Self::Circle { .. } => "circle",
            Self::Ellipse { .. } => "ellipse",
            Self::Polyline { .. } => "polyline",
            Self::Freehand { .. } => "freehand curve",
        }
    }

    /// The curves of its loops, checked.
    pub(super) fn loops(&self, subject: &Subject) -> Result<Vec<Vec<NurbsCurve2>>, OperationError> {
        let place = Place::face(subject.id);
        let point = |p: &DVec2| limits::trim_point(subject, place, *p);
        let curves = match self {
            Self::Rectangle { from, to } => {
                let (from, to) = (point(from)?, point(to)?);
                let (min, max) = (from.min(to), from.max(to));
                for (what, side) in [("width", max.x - min.x), ("height", max.y - min.y)] {
                    limits::positive(place, what, side)?;
                }
                outline::rectangle(min, max)
            }
            Self::Circle { centre, radius } => {
                limits::positive(place, "radius", *radius)?;
                checked(outline::circle(point(centre)?, *radius), point)?
            }
            Self::Ellipse { centre, radii, degrees } => {
                limits::positive(place, "radius along u", radii.x)?;
                limits::positive(place, "radius along v", radii.y)?;
                let turn = DVec2::from_angle(limits::finite(place, "degrees", *degrees)?.to_radians());
                let (centre, circle) = (point(centre)?, outline::circle(DVec2::ZERO, 1.0));
                let place_point = |p: DVec2| centre + turn.rotate(p * *radii);
                checked(circle.iter().map(|c| c.map_points(place_point)).collect(), point)?
            }
            Self::Polyline { points } => {
                let mut corners = points.iter().map(point).collect::<Result<Vec<_>, _>>()?;
                corners.dedup();
                if corners.len() > 1 && corners.first() == corners.last() {
                    corners.pop();
                }
                if corners.len() < 3 {
                    let reason = "a polyline needs at least three different points";
                    return Err(place.error(Problem::Refused { reason: reason.into() }));
                }
                outline::polygon(&corners)
            }
            Self::Freehand { points, tolerance } => {
                limits::positive(place, "tolerance", *tolerance)?;
                let domain = subject.view.domain();
                let points: Vec<DVec2> =
                    points.iter().map(|p| Ok(domain.normalise(point(p)?))).collect::<Result<_, _>>()?;
                let curve = freehand::closed_curve(&points, *tolerance);
                let curve =
                    curve.ok_or_else(|| place.refused("a curve needs at least three different points"))?;
                checked(vec![curve.map_points(|p: DVec2| domain.native(p))], point)?
            }
        };
        Ok(vec![curves])
    }
}

/// `curves`, when all their control points pass `point`.
fn checked(
    curves: Vec<NurbsCurve2>,
    point: impl Fn(&DVec2) -> Result<DVec2, OperationError>,
) -> Result<Vec<NurbsCurve2>, OperationError> {
    curves.iter().flat_map(|c| c.points()).try_for_each(|p| point(p).map(drop))?;
    Ok(curves)
}
