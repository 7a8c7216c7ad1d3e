//! The active face: the one that the uv panel shows and whose handles are drawn in 3D.

use std::sync::Arc;

use bevy::prelude::*;
use glam::{DVec2, DVec3};

use super::element::{Element, PointAddress};
use super::selection::{ElementRequest, ElementSelection};
use crate::editor::derive::Derived;
use crate::editor::object::{DerivedFace, FacePlace, Records, Scene};
use crate::editor::problems::FaceProblems;
use crate::editor::selection::{SelectMode, Selection};
use crate::kernel::nurbs::{NurbsCurve2, NurbsSurface};
use crate::kernel::trim::UvRect;
use crate::kernel::trim::validity::LoopProblem;
use crate::scene::FaceAttributes;
use crate::scene::edit::FaceId;
use crate::scene::records::{FaceRecord, LoopRecord};

/// The active face as it is now.
#[derive(Debug, Clone)]
pub struct FaceInHand {
    /// Its entity.
    pub entity: Entity,
    /// Its address in the scene.
    pub id: FaceId,
    /// Its number, from 1.
    pub number: usize,
    /// Its surface as it is now, drags included.
    pub surface: Arc<NurbsSurface>,
    /// Its loops as they are now, in order.
    pub loops: Vec<Arc<LoopRecord>>,
    /// Name, colour and the like.
    pub attributes: Arc<FaceAttributes>,
    /// The whole record.
    pub record: Arc<FaceRecord>,
    /// What is wrong with its loops.
    pub problems: Arc<[LoopProblem]>,
    /// What was derived from it; may be a little older.
    pub derived: Option<Arc<Derived>>,
}

impl FaceInHand {
    /// The point of the surface at `uv`, or at the nearest parameters that it has.
    pub fn point_in_space(&self, uv: DVec2) -> DVec3 {
        let domain = UvRect::of_surface(&self.surface);
        let uv = uv.clamp(domain.min, domain.max);
        self.surface.point(uv.x, uv.y)
    }

    /// A curve, if there is one at that position.
    pub fn curve(&self, trim_loop: usize, curve: usize) -> Option<&NurbsCurve2> {
        self.loops.get(trim_loop)?.curves.get(curve)
    }

    /// A control point, if there is one at that address.
    pub fn point(&self, (trim_loop, curve, point): PointAddress) -> Option<DVec2> {
        self.curve(trim_loop, curve)?.points().get(point).copied()
    }
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
    /// Counts changes of what is wrong with it.
    pub problems_revision: u64,
}

impl ActiveFace {
    /// Its entity.
    pub fn entity(&self) -> Option<Entity> {
        self.face.as_ref().map(|f| f.entity)
    }
}

/// Loops that were just added to a face: they are selected once the face is seen with them.
#[derive(Resource, Debug, Default)]
pub struct FreshLoops(pub Option<(FaceId, std::ops::Range<usize>)>);

/// Elements of a face that was selected together with them: they are there once it is the active one.
#[derive(Resource, Debug, Default)]
pub(super) struct Awaited(Option<(Entity, Vec<Element>)>);

/// Applies requests. The face selected last is the active one.
pub(super) fn apply(
    mut requests: MessageReader<ElementRequest>,
    faces: Res<Selection>,
    active: Res<ActiveFace>,
    mut awaited: ResMut<Awaited>,
    mut selection: ResMut<ElementSelection>,
) {
    let face = faces.faces().last().copied();
    if selection.face != face {
        selection.turn_to(face);
    }
    let in_hand = active.face.as_ref().filter(|f| Some(f.entity) == face);
    for request in requests.read() {
        let Some(in_hand) = in_hand else {
            awaited.0 = face.map(|face| (face, request.elements.clone()));
            continue;
        };
        let known: Vec<_> = request.elements.iter().copied().filter(|e| e.exists_in(in_hand)).collect();
        selection.apply(&known, request.mode);
    }
}

/// Takes over the active face's surface, loops and what was derived from them.
pub(super) fn observe(
    mut active: ResMut<ActiveFace>,
    mut selection: ResMut<ElementSelection>,
    (mut fresh, mut awaited): (ResMut<FreshLoops>, ResMut<Awaited>),
    scene: Res<Scene>,
    records: Records,
    faces: Query<(&FacePlace, Option<&DerivedFace>, Option<&FaceProblems>)>,
) {
    let found = selection.face.and_then(|entity| {
        let (place, derived, problems) = faces.get(entity).ok()?;
        let parts = records.parts(entity)?;
        let same = |f: &FaceInHand| {
            f.entity == entity
                && Arc::ptr_eq(&f.surface, &parts.surface)
                && Arc::ptr_eq(&f.attributes, &parts.attributes)
                && f.loops.len() == parts.loops.len()
                && f.loops.iter().zip(&parts.loops).all(|(a, b)| Arc::ptr_eq(a, b))
        };
        let kept = active.face.as_ref().filter(|f| same(f)).map(|f| Arc::clone(&f.record));
        Some(FaceInHand {
            entity,
            id: FaceId { model: scene.position(place.model)?, face: place.number.saturating_sub(1) },
            number: place.number,
            record: kept.unwrap_or_else(|| Arc::new(parts.to_record())),
            surface: parts.surface,
            attributes: parts.attributes,
            loops: parts.loops,
            problems: problems.map_or_else(|| Arc::from([]), |p| Arc::clone(&p.0)),
            derived: derived.map(|d| Arc::clone(&d.0)),
        })
    });
    let same_record = match (&found, &active.face) {
        (Some(a), Some(b)) => a.entity == b.entity && a.id == b.id && Arc::ptr_eq(&a.record, &b.record),
        (None, None) => true,
        _ => false,
    };
    let derived = |f: &Option<FaceInHand>| f.as_ref().and_then(|f| f.derived.as_ref()).map(Arc::as_ptr);
    let same_derived = derived(&found) == derived(&active.face);
    let problems = |f: &Option<FaceInHand>| f.as_ref().map(|f| Arc::clone(&f.problems)).unwrap_or_default();
    let same_problems = problems(&found) == problems(&active.face);
    if same_record && same_derived && same_problems {
        return;
    }
    active.problems_revision += u64::from(!same_problems);
    if !same_record {
        active.revision += 1;
        if let Some(face) = &found {
            selection.prune(face);
        }
    }
    active.derived_revision += u64::from(!same_derived || !same_record);
    if let Some((entity, elements)) = awaited.0.take()
        && let Some(face) = found.as_ref().filter(|f| f.entity == entity)
    {
        let known: Vec<Element> = elements.into_iter().filter(|e| e.exists_in(face)).collect();
        selection.apply(&known, SelectMode::Replace);
    }
    if let Some((id, loops)) = fresh.0.take()
        && let Some(face) = found.as_ref().filter(|f| f.id == id)
    {
        let elements = loops.map(|trim_loop| Element::Loop { trim_loop });
        let known: Vec<Element> = elements.filter(|e| e.exists_in(face)).collect();
        selection.apply(&known, SelectMode::Replace);
    }
    active.face = found;
}
