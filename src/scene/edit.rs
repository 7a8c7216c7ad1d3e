//! Edits: what changed, as records before and after, so that every change can be undone bit for bit.
//!
//! An [`Edit`] is a list of [`Change`]s applied in order. Each holds only what it replaces: some curves of a
//! loop, some loops of a face, some control points of a surface. Applying is checked: a change whose
//! `before` is not what the scene holds is an error, and the scene stays as it was.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::document::{Document, FaceAttributes, SceneRecord};
use super::records::{FaceRecord, LengthUnit, LoopRecord, LoopRole, ModelRecord, PartRecord};
use crate::kernel::nurbs::{NurbsCurve2, NurbsError, NurbsSurface};

mod apply;
mod size;

pub use apply::net_applied;

/// A face by position: of its model in the scene, and in the model. Written for users as a number from 1
/// (first model) or as the pair `[model, face]`, both from 1.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceId {
    /// Position of the model.
    pub model: usize,
    /// Position of the face in its model.
    pub face: usize,
}

/// One undoable step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Edit {
    /// What to call it in a history.
    pub label: String,
    /// What it changes, in order.
    pub changes: Vec<Change>,
}

/// A control point of a surface's net with its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NetPoint {
    /// Position in the net, u-major.
    pub index: usize,
    /// The control point.
    pub point: glam::DVec3,
    /// Its weight.
    pub weight: f64,
}

/// All of a model but its faces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ModelHead {
    /// Name to show.
    pub name: String,
    /// Unit of every length.
    pub unit: LengthUnit,
    /// Its parts.
    pub parts: Vec<PartRecord>,
}

/// One replaced thing. `before` and `after` of lists are splices: what stood from `at` on, and what stands
/// there afterwards.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "the fields are explained at the type and at each case")]
pub enum Change {
    /// Curves of one loop, from curve `at` on.
    Curves { face: FaceId, trim_loop: usize, at: usize, before: Vec<NurbsCurve2>, after: Vec<NurbsCurve2> },
    /// Loops of one face, from loop `at` on.
    Loops { face: FaceId, at: usize, before: Vec<LoopRecord>, after: Vec<LoopRecord> },
    /// What a loop is said to be.
    Role { face: FaceId, trim_loop: usize, before: LoopRole, after: LoopRole },
    /// The whole surface of a face.
    Surface { face: FaceId, before: Box<NurbsSurface>, after: Box<NurbsSurface> },
    /// Some control points of a surface (the same ones before and after).
    Net { face: FaceId, before: Vec<NetPoint>, after: Vec<NetPoint> },
    /// Name, colour and the like.
    Attributes { face: FaceId, before: Box<FaceAttributes>, after: Box<FaceAttributes> },
    /// Faces of one model, from face `at` on.
    Faces { model: usize, at: usize, before: Vec<FaceRecord>, after: Vec<FaceRecord> },
    /// Name, unit and parts of a model.
    Model { model: usize, before: Box<ModelHead>, after: Box<ModelHead> },
    /// Models of the scene, from model `at` on.
    Models { at: usize, before: Vec<ModelRecord>, after: Vec<ModelRecord> },
}

/// Why an edit does not fit the scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EditError {
    /// There is no such model, face, loop, curve or control point.
    #[error("{place} does not exist")]
    Missing {
        /// What was looked for.
        place: String,
    },
    /// Something else stands there than the edit was made for.
    #[error("{place} is not what the edit was made for; the scene has changed meanwhile")]
    Mismatch {
        /// What differs.
        place: String,
    },
    /// The result would not be a valid surface.
    #[error("{place}: {source}")]
    Invalid {
        /// Where.
        place: String,
        /// What is wrong.
        source: NurbsError,
    },
}

impl Edit {
    /// An edit of one change.
    pub fn new(label: impl Into<String>, changes: Vec<Change>) -> Self {
        Self { label: label.into(), changes }
    }

    /// Whether nothing changes.
    pub fn is_empty(&self) -> bool {
        self.changes.iter().all(Change::is_empty)
    }

    /// The edit that takes this one back.
    pub fn inverse(&self) -> Self {
        Self { label: self.label.clone(), changes: self.changes.iter().rev().map(Change::inverse).collect() }
    }

