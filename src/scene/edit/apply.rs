//! Applying one change to a scene record, checked.

use super::{Change, EditError, FaceId, ModelHead, NetPoint};
use crate::kernel::nurbs::{NurbsError, NurbsSurface};
use crate::scene::document::{FaceAttributes, SceneRecord};
use crate::scene::records::{FaceRecord, LoopRecord, ModelRecord};

impl Change {
    /// Applies the change, or leaves `scene` as it is.
    ///
    /// # Errors
    /// The place is missing or holds something else than `before`.
    pub fn apply(&self, scene: &mut SceneRecord) -> Result<(), EditError> {
        match self {
            Self::Models { at, before, after } => {
                splice(&mut scene.models, *at, before, after, || "the list of models".into())?;
                let kept = before.len().min(after.len());
                hidden_models(scene, at + kept, before.len() - kept, after.len() - kept);
                Ok(())
            }
            Self::Model { model, before, after } => {
                replace_head(model_mut(scene, *model)?, *model, before, after)
            }
            Self::Faces { model, at, before, after } => {
                let place = || format!("the list of faces of model {}", model + 1);
                splice(&mut model_mut(scene, *model)?.faces, *at, before, after, place)?;
                let kept = before.len().min(after.len());
                hidden_faces(scene, *model, at + kept, before.len() - kept, after.len() - kept);
                Ok(())
            }
            Self::Curves { face, .. }
            | Self::Loops { face, .. }
            | Self::Role { face, .. }
            | Self::Surface { face, .. }
            | Self::Net { face, .. }
            | Self::Attributes { face, .. } => self.apply_to_face(face_mut(scene, *face)?),
        }
    }

    /// Applies a change of one face to its record, or leaves it as it is. Other changes do nothing here.
    ///
    /// # Errors
    /// As [`Self::apply`].
    pub fn apply_to_face(&self, record: &mut FaceRecord) -> Result<(), EditError> {
        match self {
            Self::Curves { face, trim_loop, .. } | Self::Role { face, trim_loop, .. } => {
                self.apply_to_loop(loop_mut(record, *face, *trim_loop)?)
            }
            Self::Loops { face, at, before, after } => splice(&mut record.loops, *at, before, after, || {
                format!("{face}: its loops from {} on", at + 1)
            }),
            Self::Surface { face, before, after } => {
                exchange(&mut record.surface, before, after, || format!("the surface of {face}"))
            }
            Self::Net { face, before, after } => {
                record.surface = net_applied(&record.surface, *face, before, after)?;
                Ok(())
            }
            Self::Attributes { face, before, after } => {
                if FaceAttributes::of(record) != **before {
                    return Err(EditError::Mismatch { place: format!("name or looks of {face}") });
                }
                after.put(record);
                Ok(())
            }
            Self::Faces { .. } | Self::Model { .. } | Self::Models { .. } => Ok(()),
        }
    }

    /// Applies a change of one loop to its record, or leaves it as it is. Other changes do nothing here.
    ///
    /// # Errors
    /// As [`Self::apply`].
    pub fn apply_to_loop(&self, trim: &mut LoopRecord) -> Result<(), EditError> {
        match self {
            Self::Curves { face, trim_loop, at, before, after } => {
                splice(&mut trim.curves, *at, before, after, || {
                    format!("{face}, loop {}: its curves from {} on", trim_loop + 1, at + 1)
                })
            }
            Self::Role { face, trim_loop, before, after } => exchange(&mut trim.role, before, after, || {
                format!("the role of {face}, loop {}", trim_loop + 1)
            }),
            _ => Ok(()),
        }
    }
}

