//! Shapes that loops can be made of.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::address::Subject;
use super::error::{OperationError, Place, Problem};
use super::limits;
use crate::kernel::nurbs::{NurbsCurve2, freehand};
use crate::kernel::primitives::{lettering, outline};

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
    /// Smooth curves near `points` drawn by hand, closed, with its corners, within `tolerance` as a fraction of the domain
    /// (1/1000).
    Freehand {
        points: Vec<DVec2>,
        #[serde(default = "hand")]
        tolerance: f64,
    },
    /// The outlines of `text` (capitals, digits, `+-./` and blanks), one loop each and one for each counter:
    /// capitals `height` high in v, the lower left corner at `at`. `width` in u makes the text that wide;
    /// without it letters are as wide in u as they are made, in proportion to their height.
    Text {
        text: String,
        at: DVec2,
        height: f64,
        #[serde(default)]
        width: Option<f64>,
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
            Self::Text { .. } => "text",
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
                let curves = freehand::closed_chain(&points, *tolerance);
                if curves.is_empty() {
                    return Err(place.refused("a curve needs at least three points apart from each other"));
                }
                let native = |p: DVec2| domain.native(p);
                checked(curves.iter().map(|c| c.map_points(native)).collect(), point)?
            }
            Self::Text { text, at, height, width } => {
                return outlines(place, text, (*at, *height, *width), point);
            }
        };
        Ok(vec![curves])
    }
}

/// The loops of a text.
fn outlines(
    place: Place,
    text: &str,
    (at, height, width): (DVec2, f64, Option<f64>),
    point: impl Fn(&DVec2) -> Result<DVec2, OperationError>,
) -> Result<Vec<Vec<NurbsCurve2>>, OperationError> {
    limits::positive(place, "height", height)?;
    let (loops, own_width) = lettering::text(text).map_err(|character| {
        place.refused(format!(
            "there is no outline for `{character}`, only for {}",
            lettering::CHARACTERS.trim()
        ))
    })?;
    if loops.is_empty() {
        return Err(place.error(Problem::Nothing { what: "text" }));
    }
    let tall = height / lettering::HEIGHT;
    let wide = match width {
        Some(width) => limits::positive(place, "width", width)? / own_width,
        None => tall,
    };
    let (at, scale) = (point(&at)?, DVec2::new(wide, tall));
    loops.iter().map(|curves| checked(lettering::place(curves, |p| at + p * scale), &point)).collect()
}

/// `curves`, when all their control points pass `point`.
fn checked(
    curves: Vec<NurbsCurve2>,
    point: impl Fn(&DVec2) -> Result<DVec2, OperationError>,
) -> Result<Vec<NurbsCurve2>, OperationError> {
    curves.iter().flat_map(|c| c.points()).try_for_each(|p| point(p).map(drop))?;
    Ok(curves)
}
