//! The active face: the one that the uv panel shows and whose handles are drawn in 3D.

use std::sync::Arc;

use bevy::prelude::*;

use super::selection::{ElementRequest, ElementSelection};
use crate::editor::derive::Derived;
use crate::editor::object::{DerivedFace, FaceParts, FacePlace, Records};
use crate::editor::selection::Selection;
use crate::scene::records::FaceRecord;

/// The active face as it is now.
#[derive(Debug, Clone)]
pub struct FaceInHand {
    /// Its entity.
    pub entity: Entity,
    /// Its number, from 1.
    pub number: usize,
    /// Surface and loops as they are now, drags included.
    pub record: Arc<FaceRecord>,
    /// What the record was made from.
    pub parts: FaceParts,
    /// What was derived from it; may be a little older than the record.
    pub derived: Option<Arc<Derived>>,
}

/// The face that is edited: the one selected last. Written once per frame, after deriving.
#[derive(Resource, Debug, Default)]
pub struct ActiveFace {
    /// The face; none when nothing is selected.
    pub face: Option<FaceInHand>,
    /// Counts changes of the record or of which face it is.
    pub revision: u64,
    /// Counts changes of what is derived.
    pub derived_revision: u64,
}

impl ActiveFace {
    /// Its entity.
    pub fn entity(&self) -> Option<Entity> {
        self.face.as_ref().map(|f| f.entity)
    }
}

/// Applies requests. The face selected last is the active one.
pub(super) fn apply(
    mut requests: MessageReader<ElementRequest>,
    faces: Res<Selection>,
    active: Res<ActiveFace>,
    mut selection: ResMut<ElementSelection>,
) {
    let face = faces.faces().last().copied();
    if selection.face != face {
        selection.turn_to(face);
    }
    let record = active.face.as_ref().filter(|f| Some(f.entity) == face).map(|f| &f.record);
    for request in requests.read() {
        let Some(record) = record else { continue };
        let known: Vec<_> = request.elements.iter().copied().filter(|e| e.exists_in(record)).collect();
        selection.apply(&known, request.mode);
    }
}

/// Takes over the active face's record and what was derived from it.
pub(super) fn observe(
    mut active: ResMut<ActiveFace>,
    mut selection: ResMut<ElementSelection>,
    records: Records,
    faces: Query<(&FacePlace, Option<&DerivedFace>)>,
) {
    let found = selection.face.and_then(|entity| {
        let (place, derived) = faces.get(entity).ok()?;
        let parts = records.parts(entity)?;
        let kept = active.face.as_ref().filter(|f| f.entity == entity && f.parts.is_same(&parts));
        let record = kept.map_or_else(|| Arc::new(parts.to_record()), |f| Arc::clone(&f.record));
        let derived = derived.map(|d| Arc::clone(&d.0));
        Some(FaceInHand { entity, number: place.number, record, parts, derived })
    });
    let same_record = match (&found, &active.face) {
        (Some(a), Some(b)) => a.entity == b.entity && Arc::ptr_eq(&a.record, &b.record),
        (None, None) => true,
        _ => false,
    };
    let derived = |f: &Option<FaceInHand>| f.as_ref().and_then(|f| f.derived.as_ref()).map(Arc::as_ptr);
    let same_derived = derived(&found) == derived(&active.face);
    if same_record && same_derived {
        return;
    }
    if !same_record {
        active.revision += 1;
        if let Some(face) = &found {
            selection.prune(&face.record);
        }
    }
    active.derived_revision += u64::from(!same_derived || !same_record);
    active.face = found;
}
