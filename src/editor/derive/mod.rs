//! From records to derived data: patches, trimming structure, area, bounds.
//!
//! Wiring: `Derive` works on the faces in [`Changes`] and on nothing else; the box around all that is
//! shown follows in [`SceneBounds`], and a thread works out areas afterwards. Imports derive on their own thread before the faces are spawned.

mod bounds;
mod bounds_tree;
mod derived;
mod measure;

use std::sync::Arc;
use std::time::Instant;

use bevy::prelude::*;
use rayon::prelude::*;

pub use bounds::SceneBounds;
pub use derived::{Derived, Measures};

use super::EditorSystems;
use super::diagnostics::RenderFigures;
use super::object::{AuthoredFace, Changes, DerivedFace, Records, TrimLoop};
use crate::scene::records::FaceRecord;

/// Adds deriving.
pub struct DerivePlugin;

impl Plugin for DerivePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<SceneBounds>()
            .init_resource::<bounds::FaceBoxes>()
            .init_resource::<measure::Measurer>()
            .add_systems(
                Update,
                (derive_changed, bounds::update, measure::start).chain().in_set(EditorSystems::Derive),
            );
    }
}

/// Rederives faces whose components changed after they were derived, and new ones that came without.
fn derive_changed(
    mut commands: Commands,
    mut changes: ResMut<Changes>,
    figures: Res<RenderFigures>,
    records: Records,
    faces: Query<(Ref<AuthoredFace>, Option<Ref<DerivedFace>>)>,
    loops: Query<Ref<TrimLoop>>,
) {
    let changed = changes.take();
    if changed.is_empty() {
        return;
    }
    let started = Instant::now();
    let mut stale = Vec::new();
    for entity in changed {
        let Ok((authored, derived)) = faces.get(entity) else { continue };
        let previous = derived.as_ref().map(|d| Arc::clone(&d.0));
        let up_to_date = derived.is_some_and(|derived| {
            let newest = loops.iter_many(&authored.loops).map(|l| l.last_changed());
            let at = derived.last_changed();
            derived.0.loops == authored.loops.len()
                && newest.chain([authored.last_changed()]).all(|tick| tick == at)
        });
        if up_to_date {
            continue;
        }
        stale.extend(records.face(entity).map(|record| (entity, record, previous)));
    }
    // One face is derived here and now; many come from undoing the deletion of many.
    let derive = |(_, record, previous): &(Entity, FaceRecord, Option<Arc<Derived>>)| {
        DerivedFace(Arc::new(Derived::after(record, previous.as_deref())))
    };
    let derived: Vec<DerivedFace> = match stale.as_slice() {
        [one] => vec![derive(one)],
        many => many.par_iter().map(derive).collect(),
    };
    let any = !stale.is_empty();
    for ((entity, ..), derived) in stale.into_iter().zip(derived) {
        commands.entity(entity).insert(derived);
    }
    if any {
        figures.lock().edit.add(started.elapsed());
    }
}
