//! The faces as the renderer holds them: extracted when they change, packed a little per frame.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::render::Extract;

use crate::editor::derive::Derived;
use crate::editor::diagnostics::RenderFigures;
use crate::editor::object::{AuthoredFace, DerivedFace, FaceChange, FacePlace, Shown};
use crate::editor::selection::Selection;
use crate::encoding::{FaceHeader, FaceShape, FaceSlot, PackedScene};
use crate::kernel::face::Face;

/// Time for packing per frame, at least and at most: a large model appears piece by piece and the window stays alive.
const PACK_TIME: (Duration, Duration) = (Duration::from_millis(40), Duration::from_millis(300));
/// Where frames take long for other reasons, packing gets this part of their time, or a large model never arrives.
const PACK_SHARE: f32 = 0.5;
/// What was packed meanwhile is shown this often: sending and casting it takes time too.
const SHOW_TIME: Duration = Duration::from_millis(500);

/// What a face is packed from.
#[derive(Debug, Clone)]
struct Origin {
    derived: Arc<Derived>,
    colour: Option<[f32; 3]>,
    reversed: bool,
    shown: bool,
    slot: Option<FaceSlot>,
    waiting: bool,
}

/// Bits of the marks.
const SELECTED: u32 = 1;
const HOVERED: u32 = 2;

/// All faces in the render world.
#[derive(Resource, Debug, Default)]
pub(super) struct RenderFaces {
    pub packed: PackedScene,
    origins: BTreeMap<Entity, Origin>,
    waiting: VecDeque<Entity>,
    entities: Vec<Option<Entity>>,
    /// Bits for the highlight of each slot: 1 selected, 2 hovered.
    pub marks: Vec<u32>,
    selected: u64,
    hovered: Option<Entity>,
    /// Slots whose faces changed since they were last taken.
    pub changed: Vec<FaceSlot>,
    /// Counts changes of what rays can hit.
    pub geometry: u64,
    /// Counts changes of `marks`.
    pub marks_revision: u64,
    /// Whether faces were packed that are not shown yet, and when others were while these waited.
    unshown: bool,
    shown_at: Option<Instant>,
}

impl RenderFaces {
    /// What the face in a slot was packed from.
    pub fn derived(&self, slot: FaceSlot) -> Option<&Arc<Derived>> {
        let origin = self.origins.get(&self.entity(slot.0)?)?;
        Some(&origin.derived).filter(|_| origin.slot == Some(slot))
    }

    /// The faces by slot.
    pub fn entities_by_slot(&self) -> &[Option<Entity>] {
        &self.entities
    }

    /// A face that is packed, and its slot.
    pub fn packed_face(&self, entity: Entity) -> Option<(&Face, FaceSlot)> {
        let origin = self.origins.get(&entity)?;
        Some((origin.derived.face.as_deref()?, origin.slot?))
    }

    /// The slot of a face that is shown.
    pub fn shown_slot(&self, entity: Entity) -> Option<FaceSlot> {
        self.origins.get(&entity).filter(|o| o.shown)?.slot
    }

    /// The face in a slot.
    pub fn entity(&self, slot: u32) -> Option<Entity> {
        self.entities.get(slot as usize).copied().flatten()
    }

    /// Whether faces wait to be packed.
    pub fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Packs everything anew: the device was lost.
    pub fn repack(&mut self) {
        self.packed = PackedScene::default();
        self.entities.clear();
        self.waiting = self.origins.keys().copied().collect();
        self.origins.values_mut().for_each(|o| {
            o.slot = None;
            o.waiting = true;
        });
        self.marks.clear();
        self.marks_revision += 1;
        self.geometry += 1;
    }

    fn set_mark(&mut self, entity: Entity, bit: u32, on: bool) {
        if let Some(slot) = self.origins.get(&entity).and_then(|o| o.slot)
            && let Some(mark) = self.marks.get_mut(slot.0 as usize)
        {
            *mark = if on { *mark | bit } else { *mark & !bit };
        }
    }

    /// Marks every face anew.
    fn mark_all(&mut self, selection: &Selection) {
        self.marks.clear();
        self.marks.resize(self.entities.len(), 0);
        for face in selection.faces() {
            self.set_mark(*face, SELECTED, true);
        }
        if let Some(face) = selection.hovered {
            self.set_mark(face, HOVERED, true);
        }
        self.selected = selection.revision;
        self.hovered = selection.hovered;
        self.marks_revision += 1;
    }

    /// Marks one face, whose slot may be new.
    fn mark(&mut self, entity: Entity, selection: &Selection) {
        self.marks.resize(self.entities.len(), 0);
        let Some(slot) = self.origins.get(&entity).and_then(|o| o.slot) else { return };
        let mark = if selection.contains(entity) { SELECTED } else { 0 }
            | if selection.hovered == Some(entity) { HOVERED } else { 0 };
        if let Some(before) = self.marks.get_mut(slot.0 as usize)
            && *before != mark
        {
            *before = mark;
            self.marks_revision += 1;
        }
    }

