//! What a user asks for: operations on faces, loops, curves and control points, from the mouse or a script.
//!
//! [`Operation::perform`] is pure: it reads a document and returns the [`Edit`] that does it, or says why
//! not. Ends of neighbouring curves that were joined stay joined . Moved points stop at the
//! border of the surface's domain unless `beyond` is set, the surface is closed there, or they were
//! outside already; typed coordinates are refused there instead.
//!
//! In scripts an operation is an object with the field `op` and the fields of its case; positions count from 1.

mod address;
mod arrange;
mod curves;
mod error;
mod faces;
mod joints;
mod limits;
mod loops;
mod points;
pub mod random;
pub mod script;
mod shape;
mod surface_points;
mod surfaces;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

pub use address::{CurveId, NetId, PointId};
pub use arrange::Transform;
pub use error::{OperationError, Place, Problem};
pub use shape::Shape;

use super::document::Document;
use super::edit::{Edit, FaceId};
use super::number;
use super::records::{LoopRecord, LoopRole};
use crate::kernel::nurbs::Direction;
use address::Subject;

/// Something to do to a scene. Positions count from 0 here and from 1 in scripts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields are explained at each case")]
pub enum Operation {
    /// Moves control points of trim curves `by` the same vector of the uv plane.
    MovePoints {
        face: FaceId,
        points: Vec<PointId>,
        by: DVec2,
        #[serde(default)]
        beyond: bool,
    },
    /// Puts one control point of a trim curve at `to`; outside the domain it is refused unless `beyond`.
    SetPoint {
        face: FaceId,
        point: PointId,
        to: DVec2,
        #[serde(default)]
        beyond: bool,
    },
    /// Gives control points of trim curves this `weight`.
    SetWeight { face: FaceId, points: Vec<PointId>, weight: f64 },
    /// Moves whole curves `by` the same vector, as far as they stay in the domain.
    MoveCurves {
        face: FaceId,
        curves: Vec<CurveId>,
        by: DVec2,
        #[serde(default)]
        beyond: bool,
    },
    /// Moves, turns, scales or mirrors whole loops.
    TransformLoops {
        face: FaceId,
        #[serde(with = "number::many")]
        loops: Vec<usize>,
        transform: Transform,
        #[serde(default)]
        beyond: bool,
    },
    /// Adds a loop (several for text) behind the others.
    AddLoop {
        face: FaceId,
        shape: Shape,
        #[serde(default)]
        role: LoopRole,
    },
    /// Deletes whole loops. Without loops a face is untrimmed.
    DeleteLoops {
        face: FaceId,
        #[serde(with = "number::many")]
        loops: Vec<usize>,
    },
    /// Lets loops run the other way round; the face does not change.
    ReverseLoops {
        face: FaceId,
        #[serde(with = "number::many")]
        loops: Vec<usize>,
    },
    /// Moves control points of the surface `by` the same vector of model space.
    MoveSurfacePoints { face: FaceId, points: Vec<NetId>, by: DVec3 },
    /// Puts one control point of the surface at `to`.
    SetSurfacePoint { face: FaceId, point: NetId, to: DVec3 },
    /// Gives control points of the surface this `weight`.
    SetSurfaceWeight { face: FaceId, points: Vec<NetId>, weight: f64 },
    /// Inserts the knot `at` into a curve, `times` times (once). The shape stays.
    InsertKnot {
        face: FaceId,
        curve: CurveId,
        at: f64,
        #[serde(default = "once")]
        times: usize,
    },
    /// Removes one repeat of the inner knot `at`; refused if the shape would change by more than `tolerance`
    /// (none given: rounding).
    RemoveKnot {
        face: FaceId,
        curve: CurveId,
        at: f64,
        #[serde(default)]
        tolerance: Option<f64>,
    },
    /// Raises the degree of a curve `by` that much (1). The shape stays.
    ElevateDegree {
        face: FaceId,
        curve: CurveId,
        #[serde(default = "once")]
        by: usize,
    },
    /// Lowers the degree of a curve by one; refused if the shape would change by more than `tolerance`
    /// (none given: rounding).
    ReduceDegree {
        face: FaceId,
        curve: CurveId,
        #[serde(default)]
        tolerance: Option<f64>,
    },
    /// Splits a curve in two at the parameter `at`.
    SplitCurve { face: FaceId, curve: CurveId, at: f64 },
    /// Joins a curve and the next one of its loop into one. Exact, with a knot where they met; that knot is
    /// removed as far as the shape stays within `tolerance` (none given: rounding).
    JoinCurves {
        face: FaceId,
        curve: CurveId,
        #[serde(default)]
        tolerance: Option<f64>,
    },
    /// Deletes curves; what is left of their loops stays open there.
    DeleteCurves { face: FaceId, curves: Vec<CurveId> },
    /// Closes the gaps of loops: tiny ones by moving an end, others with a line.
    CloseLoops {
        face: FaceId,
        #[serde(with = "number::many")]
        loops: Vec<usize>,
    },
    /// Copies loops within their face, moved `by` a vector.
    DuplicateLoops {
        face: FaceId,
        #[serde(with = "number::many")]
        loops: Vec<usize>,
        #[serde(default)]
        by: DVec2,
    },
    /// Adds loops that were copied elsewhere, moved `by` a vector.
    PasteLoops {
        face: FaceId,
        loops: Vec<LoopRecord>,
        #[serde(default)]
        by: DVec2,
    },
    /// Says what loops are: `Outer`, `Inner` (a hole or an island) or `Unknown`. Nesting decides what is drawn.
    SetRole {
        face: FaceId,
        #[serde(with = "number::many")]
        loops: Vec<usize>,
        role: LoopRole,
    },
    /// Deletes all loops of a face.
    Untrim { face: FaceId },
    /// Inserts the knot `at` into a surface along `direction`, `times` times (once). The shape stays.
    InsertSurfaceKnot {
        face: FaceId,
        direction: Direction,
        at: f64,
        #[serde(default = "once")]
        times: usize,
    },
    /// Raises the degree of a surface along `direction`, `by` that much (1). The shape stays.
    ElevateSurface {
        face: FaceId,
        direction: Direction,
        #[serde(default = "once")]
        by: usize,
    },
    /// Lets a parameter of the surface run the other way; trims and normal stay where they are in space.
    ReverseSurface { face: FaceId, direction: Direction },
    /// Exchanges u and v of a surface; trims and normal stay where they are in space.
    SwapSurface { face: FaceId },
    /// Turns the outside of a face to its other side.
    FlipNormal { face: FaceId },
    /// Names faces; no name takes it away.
    SetName {
        faces: Vec<FaceId>,
        #[serde(default)]
        name: Option<String>,
    },
    /// Colours faces (linear RGB, 0 to 1); no colour takes it away.
    SetColour {
        faces: Vec<FaceId>,
        #[serde(default)]
        colour: Option<[f32; 3]>,
    },
    /// Puts faces on a layer; no layer takes it away.
    SetLayer {
        faces: Vec<FaceId>,
        #[serde(default)]
        layer: Option<i32>,
    },
    /// Deletes faces; those behind them get lower numbers.
    DeleteFaces { faces: Vec<FaceId> },
    /// Copies faces to the end of their models, moved `by` a vector of model space.
    DuplicateFaces {
        faces: Vec<FaceId>,
        #[serde(default)]
        by: DVec3,
    },
}