/// The surface with some control points replaced, after checking that the old ones are there.
///
/// # Errors
/// A point is missing or differs from `before`, or the result is no surface.
pub fn net_applied(
    surface: &NurbsSurface,
    face: FaceId,
    before: &[NetPoint],
    after: &[NetPoint],
) -> Result<NurbsSurface, EditError> {
    let (mut points, mut weights) = (surface.points().to_vec(), surface.weights().to_vec());
    let place = |index: usize| {
        let (_, count_v) = surface.counts();
        format!("{face}, surface control point {} {}", index / count_v + 1, index % count_v + 1)
    };
    for net in before {
        match points.get(net.index) {
            None => return Err(EditError::Missing { place: place(net.index) }),
            Some(point) if *point != net.point || weights[net.index] != net.weight => {
                return Err(EditError::Mismatch { place: place(net.index) });
            }
            Some(_) => {}
        }
    }
    for net in after {
        let Some(point) = points.get_mut(net.index) else {
            return Err(EditError::Missing { place: place(net.index) });
        };
        *point = net.point;
        weights[net.index] = net.weight;
    }
    NurbsSurface::new(surface.knots_u().clone(), surface.knots_v().clone(), points, weights)
        .map_err(|source: NurbsError| EditError::Invalid { place: face.to_string(), source })
}

fn splice<T: Clone + PartialEq>(
    list: &mut Vec<T>,
    at: usize,
    before: &[T],
    after: &[T],
    place: impl Fn() -> String,
) -> Result<(), EditError> {
    let Some(end) = at.checked_add(before.len()).filter(|end| *end <= list.len()) else {
        return Err(EditError::Missing { place: place() });
    };
    if list[at..end] != *before {
        return Err(EditError::Mismatch { place: place() });
    }
    list.splice(at..end, after.iter().cloned());
    Ok(())
}

fn exchange<T: Clone + PartialEq>(
    slot: &mut T,
    before: &T,
    after: &T,
    place: impl Fn() -> String,
) -> Result<(), EditError> {
    if slot != before {
        return Err(EditError::Mismatch { place: place() });
    }
    slot.clone_from(after);
    Ok(())
}

fn replace_head(
    record: &mut ModelRecord,
    model: usize,
    before: &ModelHead,
    after: &ModelHead,
) -> Result<(), EditError> {
    let ModelHead { name, unit, parts } = before;
    if (&record.name, &record.unit, &record.parts) != (name, unit, parts) {
        return Err(EditError::Mismatch { place: format!("name, unit or parts of model {}", model + 1) });
    }
    let ModelHead { name, unit, parts } = after.clone();
    (record.name, record.unit, record.parts) = (name, unit, parts);
    Ok(())
}

fn model_mut(scene: &mut SceneRecord, model: usize) -> Result<&mut ModelRecord, EditError> {
    scene.models.get_mut(model).ok_or_else(|| EditError::Missing { place: format!("model {}", model + 1) })
}

fn face_mut(scene: &mut SceneRecord, id: FaceId) -> Result<&mut FaceRecord, EditError> {
    let missing = || EditError::Missing { place: id.to_string() };
    scene.models.get_mut(id.model).and_then(|m| m.faces.get_mut(id.face)).ok_or_else(missing)
}

fn loop_mut(record: &mut FaceRecord, face: FaceId, index: usize) -> Result<&mut LoopRecord, EditError> {
    let missing = || EditError::Missing { place: format!("{face}, loop {}", index + 1) };
    record.loops.get_mut(index).ok_or_else(missing)
}

/// Keeps the list of hidden faces right when faces of a model come or go.
fn hidden_faces(scene: &mut SceneRecord, model: usize, at: usize, removed: usize, added: usize) {
    let moved = |id: FaceId| match id.face {
        face if id.model != model || face < at => Some(id),
        face if face < at + removed => None,
        face => Some(FaceId { face: face - removed + added, ..id }),
    };
    scene.hidden = scene.hidden.iter().filter_map(|id| moved(*id)).collect();
}

/// The same when models come or go.
fn hidden_models(scene: &mut SceneRecord, at: usize, removed: usize, added: usize) {
    let moved = |id: FaceId| match id.model {
        model if model < at => Some(id),
        model if model < at + removed => None,
        model => Some(FaceId { model: model - removed + added, ..id }),
    };
    scene.hidden = scene.hidden.iter().filter_map(|id| moved(*id)).collect();
}