    fn remove(&mut self, entity: Entity) {
        // It may still be among those that wait: packing passes over it.
        let Some(origin) = self.origins.remove(&entity) else { return };
        if let Some(slot) = origin.slot {
            self.packed.remove(slot);
            self.entities[slot.0 as usize] = None;
            self.changed.push(slot);
        }
        self.geometry += 1;
    }

    fn show(&mut self, entity: Entity, shown: bool) {
        let Some(origin) = self.origins.get_mut(&entity).filter(|o| o.shown != shown) else { return };
        origin.shown = shown;
        if let Some(slot) = origin.slot {
            self.packed.set_flag(slot, FaceHeader::VISIBLE, shown);
            self.geometry += 1;
        }
    }
}

/// Takes over what changed since the last frame. Costs nothing for the faces that did not.
pub(super) fn extract(
    mut faces: ResMut<RenderFaces>,
    mut changes: Extract<MessageReader<FaceChange>>,
    query: Extract<Query<(&AuthoredFace, &FacePlace, &DerivedFace, &Shown)>>,
    selection: Extract<Res<Selection>>,
    figures: Res<RenderFigures>,
) {
    let faces = &mut *faces;
    let mut new: Vec<(usize, Entity)> = Vec::new();
    for change in changes.read() {
        let (FaceChange::Derived(entity) | FaceChange::Shown(entity) | FaceChange::Removed(entity)) = *change;
        let Ok((authored, place, derived, shown)) = query.get(entity) else {
            faces.remove(entity);
            continue;
        };
        if !matches!(change, FaceChange::Derived(_)) {
            faces.show(entity, shown.0);
            continue;
        }
        let before = faces.origins.get(&entity);
        let (slot, waiting) = before.map_or((None, false), |o| (o.slot, o.waiting));
        let origin = Origin {
            derived: Arc::clone(&derived.0),
            colour: authored.attributes.colour,
            reversed: authored.attributes.reversed,
            shown: shown.0,
            slot,
            waiting: true,
        };
        faces.origins.insert(entity, origin);
        if !waiting {
            new.push((place.number, entity));
        }
    }
    // In file order: slots, and with them the colours by face, do not depend on the order of messages.
    new.sort();
    faces.waiting.extend(new.into_iter().map(|(_, entity)| entity));
    let started = Instant::now();
    let frame = Duration::from_secs_f32(1e-3 * figures.lock().frame_ms.clamp(0.0, 1e4));
    if pack(faces, &selection, frame) {
        figures.lock().edit.add(started.elapsed());
    }
    if faces.selected != selection.revision || faces.hovered != selection.hovered {
        faces.mark_all(&selection);
    }
}

/// Packs waiting faces for a while, given how long the last frame took. Says whether there were any.
fn pack(faces: &mut RenderFaces, selection: &Selection, frame: Duration) -> bool {
    let (started, any) = (Instant::now(), faces.is_waiting());
    let time = frame.mul_f32(PACK_SHARE).clamp(PACK_TIME.0, PACK_TIME.1);
    while started.elapsed() < time
        && let Some(entity) = faces.waiting.pop_front()
    {
        let Some(origin) = faces.origins.get_mut(&entity) else { continue };
        origin.waiting = false;
        let Some(face) = origin.derived.face.as_deref() else {
            // What cannot be derived any more is not drawn any more.
            if let Some(slot) = origin.slot.take() {
                faces.changed.push(slot);
                faces.packed.remove(slot);
                faces.entities[slot.0 as usize] = None;
                faces.unshown = true;
            }
            continue;
        };
        let shape = FaceShape::of(face, origin.colour, origin.reversed);
        let slot = match origin.slot {
            Some(slot) => {
                faces.packed.replace(slot, &shape);
                slot
            }
            None => match origin.derived.take_packed() {
                Some(packed) => faces.packed.add_packed(&shape, packed),
                None => faces.packed.add(&shape),
            },
        };
        faces.packed.set_flag(slot, FaceHeader::VISIBLE, origin.shown);
        origin.slot = Some(slot);
        faces.changed.push(slot);
        let index = slot.0 as usize;
        if faces.entities.len() <= index {
            faces.entities.resize(index + 1, None);
        }
        faces.entities[index] = Some(entity);
        faces.mark(entity, selection);
        faces.unshown = true;
    }
    let due = faces.shown_at.is_none_or(|t| t.elapsed() > SHOW_TIME.max(3 * frame));
    if faces.unshown && (due || !faces.is_waiting()) {
        faces.geometry += 1;
        faces.unshown = false;
        // The next file opened shows its first faces at once.
        faces.shown_at = faces.is_waiting().then(Instant::now);
    }
    any
}
