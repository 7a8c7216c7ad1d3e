//! The command palette: any command by a few letters of its name, with its key.

use bevy::window::RequestRedraw;
use bevy_egui::egui::{
    self, Align2, Color32, CornerRadius, FontId, Id, Key, Modal, RichText, Sense, Ui, vec2,
};

use super::{Reads, Writes};
use crate::editor::theme::size;
use crate::editor::tools::{Command, CommandRequest, find};

/// What the palette remembers while it is open.
#[derive(Debug, Default)]
pub struct PaletteState {
    /// Whether it is open.
    pub open: bool,
    text: String,
    chosen: usize,
    fresh: bool,
}

impl PaletteState {
    /// Opens it, or closes it.
    pub fn toggle(&mut self) {
        *self = Self { open: !self.open, fresh: true, ..Self::default() };
    }
}

/// Shows the palette while it is open.
pub(super) fn show(ctx: &egui::Context, reads: &Reads, state: &mut PaletteState, writes: &mut Writes) {
    if !state.open {
        return;
    }
    let p = &reads.palette;
    let found = find(&state.text);
    let mut run: Option<&Command> = None;
    let (up, down, enter) = ctx.input_mut(|i| {
        let none = egui::Modifiers::NONE;
        let (up, down) = (i.consume_key(none, Key::ArrowUp), i.consume_key(none, Key::ArrowDown));
        (up, down, i.consume_key(none, Key::Enter))
    });
    let last = found.len().saturating_sub(1);
    state.chosen = state.chosen.min(last);
    if up {
        state.chosen = if state.chosen == 0 { last } else { state.chosen - 1 };
    }
    if down {
        state.chosen = if state.chosen == last { 0 } else { state.chosen + 1 };
    }
    let backdrop = Color32::from_black_alpha(if p.light { 30 } else { 70 });
    let top = egui::Area::new(Id::new("palette area"))
        .kind(egui::UiKind::Modal)
        .anchor(Align2::CENTER_TOP, [0.0, 90.0])
        .order(egui::Order::Foreground)
        .interactable(true);
    let frame = super::sheet_frame(p).inner_margin(egui::Margin::same(10));
    let modal = Modal::new(Id::new("palette")).area(top).backdrop_color(backdrop).frame(frame);
    let response = modal.show(ctx, |ui| {
        ui.set_width(460.0);
        let edit = egui::TextEdit::singleline(&mut state.text)
            .hint_text("Find a command")
            .margin(egui::Margin::symmetric(8, 6))
            .desired_width(f32::INFINITY);
        let response = ui.add(edit);
        if std::mem::take(&mut state.fresh) {
            response.request_focus();
        }
        if response.changed() {
            state.chosen = 0;
        }
        ui.add_space(6.0);
        ui.spacing_mut().item_spacing.y = 0.0;
        if found.is_empty() {
            ui.label(RichText::new("No command has these letters in this order").color(p.weak));
        }
        egui::ScrollArea::vertical().max_height(size::ROW * 13.0).show(ui, |ui| {
            for (index, command) in found.iter().enumerate() {
                let chosen = index == state.chosen;
                let response = row(ui, command, chosen, reads);
                if chosen && (up || down) {
                    response.scroll_to_me(None);
                }
                if response.clicked() || (chosen && enter) {
                    run = Some(command);
                }
            }
        });
    });
    if let Some(command) = run {
        if (command.enabled)(&reads.situation.0) {
            writes.commands.write(CommandRequest(command.action));
            *state = PaletteState::default();
        }
        writes.redraw.write(RequestRedraw);
    } else if response.should_close() {
        *state = PaletteState::default();
        writes.redraw.write(RequestRedraw);
    }
}

fn row(ui: &mut Ui, command: &Command, chosen: bool, reads: &Reads) -> egui::Response {
    let p = &reads.palette;
    let enabled = (command.enabled)(&reads.situation.0);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), size::ROW), Sense::click());
    if chosen || response.hovered() {
        let fill = if chosen { p.selected } else { p.hovered };
        ui.painter().rect_filled(rect, CornerRadius::same(4), fill);
    }
    let color = match (enabled, chosen) {
        // On the colour of the chosen row anything weaker cannot be read.
        (false, true) => p.weak,
        (false, false) => p.weak.gamma_multiply(0.6),
        (true, true) => p.strong,
        (true, false) => p.text,
    };
    let font = FontId::proportional(size::BODY);
    let label = command.label.trim_end_matches('…');
    let place = rect.left_center() + vec2(8.0, 0.0);
    let drawn = ui.painter().text(place, Align2::LEFT_CENTER, label, font.clone(), color);
    let menu = FontId::proportional(size::SMALL);
    let place = egui::pos2(drawn.max.x + 10.0, rect.center().y);
    ui.painter().text(place, Align2::LEFT_CENTER, command.menu.label(), menu, p.weak);
    let key = command.keys.first().map(ToString::to_string).unwrap_or_default();
    ui.painter().text(rect.right_center() - vec2(8.0, 0.0), Align2::RIGHT_CENTER, key, font, p.weak);
    response
}