    /// The faces whose geometry or looks change in place, sorted. Faces that come or go with [`Change::Faces`]
    /// and [`Change::Models`] are not among them.
    pub fn faces(&self) -> Vec<FaceId> {
        let mut faces: Vec<FaceId> = self.changes.iter().filter_map(Change::face).collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// Applies all changes, or none.
    ///
    /// # Errors
    /// A change does not fit; the scene is then as it was before.
    pub fn apply(&self, scene: &mut SceneRecord) -> Result<(), EditError> {
        for (done, change) in self.changes.iter().enumerate() {
            if let Err(error) = change.apply(scene) {
                for change in self.changes[..done].iter().rev() {
                    change
                        .inverse()
                        .apply(scene)
                        .expect("invariant: what was applied a moment ago can be taken back");
                }
                return Err(error);
            }
        }
        Ok(())
    }
}

impl Change {
    /// The face that changes in place.
    pub fn face(&self) -> Option<FaceId> {
        match self {
            Self::Curves { face, .. }
            | Self::Loops { face, .. }
            | Self::Role { face, .. }
            | Self::Surface { face, .. }
            | Self::Net { face, .. }
            | Self::Attributes { face, .. } => Some(*face),
            Self::Faces { .. } | Self::Model { .. } | Self::Models { .. } => None,
        }
    }

    /// Whether before and after are the same.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Curves { before, after, .. } => before == after,
            Self::Loops { before, after, .. } => before == after,
            Self::Role { before, after, .. } => before == after,
            Self::Surface { before, after, .. } => before == after,
            Self::Net { before, after, .. } => before == after,
            Self::Attributes { before, after, .. } => before == after,
            Self::Faces { before, after, .. } => before == after,
            Self::Model { before, after, .. } => before == after,
            Self::Models { before, after, .. } => before == after,
        }
    }

    /// The change that takes this one back.
    pub fn inverse(&self) -> Self {
        let mut inverse = self.clone();
        match &mut inverse {
            Self::Curves { before, after, .. } => std::mem::swap(before, after),
            Self::Loops { before, after, .. } => std::mem::swap(before, after),
            Self::Role { before, after, .. } => std::mem::swap(before, after),
            Self::Surface { before, after, .. } => std::mem::swap(before, after),
            Self::Net { before, after, .. } => std::mem::swap(before, after),
            Self::Attributes { before, after, .. } => std::mem::swap(before, after),
            Self::Faces { before, after, .. } => std::mem::swap(before, after),
            Self::Model { before, after, .. } => std::mem::swap(before, after),
            Self::Models { before, after, .. } => std::mem::swap(before, after),
        }
        inverse
    }
}

impl FaceId {
    /// The face as users count: a position beyond the faces of a model goes on through the next ones.
    pub fn resolved(self, document: &(impl Document + ?Sized)) -> Option<Self> {
        let Self { mut model, mut face } = self;
        while model < document.model_count() {
            let count = document.face_count(model);
            if face < count {
                return Some(Self { model, face });
            }
            face -= count;
            model += 1;
        }
        None
    }
}

impl std::fmt::Display for FaceId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.model {
            0 => write!(f, "face {}", self.face + 1),
            model => write!(f, "model {}, face {}", model + 1, self.face + 1),
        }
    }
}

impl Serialize for FaceId {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.model {
            0 => serializer.serialize_u64(self.face as u64 + 1),
            model => serializer.collect_seq([model as u64 + 1, self.face as u64 + 1]),
        }
    }
}

impl<'de> Deserialize<'de> for FaceId {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl<'de> serde::de::Visitor<'de> for Visitor {
            type Value = FaceId;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("the number of a face (from 1) or [model, face]")
            }

            fn visit_u64<E: serde::de::Error>(self, number: u64) -> Result<FaceId, E> {
                match number.checked_sub(1) {
                    Some(face) => Ok(FaceId { model: 0, face: face as usize }),
                    None => Err(E::custom("faces count from 1")),
                }
            }

            fn visit_i64<E: serde::de::Error>(self, number: i64) -> Result<FaceId, E> {
                self.visit_u64(u64::try_from(number).map_err(|_| E::custom("faces count from 1"))?)
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut pair: A) -> Result<FaceId, A::Error> {
                use serde::de::Error;
                let mut next = |index| -> Result<usize, A::Error> {
                    let number: u64 =
                        pair.next_element()?.ok_or_else(|| A::Error::invalid_length(index, &Visitor))?;
                    let position = number.checked_sub(1);
                    position.map(|p| p as usize).ok_or_else(|| A::Error::custom("faces count from 1"))
                };
                let id = FaceId { model: next(0)?, face: next(1)? };
                match pair.next_element::<u64>()? {
                    None => Ok(id),
                    Some(_) => Err(A::Error::invalid_length(3, &Visitor)),
                }
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}
