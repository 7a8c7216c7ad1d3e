//! Clicks and hovering.

use std::time::Duration;

use bevy::prelude::*;
use bevy::window::RequestRedraw;

use super::{LeftButton, Picker, ViewportClick};
use crate::editor::camera::CameraRequest;
use crate::editor::object::DerivedFace;
use crate::editor::selection::{SelectMode, SelectRequest, Selection};
use crate::editor::viewport::{Pointer, Viewport};

/// Farther than this, logical pixels, it is a drag.
const CLICK_SLOP: f32 = 4.0;
/// Two clicks within this time are a double click.
const DOUBLE_CLICK: Duration = Duration::from_millis(400);

/// A click that has no answer by then is forgotten: its pixel is gone.
const ANSWER_DUE: Duration = Duration::from_secs(5);

/// A click whose pixel is not answered yet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Click {
    pixel: UVec2,
    mode: SelectMode,
    double: bool,
    at: Duration,
}

/// Notes clicks: left button down and up again at about the same place of the viewport.
pub(super) fn press(
    mut picker: ResMut<Picker>,
    mut last: Local<Option<(Duration, Vec2)>>,
    left: Res<LeftButton>,
    viewport: Res<Viewport>,
    time: Res<Time<Real>>,
    mut clicks: MessageWriter<ViewportClick>,
) {
    let now = time.elapsed();
    if picker.click.is_some_and(|click| now.saturating_sub(click.at) > ANSWER_DUE) {
        picker.click = None;
    }
    for stroke in left.strokes.iter().filter(|s| !s.held.alt && s.down.distance(s.up) <= CLICK_SLOP) {
        let double = last.is_some_and(|(t, p)| {
            now.saturating_sub(t) <= DOUBLE_CLICK && p.distance(stroke.down) <= CLICK_SLOP
        });
        *last = (!double).then_some((now, stroke.down));
        let toggle = stroke.held.ctrl || stroke.held.shift;
        let mode = if toggle { SelectMode::Toggle } else { SelectMode::Replace };
        let pixel = viewport.pixel(stroke.down);
        picker.wanted = Some(pixel);
        picker.click = Some(Click { pixel, mode, double, at: now });
        clicks.write(ViewportClick { position: stroke.down });
    }
}

/// Serves hover and the waiting click from the answer; asks for frames until the answer is there.
pub(super) fn resolve(
    mut picker: ResMut<Picker>,
    mut selection: ResMut<Selection>,
    pointer: Res<Pointer>,
    faces: Query<&DerivedFace>,
    mut requests: MessageWriter<SelectRequest>,
    mut camera: MessageWriter<CameraRequest>,
    mut redraw: MessageWriter<RequestRedraw>,
    mut hovering: Local<bool>,
) {
    if let (Some(click), Some((pixel, hit))) = (picker.click, picker.answer)
        && pixel == click.pixel
    {
        picker.click = None;
        let faces_hit: Vec<Entity> = hit.map(|h| h.face).into_iter().collect();
        if click.double {
            if let Some(derived) = hit.and_then(|h| faces.get(h.face).ok()) {
                camera.write(CameraRequest::FitBounds(derived.0.bounds));
            }
        } else if !faces_hit.is_empty() || click.mode == SelectMode::Replace {
            requests.write(SelectRequest { faces: faces_hit, mode: click.mode });
        }
        redraw.write(RequestRedraw);
    }
    if pointer.in_viewport {
        let hovered =
            picker.answer.filter(|_| picker.wanted.is_some()).and_then(|(_, hit)| hit).map(|h| h.face);
        if selection.hovered != hovered {
            selection.hovered = hovered;
        }
    } else if *hovering && selection.hovered.is_some() {
        // The pointer left for a panel: the tree sets its own.
        selection.hovered = None;
    }
    *hovering = pointer.in_viewport;
    if picker.is_waiting() {
        redraw.write(RequestRedraw);
    }
}
