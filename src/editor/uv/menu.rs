//! The context menu: what can be done with what is under the pointer, most particular things first.

use bevy_egui::egui::{self, Button, RichText, Ui, vec2};
use glam::DVec2;

use super::hit::UvHit;
use super::panel::Fit;
use super::show::{UvParams, describe};
use crate::editor::editing::EditRequest;
use crate::editor::elements::{Element, FaceInHand};
use crate::editor::selection::SelectMode;
use crate::editor::tools::{Action, EditAction};
use crate::kernel::trim::UvRect;
use crate::scene::operation::{CurveId, Operation, Transform};
use crate::scene::records::{LoopRecord, LoopRole};

/// Width of the menu, logical pixels.
const WIDTH_PX: f32 = 224.0;

/// Opens it where it was asked for, and shows it.
pub(super) fn show(ui: &mut Ui, canvas: &egui::Response, face: &FaceInHand, params: &mut UvParams) {
    let id = canvas.id.with("menu");
    if let Some(at) = params.panel.menu_at.take() {
        params.panel.menu_place = egui::pos2(at.x as f32, at.y as f32);
        params.panel.menu_hit = params.panel.hit;
        egui::Popup::open_id(ui.ctx(), id);
    }
    let place = params.panel.menu_place;
    let popup = egui::Popup::new(id, ui.ctx().clone(), place, ui.layer_id());
    let popup = popup.kind(egui::PopupKind::Menu).style(egui::containers::menu::menu_style);
    popup.open_memory(None).show(|ui| {
        ui.set_width(WIDTH_PX);
        ui.spacing_mut().item_spacing.y = 0.0;
        items(ui, face, params);
    });
}

fn items(ui: &mut Ui, face: &FaceInHand, params: &mut UvParams) {
    let hit = params.panel.menu_hit.filter(|h| h.element.exists_in(face));
    let place = DVec2::new(params.panel.menu_place.x.into(), params.panel.menu_place.y.into());
    let at = params.panel.view.to_uv(place);
    if let Some(hit) = hit {
        head(ui, &describe(hit.element, params), params);
        if let Some((trim_loop, curve)) = hit.element.curve() {
            of_curve(ui, face, CurveId { trim_loop, curve }, hit, params);
        }
    }
    let loops = params.selection.loops();
    if !loops.is_empty() {
        let title = match loops.as_slice() {
            [one] => format!("Loop {}", one + 1),
            many => format!("{} loops", many.len()),
        };
        head(ui, &title, params);
        of_loops(ui, face, &loops, params);
    }
    head(ui, &format!("Face {}", face.number), params);
    if !params.clipboard.0.is_empty() && item(ui, "Paste here", "", true) {
        let by = shift_to(&params.clipboard.0, at);
        let loops = params.clipboard.0.clone();
        params.edit(EditRequest::Perform(Operation::PasteLoops { face: face.id, loops, by }));
    }
    if item(ui, "Select all loops", "Ctrl+A", !face.loops.is_empty()) {
        let all = (0..face.loops.len()).map(|trim_loop| Element::Loop { trim_loop }).collect();
        params.select(all, SelectMode::Replace);
    }
    if item(ui, "Untrim", &key(EditAction::Untrim), !face.loops.is_empty()) {
        params.edit(EditRequest::Perform(Operation::Untrim { face: face.id }));
    }
    if item(ui, "Fit", "F", true) {
        params.panel.wanted_fit = Fit::All;
    }
    if item(ui, "Undo", "Ctrl+Z", true) {
        params.edit(EditRequest::Undo);
    }
}

/// The vector that brings the middle of loops to `place`.
fn shift_to(loops: &[LoopRecord], place: DVec2) -> DVec2 {
    let mut hull = UvRect::EMPTY;
    loops.iter().flat_map(|l| &l.curves).flat_map(|c| c.points()).for_each(|p| hull.include(*p));
    let by = place - 0.5 * (hull.min + hull.max);
    if by.is_finite() { by } else { DVec2::ZERO }
}

