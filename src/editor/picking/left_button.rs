//! The left button and the keys held with it, in the order in which things happened.
//!
//! The state that Bevy and egui offer is that at the end of a frame. In a slow frame Ctrl may be down and up
//! again and the pointer elsewhere before it is over; following the messages one by one keeps clicks right.

use bevy::input::ButtonState;
use bevy::prelude::*;
use bevy::window::WindowEvent;

use crate::editor::tools::Modifiers;
use crate::editor::viewport::{Pointer, Viewport};

/// A press and release of the left button that began in the viewport.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stroke {
    pub down: Vec2,
    pub up: Vec2,
    pub held: Modifiers,
}

/// The left button.
#[derive(Resource, Debug, Default)]
pub struct LeftButton {
    /// Keys held when it last went down, wherever that was.
    pub held: Modifiers,
    keys: Modifiers,
    position: Vec2,
    down: Option<Vec2>,
    pub(super) strokes: Vec<Stroke>,
}

/// For each press of the left button in this frame, in order, whether something drawn over the model took it.
#[derive(Resource, Debug, Default)]
pub struct PressClaims(pub Vec<bool>);

/// Follows the messages of this frame.
pub(super) fn follow(
    mut events: MessageReader<WindowEvent>,
    mut left: ResMut<LeftButton>,
    pointer: Res<Pointer>,
    viewport: Res<Viewport>,
    claims: Res<PressClaims>,
) {
    if events.is_empty() && left.strokes.is_empty() {
        return;
    }
    let left = &mut *left;
    left.strokes.clear();
    let mut claims = claims.0.iter().copied();
    for event in events.read() {
        match event {
            WindowEvent::CursorMoved(moved) => left.position = moved.position,
            WindowEvent::KeyboardFocusLost(_) => left.keys = Modifiers::default(),
            WindowEvent::KeyboardInput(key) => left.keys.follow(key.key_code, key.state),
            WindowEvent::MouseButtonInput(button) if button.button == MouseButton::Left => {
                if button.state == ButtonState::Pressed {
                    left.held = left.keys;
                    let claimed = claims.next().unwrap_or_default();
                    let ours = pointer.in_viewport && viewport.contains(left.position) && !claimed;
                    left.down = ours.then_some(left.position);
                } else if let Some(down) = left.down.take() {
                    left.strokes.push(Stroke { down, up: left.position, held: left.held });
                }
            }
            _ => {}
        }
    }
}
