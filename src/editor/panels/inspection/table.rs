//! The table of edges: a click on a head sorts, a click on a row flies to the largest gap of its edge.

use bevy::window::RequestRedraw;
use bevy_egui::egui::{
    self, Align2, Color32, CornerRadius, FontFamily, FontId, Rect, RichText, Sense, Ui, pos2, vec2,
};

use super::InspectionState;
use super::measure::sense;
use crate::editor::inspection::{CloseGap, Column, InspectRequest, Row, can_close, ramp};
use crate::editor::panels::format::plural;
use crate::editor::panels::{Reads, Writes};
use crate::editor::theme::size;
use crate::inspect::{EdgeKey, EdgeKind, Length};

/// Columns with their heads and shares of the width.
const COLUMNS: [(Column, &str, f32, &str); 7] = [
    (Column::Kind, "Edge", 0.17, "Shared by two faces, naked (one), non-manifold (three or more), or a seam"),
    (Column::Faces, "Faces", 0.17, "Numbers of the faces that border on it"),
    (Column::Gap, "Gap", 0.14, "Largest distance between the two exact curves"),
    (Column::Mean, "Mean", 0.14, "Mean distance along the edge"),
    (Column::Sense, "Sense", 0.13, "How the sides lie to each other where the gap is largest"),
    (Column::Length, "Length", 0.14, "Length of the edge"),
    (Column::Angle, "Angle", 0.11, "Largest angle between the tangent planes of the two sides"),
];

/// What was asked for an edge.
enum Asked {
    Choose,
    Fly,
    Close,
}

fn seen_id(ui: &Ui) -> egui::Id {
    ui.id().with("seen")
}

/// How far to scroll so that the chosen edge is seen, after another was chosen or rows changed places.
fn offset_of_chosen(ui: &Ui, state: &InspectionState) -> Option<f32> {
    let key = state.chosen.edge?;
    let now = (key, state.rows.revision);
    let id = ui.id().with("chosen");
    if ui.data_mut(|d| d.get_temp::<(EdgeKey, u64)>(id) == Some(now)) {
        return None;
    }
    ui.data_mut(|d| d.insert_temp(id, now));
    let at = state.rows.rows.iter().position(|r| r.key == key)?;
    let (offset, height) = ui.data_mut(|d| d.get_temp::<(f32, f32)>(seen_id(ui)))?;
    let top = at as f32 * size::ROW;
    let is_seen = top >= offset && top + size::ROW <= offset + height;
    (!is_seen).then_some((top - 0.5 * (height - size::ROW)).max(0.0))
}

/// Shows the table.
pub(super) fn show(ui: &mut Ui, reads: &Reads, writes: &mut Writes, state: &mut InspectionState) {
    let width = ui.available_width() - 10.0;
    head(ui, width, reads, writes, state);
    ui.spacing_mut().item_spacing.y = 0.0;
    if state.rows.rows.is_empty() {
        ui.add_space(10.0);
        ui.label(RichText::new("No edge passes the filter").color(reads.palette.weak));
        return;
    }
    let mut asked = None;
    let mut area = egui::ScrollArea::vertical().auto_shrink(false);
    if let Some(offset) = offset_of_chosen(ui, state) {
        area = area.vertical_scroll_offset(offset);
    }
    let count = state.rows.rows.len();
    let shown = area.show_rows(ui, size::ROW, count, |ui, range| {
        for row in &state.rows.rows[range] {
            let chosen = state.chosen.edge == Some(row.key);
            let response = line(ui, width, row, chosen, state.choices.tolerance, reads);
            if response.clicked() {
                asked = Some((row.key, Asked::Fly));
            } else if response.secondary_clicked() {
                asked = Some((row.key, Asked::Choose));
            }
            let can_close = state.findings.edge(&row.key).is_some_and(can_close);
            response.context_menu(|ui| {
                if ui.button("Go there").clicked() {
                    asked = Some((row.key, Asked::Fly));
                }
                let limit = Length { mm: state.mend.tolerance };
                let button = ui.add_enabled(can_close, egui::Button::new(format!("Close gap to {limit}")));
                if button.clicked() {
                    asked = Some((row.key, Asked::Close));
                }
            });
        }
    });
    ui.data_mut(|d| d.insert_temp(seen_id(ui), (shown.state.offset.y, shown.inner_rect.height())));
    if let Some((edge, what)) = asked {
        match what {
            Asked::Choose => drop(state.requests.write(InspectRequest::Choose { edge, fly: false })),
            Asked::Fly => drop(state.requests.write(InspectRequest::Choose { edge, fly: true })),
            Asked::Close => drop(state.close.write(CloseGap(edge))),
        }
        writes.redraw.write(RequestRedraw);
    }
}

