//! The menu bar, made from the command table.

use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Align, Button, Frame, Layout, Margin, RichText, Ui};

use super::{Reads, Writes};
use crate::editor::files::{OpenFiles, Source};
use crate::editor::tools::{Action, COMMANDS, Command, CommandRequest, Menu};

/// Shows the bar.
pub(super) fn show(root: &mut Ui, reads: &Reads, writes: &mut Writes) {
    let frame = Frame::new().fill(reads.palette.bar).inner_margin(Margin::symmetric(8, 3));
    egui::Panel::top("menu").frame(frame).show_separator_line(false).show(root, |ui| {
        egui::MenuBar::new().ui(ui, |ui| {
            ui.label(RichText::new("Hairline").heading().color(reads.palette.accent));
            ui.add_space(8.0);
            for menu in Menu::ALL {
                ui.menu_button(menu.label(), |ui| {
                    for command in COMMANDS.iter().filter(|c| c.menu == menu) {
                        item(ui, command, reads, writes);
                        if command.action == Action::OpenDemo {
                            recent(ui, reads, writes);
                        }
                    }
                });
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let star = if reads.editing.is_unsaved() { "*" } else { "" };
                let name = if reads.scene.is_empty() { String::new() } else { reads.document_name() };
                ui.label(RichText::new(format!("{star}{name}")).color(reads.palette.weak));
            });
        });
    });
}

/// One entry: tick, label, key.
fn item(ui: &mut Ui, command: &Command, reads: &Reads, writes: &mut Writes) {
    if command.separated {
        ui.separator();
    }
    let tick = match command.checked {
        Some(checked) if checked(&reads.settings) => "✔",
        _ => "",
    };
    let key = command.keys.first().map(ToString::to_string).unwrap_or_default();
    let enabled = (command.enabled)(&reads.situation.0);
    let response = ui
        .scope(|ui| {
            ui.style_mut().spacing.item_spacing.x = 0.0;
            let button = Button::new(format!("      {}", command.label))
                .shortcut_text(RichText::new(key).color(reads.palette.weak))
                .min_size(egui::vec2(230.0, 24.0));
            let response = ui.add_enabled(enabled, button);
            let place = response.rect.left_center() + egui::vec2(14.0, 0.0);
            let font = egui::TextStyle::Body.resolve(ui.style());
            ui.painter().text(place, egui::Align2::CENTER_CENTER, tick, font, reads.palette.accent);
            response
        })
        .inner;
    if response.clicked() {
        writes.commands.write(CommandRequest(command.action));
        writes.redraw.write(RequestRedraw);
        ui.close();
    }
}

/// Recent files as a submenu.
fn recent(ui: &mut Ui, reads: &Reads, writes: &mut Writes) {
    if reads.settings.recent.is_empty() {
        ui.add_enabled(false, Button::new("      Open recent").min_size(egui::vec2(230.0, 24.0)));
        return;
    }
    ui.menu_button("      Open recent", |ui| {
        for path in &reads.settings.recent {
            let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
            let button = Button::new(name).min_size(egui::vec2(230.0, 24.0));
            if ui.add(button).on_hover_text(path.display().to_string()).clicked() {
                writes.open.write(OpenFiles { sources: vec![Source::File(path.clone())], replace: true });
                writes.redraw.write(RequestRedraw);
                ui.close();
            }
        }
    });
}
