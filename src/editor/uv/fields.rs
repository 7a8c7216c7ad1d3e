//! The line under the canvas: place of the pointer, and the exact coordinates and weight of what is selected.

use bevy_egui::egui::{self, Align, DragValue, Layout, Rect, RichText, Ui, UiBuilder};
use glam::DVec2;

use super::gesture::Gesture;
use super::show::UvParams;
use crate::editor::editing::EditRequest;
use crate::editor::elements::{FaceInHand, PointAddress};
use crate::scene::operation::{NetId, Operation, PointId};

/// Height of the line, logical pixels.
pub(super) const HEIGHT_PX: f32 = 30.0;
/// Digits shown of a parameter; all are kept.
const DIGITS: usize = 6;

/// What is being dragged in a field.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum FieldDrag {
    /// Nothing.
    #[default]
    None,
    /// A value is dragged: previews go out until it is let go.
    On,
}

/// Shows the line.
pub(super) fn show(ui: &mut Ui, rect: Rect, params: &mut UvParams) {
    let palette = *params.palette;
    ui.painter().rect_filled(rect, 0.0, palette.bar);
    let inner = rect.shrink2(egui::vec2(10.0, 2.0));
    let layout = Layout::left_to_right(Align::Center);
    ui.scope_builder(UiBuilder::new().max_rect(inner).layout(layout), |ui| {
        ui.style_mut().override_text_style = Some(egui::TextStyle::Small);
        ui.spacing_mut().item_spacing.x = 6.0;
        let Some(face) = params.active.face.clone() else { return };
        let points = params.selection.points(&face.loops);
        let net = params.selection.surface_points();
        match points.as_slice() {
            [] if !net.is_empty() => surface_points(ui, &face, &net, params),
            [] => {
                let text = match params.panel.pointer_uv().or_else(|| in_space(params, &face)) {
                    Some(uv) => format!("u {:.6}   v {:.6}", uv.x, uv.y),
                    None => "Click a point or a curve to edit it".into(),
                };
                ui.label(RichText::new(text).color(palette.weak));
            }
            points => selected(ui, &face, points, params),
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if !points.is_empty()
                && let Some(uv) = params.panel.pointer_uv()
            {
                let text = format!("u {:.6}   v {:.6}", uv.x, uv.y);
                ui.label(RichText::new(text).color(palette.weak));
            }
        });
    });
}

fn in_space(params: &UvParams, face: &FaceInHand) -> Option<DVec2> {
    let hit = params.picker.answer?.1?;
    (hit.face == face.entity && params.picker.wanted.is_some()).then_some(hit.uv)
}

/// What is selected, with fields where it is one place.
fn selected(ui: &mut Ui, face: &FaceInHand, points: &[PointAddress], params: &mut UvParams) {
    let palette = *params.palette;
    let what = match params.selection.only() {
        Some(element) => element.label(),
        None => {
            let count = params.selection.elements().count();
            format!("{count} selected")
        }
    };
    ui.label(RichText::new(what).color(palette.accent));
    let place = joined_place(face, points);
    let weight = common_weight(face, points);
    if let Some(at) = place {
        let speed = 1.0 / params.panel.view.scale;
        for (axis, name) in ["u", "v"].into_iter().enumerate() {
            ui.label(RichText::new(name).color(palette.weak));
            let mut value = at[axis];
            let response = ui.add(
                DragValue::new(&mut value)
                    .speed(speed[axis])
                    .max_decimals(15)
                    .min_decimals(0)
                    .custom_formatter(|x, _| short(x)),
            );
            let mut to = at;
            to[axis] = value;
            let (face_id, point) = (face.id, id(points[0]));
            follow(&response, value != at[axis], params, move || Operation::SetPoint {
                face: face_id,
                point,
                to,
                beyond: false,
            });
        }
    }
    ui.label(RichText::new("weight").color(palette.weak));
    let mut value = weight.unwrap_or(1.0);
    let before = value;
    let field = DragValue::new(&mut value)
        .speed(0.01)
        .range(1e-6..=1e6)
        .max_decimals(12)
        .custom_formatter(|x, _| short(x));
    let field = if weight.is_none() { field.prefix("≈ ") } else { field };
    let response = ui.add(field).on_hover_text("Weight of the selected control points; positive");
    let ids: Vec<PointId> = points.iter().map(|p| id(*p)).collect();
    let face_id = face.id;
    follow(&response, value != before, params, move || Operation::SetWeight {
        face: face_id,
        points: ids,
        weight: value,
    });
}

