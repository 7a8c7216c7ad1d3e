//! The divider between the exact surfaces and their triangles, dragged with the left button.
//!
//! Messages are followed one by one, as everywhere: in a slow frame a whole drag may have happened. A press on the
//! divider is claimed, so that it does not select the face under it.

use bevy::prelude::*;
use bevy::window::{RequestRedraw, WindowEvent};

use super::{Tessellation, TessellationView};
use crate::editor::picking::PressClaims;
use crate::editor::settings::Settings;
use crate::editor::viewport::{Pointer, Viewport};

/// How near to the divider the pointer takes it, logical pixels.
const REACH: f32 = 7.0;
/// It stays this far from the borders, as shares of the width, so that it can be taken again.
const MARGIN: f32 = 0.01;

/// The divider.
#[derive(Resource, Debug, Clone, Copy, PartialEq)]
pub struct Wipe {
    /// Where it is, as a share of the width of the viewport.
    pub share: f32,
    /// Whether the pointer is on it.
    pub hovered: bool,
    /// While it is dragged: from the pointer to it, logical pixels.
    pub grip: Option<f32>,
    position: Vec2,
}

impl Default for Wipe {
    fn default() -> Self {
        Self { share: 0.5, hovered: false, grip: None, position: Vec2::ZERO }
    }
}

impl Wipe {
    /// Where it is in the window, logical pixels.
    pub fn x(&self, viewport: &Viewport) -> f32 {
        viewport.min.x + self.share * viewport.size.x
    }

    fn is_near(&self, position: Vec2, viewport: &Viewport) -> bool {
        viewport.contains(position) && (position.x - self.x(viewport)).abs() <= REACH
    }

    fn follow(&mut self, x: f32, viewport: &Viewport) {
        let share = (x - viewport.min.x) / viewport.size.x.max(1.0);
        self.share = share.clamp(MARGIN, 1.0 - MARGIN);
    }
}

/// Follows the messages of this frame.
pub(super) fn drag(
    mut events: MessageReader<WindowEvent>,
    mut wipe: ResMut<Wipe>,
    mut settings: ResMut<Settings>,
    mut claims: ResMut<PressClaims>,
    mut redraw: MessageWriter<RequestRedraw>,
    state: Res<Tessellation>,
    pointer: Res<Pointer>,
    viewport: Res<Viewport>,
) {
    if settings.is_changed() && wipe.grip.is_none() {
        let kept = settings.tessellation.wipe;
        let share = if kept.is_finite() { kept.clamp(MARGIN, 1.0 - MARGIN) } else { 0.5 };
        if wipe.share != share {
            wipe.share = share;
        }
    }
    let active = settings.tessellation.view == TessellationView::Wipe && state.made().is_some();
    if events.is_empty() && (active || !wipe.hovered) {
        return;
    }
    let mut now = *wipe;
    let mut presses = 0;
    let mut released = false;
    for event in events.read() {
        match event {
            WindowEvent::CursorMoved(moved) => {
                now.position = moved.position;
                if let Some(grip) = now.grip {
                    now.follow(moved.position.x + grip, &viewport);
                }
            }
            WindowEvent::KeyboardFocusLost(_) => released |= now.grip.take().is_some(),
            WindowEvent::MouseButtonInput(input) if input.button == MouseButton::Left => {
                if !input.state.is_pressed() {
                    released |= now.grip.take().is_some();
                    continue;
                }
                let claimed = claims.0.get(presses).copied().unwrap_or_default();
                let ours = active && !claimed && pointer.in_viewport && now.is_near(now.position, &viewport);
                if ours {
                    now.grip = Some(now.x(&viewport) - now.position.x);
                    if claims.0.len() <= presses {
                        claims.0.resize(presses + 1, false);
                    }
                    claims.0[presses] = true;
                }
                presses += 1;
            }
            _ => {}
        }
    }
    let free = active && pointer.in_viewport;
    now.hovered = now.grip.is_some() || free && now.is_near(now.position, &viewport);
    if now.hovered != wipe.hovered || now.share != wipe.share {
        redraw.write(RequestRedraw);
    }
    wipe.set_if_neq(now);
    if released && settings.tessellation.wipe != now.share {
        settings.tessellation.wipe = now.share;
    }
}
