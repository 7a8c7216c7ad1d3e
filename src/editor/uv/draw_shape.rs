//! The tools that draw a new loop, and those that work on a place of a curve.

use std::collections::BTreeSet;

use glam::DVec2;

use super::gesture::{Gesture, Hand};
use super::hit;
use super::tool::Tool;
use crate::editor::editing::EditRequest;
use crate::editor::elements::Element;
use crate::kernel::nurbs::{NurbsCurve2, freehand};
use crate::scene::operation::{CurveId, Operation, Shape};
use crate::scene::records::{LoopRecord, LoopRole};

/// A shape smaller than this on the screen is a slip of the hand, logical pixels.
const SMALLEST_PX: f64 = 3.0;
/// The first corner closes a polyline within this reach, logical pixels.
pub const CLOSE_REACH_PX: f64 = 9.0;
/// Points of a freehand line are at least this far apart, logical pixels.
const FREEHAND_STEP_PX: f64 = 2.0;

/// The fitted curve may be this far from the hand's way, logical pixels.
const FREEHAND_TOLERANCE_PX: f64 = 1.5;

/// Where the pointer's place goes when something is drawn.
fn place(hand: &mut Hand, at: DVec2, origin: Option<DVec2>) -> DVec2 {
    let raw = hand.panel.view.to_uv(at);
    hand.snap(raw, origin, &BTreeSet::new())
}

/// The left button went down with a drawing tool.
pub(super) fn press(hand: &mut Hand, at: DVec2, double: bool) {
    match hand.panel.tool {
        Tool::Freehand => {
            let raw = hand.panel.view.to_uv(at);
            hand.panel.gesture = Gesture::Freehand { points: vec![raw] };
        }
        Tool::Polyline => corner(hand, at, double),
        _ => {
            let from = place(hand, at, None);
            hand.panel.gesture = Gesture::Shape { from, to: from };
        }
    }
}

fn corner(hand: &mut Hand, at: DVec2, double: bool) {
    let mut corners = match std::mem::take(&mut hand.panel.gesture) {
        Gesture::Polyline { corners } => corners,
        _ => Vec::new(),
    };
    let closes = corners
        .first()
        .is_some_and(|first| (hand.panel.view.to_screen(*first) - at).length() <= CLOSE_REACH_PX);
    if corners.len() >= 3 && (closes || double) {
        return close(hand, corners);
    }
    let origin = corners.last().copied().filter(|_| hand.keys.shift);
    let next = place(hand, at, origin);
    if corners.last() != Some(&next) {
        corners.push(next);
    }
    hand.panel.gesture = Gesture::Polyline { corners };
}

fn close(hand: &mut Hand, corners: Vec<DVec2>) {
    hand.panel.snapped = None;
    add(hand, Shape::Polyline { points: corners });
}

/// Enter: closes a polyline.
pub(super) fn enter(hand: &mut Hand) {
    if let Gesture::Polyline { corners } = std::mem::take(&mut hand.panel.gesture)
        && corners.len() >= 3
    {
        close(hand, corners);
    }
}

/// Backspace: takes the last corner of a polyline back.
pub(super) fn back(hand: &mut Hand) {
    if let Gesture::Polyline { corners } = &mut hand.panel.gesture {
        corners.pop();
        if corners.is_empty() {
            hand.panel.gesture = Gesture::None;
        }
    }
}

/// The pointer moved with a tool other than selecting.
pub(super) fn moved(hand: &mut Hand, to: DVec2) {
    match std::mem::take(&mut hand.panel.gesture) {
        Gesture::Shape { from, .. } => {
            let place = place(hand, to, None);
            let to = if hand.keys.shift { square(hand, from, place) } else { place };
            hand.panel.gesture = Gesture::Shape { from, to };
        }
        Gesture::Freehand { mut points } => {
            let raw = hand.panel.view.to_uv(to);
            let far = points.last().is_none_or(|p| hand.panel.view.distance_px(*p, raw) >= FREEHAND_STEP_PX);
            if far {
                points.push(raw);
            }
            hand.panel.gesture = Gesture::Freehand { points };
        }
        Gesture::Polyline { corners } => {
            let origin = corners.last().copied().filter(|_| hand.keys.shift);
            place(hand, to, origin);
            hand.panel.gesture = Gesture::Polyline { corners };
        }
        other => {
            hand.panel.gesture = other;
            if hand.panel.tool.draws() {
                place(hand, to, None);
            }
        }
    }
}