/// Default of repeat counts.
fn once() -> usize {
    1
}

impl Operation {
    /// The edit that does it.
    ///
    /// # Errors
    /// See [`Problem`]; the message says at which face, loop, curve and point.
    pub fn perform(&self, document: &dyn Document) -> Result<Edit, OperationError> {
        let subject = |face: &FaceId| Subject::find(document, *face);
        match self {
            Self::MovePoints { face, points, by, beyond } => {
                points::move_points(&subject(face)?, points, *by, *beyond)
            }
            Self::SetPoint { face, point, to, beyond } => {
                points::set_point(&subject(face)?, *point, *to, *beyond)
            }
            Self::SetWeight { face, points, weight } => points::set_weight(&subject(face)?, points, *weight),
            Self::MoveCurves { face, curves, by, beyond } => {
                points::move_curves(&subject(face)?, curves, *by, *beyond)
            }
            Self::TransformLoops { face, loops, transform, beyond } => {
                arrange::transform(&subject(face)?, loops, transform, *beyond)
            }
            Self::AddLoop { face, shape, role } => arrange::add(&subject(face)?, shape, *role),
            Self::DeleteLoops { face, loops } => arrange::delete(&subject(face)?, loops),
            Self::ReverseLoops { face, loops } => arrange::reverse(&subject(face)?, loops),
            Self::MoveSurfacePoints { face, points, by } => {
                surface_points::shift(&subject(face)?, points, *by)
            }
            Self::SetSurfacePoint { face, point, to } => surface_points::put(&subject(face)?, *point, *to),
            Self::SetSurfaceWeight { face, points, weight } => {
                surface_points::weigh(&subject(face)?, points, *weight)
            }
            Self::InsertKnot { face, curve, at, times } => {
                curves::insert_knot(&subject(face)?, *curve, *at, *times)
            }
            Self::RemoveKnot { face, curve, at, tolerance } => {
                curves::remove_knot(&subject(face)?, *curve, *at, *tolerance)
            }
            Self::ElevateDegree { face, curve, by } => curves::elevate(&subject(face)?, *curve, *by),
            Self::ReduceDegree { face, curve, tolerance } => {
                curves::reduce(&subject(face)?, *curve, *tolerance)
            }
            Self::SplitCurve { face, curve, at } => curves::split(&subject(face)?, *curve, *at),
            Self::JoinCurves { face, curve, tolerance } => curves::join(&subject(face)?, *curve, *tolerance),
            Self::DeleteCurves { face, curves } => loops::delete_curves(&subject(face)?, curves),
            Self::CloseLoops { face, loops } => loops::close(&subject(face)?, loops),
            Self::DuplicateLoops { face, loops, by } => loops::duplicate(&subject(face)?, loops, *by),
            Self::PasteLoops { face, loops, by } => loops::paste(&subject(face)?, loops, *by),
            Self::SetRole { face, loops, role } => loops::set_role(&subject(face)?, loops, *role),
            Self::Untrim { face } => loops::untrim(&subject(face)?),
            Self::InsertSurfaceKnot { face, direction, at, times } => {
                surfaces::insert_knot(&subject(face)?, *direction, *at, *times)
            }
            Self::ElevateSurface { face, direction, by } => {
                surfaces::elevate(&subject(face)?, *direction, *by)
            }
            Self::ReverseSurface { face, direction } => surfaces::reverse(&subject(face)?, *direction),
            Self::SwapSurface { face } => Ok(surfaces::swap(&subject(face)?)),
            Self::FlipNormal { face } => Ok(surfaces::flip_normal(&subject(face)?)),
            Self::SetName { faces, name } => {
                faces::set(document, faces, "Rename face", |a| a.name.clone_from(name))
            }
            Self::SetColour { faces, colour } => {
                let colour = faces::colour(*colour)?;
                faces::set(document, faces, "Colour face", |a| a.colour = colour)
            }
            Self::SetLayer { faces, layer } => faces::set(document, faces, "Set layer", |a| a.layer = *layer),
            Self::DeleteFaces { faces } => faces::delete(document, faces),
            Self::DuplicateFaces { faces, by } => faces::duplicate(document, faces, *by),
        }
    }
}
