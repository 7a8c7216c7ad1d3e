//! The list of pin holes, by the edge that they belong to: a click chooses the edge and flies to its gap.

use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Align2, CornerRadius, FontId, Rect, RichText, Sense, Ui, pos2, vec2};

use super::InspectionState;
use super::holes::{CLASSES, colour, summary};
use crate::editor::inspection::{HoleGroup, InspectRequest};
use crate::editor::panels::format::plural;
use crate::editor::panels::{Reads, Writes};
use crate::editor::settings::HoleMarks;
use crate::editor::theme::size;
use crate::editor::tools::{Action, CommandRequest};
use crate::inspect::Length;

/// Heads and shares of the width.
const COLUMNS: [(&str, f32); 4] = [("Class", 0.28), ("Faces", 0.26), ("Pixels", 0.22), ("Gap here", 0.24)];

/// Shows the list.
pub(super) fn show(ui: &mut Ui, reads: &Reads, writes: &mut Writes, state: &mut InspectionState) {
    ui.horizontal(|ui| choices(ui, reads, writes));
    if !reads.settings.pin_holes {
        hint(ui, reads, "Pin holes are not looked for");
        return;
    }
    let moving = reads.settings.holes_moving;
    if state.holes.of(&reads.camera.now).is_none() && !moving {
        hint(ui, reads, "Counted as soon as the view is at rest");
        return;
    }
    let text = RichText::new(summary(&state.holes)).color(reads.palette.strong);
    ui.label(text).on_hover_text("Pixels through which one sees between two faces that share an edge");
    if state.holes.groups.is_empty() {
        return;
    }
    let width = ui.available_width() - 10.0;
    let (rect, _) = ui.allocate_exact_size(vec2(width, 20.0), Sense::hover());
    for (cell, (title, _)) in cells(rect).zip(COLUMNS) {
        let font = FontId::proportional(size::SMALL);
        ui.painter().text(cell.left_center(), Align2::LEFT_CENTER, title, font, reads.palette.weak);
    }
    ui.painter().hline(rect.x_range(), rect.max.y, egui::Stroke::new(1.0, reads.palette.line));
    ui.spacing_mut().item_spacing.y = 0.0;
    let mut clicked = None;
    let rows = state.holes.groups.len();
    egui::ScrollArea::vertical().id_salt("pin holes").auto_shrink(false).show_rows(
        ui,
        size::ROW,
        rows,
        |ui, range| {
            for group in &state.holes.groups[range] {
                if line(ui, width, group, reads, state) {
                    clicked = Some(group.edge);
                }
            }
        },
    );
    if let Some(edge) = clicked {
        state.requests.write(InspectRequest::Choose { edge, fly: true });
        writes.redraw.write(RequestRedraw);
    }
}

fn hint(ui: &mut Ui, reads: &Reads, text: &str) {
    ui.label(RichText::new(text).color(reads.palette.weak));
}

/// Whether holes are looked for, and how they are marked.
fn choices(ui: &mut Ui, reads: &Reads, writes: &mut Writes) {
    let settings = &reads.settings;
    let marks = settings.hole_marks;
    let buttons = [
        (settings.pin_holes, "Mark", Action::TogglePinHoles),
        (marks == HoleMarks::Rings, "Rings", Action::HoleMarks(HoleMarks::Rings)),
        (marks == HoleMarks::Blinking, "Blinking", Action::HoleMarks(HoleMarks::Blinking)),
        (marks == HoleMarks::Dilated, "Dilated", Action::HoleMarks(HoleMarks::Dilated)),
        (settings.holes_moving, "While moving", Action::ToggleMovingHoles),
        (settings.lens, "Magnifier", Action::ToggleLens),
    ];
    for (mut on, text, action) in buttons {
        if super::toggle(ui, &reads.palette, &mut on, text) {
            writes.commands.write(CommandRequest(action));
            writes.redraw.write(RequestRedraw);
        }
    }
}

/// The cells of a row, side by side.
fn cells(rect: Rect) -> impl Iterator<Item = Rect> {
    COLUMNS.into_iter().scan(rect.min.x, move |left, (_, share)| {
        let right = *left + share * rect.width();
        let cell = Rect::from_min_max(pos2(*left, rect.min.y), pos2(right - 6.0, rect.max.y));
        *left = right;
        Some(cell)
    })
}

fn line(ui: &mut Ui, width: f32, group: &HoleGroup, reads: &Reads, state: &InspectionState) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(width, size::ROW), Sense::click());
    let palette = &reads.palette;
    let chosen = state.chosen.edge == Some(group.edge);
    if chosen || response.hovered() {
        let fill = if chosen { palette.selected } else { palette.hovered };
        ui.painter().rect_filled(rect.expand2(vec2(4.0, 0.0)), CornerRadius::same(4), fill);
    }
    let number = |face: usize| {
        let place = state.findings.face(face).and_then(|entity| reads.faces.get(entity).ok());
        place.map_or_else(|| "–".to_owned(), |view| view.place.number.to_string())
    };
    let class = CLASSES.iter().find(|(class, ..)| *class == group.class);
    let texts = [
        class.map_or("", |(_, name, _)| name).to_owned(),
        format!("{}, {}", number(group.faces[0]), number(group.faces[1])),
        plural(group.pixels, "pixel"),
        Length { mm: group.gap * state.findings.unit() }.to_string(),
    ];
    for (k, (cell, text)) in cells(rect).zip(texts).enumerate() {
        let mut at = cell.left_center();
        if k == 0 {
            ui.painter().circle_filled(at + vec2(5.0, 0.0), 4.0, colour(group.class));
            at.x += 15.0;
        }
        let font = FontId::proportional(size::BODY);
        ui.painter_at(cell).text(at, Align2::LEFT_CENTER, text, font, palette.text);
    }
    let clicked = response.clicked();
    response.on_hover_text(class.map_or("", |(.., why)| why));
    clicked
}
