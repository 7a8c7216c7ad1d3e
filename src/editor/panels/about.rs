//! The about box.

use bevy_egui::egui::{Color32, Context, Id, Modal, RichText};

use crate::editor::theme::{Palette, size};

/// Shows the box while `open`.
pub(super) fn show(ctx: &Context, palette: &Palette, open: &mut bool) {
    if !*open {
        return;
    }
    let backdrop = Color32::from_black_alpha(if palette.light { 60 } else { 120 });
    let response = Modal::new(Id::new("about")).backdrop_color(backdrop).frame(super::sheet_frame(palette)).show(ctx, |ui| {
        ui.set_width(380.0);
        ui.label(RichText::new("Hairline").size(size::TITLE).color(palette.accent));
        ui.label(RichText::new(concat!("Version ", env!("CARGO_PKG_VERSION"))).color(palette.weak));
        ui.add_space(8.0);
        ui.label(
            "Shows trimmed NURBS surfaces exactly: every pixel is a ray cast against the rational surface and \
             classified against the rational trim curves. No triangles stand in between.",
        );
        ui.add_space(8.0);
        ui.label(RichText::new("MIT or Apache-2.0. Font: Roboto, Apache-2.0.").color(palette.weak));
    });
    if response.should_close() {
        *open = false;
    }
}
