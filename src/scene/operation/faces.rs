//! Faces as wholes: name, colour, layer, copies, and deleting them.

use glam::DVec3;

use super::address::Subject;
use super::error::{OperationError, Place, Problem};
use super::limits;
use crate::scene::document::{Document, FaceAttributes};
use crate::scene::edit::{Change, Edit, FaceId};

/// The faces named, each once, in order.
fn named<'d>(document: &'d dyn Document, faces: &[FaceId]) -> Result<Vec<Subject<'d>>, OperationError> {
    if faces.is_empty() {
        return Err(Place::default().error(Problem::Nothing { what: "faces" }));
    }
    let mut found: Vec<Subject> =
        faces.iter().map(|id| Subject::find(document, *id)).collect::<Result<_, _>>()?;
    found.sort_unstable_by_key(|s| s.id);
    found.dedup_by_key(|s| s.id);
    Ok(found)
}

/// The edit that changes the attributes of faces.
pub(super) fn set(
    document: &dyn Document,
    faces: &[FaceId],
    label: &str,
    change: impl Fn(&mut FaceAttributes),
) -> Result<Edit, OperationError> {
    let changes = named(document, faces)?.into_iter().map(|subject| {
        let before = Box::new(subject.view.attributes);
        let mut after = before.clone();
        change(&mut after);
        Change::Attributes { face: subject.id, before, after }
    });
    Ok(Edit::new(label, changes.collect()))
}

/// Refuses a colour that is not linear RGB in 0 to 1.
pub(super) fn colour(colour: Option<[f32; 3]>) -> Result<Option<[f32; 3]>, OperationError> {
    match colour.into_iter().flatten().find(|c| !(0.0..=1.0).contains(c)) {
        None => Ok(colour),
        Some(value) => Err(Place::default().error(Problem::Number {
            what: "a part of the colour",
            value: value.into(),
            expected: "between 0 and 1",
        })),
    }
}

pub(super) fn delete(document: &dyn Document, faces: &[FaceId]) -> Result<Edit, OperationError> {
    // From the last to the first, so that positions stay right while they go.
    let named = named(document, faces)?;
    let changes = named.iter().rev().map(|subject| Change::Faces {
        model: subject.id.model,
        at: subject.id.face,
        before: vec![subject.view.to_record()],
        after: Vec::new(),
    });
    Ok(Edit::new(if named.len() == 1 { "Delete face" } else { "Delete faces" }, changes.collect()))
}

pub(super) fn duplicate(
    document: &dyn Document,
    faces: &[FaceId],
    by: DVec3,
) -> Result<Edit, OperationError> {
    let named = named(document, faces)?;
    let mut changes: Vec<Change> = Vec::new();
    for subject in named {
        let place = Place::face(subject.id);
        let mut copy = subject.view.to_record();
        for p in copy.surface.points() {
            limits::model_point(place, *p + by)?;
        }
        copy.surface = copy.surface.map_points(|p| p + by);
        copy.source = None;
        // A copy bounds no edge of the model that the original bounds.
        copy.loops.iter_mut().for_each(|l| l.edges.clear());
        let model = subject.id.model;
        match changes.last_mut() {
            Some(Change::Faces { model: last, after, .. }) if *last == model => after.push(copy),
            _ => {
                let (at, before) = (document.face_count(model), Vec::new());
                changes.push(Change::Faces { model, at, before, after: vec![copy] });
            }
        }
    }
    Ok(Edit::new("Duplicate face", changes))
}
