//! The list of problems: what is wrong with which loop; a click selects the face and flies there.

use bevy::prelude::Entity;
use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Align2, CornerRadius, FontId, Frame, Margin, RichText, Sense, Ui, pos2, vec2};
use glam::DVec2;

use super::format::plural;
use super::icon::{self, Icon};
use super::report::mark;
use super::{Owned, Reads, Writes};
use crate::editor::camera::CameraRequest;
use crate::editor::elements::{Element, ElementRequest};
use crate::editor::selection::{SelectMode, SelectRequest};
use crate::editor::theme::size;
use crate::editor::tools::{Action, CommandRequest};
use crate::exchange::report::Severity;
use crate::kernel::trim::validity::{self, At};
use crate::kernel::view::Bounds;

/// Part of a face's box that is shown around a problem.
const AROUND: f64 = 0.12;

/// The lines, made again when problems change.
#[derive(Debug, Default)]
pub struct ProblemsState {
    made_from: Option<(u64, u64)>,
    lines: Vec<Line>,
}

#[derive(Debug, Clone)]
struct Line {
    face: Entity,
    name: String,
    severity: Severity,
    text: String,
    place: Option<(At, DVec2)>,
}

fn severity(severity: validity::Severity) -> Severity {
    match severity {
        validity::Severity::Note => Severity::Note,
        validity::Severity::Warning => Severity::Warning,
        validity::Severity::Error => Severity::Error,
    }
}

fn update(state: &mut ProblemsState, reads: &Reads) {
    let key = (reads.problems.revision, reads.scene.revision);
    if state.made_from == Some(key) {
        return;
    }
    state.made_from = Some(key);
    let mut lines = Vec::new();
    for (entity, found) in reads.problems.faces() {
        let Ok(face) = reads.faces.get(entity) else { continue };
        let model = reads.scene.position(face.place.model).unwrap_or_default();
        let name = format!("Face {}", face.place.number);
        let key = (model, face.place.number);
        if let Some(text) = &found.failure {
            let (name, text) = (name.clone(), format!("not drawn: {text}"));
            lines.push((key, Line { face: entity, name, severity: Severity::Error, text, place: None }));
        }
        for problem in found.loops.iter() {
            let (name, text) = (name.clone(), problem.to_string());
            let severity = severity(problem.severity());
            let place = Some((problem.at, problem.uv));
            lines.push((key, Line { face: entity, name, severity, text, place }));
        }
    }
    // Worst first, then in file order; stable within a face.
    lines.sort_by_key(|(key, line)| (std::cmp::Reverse(line.severity), *key));
    state.lines = lines.into_iter().map(|(_, line)| line).collect();
}

/// Shows the panel.
pub(super) fn show(root: &mut Ui, reads: &Reads, writes: &mut Writes, owned: &mut Owned) {
    let state = &mut owned.state.problems;
    update(state, reads);
    let frame = Frame::new().inner_margin(Margin { left: 12, right: 8, top: 8, bottom: 4 });
    let panel =
        egui::Panel::bottom("problems").frame(frame).default_size(150.0).min_size(80.0).max_size(500.0);
    panel.resizable(true).show(root, |ui| {
        ui.horizontal(|ui| {
            ui.heading("Problems");
            ui.add_space(8.0);
            let serious = state.lines.iter().filter(|l| l.severity > Severity::Note).count();
            let notes = state.lines.len() - serious;
            let text = match notes {
                0 => plural(serious, "problem"),
                _ => format!("{}, {}", plural(serious, "problem"), plural(notes, "note")),
            };
            ui.label(RichText::new(text).color(reads.palette.weak));
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let (rect, response) = ui.allocate_exact_size(vec2(24.0, 22.0), Sense::click());
                icon::paint(ui.painter(), rect, Icon::Cross, reads.palette.weak);
                if response.on_hover_text("Close").clicked() {
                    writes.commands.write(CommandRequest(Action::ToggleProblems));
                    writes.redraw.write(RequestRedraw);
                }
            });
        });
        ui.spacing_mut().item_spacing.y = 0.0;
        if state.lines.is_empty() {
            ui.add_space(8.0);
            let text = if reads.scene.is_empty() { "Nothing open" } else { "All loops are closed and apart" };
            ui.label(RichText::new(text).color(reads.palette.weak));
        }
        let area = egui::ScrollArea::vertical().auto_shrink(false);
        area.show_rows(ui, size::ROW, state.lines.len(), |ui, range| {
            for line in &state.lines[range] {
                row(ui, line, reads, writes);
            }
        });
    });
}

fn row(ui: &mut Ui, line: &Line, reads: &Reads, writes: &mut Writes) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), size::ROW), Sense::click());
    if response.hovered() {
        ui.painter().rect_filled(rect, CornerRadius::same(4), reads.palette.hovered);
    }
    let (icon, color) = mark(line.severity, &reads.palette);
    icon::paint(ui.painter(), egui::Rect::from_min_size(rect.min, vec2(24.0, rect.height())), icon, color);
    let font = FontId::proportional(size::BODY);
    let (painter, y) = (ui.painter_at(rect), rect.center().y);
    let place = pos2(rect.min.x + 28.0, y);
    painter.text(place, Align2::LEFT_CENTER, &line.name, font.clone(), reads.palette.weak);
    let place = pos2(rect.min.x + 110.0, y);
    painter.text(place, Align2::LEFT_CENTER, &line.text, font, reads.palette.text);
    if response.on_hover_text(&line.text).clicked() {
        go(line, reads, writes);
    }
}

/// Selects the face, and the curve once the face is the one in hand; flies to the place.
fn go(line: &Line, reads: &Reads, writes: &mut Writes) {
    writes.select.write(SelectRequest { faces: vec![line.face], mode: SelectMode::Replace });
    if let Ok(face) = reads.faces.get(line.face) {
        let bounds = face.derived.map_or(Bounds::EMPTY, |d| d.0.best_bounds());
        let around = line.place.map(|(_, uv)| {
            let (point, reach) = (face.authored.surface.point(uv.x, uv.y), AROUND * bounds.diagonal());
            Bounds { min: point - 0.5 * reach, max: point + 0.5 * reach }
        });
        writes.camera.write(CameraRequest::FitBounds(around.unwrap_or(bounds)));
    }
    if let Some((At { trim_loop, curve }, _)) = line.place {
        let elements = vec![Element::Curve { trim_loop, curve }];
        writes.elements.write(ElementRequest { elements, mode: SelectMode::Replace });
    }
    writes.redraw.write(RequestRedraw);
}
