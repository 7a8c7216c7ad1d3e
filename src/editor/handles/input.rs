//! Mouse and keys on the handles in the 3D view, message by message.
//!
//! A press of the left button on a handle is claimed, so that it does not select the face under it.

use std::time::Duration;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::window::{RequestRedraw, WindowEvent};

use super::aim::{self, Aimed, Lens};
use super::drag::HandleDrag;
use super::shapes::HandleShapes;
use crate::editor::camera::ViewCamera;
use crate::editor::editing::EditRequest;
use crate::editor::elements::{ActiveFace, Element, ElementRequest, ElementSelection, FaceInHand};
use crate::editor::picking::PressClaims;
use crate::editor::selection::SelectMode;
use crate::editor::tools::Modifiers;
use crate::editor::uv::gesture::mode_of;
use crate::editor::viewport::{Pointer, Viewport};

/// Farther than this, logical pixels, a press is a drag.
const CLICK_SLOP_PX: f32 = 3.0;
/// Two clicks within this time are a double click.
const DOUBLE_CLICK: Duration = Duration::from_millis(400);

/// What the hand does with handles.
#[derive(Resource, Debug, Default)]
pub struct HandleHand {
    /// The handle under the pointer.
    pub aimed: Option<Aimed>,
    /// What is under way.
    pub grip: Grip,
    position: Vec2,
    keys: Modifiers,
    last_click: Option<(Duration, Vec2)>,
    entity: Option<Entity>,
}

/// Stages of a press.
#[derive(Debug, Default)]
pub enum Grip {
    /// Nothing.
    #[default]
    None,
    /// The button went down on a handle.
    Pressed {
        /// The handle.
        aimed: Aimed,
        /// Where.
        at: Vec2,
        /// Keys held then.
        keys: Modifiers,
        /// Whether it is the second of a double click.
        double: bool,
    },
    /// Handles are dragged.
    Drag(HandleDrag),
}

impl HandleHand {
    /// Whether handles are being dragged.
    pub fn is_dragging(&self) -> bool {
        matches!(self.grip, Grip::Drag(_))
    }
}

/// What input on handles reads.
#[derive(SystemParam)]
pub(super) struct Sight<'w> {
    active: Res<'w, ActiveFace>,
    shapes: Res<'w, HandleShapes>,
    camera: Res<'w, ViewCamera>,
    viewport: Res<'w, Viewport>,
    time: Res<'w, Time<Real>>,
}

/// What it writes.
#[derive(SystemParam)]
pub(super) struct Sink<'w> {
    elements: MessageWriter<'w, ElementRequest>,
    edits: MessageWriter<'w, EditRequest>,
    redraw: MessageWriter<'w, RequestRedraw>,
    claims: ResMut<'w, PressClaims>,
}

impl Sink<'_> {
    fn edit(&mut self, request: EditRequest) {
        self.edits.write(request);
        self.redraw.write(RequestRedraw);
    }

    fn select(&mut self, elements: Vec<Element>, mode: SelectMode) {
        self.elements.write(ElementRequest { elements, mode });
        self.redraw.write(RequestRedraw);
    }
}

/// Follows the messages of this frame.
pub(super) fn follow(
    mut events: MessageReader<WindowEvent>,
    mut hand: ResMut<HandleHand>,
    mut pointer: ResMut<Pointer>,
    mut selection: ResMut<ElementSelection>,
    sight: Sight,
    mut sink: Sink,
) {
    sink.claims.0.clear();
    let hand = &mut *hand;
    let entity = sight.active.entity().filter(|_| sight.shapes.map.is_some());
    if hand.entity != entity {
        hand.entity = entity;
        if hand.is_dragging() {
            sink.edit(EditRequest::Cancel);
        }
        (hand.grip, hand.aimed) = (Grip::None, None);
    }
    if events.is_empty() {
        return;
    }
    for event in events.read() {
        match event {
            WindowEvent::CursorMoved(moved) => hand.position = moved.position,
            WindowEvent::KeyboardInput(key) => hand.keys.follow(key.key_code, key.state),
            WindowEvent::KeyboardFocusLost(_) => hand.keys = Modifiers::default(),
            _ => {}
        }
        let claimed = entity.is_some() && {
            let Some(face) = &sight.active.face else { continue };
            let lens = Lens::new(&sight.camera.now, &sight.viewport);
            let now = sight.time.elapsed();
            one(event, hand, face, &lens, &pointer, &selection, &sight.shapes, &mut sink, now)
        };
        if let WindowEvent::MouseButtonInput(input) = event
            && input.button == MouseButton::Left
            && input.state.is_pressed()
        {
            sink.claims.0.push(claimed);
        }
    }
    aim_idle(hand, entity.is_some(), &pointer, &mut selection, &sight, &mut sink);
    let dragging = hand.is_dragging();
    if pointer.drags_handle != dragging {
        pointer.drags_handle = dragging;
    }
}