fn of_curve(ui: &mut Ui, face: &FaceInHand, id: CurveId, hit: UvHit, params: &mut UvParams) {
    let Some(curve) = face.curve(id.trim_loop, id.curve) else { return };
    let face_id = face.id;
    if let Some(at) = hit.parameter {
        if item(ui, "Insert knot here", "K, click", true) {
            params.edit(EditRequest::Perform(Operation::InsertKnot {
                face: face_id,
                curve: id,
                at,
                times: 1,
            }));
        }
        if item(ui, "Split here", "S, click", true) {
            params.edit(EditRequest::Perform(Operation::SplitCurve { face: face_id, curve: id, at }));
        }
    }
    let inner: Vec<f64> = curve.knots().breaks();
    if let [_, knots @ .., _] = inner.as_slice()
        && !knots.is_empty()
        && item(ui, "Remove nearest knot", "", true)
    {
        let (start, end) = curve.domain();
        let at = hit.parameter.unwrap_or(0.5 * (start + end));
        let nearest = knots.iter().copied().min_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs()));
        if let Some(at) = nearest {
            let tolerance = None;
            params.edit(EditRequest::Perform(Operation::RemoveKnot {
                face: face_id,
                curve: id,
                at,
                tolerance,
            }));
        }
    }
    if item(ui, "Elevate degree", &key(EditAction::Elevate), true) {
        params.edit(EditRequest::Perform(Operation::ElevateDegree { face: face_id, curve: id, by: 1 }));
    }
    let several = face.loops.get(id.trim_loop).is_some_and(|l| l.curves.len() > 1);
    if item(ui, "Join with next curve", &key(EditAction::Join), several) {
        params.edit(EditRequest::Perform(Operation::JoinCurves {
            face: face_id,
            curve: id,
            tolerance: None,
        }));
    }
    if item(ui, "Delete curve", "", true) {
        params.edit(EditRequest::Perform(Operation::DeleteCurves { face: face_id, curves: vec![id] }));
    }
    if item(ui, "Select loop", "Double click", true) {
        params.select(vec![Element::Loop { trim_loop: id.trim_loop }], SelectMode::Replace);
    }
}

fn of_loops(ui: &mut Ui, face: &FaceInHand, loops: &[usize], params: &mut UvParams) {
    let (face_id, all) = (face.id, loops.to_vec());
    let copied = || loops.iter().filter_map(|l| face.loops.get(*l)).map(|l| (**l).clone()).collect();
    if item(ui, "Cut", &key(EditAction::Cut), true) {
        params.clipboard.0 = copied();
        params.edit(EditRequest::Perform(Operation::DeleteLoops { face: face_id, loops: all.clone() }));
    }
    if item(ui, "Copy", &key(EditAction::Copy), true) {
        params.clipboard.0 = copied();
    }
    if item(ui, "Duplicate", &key(EditAction::Duplicate), true) {
        // A little aside, so that the copy can be seen.
        let by = params.panel.view.delta_uv(DVec2::new(16.0, 16.0));
        params.edit(EditRequest::Perform(Operation::DuplicateLoops {
            face: face_id,
            loops: all.clone(),
            by,
        }));
    }
    for (label, action, along) in [
        ("Mirror left and right", EditAction::MirrorU, DVec2::Y),
        ("Mirror up and down", EditAction::MirrorV, DVec2::X),
    ] {
        if item(ui, label, &key(action), true) {
            let transform = Transform::Mirror { along, about: None };
            let loops = all.clone();
            let operation = Operation::TransformLoops { face: face_id, loops, transform, beyond: false };
            params.edit(EditRequest::Perform(operation));
        }
    }
    if item(ui, "Reverse", &key(EditAction::ReverseLoop), true) {
        params.edit(EditRequest::Perform(Operation::ReverseLoops { face: face_id, loops: all.clone() }));
    }
    if item(ui, "Close loop", &key(EditAction::CloseLoop), true) {
        params.edit(EditRequest::Perform(Operation::CloseLoops { face: face_id, loops: all.clone() }));
    }
    let holes = loops.iter().all(|l| face.loops.get(*l).is_some_and(|l| l.role == LoopRole::Inner));
    let (label, action, role) = match holes {
        true => ("Make island or outer loop", EditAction::MakeOuter, LoopRole::Outer),
        false => ("Make hole", EditAction::MakeHole, LoopRole::Inner),
    };
    if item(ui, label, &key(action), true) {
        params.edit(EditRequest::Perform(Operation::SetRole { face: face_id, loops: all.clone(), role }));
    }
    if item(ui, "Delete", "Del", true) {
        params.edit(EditRequest::Perform(Operation::DeleteLoops { face: face_id, loops: all }));
    }
}

fn head(ui: &mut Ui, title: &str, params: &UvParams) {
    if ui.cursor().top() > ui.min_rect().top() + 4.0 {
        ui.separator();
    }
    ui.label(RichText::new(title).small().color(params.palette.weak));
}

/// The key of the same command outside the panel.
fn key(action: EditAction) -> String {
    let keys = Action::Edit(action).command().map_or(&[][..], |c| c.keys);
    keys.first().map(ToString::to_string).unwrap_or_default()
}

/// One entry. Whether it was clicked.
fn item(ui: &mut Ui, label: &str, key: &str, enabled: bool) -> bool {
    let weak = ui.visuals().weak_text_color();
    let button =
        Button::new(label).shortcut_text(RichText::new(key).color(weak)).min_size(vec2(WIDTH_PX, 23.0));
    let clicked = ui.add_enabled(enabled, button).clicked();
    if clicked {
        ui.close();
    }
    clicked
}
