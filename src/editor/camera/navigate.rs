//! Mouse and wheel to camera motions.

use bevy::input::mouse::{MouseScrollUnit, MouseWheel};
use bevy::prelude::*;
use bevy::window::WindowEvent;
use glam::{DVec2, DVec3};

use super::{ViewCamera, motion};
use crate::editor::derive::SceneBounds;
use crate::editor::picking::Picker;
use crate::editor::tools::Modifiers;
use crate::editor::viewport::{Pointer, Viewport};

/// Radians of orbit for a drag over the height of the viewport.
const ORBIT_PER_HEIGHT: f64 = std::f64::consts::PI;
/// Zoom factor of one notch of the wheel.
const ZOOM_PER_LINE: f64 = 1.15;
/// Trackpads report pixels: this many count as one notch.
const PIXELS_PER_LINE: f64 = 40.0;
/// Most notches taken per frame: a slow frame must not make a leap of the zoom.
const MOST_LINES: f64 = 6.0;

/// The drag under way.
#[derive(Resource, Debug, Default)]
pub(in crate::editor) struct Drag(Option<Grip>);

impl Drag {
    /// Whether the view is being turned or moved.
    pub fn is_on(&self) -> bool {
        self.0.is_some()
    }
}

#[derive(Debug)]
struct Grip {
    button: MouseButton,
    pivot: DVec3,
    last: Vec2,
    pan: bool,
}

/// Pointer and keys as of the message last looked at.
#[derive(Debug, Default)]
pub(super) struct Hand {
    position: Vec2,
    keys: Modifiers,
}

/// Orbit and pan. Messages are followed one by one: in a slow frame a whole drag may have happened.
pub(super) fn drag(
    mut events: MessageReader<WindowEvent>,
    mut hand: Local<Hand>,
    mut drag: ResMut<Drag>,
    mut camera: ResMut<ViewCamera>,
    pointer: Res<Pointer>,
    viewport: Res<Viewport>,
    picker: Res<Picker>,
) {
    for event in events.read() {
        match event {
            WindowEvent::KeyboardInput(key) => hand.keys.follow(key.key_code, key.state),
            WindowEvent::KeyboardFocusLost(_) => {
                hand.keys = Modifiers::default();
                drag.0 = None;
            }
            WindowEvent::CursorMoved(moved) => {
                hand.position = moved.position;
                if let Some(grip) = &mut drag.0 {
                    pull(grip, moved.position, &mut camera, &viewport);
                }
            }
            WindowEvent::MouseButtonInput(input) if input.state.is_pressed() => {
                let turns = match input.button {
                    MouseButton::Middle | MouseButton::Right => true,
                    MouseButton::Left => hand.keys.alt,
                    _ => false,
                };
                let ours = pointer.in_viewport && viewport.contains(hand.position);
                if turns && ours && drag.0.is_none() {
                    drag.0 = Some(Grip {
                        button: input.button,
                        pivot: point_under(&camera, &picker, &viewport, hand.position),
                        last: hand.position,
                        pan: hand.keys.shift,
                    });
                }
            }
            WindowEvent::MouseButtonInput(input)
                if drag.0.as_ref().is_some_and(|grip| grip.button == input.button) =>
            {
                drag.0 = None;
            }
            _ => {}
        }
    }
}

/// Moves the camera so that what is gripped follows the pointer to `position`.
fn pull(grip: &mut Grip, position: Vec2, camera: &mut ViewCamera, viewport: &Viewport) {
    if position == grip.last {
        return;
    }
    let aspect = viewport.aspect();
    let now = camera.now;
    camera.now = if grip.pan {
        motion::pan(&now, grip.pivot, viewport.ndc(grip.last), viewport.ndc(position), aspect)
    } else {
        let moved = (position - grip.last).as_dvec2() / f64::from(viewport.size.y.max(1.0));
        motion::orbit(&now, grip.pivot, -moved.x * ORBIT_PER_HEIGHT, moved.y * ORBIT_PER_HEIGHT)
    };
    camera.flight = None;
    grip.last = position;
}

/// Zoom to the pointer.
pub(super) fn wheel(
    mut wheel: MessageReader<MouseWheel>,
    mut camera: ResMut<ViewCamera>,
    pointer: Res<Pointer>,
    viewport: Res<Viewport>,
    picker: Res<Picker>,
    bounds: Res<SceneBounds>,
) {
    let lines: f64 = wheel
        .read()
        .map(|event| match event.unit {
            MouseScrollUnit::Line => f64::from(event.y),
            MouseScrollUnit::Pixel => f64::from(event.y) / PIXELS_PER_LINE,
        })
        .sum();
    let Some(position) = pointer.position.filter(|_| pointer.in_viewport) else { return };
    if lines == 0.0 || !lines.is_finite() {
        return;
    }
    let about = point_under(&camera, &picker, &viewport, position);
    let factor = ZOOM_PER_LINE.powf(-lines.clamp(-MOST_LINES, MOST_LINES));
    camera.now = motion::zoom(&camera.now, about, factor, bounds.scale());
    camera.flight = None;
}

/// The model point under the pointer; beside the model the point at the depth of the target.
fn point_under(camera: &ViewCamera, picker: &Picker, viewport: &Viewport, position: Vec2) -> DVec3 {
    let ndc: DVec2 = viewport.ndc(position);
    let aspect = viewport.aspect();
    let depth_of = picker.hit_near(viewport.pixel(position)).map_or(camera.now.target, |hit| hit.position);
    let point = motion::on_plane(&camera.now, depth_of, ndc, aspect);
    if point.is_finite() { point } else { camera.now.target }
}