/// The corner that makes a square on the screen.
fn square(hand: &Hand, from: DVec2, to: DVec2) -> DVec2 {
    let d = (to - from) * hand.panel.view.scale;
    let side = d.abs().max_element();
    from + DVec2::new(side.copysign(d.x), side.copysign(d.y)) / hand.panel.view.scale
}

/// The left button went up with a tool other than selecting.
pub(super) fn release(hand: &mut Hand, _at: DVec2) {
    match std::mem::take(&mut hand.panel.gesture) {
        Gesture::Shape { from, to } => {
            hand.panel.snapped = None;
            if hand.panel.view.distance_px(from, to) >= SMALLEST_PX
                && let Some(shape) = shape_of(hand, from, to)
            {
                add(hand, shape);
            }
        }
        Gesture::Freehand { points } if points.len() >= 3 => add_freehand(hand, &points),
        other @ Gesture::Polyline { .. } => hand.panel.gesture = other,
        _ => {}
    }
}

/// Cubics through the hand's way, fitted as it looks on the screen; all of it is one step.
fn add_freehand(hand: &mut Hand, points: &[DVec2]) {
    let scale = hand.panel.view.scale;
    let on_screen: Vec<DVec2> = points.iter().map(|p| (*p - points[0]) * scale).collect();
    let origin = points[0];
    let fitted = freehand::closed_chain(&on_screen, FREEHAND_TOLERANCE_PX);
    // Affine, so the fit is as good in parameters.
    let curves: Vec<NurbsCurve2> =
        fitted.iter().map(|c| c.map_points(|p: DVec2| origin + p / scale)).collect();
    if !curves.is_empty() {
        let face = hand.face.id;
        let trim_loop = LoopRecord { curves, ..LoopRecord::default() };
        hand.ask(EditRequest::Perform(Operation::PasteLoops {
            face,
            loops: vec![trim_loop],
            by: DVec2::ZERO,
        }));
    }
    hand.panel.tool = Tool::Select;
}

/// Rectangle, or what is a circle on the screen and so on the surface, as far as its parameters allow.
fn shape_of(hand: &Hand, from: DVec2, to: DVec2) -> Option<Shape> {
    if hand.panel.tool == Tool::Rectangle {
        return (from.x != to.x && from.y != to.y).then_some(Shape::Rectangle { from, to });
    }
    let radii = circle_radii(hand.panel.view.scale, from, to);
    Some(if radii.x == radii.y {
        Shape::Circle { centre: from, radius: radii.x }
    } else {
        Shape::Ellipse { centre: from, radii, degrees: 0.0 }
    })
}

/// Radii along u and v of the circle on the screen around `centre` through `to`.
pub fn circle_radii(scale: DVec2, centre: DVec2, to: DVec2) -> DVec2 {
    let radius_px = ((to - centre) * scale).length();
    radius_px / scale
}

fn add(hand: &mut Hand, shape: Shape) {
    let face = hand.face.id;
    hand.ask(EditRequest::Perform(Operation::AddLoop { face, shape, role: LoopRole::Unknown }));
    hand.panel.tool = Tool::Select;
}

/// A click with a tool that works on a place of a curve.
pub(super) fn click_on_curve(hand: &mut Hand, at: DVec2) {
    let Some(hit) = hit::curve_at(at, hand.geometry, &hand.panel.view) else { return };
    let (Element::Curve { trim_loop, curve }, Some(at)) = (hit.element, hit.parameter) else { return };
    let (face, curve) = (hand.face.id, CurveId { trim_loop, curve });
    hand.ask(EditRequest::Perform(match hand.panel.tool {
        Tool::InsertKnot => Operation::InsertKnot { face, curve, at, times: 1 },
        _ => Operation::SplitCurve { face, curve, at },
    }));
}
