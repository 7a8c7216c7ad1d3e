//! The faces as the renderer holds them: extracted when they change, packed a little per frame.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::render::Extract;

use crate::editor::derive::Derived;
use crate::editor::object::{AuthoredFace, DerivedFace, Shown};
use crate::editor::selection::Selection;
use crate::encoding::{FaceHeader, FaceShape, FaceSlot, PackedScene};

/// Time for packing per frame: a large model appears piece by piece and the window stays alive.
const PACK_TIME: Duration = Duration::from_millis(40);
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
}

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
    /// Counts changes of what rays can hit.
    pub geometry: u64,
    /// Counts changes of `marks`.
    pub marks_revision: u64,
    /// Whether faces were packed that are not shown yet, and when others were while these waited.
    unshown: bool,
    shown_at: Option<Instant>,
}

impl RenderFaces {
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
        self.origins.values_mut().for_each(|o| o.slot = None);
        self.geometry += 1;
    }

    fn set_mark(&mut self, entity: Entity, bit: u32, on: bool) {
        if let Some(slot) = self.origins.get(&entity).and_then(|o| o.slot)
            && let Some(mark) = self.marks.get_mut(slot.0 as usize)
        {
            *mark = if on { *mark | bit } else { *mark & !bit };
        }
    }

    fn mark_all(&mut self, selection: &Selection) {
        self.marks.clear();
        self.marks.resize(self.entities.len(), 0);
        for face in selection.faces() {
            self.set_mark(*face, 1, true);
        }
        if let Some(face) = selection.hovered {
            self.set_mark(face, 2, true);
        }
        self.selected = selection.revision;
        self.hovered = selection.hovered;
        self.marks_revision += 1;
    }
}

/// Takes over what changed since the last frame.
pub(super) fn extract(
    mut faces: ResMut<RenderFaces>,
    changed: Extract<Query<(Entity, &AuthoredFace, &DerivedFace, &Shown), Changed<DerivedFace>>>,
    shown: Extract<Query<(Entity, &Shown), Changed<Shown>>>,
    mut removed: Extract<RemovedComponents<DerivedFace>>,
    selection: Extract<Res<Selection>>,
) {
    let faces = &mut *faces;
    for entity in removed.read() {
        let Some(origin) = faces.origins.remove(&entity) else { continue };
        faces.waiting.retain(|e| *e != entity);
        if let Some(slot) = origin.slot {
            faces.packed.remove(slot);
            faces.entities[slot.0 as usize] = None;
        }
        faces.geometry += 1;
    }
    let mut new: Vec<(usize, Entity)> = Vec::new();
    for (entity, authored, derived, shown) in &changed {
        let slot = faces.origins.get(&entity).and_then(|o| o.slot);
        let origin = Origin {
            derived: Arc::clone(&derived.0),
            colour: authored.record.colour,
            reversed: authored.record.reversed,
            shown: shown.0,
            slot,
        };
        faces.origins.insert(entity, origin);
        new.push((authored.number, entity));
    }
    // In file order: slots, and with them the colours by face, do not depend on the order of a query.
    new.sort();
    faces.waiting.extend(new.into_iter().map(|(_, entity)| entity));
    for (entity, shown) in &shown {
        let Some(origin) = faces.origins.get_mut(&entity) else { continue };
        if origin.shown != shown.0 {
            origin.shown = shown.0;
            if let Some(slot) = origin.slot {
                faces.packed.set_flag(slot, FaceHeader::VISIBLE, shown.0);
                faces.geometry += 1;
            }
        }
    }
    if faces.selected != selection.revision || faces.hovered != selection.hovered || pack(faces) {
        faces.mark_all(&selection);
    }
}

/// Packs waiting faces for a while. Says whether any was packed.
fn pack(faces: &mut RenderFaces) -> bool {
    let started = Instant::now();
    let mut any = false;
    while started.elapsed() < PACK_TIME
        && let Some(entity) = faces.waiting.pop_front()
    {
        let Some(origin) = faces.origins.get_mut(&entity) else { continue };
        let Some(face) = origin.derived.face.as_deref() else { continue };
        let shape = FaceShape::of(face, origin.colour, origin.reversed);
        let slot = match origin.slot {
            Some(slot) => {
                faces.packed.replace(slot, &shape);
                slot
            }
            None => faces.packed.add(&shape),
        };
        faces.packed.set_flag(slot, FaceHeader::VISIBLE, origin.shown);
        origin.slot = Some(slot);
        let index = slot.0 as usize;
        if faces.entities.len() <= index {
            faces.entities.resize(index + 1, None);
        }
        faces.entities[index] = Some(entity);
        any = true;
    }
    faces.unshown |= any;
    let due = faces.shown_at.is_none_or(|t| t.elapsed() > SHOW_TIME);
    if faces.unshown && (due || !faces.is_waiting()) {
        faces.geometry += 1;
        faces.unshown = false;
        // The next file opened shows its first faces at once.
        faces.shown_at = faces.is_waiting().then(Instant::now);
    }
    any
}
