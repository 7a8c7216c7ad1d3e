//! Showing, hiding and isolating faces.

use std::collections::HashSet;

use bevy::ecs::entity::EntityIndexMap;
use bevy::prelude::*;

use super::Selection;
use crate::editor::object::{Scene, Shown};
use crate::editor::tools::{Action, CommandRequest};

/// Asks for a change of what is drawn.
#[derive(Message, Debug, Clone, PartialEq, Eq)]
pub enum VisibilityRequest {
    /// Draw these faces.
    Show(Vec<Entity>),
    /// Do not draw these faces.
    Hide(Vec<Entity>),
    /// Draw these and nothing else.
    Isolate(Vec<Entity>),
    /// Draw everything.
    ShowAll,
}

/// Hide, isolate and show all from the command table, on the selection.
pub(super) fn command_requests(
    mut commands: MessageReader<CommandRequest>,
    selection: Res<Selection>,
    mut requests: MessageWriter<VisibilityRequest>,
) {
    for CommandRequest(action) in commands.read() {
        let selected = || selection.faces().to_vec();
        requests.write(match action {
            Action::Hide => VisibilityRequest::Hide(selected()),
            Action::Isolate if !selection.is_empty() => VisibilityRequest::Isolate(selected()),
            Action::ShowAll => VisibilityRequest::ShowAll,
            _ => continue,
        });
    }
}

/// Replaces [`Shown`] where it changes.
pub(super) fn apply(
    mut requests: MessageReader<VisibilityRequest>,
    scene: Res<Scene>,
    shown: Query<&Shown>,
    mut commands: Commands,
) {
    // What several requests of a frame come to, in the order in which the faces were first named.
    let mut wanted = EntityIndexMap::<bool>::default();
    let mut set = |face: Entity, value: bool| {
        wanted.insert(face, value);
    };
    for request in requests.read() {
        match request {
            VisibilityRequest::Show(faces) => faces.iter().for_each(|f| set(*f, true)),
            VisibilityRequest::Hide(faces) => faces.iter().for_each(|f| set(*f, false)),
            VisibilityRequest::Isolate(faces) => {
                let keep: HashSet<Entity> = faces.iter().copied().collect();
                scene.faces().for_each(|f| set(f, keep.contains(&f)));
            }
            VisibilityRequest::ShowAll => scene.faces().for_each(|f| set(f, true)),
        }
    }
    for (face, value) in wanted {
        if shown.get(face).is_ok_and(|s| s.0 != value) {
            commands.entity(face).insert(Shown(value));
        }
    }
}