/// Looks for the handle under the pointer while nothing is under way.
fn aim_idle(
    hand: &mut HandleHand,
    shown: bool,
    pointer: &Pointer,
    selection: &mut ElementSelection,
    sight: &Sight,
    sink: &mut Sink,
) {
    if !matches!(hand.grip, Grip::None) {
        return;
    }
    let lens = Lens::new(&sight.camera.now, &sight.viewport);
    let over = shown && pointer.in_viewport;
    let aimed = if over { aim::at(hand.position, &sight.shapes, &lens, selection) } else { None };
    let (before, now) = (hand.aimed.map(|a| a.element), aimed.map(|a| a.element));
    hand.aimed = aimed;
    if before != now {
        if over || before.is_some() {
            selection.hovered = now;
        }
        sink.redraw.write(RequestRedraw);
    }
}

/// One message. Whether it is a press that belongs to a handle.
fn one(
    event: &WindowEvent,
    hand: &mut HandleHand,
    face: &FaceInHand,
    lens: &Lens,
    pointer: &Pointer,
    selection: &ElementSelection,
    shapes: &HandleShapes,
    sink: &mut Sink,
    now: Duration,
) -> bool {
    let at = hand.position;
    match event {
        WindowEvent::CursorMoved(_) => moved(hand, face, lens, selection, shapes, sink),
        WindowEvent::MouseButtonInput(input) if input.button == MouseButton::Left => {
            if !input.state.is_pressed() {
                release(hand, sink);
                return false;
            }
            if shapes.passive || !pointer.in_viewport || !lens.viewport.contains(at) || hand.keys.alt {
                return false;
            }
            let Some(aimed) = aim::at(at, shapes, lens, selection) else { return false };
            let double = hand
                .last_click
                .is_some_and(|(t, p)| now.saturating_sub(t) <= DOUBLE_CLICK && p.distance(at) <= 5.0);
            hand.last_click = (!double).then_some((now, at));
            hand.grip = Grip::Pressed { aimed, at, keys: hand.keys, double };
            return true;
        }
        WindowEvent::KeyboardInput(input) if input.state.is_pressed() && !pointer.keyboard_taken => {
            let Grip::Drag(drag) = &mut hand.grip else { return false };
            match (input.key_code, drag) {
                (KeyCode::Escape, _) => {
                    hand.grip = Grip::None;
                    sink.edit(EditRequest::Cancel);
                }
                (key @ (KeyCode::KeyX | KeyCode::KeyY | KeyCode::KeyZ), HandleDrag::Net { axis, .. }) => {
                    let wanted = match key {
                        KeyCode::KeyX => 0,
                        KeyCode::KeyY => 1,
                        _ => 2,
                    };
                    *axis = (*axis != Some(wanted)).then_some(wanted);
                    moved(hand, face, lens, selection, shapes, sink);
                }
                _ => {}
            }
        }
        _ => {}
    }
    false
}

fn moved(
    hand: &mut HandleHand,
    face: &FaceInHand,
    lens: &Lens,
    selection: &ElementSelection,
    shapes: &HandleShapes,
    sink: &mut Sink,
) {
    if let Grip::Pressed { aimed, at, keys, .. } = hand.grip {
        if hand.position.distance(at) <= CLICK_SLOP_PX {
            return;
        }
        let mut elements = vec![aimed.element];
        if selection.covers(aimed.element) {
            elements = selection.elements().collect();
        } else if keys.shift || keys.ctrl {
            elements.extend(selection.elements());
            sink.select(vec![aimed.element], SelectMode::Add);
        } else {
            sink.select(elements.clone(), SelectMode::Replace);
        }
        let Some(drag) = HandleDrag::begin(aimed, at, &elements, face, shapes, lens) else { return };
        hand.grip = Grip::Drag(drag);
        sink.edit(EditRequest::Begin);
    }
    let snaps = !hand.keys.ctrl;
    if let Grip::Drag(drag) = &mut hand.grip
        && let Some(operation) = drag.follow(hand.position, face, shapes, lens, snaps)
    {
        sink.edit(EditRequest::Preview(operation));
    }
}

fn release(hand: &mut HandleHand, sink: &mut Sink) {
    match std::mem::take(&mut hand.grip) {
        Grip::None => {}
        Grip::Drag(_) => sink.edit(EditRequest::Commit),
        Grip::Pressed { aimed, keys, double, .. } => {
            let mode = mode_of(keys);
            match aimed.element.trim_loop() {
                Some(trim_loop) if double => sink.select(vec![Element::Loop { trim_loop }], mode),
                _ => sink.select(vec![aimed.element], mode),
            }
        }
    }
}
