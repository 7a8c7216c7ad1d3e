//! Addresses inside a face: loops, curves and control points by position, and looking them up.

use serde::{Deserialize, Serialize};

use super::error::{OperationError, Place};
use crate::kernel::nurbs::NurbsCurve2;
use crate::scene::document::{Document, FaceView};
use crate::scene::edit::FaceId;
use crate::scene::number;
use crate::scene::records::LoopRecord;

/// A curve of a trim loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurveId {
    /// Position of the loop in its face.
    #[serde(rename = "loop", with = "number::one")]
    pub trim_loop: usize,
    /// Position of the curve in its loop.
    #[serde(with = "number::one")]
    pub curve: usize,
}

/// A control point of a curve of a trim loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointId {
    /// Position of the loop in its face.
    #[serde(rename = "loop", with = "number::one")]
    pub trim_loop: usize,
    /// Position of the curve in its loop.
    #[serde(with = "number::one")]
    pub curve: usize,
    /// Position of the control point in its curve.
    #[serde(with = "number::one")]
    pub point: usize,
}

/// A control point of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NetId {
    /// Position along u.
    #[serde(with = "number::one")]
    pub i: usize,
    /// Position along v.
    #[serde(with = "number::one")]
    pub j: usize,
}

impl PointId {
    /// The curve that has the point.
    pub fn curve_id(self) -> CurveId {
        CurveId { trim_loop: self.trim_loop, curve: self.curve }
    }
}

/// A face of a document being operated on.
#[derive(Debug, Clone)]
pub(super) struct Subject<'a> {
    /// Its address.
    pub id: FaceId,
    /// The face.
    pub view: FaceView<'a>,
}

impl<'a> Subject<'a> {
    /// The face at `id`, or beyond the faces of its model in the next ones.
    pub fn find(document: &'a dyn Document, id: FaceId) -> Result<Self, OperationError> {
        let resolved = id.resolved(document);
        let found = resolved.and_then(|id| Some(Self { id, view: document.face(id)? }));
        found.ok_or_else(|| {
            let count = match id.model {
                0 => (0..document.model_count()).map(|m| document.face_count(m)).sum(),
                model => document.face_count(model),
            };
            Place::default().missing(id.to_string(), count)
        })
    }

    /// A loop.
    pub fn trim_loop(&self, index: usize) -> Result<&'a LoopRecord, OperationError> {
        let missing = || Place::face(self.id).missing(format!("loop {}", index + 1), self.view.loops.len());
        self.view.loops.get(index).copied().ok_or_else(missing)
    }

    /// A curve.
    pub fn curve(&self, id: CurveId) -> Result<&'a NurbsCurve2, OperationError> {
        let curves = &self.trim_loop(id.trim_loop)?.curves;
        let missing = || {
            let place = Place::trim_loop(self.id, id.trim_loop);
            place.missing(format!("curve {}", id.curve + 1), curves.len())
        };
        curves.get(id.curve).ok_or_else(missing)
    }

    /// The curve of a control point that exists.
    pub fn curve_of_point(&self, id: PointId) -> Result<&'a NurbsCurve2, OperationError> {
        let curve = self.curve(id.curve_id())?;
        let count = curve.points().len();
        if id.point >= count {
            let place = Place::curve(self.id, id.trim_loop, id.curve);
            return Err(place.missing(format!("point {}", id.point + 1), count));
        }
        Ok(curve)
    }

    /// Position in the net of a surface control point.
    pub fn net_index(&self, id: NetId) -> Result<usize, OperationError> {
        let (nu, nv) = self.view.surface.counts();
        if id.i >= nu || id.j >= nv {
            let what = format!("surface control point {} {} in a net of {nu} x {nv}", id.i + 1, id.j + 1);
            return Err(Place::face(self.id).missing(what, nu * nv));
        }
        Ok(id.i * nv + id.j)
    }

    /// Where a curve is.
    pub fn place(&self, id: CurveId) -> Place {
        Place::curve(self.id, id.trim_loop, id.curve)
    }
}
