//! Keeping the findings true: in the background for a whole scene, at once for a face that was edited.

use bevy::prelude::*;

use super::Findings;
use crate::editor::object::{FaceChange, Model, Records, Scene};
use crate::editor::redraw::Waker;
use crate::editor::settings::Settings;

/// More changed faces than this are measured in the background.
const AT_ONCE: usize = 8;

/// Measures what changed while the inspection is on.
pub(super) fn measure(
    settings: Res<Settings>,
    scene: Res<Scene>,
    records: Records,
    models: Query<&Model>,
    waker: Res<Waker>,
    mut changes: MessageReader<FaceChange>,
    mut findings: ResMut<Findings>,
) {
    let changed: Vec<Entity> = changes
        .read()
        .filter_map(|change| match change {
            FaceChange::Derived(face) => Some(*face),
            FaceChange::Shown(_) | FaceChange::Removed(_) => None,
        })
        .collect();
    let on = settings.inspection && !scene.is_empty();
    if !on {
        if findings.scene.is_some() {
            findings.clear();
        }
        return;
    }
    if findings.scene != Some(scene.revision) {
        start(&mut findings, &scene, &records, &models, &waker);
        return;
    }
    for face in &changed {
        findings.note(*face);
    }
    let mut stale = match findings.collect() {
        Some(since) => since,
        None if changed.is_empty() => return,
        None => Vec::new(),
    };
    stale.extend(changed);
    stale.sort_unstable();
    stale.dedup();
    if stale.len() > AT_ONCE {
        start(&mut findings, &scene, &records, &models, &waker);
        return;
    }
    for face in stale {
        if let Some(parts) = records.parts(face) {
            findings.update(face, &parts);
        }
    }
    findings.settle();
}

/// Figures are in the unit of the first model: all of them lie in one space.
fn start(findings: &mut Findings, scene: &Scene, records: &Records, models: &Query<&Model>, waker: &Waker) {
    let first = scene.models.first().and_then(|m| models.get(m.entity).ok());
    let unit = first.map_or(1.0, |m| m.unit.millimetres);
    let faces = scene.models.iter().flat_map(|m| &m.order);
    let parts = faces.filter_map(|face| Some((*face, records.parts(*face)?))).collect();
    findings.start(scene.revision, parts, unit, waker);
}
