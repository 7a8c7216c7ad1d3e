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
mod error;
mod joints;
mod limits;
mod points;
mod shape;
mod surface_points;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

pub use address::{CurveId, NetId, PointId};
pub use arrange::Transform;
pub use error::{OperationError, Place, Problem};
pub use shape::Shape;

use super::document::Document;
use super::edit::{Edit, FaceId};
use super::number;
use super::records::LoopRole;
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
        }
    }
}
