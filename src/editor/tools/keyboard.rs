//! From key presses to commands.

use bevy::input::keyboard::{KeyboardFocusLost, KeyboardInput};
use bevy::prelude::*;

use super::command::{Action, COMMANDS, Command, CommandRequest, Situation};
use super::key::Modifiers;
use crate::editor::editing::Editing;
use crate::editor::files::Loading;
use crate::editor::object::{FaceChange, Scene, Shown};
use crate::editor::selection::Selection;
use crate::editor::viewport::Pointer;

/// The [`Situation`] of this frame.
#[derive(Resource, Debug, Default, Clone, Copy)]
pub struct CurrentSituation(pub Situation);

/// Looks at what is open, selected and hidden.
pub(super) fn observe(
    mut current: ResMut<CurrentSituation>,
    scene: Res<Scene>,
    selection: Res<Selection>,
    loading: Res<Loading>,
    editing: Res<Editing>,
    shown: Query<&Shown>,
    mut changes: MessageReader<FaceChange>,
    mut seen: Local<u64>,
) {
    let switched = changes.read().any(|c| matches!(c, FaceChange::Shown(_)));
    let hidden = if *seen != scene.revision || switched {
        *seen = scene.revision;
        shown.iter().any(|s| !s.0)
    } else {
        current.0.hidden
    };
    current.0 = Situation {
        model: !scene.is_empty(),
        selection: !selection.is_empty(),
        hidden,
        undo: editing.is_dragging() || editing.history().undo_count() > 0,
        redo: editing.history().redo_count() > 0,
        loading: loading.is_active(),
    };
}

/// Sends the command of each key pressed, if it is enabled now. Modifiers are followed message by message:
/// in a slow frame Ctrl may be down and up again before it is over.
pub(super) fn press(
    mut presses: MessageReader<KeyboardInput>,
    mut focus_lost: MessageReader<KeyboardFocusLost>,
    mut held: Local<Modifiers>,
    pointer: Res<Pointer>,
    situation: Res<CurrentSituation>,
    mut requests: MessageWriter<CommandRequest>,
) {
    if focus_lost.read().count() > 0 {
        *held = Modifiers::default();
    }
    for press in presses.read() {
        held.follow(press.key_code, press.state);
        if !press.state.is_pressed() || press.repeat || pointer.keyboard_taken {
            continue;
        }
        let command = COMMANDS
            .iter()
            .find(|c| c.keys.iter().any(|k| k.matches(&press.logical_key, press.key_code, *held)));
        let served =
            |c: &&Command| !pointer.sheet_open || matches!(c.action, Action::Shortcuts | Action::About);
        if let Some(command) = command.filter(served).filter(|c| (c.enabled)(&situation.0)) {
            requests.write(CommandRequest(command.action));
        }
    }
}
