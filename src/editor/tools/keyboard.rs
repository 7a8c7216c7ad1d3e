//! From key presses to commands.

use std::collections::VecDeque;

use bevy::prelude::*;
use bevy::window::WindowEvent;

use super::command::{Action, COMMANDS, Command, CommandRequest};
use super::key::Modifiers;
use super::situation::CurrentSituation;
use crate::editor::redraw::Waker;
use crate::editor::uv;
use crate::editor::viewport::{Pointer, Viewport};

/// What is followed from event to event, across frames.
#[derive(Debug, Default)]
pub(super) struct Hands {
    held: Modifiers,
    position: Option<Vec2>,
    /// What came after a command of the last frame.
    waiting: VecDeque<WindowEvent>,
}

/// Sends the command of each key pressed, if it is enabled now. Events are taken in the order in which they
/// came: in a slow frame Ctrl may be down and up again, or a panel's text field clicked and typed into,
/// before it is over. What follows a click on a panel in the same frame may be meant for a text field, so
/// that it waits for the next one, in which it is known who has the keyboard.
///
/// One command is sent per frame, and what comes after it waits for the next one: so each sees what the one before it
/// did, and a file saved right after an edit has the edit in it.
pub(super) fn press(
    mut events: MessageReader<WindowEvent>,
    mut hands: Local<Hands>,
    viewport: Res<Viewport>,
    pointer: Res<Pointer>,
    situation: Res<CurrentSituation>,
    waker: Res<Waker>,
    mut requests: MessageWriter<CommandRequest>,
) {
    hands.waiting.extend(events.read().cloned());
    while let Some(event) = hands.waiting.pop_front() {
        let press = match &event {
            WindowEvent::CursorMoved(moved) => {
                hands.position = Some(moved.position);
                continue;
            }
            WindowEvent::MouseButtonInput(_) => {
                if !pointer.in_uv && hands.position.is_some_and(|p| !viewport.contains(p)) {
                    break;
                }
                continue;
            }
            WindowEvent::KeyboardFocusLost(_) => {
                hands.held = Modifiers::default();
                continue;
            }
            WindowEvent::KeyboardInput(press) => press,
            _ => continue,
        };
        hands.held.follow(press.key_code, press.state);
        if !press.state.is_pressed() || press.repeat || pointer.keyboard_taken {
            continue;
        }
        // X, Y and Z are for the drag; undo and the like end it.
        if pointer.drags_handle && !hands.held.ctrl {
            continue;
        }
        // Over the uv panel its own keys come first; the panel follows them itself.
        if pointer.in_uv && uv::input::panel_key(&press.logical_key, press.key_code, hands.held).is_some() {
            continue;
        }
        let command = COMMANDS
            .iter()
            .find(|c| c.keys.iter().any(|k| k.matches(&press.logical_key, press.key_code, hands.held)));
        let served =
            |c: &&Command| !pointer.sheet_open || matches!(c.action, Action::Shortcuts | Action::About);
        if let Some(command) = command.filter(served).filter(|c| (c.enabled)(&situation.0)) {
            requests.write(CommandRequest(command.action));
            break;
        }
    }
    let pressed =
        |e: &WindowEvent| matches!(e, WindowEvent::KeyboardInput(press) if press.state.is_pressed());
    if hands.waiting.iter().any(pressed) {
        waker.wake();
    }
}
