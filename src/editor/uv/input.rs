//! Mouse, wheel and keys over the canvas, message by message: in a slow frame a whole drag may have happened.

use std::time::Duration;

use bevy::ecs::system::SystemParam;
use bevy::input::mouse::MouseScrollUnit;
use bevy::prelude::*;
use bevy::window::{RequestRedraw, WindowEvent};
use glam::DVec2;

use super::draw_shape;
use super::geometry::UvGeometry;
use super::gesture::{Asked, Gesture, Hand};
use super::panel::{Overlay, UvPanel};
use super::ruler;
use super::tool::{PANEL_KEYS, PanelKey, Tool};
use crate::editor::editing::EditRequest;
use crate::editor::elements::{ActiveFace, ElementRequest, ElementSelection};
use crate::editor::tools::Modifiers;
use crate::editor::viewport::Pointer;

/// Two clicks within this time are a double click.
const DOUBLE_CLICK: Duration = Duration::from_millis(400);
/// Farthest the second click may be from the first, logical pixels.
const DOUBLE_CLICK_PX: f64 = 5.0;
/// Zoom factor of one notch of the wheel.
const ZOOM_PER_LINE: f64 = 1.2;
/// Trackpads report pixels: this many count as one notch.
const PIXELS_PER_LINE: f64 = 40.0;
/// Most notches taken at once.
const MOST_LINES: f64 = 6.0;

/// Pointer, keys and buttons as of the message last looked at.
#[derive(Debug, Default)]
pub(super) struct Held {
    position: DVec2,
    keys: Modifiers,
    space: bool,
    pan_button: Option<MouseButton>,
    last_click: Option<(Duration, DVec2)>,
    entity: Option<Entity>,
}

/// What input writes.
#[derive(SystemParam)]
pub(super) struct Sink<'w> {
    elements: MessageWriter<'w, ElementRequest>,
    edits: MessageWriter<'w, EditRequest>,
    redraw: MessageWriter<'w, RequestRedraw>,
}

impl Sink<'_> {
    fn send(&mut self, asked: Vec<Asked>) {
        if !asked.is_empty() {
            // What follows from it is shown in this frame, glyphs and highlights in the next.
            self.redraw.write(RequestRedraw);
        }
        for asked in asked {
            match asked {
                Asked::Elements(request) => drop(self.elements.write(request)),
                Asked::Edit(request) => drop(self.edits.write(request)),
            }
        }
    }
}

/// Follows the messages of this frame.
pub(super) fn follow(
    mut events: MessageReader<WindowEvent>,
    mut held: Local<Held>,
    mut panel: ResMut<UvPanel>,
    active: Res<ActiveFace>,
    geometry: Res<UvGeometry>,
    mut selection: ResMut<ElementSelection>,
    pointer: Res<Pointer>,
    time: Res<Time<Real>>,
    mut sink: Sink,
) {
    let mut asked = Vec::new();
    let held = &mut *held;
    if held.entity != active.entity() {
        held.entity = active.entity();
        if matches!(panel.gesture, Gesture::Drag(_)) {
            asked.push(Asked::Edit(EditRequest::Cancel));
        }
        panel.gesture = Gesture::None;
    }
    if events.is_empty() && asked.is_empty() {
        return;
    }
    let panel = &mut *panel;
    let selection_now = &*selection;
    for event in events.read() {
        follow_keys(event, held);
        let Some(face) = active.face.as_ref().filter(|_| panel.open) else { continue };
        let keys = held.keys;
        let mut hand = Hand {
            panel: &mut *panel,
            face,
            geometry: &geometry,
            selection: selection_now,
            keys,
            asked: &mut asked,
        };
        one(event, held, &mut hand, &pointer, time.elapsed());
    }
    let over = panel.open && pointer.in_uv;
    panel.pointer = (over || panel.is_busy()).then_some(held.position);
    if let Some(face) = &active.face {
        let idle = matches!(panel.gesture, Gesture::None);
        let hand = Hand {
            panel,
            face,
            geometry: &geometry,
            selection: selection_now,
            keys: held.keys,
            asked: &mut asked,
        };
        let hit = hand.panel.pointer.filter(|_| idle && over).and_then(|at| hand.hit(at));
        let hovered = hit.map(|h| h.element);
        if idle && hand.panel.hit != hit {
            let left_panel = !over && hand.panel.hit.is_none();
            hand.panel.hit = hit;
            if !left_panel && selection.hovered != hovered {
                selection.hovered = hovered;
            }
        }
    }
    sink.send(asked);
}

/// Keeps track of pointer and keys, whoever they are for.
fn follow_keys(event: &WindowEvent, held: &mut Held) {
    match event {
        WindowEvent::KeyboardInput(key) => {
            held.keys.follow(key.key_code, key.state);
            if key.key_code == KeyCode::Space {
                held.space = key.state.is_pressed();
            }
        }
        WindowEvent::KeyboardFocusLost(_) => (held.keys, held.space) = (Modifiers::default(), false),
        WindowEvent::CursorMoved(moved) => held.position = moved.position.as_dvec2(),
        _ => {}
    }
}

