//! The prompt for the values that a command needs. Enter does it, Esc leaves it.

use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Color32, Grid, Id, Key, Modal, RichText};

use super::Writes;
use crate::editor::editing::{Prompt, RunEdit};
use crate::editor::theme::{Palette, size};
use crate::editor::tools::Action;

/// Shows the prompt while there is one.
pub(super) fn show(ctx: &egui::Context, p: &Palette, prompt: &mut Prompt, writes: &mut Writes) {
    let Some(action) = prompt.action() else { return };
    let title = Action::Edit(action).command().map_or("Values", |c| c.label.trim_end_matches('…'));
    let enter = ctx.input_mut(|i| i.consume_key(egui::Modifiers::NONE, Key::Enter));
    let backdrop = Color32::from_black_alpha(if p.light { 30 } else { 70 });
    let modal = Modal::new(Id::new("prompt")).backdrop_color(backdrop).frame(super::sheet_frame(p));
    let (mut run, mut close) = (enter, false);
    let response = modal.show(ctx, |ui| {
        ui.set_width(330.0);
        ui.label(RichText::new(title).size(size::TITLE).color(p.strong));
        ui.add_space(8.0);
        let refusal = prompt.refusal().map(str::to_owned);
        let fresh = std::mem::take(&mut prompt.fresh);
        let wide = action.fields().len() == 1;
        let mut field = |ui: &mut egui::Ui, index: usize, name: &str, width: f32| {
            let Some(value) = prompt.values.get_mut(index) else { return };
            ui.label(RichText::new(name).color(p.weak));
            let edit =
                egui::TextEdit::singleline(value).margin(egui::Margin::symmetric(8, 5)).desired_width(width);
            let response = ui.add(edit);
            let first = fresh && index == 0;
            if first {
                response.request_focus();
            }
            // Entered by key: what is typed replaces what is there.
            if first || (response.gained_focus() && !response.is_pointer_button_down_on()) {
                let all = egui::text::CCursorRange::two(
                    egui::text::CCursor::new(0),
                    egui::text::CCursor::new(value.chars().count()),
                );
                let mut state = egui::TextEdit::load_state(ui.ctx(), response.id).unwrap_or_default();
                state.cursor.set_char_range(Some(all));
                state.store(ui.ctx(), response.id);
            }
        };
        if wide {
            field(ui, 0, action.fields()[0], f32::INFINITY);
        } else {
            Grid::new("prompt fields").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
                for (index, name) in action.fields().iter().enumerate() {
                    field(ui, index, name, 170.0);
                    ui.end_row();
                }
            });
        }
        if let Some(reason) = refusal {
            ui.add_space(6.0);
            ui.label(RichText::new(reason).color(p.error));
        }
        ui.add_space(12.0);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            run |= ui.button("  OK  ").clicked();
            close = ui.button("Cancel").clicked();
        });
    });
    if run {
        writes.run.write(RunEdit { action, values: prompt.values.clone() });
        writes.redraw.write(RequestRedraw);
    } else if close || response.should_close() {
        prompt.close();
        writes.redraw.write(RequestRedraw);
    }
}
