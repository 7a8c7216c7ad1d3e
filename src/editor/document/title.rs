//! The title of the window: the name of the document, with a star while it is unsaved.

use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use super::DocumentFile;
use crate::editor::editing::Editing;
use crate::editor::object::{Model, Scene};

/// The name of the document: that of its file, else of what is open.
pub fn document_name(file: &DocumentFile, scene: &Scene, model: impl Fn(Entity) -> Option<String>) -> String {
    if let Some(name) = file.path.as_ref().and_then(|p| p.file_name()) {
        return name.to_string_lossy().into_owned();
    }
    let mut names = scene.models.iter().filter_map(|m| model(m.entity));
    match (names.next(), names.count()) {
        (None, _) => "Untitled".into(),
        (Some(first), 0) => first,
        (Some(first), more) => format!("{first} and {more} more"),
    }
}

/// Sets the title where it changes.
pub(super) fn show(
    mut windows: Query<&mut Window, With<PrimaryWindow>>,
    file: Res<DocumentFile>,
    editing: Res<Editing>,
    scene: Res<Scene>,
    models: Query<&Model>,
) {
    let Ok(mut window) = windows.single_mut() else { return };
    let name = document_name(&file, &scene, |e| models.get(e).ok().map(|m| m.name.clone()));
    let star = if editing.is_unsaved() { "*" } else { "" };
    let title = if scene.is_empty() && star.is_empty() && file.path.is_none() {
        "Hairline".to_owned()
    } else {
        format!("{star}{name} - Hairline")
    };
    if window.title != title {
        window.title = title;
    }
}