fn one(event: &WindowEvent, held: &mut Held, hand: &mut Hand, pointer: &Pointer, now: Duration) {
    let at = held.position;
    let ours = pointer.in_uv && hand.panel.view.contains(at);
    match event {
        WindowEvent::CursorMoved(_) if ours || hand.panel.is_busy() => hand.moved(at),
        WindowEvent::MouseWheel(wheel) if ours => {
            let lines = match wheel.unit {
                MouseScrollUnit::Line => f64::from(wheel.y),
                MouseScrollUnit::Pixel => f64::from(wheel.y) / PIXELS_PER_LINE,
            };
            if lines.is_finite() {
                hand.panel.view.zoom(at, ZOOM_PER_LINE.powf(lines.clamp(-MOST_LINES, MOST_LINES)));
                hand.moved(at);
            }
        }
        WindowEvent::MouseButtonInput(input) => {
            let (button, down) = (input.button, input.state.is_pressed());
            let pans =
                matches!(button, MouseButton::Middle | MouseButton::Right) || held.space || held.keys.alt;
            if down && ours && pans && !hand.panel.is_busy() {
                held.pan_button = Some(button);
                hand.panel.gesture = Gesture::Pan { last: at, moved: false };
            } else if !down && held.pan_button == Some(button) {
                held.pan_button = None;
                let clicked = hand.panel.gesture == Gesture::Pan { last: at, moved: false }
                    || matches!(hand.panel.gesture, Gesture::Pan { moved: false, .. });
                if matches!(hand.panel.gesture, Gesture::Pan { .. }) {
                    hand.panel.gesture = Gesture::None;
                }
                if clicked && button == MouseButton::Right {
                    open_menu(hand, at);
                }
            } else if button == MouseButton::Left && down && ours {
                let double = held.last_click.is_some_and(|(t, p)| {
                    now.saturating_sub(t) <= DOUBLE_CLICK && p.distance(at) <= DOUBLE_CLICK_PX
                });
                held.last_click = (!double).then_some((now, at));
                hand.press(at, double);
            } else if button == MouseButton::Left && !down && hand.panel.is_busy() {
                hand.release(at);
            }
        }
        WindowEvent::KeyboardInput(input) if input.state.is_pressed() && !pointer.keyboard_taken => {
            let busy = hand.panel.is_busy();
            if !pointer.in_uv && !(busy && input.key_code == KeyCode::Escape) || pointer.sheet_open {
                return;
            }
            if let Some(key) = panel_key(&input.logical_key, input.key_code, held.keys) {
                if !input.repeat || matches!(key, PanelKey::Nudge(..)) {
                    press_key(hand, key);
                }
            } else if busy {
                hand.moved(at);
            }
        }
        // Shift or Ctrl let go changes what a drag snaps to.
        WindowEvent::KeyboardInput(_) if hand.panel.is_busy() => hand.moved(at),
        _ => {}
    }
}

/// What a key means to the panel.
pub(crate) fn panel_key(
    logical: &bevy::input::keyboard::Key,
    code: KeyCode,
    held: Modifiers,
) -> Option<PanelKey> {
    let tool = Tool::ALL.into_iter().find(|t| t.key().matches(logical, code, held)).map(PanelKey::Tool);
    tool.or_else(|| PANEL_KEYS.iter().find(|k| k.0.matches(logical, code, held)).map(|k| k.1))
}

/// Selects what is under the pointer unless it is selected, and asks for the menu.
fn open_menu(hand: &mut Hand, at: DVec2) {
    let hit = hand.hit(at);
    if let Some(hit) = hit.filter(|h| !hand.selection.covers(h.element)) {
        let mode = crate::editor::selection::SelectMode::Replace;
        hand.asked.push(Asked::Elements(ElementRequest { elements: vec![hit.element], mode }));
    }
    hand.panel.hit = hit;
    hand.panel.menu_at = Some(at);
}

fn press_key(hand: &mut Hand, key: PanelKey) {
    match key {
        PanelKey::Tool(tool) => {
            if !matches!(hand.panel.gesture, Gesture::Drag(_)) {
                hand.panel.tool = tool;
                hand.panel.gesture = Gesture::None;
                hand.panel.snapped = None;
            }
        }
        PanelKey::Fit => hand.panel.fit(hand.face),
        PanelKey::FitSelection => hand.panel.fit_selection(hand.face, hand.selection),
        PanelKey::SelectAll => hand.select_all(),
        PanelKey::Escape => {
            hand.escape();
        }
        PanelKey::Enter => draw_shape::enter(hand),
        PanelKey::Back => draw_shape::back(hand),
        PanelKey::Nudge(u, v) => {
            let step = ruler::Steps::of(&hand.panel.view).minor * 0.1;
            hand.nudge(step * DVec2::new(u.into(), v.into()));
        }
        PanelKey::Snap => hand.panel.snapping.on = !hand.panel.snapping.on,
        PanelKey::Overlay => {
            hand.panel.overlay = match hand.panel.overlay {
                Overlay::None => Overlay::Intervals,
                Overlay::Intervals => Overlay::Grid,
                Overlay::Grid => Overlay::None,
            }
        }
    }
}
