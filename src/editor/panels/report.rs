//! The import report: remarks by severity; a click selects the face a remark is about.

use bevy::prelude::Entity;
use bevy::window::RequestRedraw;
use bevy_egui::egui::{
    self, Align2, CornerRadius, FontId, Frame, Label, Margin, RichText, Sense, Ui, pos2, vec2,
};

use super::format::count;
use super::icon::{self, Icon};
use super::{Owned, Reads, Writes};
use crate::editor::selection::{SelectMode, SelectRequest};
use crate::editor::theme::{Palette, size};
use crate::editor::tools::{Action, CommandRequest};
use crate::exchange::report::{Remark, Severity};

/// Which severities are hidden.
#[derive(Default)]
pub struct ReportState {
    hidden: Vec<Severity>,
}

const SEVERITIES: [Severity; 3] = [Severity::Error, Severity::Warning, Severity::Note];

/// Icon and colour of a severity.
pub(super) fn mark(severity: Severity, palette: &Palette) -> (Icon, egui::Color32) {
    match severity {
        Severity::Error => (Icon::Error, palette.error),
        Severity::Warning => (Icon::Warning, palette.warning),
        Severity::Note => (Icon::Note, palette.note),
    }
}

/// Shows the panel.
pub(super) fn show(root: &mut Ui, reads: &Reads, writes: &mut Writes, owned: &mut Owned) {
    let frame = Frame::new().inner_margin(Margin { left: 12, right: 8, top: 8, bottom: 4 });
    let panel = egui::Panel::bottom("report").frame(frame).default_size(190.0).min_size(90.0).max_size(500.0);
    panel.resizable(true).show(root, |ui| {
        let remarks: Vec<(Entity, &Remark)> = reads
            .scene
            .models
            .iter()
            .filter_map(|m| reads.models.get(m.entity).ok().map(|model| (m.entity, model)))
            .flat_map(|(entity, model)| model.report.remarks.iter().map(move |r| (entity, r)))
            .collect();
        head(ui, &remarks, reads, writes, &mut owned.state.report);
        let mut visible: Vec<(Entity, &Remark)> =
            remarks.into_iter().filter(|(_, r)| !owned.state.report.hidden.contains(&r.severity)).collect();
        visible.sort_by_key(|(_, r)| std::cmp::Reverse(r.severity));
        ui.spacing_mut().item_spacing.y = 0.0;
        if visible.is_empty() {
            ui.add_space(10.0);
            let text = if reads.scene.is_empty() { "Nothing open" } else { "Nothing to report" };
            ui.label(RichText::new(text).color(reads.palette.weak));
        }
        egui::ScrollArea::vertical().auto_shrink(false).show_rows(
            ui,
            size::ROW,
            visible.len(),
            |ui, range| {
                for (model, remark) in &visible[range] {
                    row(ui, *model, remark, reads, writes);
                }
            },
        );
    });
}

fn head(
    ui: &mut Ui,
    remarks: &[(Entity, &Remark)],
    reads: &Reads,
    writes: &mut Writes,
    state: &mut ReportState,
) {
    ui.horizontal(|ui| {
        ui.heading("Import report");
        ui.add_space(10.0);
        for severity in SEVERITIES {
            let number = remarks.iter().filter(|(_, r)| r.severity == severity).count();
            let on = !state.hidden.contains(&severity);
            let (icon, color) = mark(severity, &reads.palette);
            let (rect, response) = ui.allocate_exact_size(vec2(58.0, 22.0), Sense::click());
            let fill = if on { reads.palette.hovered } else { egui::Color32::TRANSPARENT };
            ui.painter().rect_filled(rect, CornerRadius::same(4), fill);
            let left = egui::Rect::from_min_size(rect.min, vec2(24.0, rect.height()));
            let fade = if on { 1.0 } else { 0.4 };
            icon::paint(ui.painter(), left, icon, color.gamma_multiply(fade));
            let font = FontId::proportional(size::SMALL);
            let text = reads.palette.text.gamma_multiply(fade);
            ui.painter().text(
                pos2(rect.min.x + 26.0, rect.center().y),
                Align2::LEFT_CENTER,
                count(number),
                font,
                text,
            );
            let name = ["notes", "warnings", "errors"][severity as usize];
            if response.on_hover_text(format!("Show or hide {name}")).clicked() {
                match state.hidden.iter().position(|s| *s == severity) {
                    Some(i) => drop(state.hidden.remove(i)),
                    None => state.hidden.push(severity),
                }
            }
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let (rect, response) = ui.allocate_exact_size(vec2(24.0, 22.0), Sense::click());
            icon::paint(ui.painter(), rect, Icon::Cross, reads.palette.weak);
            if response.on_hover_text("Close").clicked() {
                writes.commands.write(CommandRequest(Action::ToggleReport));
                writes.redraw.write(RequestRedraw);
            }
        });
    });
}

fn row(ui: &mut Ui, model: Entity, remark: &Remark, reads: &Reads, writes: &mut Writes) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), size::ROW), Sense::click());
    if response.hovered() {
        ui.painter().rect_filled(rect, CornerRadius::same(4), reads.palette.hovered);
    }
    let (icon, color) = mark(remark.severity, &reads.palette);
    icon::paint(ui.painter(), egui::Rect::from_min_size(rect.min, vec2(24.0, rect.height())), icon, color);
    let place = match (remark.entity.is_empty(), remark.id) {
        (true, _) => "file".to_owned(),
        (false, 0) => remark.entity.clone(),
        (false, id) => format!("{} D{id}", remark.entity),
    };
    let painter = ui.painter();
    let font = FontId::proportional(size::BODY);
    let y = rect.center().y;
    painter.text(pos2(rect.min.x + 28.0, y), Align2::LEFT_CENTER, place, font.clone(), reads.palette.weak);
    let clip = ui.painter_at(rect);
    clip.text(pos2(rect.min.x + 130.0, y), Align2::LEFT_CENTER, &remark.message, font, reads.palette.text);
    let line = if remark.line > 0 { format!(" (line {})", remark.line) } else { String::new() };
    let clicked = response.clicked();
    response.on_hover_ui(|ui| {
        ui.add(Label::new(format!("{}{line}", remark.message)).wrap());
    });
    if clicked {
        let faces = faces_about(model, remark, reads);
        if !faces.is_empty() {
            writes.select.write(SelectRequest { faces, mode: SelectMode::Replace });
            writes.redraw.write(RequestRedraw);
        }
    }
}

/// Faces made from the entity the remark is about.
fn faces_about(model: Entity, remark: &Remark, reads: &Reads) -> Vec<Entity> {
    if remark.id == 0 {
        return Vec::new();
    }
    let about = |face: &Entity| {
        reads.faces.get(*face).is_ok_and(|face| {
            let source = face.authored.attributes.source.as_ref();
            face.place.model == model && source.is_some_and(|s| s.id == remark.id)
        })
    };
    reads.scene.faces().filter(about).collect()
}
