//! The toolbar: the commands one reaches for with the mouse, as icons.

use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Align, Color32, CornerRadius, Frame, Layout, Margin, Sense, Ui, vec2};

use super::icon::{self, Icon};
use super::{Reads, Writes};
use crate::editor::settings::{DisplayMode, Handles};
use crate::editor::tessellation::TessellationView;
use crate::editor::tools::{Action, CommandRequest};

/// Shows the toolbar.
pub(super) fn show(root: &mut Ui, reads: &Reads, writes: &mut Writes) {
    let frame =
        Frame::new().fill(reads.palette.bar).inner_margin(Margin { left: 8, right: 8, top: 0, bottom: 5 });
    egui::Panel::top("toolbar").frame(frame).show(root, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            button(ui, Icon::Open, Action::Open, reads, writes);
            gap(ui, reads);
            button(ui, Icon::Fit, Action::Fit, reads, writes);
            button(ui, Icon::FitSelection, Action::FitSelection, reads, writes);
            let projection = if reads.settings.perspective { Icon::Perspective } else { Icon::Parallel };
            plain_button(ui, projection, Action::ToggleProjection, reads, writes);
            gap(ui, reads);
            for (mode, icon) in DisplayMode::ALL.into_iter().zip([
                Icon::Cube,
                Icon::Faces,
                Icon::Uv,
                Icon::Heat,
                Icon::Untrimmed,
            ]) {
                button(ui, icon, Action::Display(mode), reads, writes);
            }
            gap(ui, reads);
            button(ui, Icon::Edges, Action::ToggleEdges, reads, writes);
            button(ui, Icon::Grid, Action::ToggleGrid, reads, writes);
            gap(ui, reads);
            button(ui, Icon::Triangles, Action::Tessellation(TessellationView::Overlay), reads, writes);
            button(ui, Icon::Wipe, Action::Tessellation(TessellationView::Wipe), reads, writes);
            gap(ui, reads);
            button(ui, Icon::UvEditor, Action::ToggleUv, reads, writes);
            button(ui, Icon::Curves, Action::Handles(Handles::Curves), reads, writes);
            button(ui, Icon::Net, Action::Handles(Handles::Surface), reads, writes);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.spacing_mut().item_spacing.x = 2.0;
                button(ui, Icon::Question, Action::Shortcuts, reads, writes);
                let theme = if reads.settings.light { Icon::Moon } else { Icon::Sun };
                plain_button(ui, theme, Action::ToggleTheme, reads, writes);
                gap(ui, reads);
                button(ui, Icon::Properties, Action::ToggleProperties, reads, writes);
                button(ui, Icon::Report, Action::ToggleReport, reads, writes);
                button(ui, Icon::Tree, Action::ToggleTree, reads, writes);
            });
        });
    });
}

fn gap(ui: &mut Ui, reads: &Reads) {
    let (rect, _) = ui.allocate_exact_size(vec2(13.0, 28.0), Sense::hover());
    let stroke = egui::Stroke::new(1.0, reads.palette.line);
    ui.painter().vline(rect.center().x.round() + 0.5, rect.y_range().shrink(5.0), stroke);
}

fn button(ui: &mut Ui, icon: Icon, action: Action, reads: &Reads, writes: &mut Writes) {
    let on = action.command().and_then(|c| c.checked).is_some_and(|checked| checked(&reads.settings));
    any_button(ui, icon, action, on, reads, writes);
}

/// A button whose icon shows the state, so that it needs no mark.
fn plain_button(ui: &mut Ui, icon: Icon, action: Action, reads: &Reads, writes: &mut Writes) {
    any_button(ui, icon, action, false, reads, writes);
}

fn any_button(ui: &mut Ui, icon: Icon, action: Action, on: bool, reads: &Reads, writes: &mut Writes) {
    let Some(command) = action.command() else { return };
    let enabled = (command.enabled)(&reads.situation.0);
    let p = &reads.palette;
    let (rect, response) = ui.allocate_exact_size(vec2(30.0, 28.0), Sense::click());
    let (fill, color) = match (enabled, on, response.hovered()) {
        (false, ..) => (Color32::TRANSPARENT, p.weak.gamma_multiply(0.5)),
        (true, true, _) => (p.selected, p.accent),
        (true, false, true) => (p.hovered, p.strong),
        (true, false, false) => (Color32::TRANSPARENT, p.text),
    };
    ui.painter().rect_filled(rect.shrink2(vec2(1.0, 1.0)), CornerRadius::same(4), fill);
    icon::paint(ui.painter(), rect, icon, color);
    let key = command.keys.first().map(|k| format!("   {k}")).unwrap_or_default();
    let clicked = response.clicked();
    response.on_hover_text(format!("{}{key}", command.label.trim_end_matches('…')));
    if clicked && enabled {
        writes.commands.write(CommandRequest(action));
        writes.redraw.write(RequestRedraw);
    }
}