/// Selected control points of the surface: place of one, weight of all.
fn surface_points(ui: &mut Ui, face: &FaceInHand, net: &[usize], params: &mut UvParams) {
    let palette = *params.palette;
    let (_, count_v) = face.surface.counts();
    let id = |p: usize| NetId { i: p / count_v, j: p % count_v };
    let what = match net {
        [one] => format!("Surface point {}, {}", id(*one).i + 1, id(*one).j + 1),
        many => format!("{} surface points", many.len()),
    };
    ui.label(RichText::new(what).color(palette.accent));
    let face_id = face.id;
    if let [one] = net {
        let at = face.surface.points()[*one];
        let speed = 1e-3 * face.surface.bounds().diagonal();
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            ui.label(RichText::new(name).color(palette.weak));
            let mut to = at;
            let field = DragValue::new(&mut to[axis]).speed(speed).max_decimals(15);
            let response = ui.add(field.custom_formatter(|x, _| short(x)));
            let point = id(*one);
            follow(&response, to != at, params, move || Operation::SetSurfacePoint {
                face: face_id,
                point,
                to,
            });
        }
    }
    ui.label(RichText::new("weight").color(palette.weak));
    let before = face.surface.weights()[net[0]];
    let mut weight = before;
    let field = DragValue::new(&mut weight).speed(0.01).range(1e-6..=1e6).max_decimals(12);
    let response = ui.add(field.custom_formatter(|x, _| short(x)));
    let points = net.iter().map(|p| id(*p)).collect();
    follow(&response, weight != before, params, move || Operation::SetSurfaceWeight {
        face: face_id,
        points,
        weight,
    });
}

/// A field that is dragged sends previews and ends as one step; a typed value is one step at once.
fn follow(
    response: &egui::Response,
    changed: bool,
    params: &mut UvParams,
    operation: impl FnOnce() -> Operation,
) {
    if response.drag_started()
        && params.panel.field == FieldDrag::None
        && params.panel.gesture == Gesture::None
    {
        params.panel.field = FieldDrag::On;
        params.edit(EditRequest::Begin);
    }
    let dragging = params.panel.field == FieldDrag::On && (response.dragged() || response.drag_stopped());
    if changed && dragging {
        params.edit(EditRequest::Preview(operation()));
    } else if changed {
        params.edit(EditRequest::Perform(operation()));
    }
    if response.drag_stopped() && params.panel.field == FieldDrag::On {
        params.panel.field = FieldDrag::None;
        params.edit(EditRequest::Commit);
    }
}

fn id((trim_loop, curve, point): PointAddress) -> PointId {
    PointId { trim_loop, curve, point }
}

/// The one place of all points, if it is one.
fn joined_place(face: &FaceInHand, points: &[PointAddress]) -> Option<DVec2> {
    let first = face.point(*points.first()?)?;
    points.iter().all(|p| face.point(*p) == Some(first)).then_some(first)
}

/// The one weight of all points, if it is one.
fn common_weight(face: &FaceInHand, points: &[PointAddress]) -> Option<f64> {
    let of = |p: &PointAddress| face.curve(p.0, p.1)?.weights().get(p.2).copied();
    let first = of(points.first()?)?;
    points.iter().all(|p| of(p) == Some(first)).then_some(first)
}

/// A number with the digits that matter here.
fn short(x: f64) -> String {
    if x != 0.0 && !(1e-5..1e9).contains(&x.abs()) {
        return format!("{x:e}");
    }
    let text = format!("{x:.DIGITS$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}
