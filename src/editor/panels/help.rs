//! The help sheet: all keys and what the mouse does, made from the command table.

use bevy_egui::egui::{self, Align2, Color32, Context, FontId, Id, Modal, RichText, Sense, Ui, vec2};

use crate::editor::theme::{Palette, size};
use crate::editor::tools::{COMMANDS, MOUSE_HELP, Menu};

/// Shows the sheet while `open`.
pub(super) fn show(ctx: &Context, palette: &Palette, open: &mut bool) {
    if !*open {
        return;
    }
    let backdrop = Color32::from_black_alpha(if palette.light { 60 } else { 120 });
    let response = Modal::new(Id::new("help"))
        .backdrop_color(backdrop)
        .frame(super::sheet_frame(palette))
        .show(ctx, |ui| {
            ui.set_width((ctx.viewport_rect().width() - 120.0).min(860.0));
            ui.label(RichText::new("Keys and mouse").size(size::TITLE).color(palette.strong));
            ui.add_space(8.0);
            let height = ctx.viewport_rect().height() - 160.0;
            egui::ScrollArea::vertical().max_height(height).min_scrolled_height(height.min(560.0)).show(
                ui,
                |ui| {
                    ui.columns(3, |columns| {
                        for (column, menus) in columns.iter_mut().zip([
                            &[Menu::File, Menu::Edit, Menu::Inspect, Menu::Help][..],
                            &[Menu::Loop, Menu::Curve, Menu::Surface][..],
                            &[Menu::View, Menu::Display, Menu::Tessellation][..],
                        ]) {
                            for menu in menus {
                                group(column, palette, *menu);
                            }
                        }
                    });
                    ui.add_space(4.0);
                    title(ui, palette, "Mouse");
                    ui.columns(2, |columns| {
                        let half = MOUSE_HELP.len().div_ceil(2);
                        for (i, (what, does)) in MOUSE_HELP.iter().enumerate() {
                            mouse(&mut columns[usize::from(i >= half)], palette, what, does);
                        }
                    });
                },
            );
        });
    if response.should_close() {
        *open = false;
    }
}

fn title(ui: &mut Ui, palette: &Palette, text: &str) {
    ui.label(RichText::new(text).heading().color(palette.accent));
    ui.add_space(2.0);
}

fn group(ui: &mut Ui, palette: &Palette, menu: Menu) {
    title(ui, palette, menu.label());
    for command in COMMANDS.iter().filter(|c| c.menu == menu && !c.keys.is_empty()) {
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 19.0), Sense::hover());
        let font = FontId::proportional(size::BODY);
        ui.painter().text(rect.left_center(), Align2::LEFT_CENTER, command.label, font.clone(), palette.text);
        let keys: Vec<String> = command.keys.iter().take(2).map(ToString::to_string).collect();
        let right = rect.right_center() - vec2(10.0, 0.0);
        ui.painter().text(right, Align2::RIGHT_CENTER, keys.join("  or  "), font, palette.strong);
    }
    ui.add_space(10.0);
}

fn mouse(ui: &mut Ui, palette: &Palette, what: &str, does: &str) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 19.0), Sense::hover());
    let font = FontId::proportional(size::BODY);
    ui.painter().text(rect.left_center(), Align2::LEFT_CENTER, what, font.clone(), palette.strong);
    let left = rect.left_center() + vec2(144.0, 0.0);
    ui.painter().text(left, Align2::LEFT_CENTER, does, font, palette.text);
}