fn head(ui: &mut Ui, width: f32, reads: &Reads, writes: &mut Writes, state: &mut InspectionState) {
    let (rect, _) = ui.allocate_exact_size(vec2(width, 20.0), Sense::hover());
    let order = state.choices.order;
    for (cell, (column, title, _, hint)) in cells(rect).zip(COLUMNS) {
        let response = ui.interact(cell, ui.id().with(title), Sense::click());
        let sorted = order.column == column;
        let colour = if sorted || response.hovered() { reads.palette.strong } else { reads.palette.weak };
        let font = FontId::proportional(size::SMALL);
        let text = ui.painter().text(cell.left_center(), Align2::LEFT_CENTER, title, font, colour);
        if sorted {
            let end = cell.left_center() + vec2(text.width() + 9.0, 0.0);
            arrow(ui, end, order.descending, colour);
        }
        if response.on_hover_text(hint).clicked() {
            state.choices.order = order.clicked(column);
            writes.redraw.write(RequestRedraw);
        }
    }
    ui.painter().hline(rect.x_range(), rect.max.y, egui::Stroke::new(1.0, reads.palette.line));
}

/// A small triangle that points down when the largest come first.
fn arrow(ui: &Ui, at: egui::Pos2, down: bool, colour: Color32) {
    let tip = if down { 3.0 } else { -3.0 };
    let corners = vec![at + vec2(-3.5, -tip), at + vec2(3.5, -tip), at + vec2(0.0, tip)];
    ui.painter().add(egui::Shape::convex_polygon(corners, colour, egui::Stroke::NONE));
}

/// The cells of a row, side by side.
fn cells(rect: Rect) -> impl Iterator<Item = Rect> {
    COLUMNS.into_iter().scan(rect.min.x, move |left, (_, _, share, _)| {
        let cell =
            Rect::from_min_max(pos2(*left, rect.min.y), pos2(*left + share * rect.width() - 6.0, rect.max.y));
        *left += share * rect.width();
        Some(cell)
    })
}

fn line(ui: &mut Ui, width: f32, row: &Row, chosen: bool, tolerance: f64, reads: &Reads) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(vec2(width, size::ROW), Sense::click());
    let palette = &reads.palette;
    if chosen || response.hovered() {
        let fill = if chosen { palette.selected } else { palette.hovered };
        ui.painter().rect_filled(rect.expand2(vec2(4.0, 0.0)), CornerRadius::same(4), fill);
    }
    let [r, g, b] = match row.kind {
        EdgeKind::Naked => ramp::NAKED,
        EdgeKind::NonManifold => ramp::NON_MANIFOLD,
        _ => row.gap.map_or(ramp::CLOSED, ramp::colour),
    };
    let mm = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), |mm| Length { mm }.to_string());
    let kind = match row.kind {
        EdgeKind::Shared => "shared",
        EdgeKind::Naked => "naked",
        EdgeKind::NonManifold => "non-manifold",
        EdgeKind::Seam => "seam",
        EdgeKind::Degenerate => "point",
    };
    let faces = match row.faces.as_slice() {
        [] => "–".to_owned(),
        few if few.len() <= 3 => few.iter().map(usize::to_string).collect::<Vec<_>>().join(", "),
        many => plural(many.len(), "face"),
    };
    let texts = [
        kind.to_owned(),
        faces,
        mm(row.gap),
        mm(row.mean),
        row.sense.map_or("–", sense).to_owned(),
        mm(Some(row.length)),
        row.angle.map_or_else(|| "–".to_owned(), |angle| format!("{:.2}°", angle.to_degrees())),
    ];
    let font = FontId::new(size::BODY, FontFamily::Proportional);
    for (k, (cell, text)) in cells(rect).zip(texts).enumerate() {
        let painter = ui.painter_at(cell);
        let mut at = cell.left_center();
        if k == 0 {
            painter.circle_filled(at + vec2(5.0, 0.0), 4.0, Color32::from_rgb(r, g, b));
            at.x += 15.0;
        }
        let colour = match k {
            2 if row.is_defect(tolerance) => palette.warning,
            2 => palette.strong,
            _ => palette.text,
        };
        painter.text(at, Align2::LEFT_CENTER, text, font.clone(), colour);
    }
    response
}
