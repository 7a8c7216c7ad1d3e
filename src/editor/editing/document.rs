//! The open document as operations see it: components lent as views.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use crate::editor::object::{FacePlace, Records, Scene};
use crate::scene::{Document, FaceId, FaceView};

/// Reads the document.
#[derive(SystemParam)]
pub struct OpenDocument<'w, 's> {
    /// The index.
    pub scene: Res<'w, Scene>,
    /// The records.
    pub records: Records<'w, 's>,
    places: Query<'w, 's, &'static FacePlace>,
}

impl OpenDocument<'_, '_> {
    /// The address of a face.
    pub fn id(&self, face: Entity) -> Option<FaceId> {
        let place = self.places.get(face).ok()?;
        Some(FaceId { model: self.scene.position(place.model)?, face: place.number.checked_sub(1)? })
    }
}

impl Document for OpenDocument<'_, '_> {
    fn model_count(&self) -> usize {
        self.scene.models.len()
    }

    fn face_count(&self, model: usize) -> usize {
        self.scene.models.get(model).map_or(0, |m| m.order.len())
    }

    fn face(&self, id: FaceId) -> Option<FaceView<'_>> {
        self.records.view(self.scene.face(id.model, id.face)?)
    }
}
