//! The whole document as a record, and the parts of a record that are not models back into the editor.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::DocumentFile;
use crate::editor::camera::{CameraRequest, ViewCamera};
use crate::editor::object::{Records, Scene, Shown};
use crate::editor::settings::{DisplayMode, Settings};
use crate::scene::settings::DisplayRecord;
use crate::scene::{FaceId, SceneRecord};

/// Reads everything that a scene file holds.
#[derive(SystemParam)]
pub struct Snapshot<'w, 's> {
    scene: Res<'w, Scene>,
    records: Records<'w, 's>,
    shown: Query<'w, 's, &'static Shown>,
    camera: Res<'w, ViewCamera>,
    settings: Res<'w, Settings>,
    file: Res<'w, DocumentFile>,
}

impl Snapshot<'_, '_> {
    /// The record of now.
    pub fn record(&self) -> SceneRecord {
        let addresses = self.scene.models.iter().enumerate().flat_map(|(model, entry)| {
            entry.order.iter().enumerate().map(move |(face, entity)| (FaceId { model, face }, *entity))
        });
        let hidden = addresses.filter(|(_, e)| self.shown.get(*e).is_ok_and(|s| !s.0)).map(|(id, _)| id);
        SceneRecord {
            models: self.scene.models.iter().filter_map(|m| self.records.model(m)).collect(),
            hidden: hidden.collect(),
            camera: Some(self.camera.destination()),
            views: self.file.views.clone(),
            display: DisplayRecord {
                mode: Some(self.settings.mode.name().into()),
                edges: Some(self.settings.edges),
                grid: Some(self.settings.grid),
                gaps: self.file.gaps.clone(),
            },
        }
    }
}

/// Sets camera, visibility and display as a record says. The models are there already.
pub fn restore(
    record: &SceneRecord,
    scene: &Scene,
    commands: &mut Commands,
    settings: &mut Settings,
    file: &mut DocumentFile,
    camera: &mut MessageWriter<CameraRequest>,
) {
    for id in &record.hidden {
        if let Some(face) = scene.face(id.model, id.face) {
            commands.entity(face).insert(Shown(false));
        }
    }
    camera.write(record.camera.map_or(CameraRequest::FitNew, CameraRequest::Go));
    let DisplayRecord { mode, edges, grid, gaps } = &record.display;
    let mode = mode.as_ref().and_then(|name| DisplayMode::ALL.into_iter().find(|m| m.name() == name));
    settings.mode = mode.unwrap_or(settings.mode);
    settings.edges = edges.unwrap_or(settings.edges);
    settings.grid = grid.unwrap_or(settings.grid);
    file.views = record.views.clone();
    file.gaps = gaps.clone();
}
