//! The bar shown while a file is being read, with its cancel button.

use bevy::window::RequestRedraw;
use bevy_egui::egui::{
    self, Align2, Context, CornerRadius, Frame, Margin, Rect, RichText, Sense, Stroke, vec2,
};

use super::{Reads, Writes};
use crate::editor::tools::{Action, CommandRequest};

/// Shows the bar in the middle of the viewport's lower half.
pub(super) fn show(ctx: &Context, viewport: Rect, reads: &Reads, writes: &mut Writes) {
    let Some(progress) = reads.loading.progress() else { return };
    let p = &reads.palette;
    let frame = Frame::new()
        .fill(p.raised)
        .stroke(Stroke::new(1.0, p.line))
        .corner_radius(8)
        .inner_margin(Margin::same(14));
    let place = egui::pos2(viewport.center().x, viewport.min.y + 0.7 * viewport.height());
    egui::Area::new(egui::Id::new("progress"))
        .order(egui::Order::Foreground)
        .pivot(Align2::CENTER_CENTER)
        .fixed_pos(place)
        .show(ctx, |ui| {
            frame.show(ui, |ui| {
                ui.set_width(320.0);
                ui.horizontal(|ui| {
                    ui.label(RichText::new(format!("{} {}", progress.stage, progress.name)).color(p.strong));
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        ui.label(RichText::new(format!("{:.0} %", 100.0 * progress.fraction)).color(p.weak));
                    });
                });
                ui.add_space(6.0);
                ui.horizontal(|ui| {
                    let (trough, _) = ui.allocate_exact_size(vec2(244.0, 6.0), Sense::hover());
                    let radius = CornerRadius::same(3);
                    ui.painter().rect_filled(trough, radius, p.sunken);
                    let filled =
                        Rect::from_min_size(trough.min, vec2(trough.width() * progress.fraction, 6.0));
                    ui.painter().rect_filled(filled, radius, p.accent);
                    if ui.button("Cancel").clicked() {
                        writes.commands.write(CommandRequest(Action::Cancel));
                        writes.redraw.write(RequestRedraw);
                    }
                });
            });
        });
}
