//! What a file that is about to be written is called, until the user says otherwise.

use std::path::PathBuf;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::DocumentFile;
use crate::editor::object::{Model, Scene};

/// The document's own file, and where its models came from.
#[derive(SystemParam)]
pub struct Naming<'w, 's> {
    file: Res<'w, DocumentFile>,
    scene: Res<'w, Scene>,
    models: Query<'w, 's, &'static Model>,
}

impl Naming<'_, '_> {
    /// The file of the document, or of the first model when it was never saved: its folder is offered, and its name
    /// with another ending. Only a name for a built-in scene; `None` for an empty one.
    pub fn suggestion(&self) -> Option<PathBuf> {
        self.file.path.clone().or_else(|| {
            let model = self.models.get(self.scene.models.first()?.entity).ok()?;
            Some(model.path.clone().unwrap_or_else(|| format!("{}.", model.name).into()))
        })
    }
}
