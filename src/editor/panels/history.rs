//! The history panel: all steps, the present state, the saved one; a click goes there.

use bevy::window::RequestRedraw;
use bevy_egui::egui::{
    self, Align2, CornerRadius, FontId, Frame, Margin, Rect, RichText, Sense, Ui, pos2, vec2,
};

use super::format::{bytes, plural};
use super::{Reads, Writes};
use crate::editor::editing::EditRequest;
use crate::editor::theme::size;

/// Shows the steps as a part of the right panel.
pub(super) fn show(root: &mut Ui, reads: &Reads, writes: &mut Writes) {
    let frame = Frame::new().inner_margin(Margin::symmetric(10, 8));
    egui::Panel::right("history").frame(frame).default_size(220.0).min_size(160.0).max_size(420.0).show(
        root,
        |ui| {
            ui.heading("History");
            let history = reads.editing.history();
            let mut text = plural(history.undo_count(), "step");
            if history.bytes() > 0 {
                text += &format!(", {}", bytes(history.bytes() as u64));
            }
            ui.label(RichText::new(text).color(reads.palette.weak));
            if history.dropped() > 0 {
                let text = format!("{} forgotten to save memory", plural(history.dropped(), "older step"));
                ui.label(RichText::new(text).color(reads.palette.weak));
            }
            ui.add_space(4.0);
            ui.spacing_mut().item_spacing.y = 0.0;
            let count = history.entries().len() + 1;
            let area = egui::ScrollArea::vertical().auto_shrink(false).stick_to_bottom(true);
            area.show_rows(ui, size::ROW, count, |ui, range| {
                for index in range {
                    row(ui, index, reads, writes);
                }
            });
        },
    );
}

/// Row 0 is the state in the beginning, row `k` the one after step `k`.
fn row(ui: &mut Ui, index: usize, reads: &Reads, writes: &mut Writes) {
    let history = reads.editing.history();
    let p = &reads.palette;
    let entry = index.checked_sub(1).and_then(|k| history.entries().nth(k));
    let saved = match entry {
        Some(entry) => entry.saved,
        None => history.start_is_saved(),
    };
    let label = match entry {
        Some(entry) => entry.label,
        None if history.dropped() > 0 => "Oldest step kept",
        None => "Beginning",
    };
    let now = index == history.undo_count();
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), size::ROW), Sense::click());
    if now {
        ui.painter().rect_filled(rect, CornerRadius::same(4), p.selected);
        let mark = Rect::from_min_size(rect.min + vec2(0.0, 4.0), vec2(2.5, rect.height() - 8.0));
        ui.painter().rect_filled(mark, CornerRadius::same(1), p.accent);
    } else if response.hovered() {
        ui.painter().rect_filled(rect, CornerRadius::same(4), p.hovered);
    }
    let done = index <= history.undo_count();
    let color = if now {
        p.strong
    } else if done {
        p.text
    } else {
        p.weak.gamma_multiply(0.7)
    };
    let text = ui.painter().with_clip_rect(Rect::from_min_max(rect.min, pos2(rect.max.x - 46.0, rect.max.y)));
    let font = FontId::proportional(size::BODY);
    text.text(rect.left_center() + vec2(10.0, 0.0), Align2::LEFT_CENTER, label, font, color);
    if saved {
        let font = FontId::proportional(size::SMALL);
        ui.painter().text(
            rect.right_center() - vec2(6.0, 0.0),
            Align2::RIGHT_CENTER,
            "saved",
            font,
            p.accent,
        );
    }
    if response.on_hover_text(label).clicked() && !now {
        writes.edits.write(EditRequest::GoTo(index));
        writes.redraw.write(RequestRedraw);
    }
}
