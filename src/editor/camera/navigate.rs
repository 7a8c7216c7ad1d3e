//! Mouse and wheel to camera motions.

use bevy::input::mouse::{MouseScrollUnit, MouseWheel};
use bevy::prelude::*;
use glam::{DVec2, DVec3};

use super::{ViewCamera, motion};
use crate::editor::derive::SceneBounds;
use crate::editor::picking::Picker;
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
pub(super) struct Drag(Option<Grip>);

#[derive(Debug)]
struct Grip {
    button: MouseButton,
    pivot: DVec3,
    last: Vec2,
    pan: bool,
}

/// Orbit and pan.
pub(super) fn drag(
    mut drag: ResMut<Drag>,
    mut camera: ResMut<ViewCamera>,
    buttons: Res<ButtonInput<MouseButton>>,
    keys: Res<ButtonInput<KeyCode>>,
    pointer: Res<Pointer>,
    viewport: Res<Viewport>,
    picker: Res<Picker>,
) {
    let alt = keys.any_pressed([KeyCode::AltLeft, KeyCode::AltRight]);
    let shift = keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
    let Some(position) = pointer.position else {
        drag.0 = None;
        return;
    };
    if drag.0.as_ref().is_some_and(|grip| !buttons.pressed(grip.button)) {
        drag.0 = None;
    }
    if drag.0.is_none() && pointer.in_viewport {
        let pressed = |button| buttons.just_pressed(button);
        let button = [MouseButton::Middle, MouseButton::Right].into_iter().find(|b| pressed(*b));
        let button = button.or((alt && pressed(MouseButton::Left)).then_some(MouseButton::Left));
        drag.0 = button.map(|button| Grip {
            button,
            pivot: point_under(&camera, &picker, &viewport, position),
            last: position,
            pan: shift,
        });
    }
    let Some(grip) = &mut drag.0 else { return };
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
