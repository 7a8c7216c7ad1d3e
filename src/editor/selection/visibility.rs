//! Showing, hiding and isolating faces.

use std::collections::HashSet;

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

/// Writes [`Shown`] where it changes.
pub(super) fn apply(
    mut requests: MessageReader<VisibilityRequest>,
    scene: Res<Scene>,
    mut shown: Query<&mut Shown>,
) {
    let mut set = |face: Entity, value: bool| {
        if let Ok(mut shown) = shown.get_mut(face) {
            shown.set_if_neq(Shown(value));
        }
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
}
