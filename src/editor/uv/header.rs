//! The panel's own toolbar: tools, view, snapping, structure.

use bevy_egui::egui::{
    self, Align, Color32, CornerRadius, Frame, Label, Layout, Margin, RichText, Sense, Ui, vec2,
};

use super::gesture::Gesture;
use super::panel::Overlay;
use super::show::{UvParams, title};
use super::tool::Tool;
use crate::editor::panels::format::plural;
use crate::editor::panels::icon::{self, Icon};
use crate::editor::tools::Action;

/// Shows it.
pub(super) fn show(ui: &mut Ui, params: &mut UvParams) {
    let palette = *params.palette;
    let frame = Frame::new().fill(palette.bar).inner_margin(Margin { left: 10, right: 6, top: 2, bottom: 2 });
    frame.show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            let name = params.active.face.as_ref().map_or("UV".to_owned(), |f| format!("Face {}", f.number));
            ui.add(Label::new(title(name, &palette)));
            if let Some(face) = &params.active.face {
                let curves: usize = face.loops.iter().map(|l| l.curves.len()).sum();
                let text = format!("{}, {}", plural(face.loops.len(), "loop"), plural(curves, "curve"));
                if ui.available_width() > 520.0 {
                    ui.add_space(6.0);
                    ui.label(RichText::new(text).small().color(palette.weak));
                }
            }
            ui.add_space(8.0);
            for tool in Tool::ALL {
                let on = params.panel.tool == tool;
                let hint = format!("{}   {}\n{}", tool.label(), tool.key(), tool.hint());
                if button(ui, tool_icon(tool), on, &hint, params) {
                    params.panel.tool = tool;
                    params.panel.gesture = Gesture::None;
                    params.panel.snapped = None;
                }
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.spacing_mut().item_spacing.x = 2.0;
                right(ui, params);
            });
        });
    });
}

fn right(ui: &mut Ui, params: &mut UvParams) {
    if button(ui, Icon::Cross, false, "Close   Shift+U", params) {
        params.command(Action::ToggleUv);
    }
    let beside = params.settings.uv_beside;
    let (icon, hint) = match beside {
        true => (Icon::DockBelow, "Put the panel below the view"),
        false => (Icon::DockBeside, "Put the panel beside the view"),
    };
    if button(ui, icon, false, hint, params) {
        params.command(Action::ToggleUvSide);
    }
    let overlay = params.panel.overlay;
    for (mode, icon, hint) in [
        (Overlay::Grid, Icon::Cells, "Cells of the parity grid   M"),
        (Overlay::Intervals, Icon::Intervals, "Intervals of the paper   M"),
    ] {
        if button(ui, icon, overlay == mode, hint, params) {
            params.panel.overlay = if overlay == mode { Overlay::None } else { mode };
        }
    }
    snapping(ui, params);
    if button(ui, Icon::FitSelection, false, "Fit selection   Z", params) {
        params.panel.wanted_fit = super::panel::Fit::Selection;
    }
    if button(ui, Icon::Fit, false, "Fit   F", params) {
        params.panel.wanted_fit = super::panel::Fit::All;
    }
}

fn snapping(ui: &mut Ui, params: &mut UvParams) {
    let on = params.panel.snapping.on;
    let hint = "Snap   N (Ctrl while dragging turns it round)";
    // From right to left.
    let (narrow, arrow) = ui.allocate_exact_size(vec2(14.0, 26.0), Sense::click());
    paint(ui, narrow, Icon::Down, false, arrow.hovered(), params);
    let (rect, response) = ui.allocate_exact_size(vec2(28.0, 26.0), Sense::click());
    paint(ui, rect, Icon::Magnet, on, response.hovered(), params);
    if response.clicked() {
        params.panel.snapping.on = !on;
    }
    egui::Popup::menu(&arrow).close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        let snap = &mut params.panel.snapping;
        ui.checkbox(&mut snap.points, "End and control points");
        ui.checkbox(&mut snap.curves, "Curves");
        ui.checkbox(&mut snap.knots, "Knot lines and border");
        ui.checkbox(&mut snap.grid, "Grid");
    });
    response.on_hover_text(hint);
    arrow.on_hover_text("What to snap to");
}

fn tool_icon(tool: Tool) -> Icon {
    match tool {
        Tool::Select => Icon::Arrow,
        Tool::Rectangle => Icon::Rectangle,
        Tool::Circle => Icon::Circle,
        Tool::Polyline => Icon::Polyline,
        Tool::Freehand => Icon::Freehand,
        Tool::InsertKnot => Icon::Knot,
        Tool::Split => Icon::Split,
    }
}

fn button(ui: &mut Ui, icon: Icon, on: bool, hint: &str, params: &UvParams) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(28.0, 26.0), Sense::click());
    paint(ui, rect, icon, on, response.hovered(), params);
    let clicked = response.clicked();
    response.on_hover_text(hint);
    clicked
}

fn paint(ui: &Ui, rect: egui::Rect, icon: Icon, on: bool, hovered: bool, params: &UvParams) {
    let p = &params.palette;
    let (fill, color) = match (on, hovered) {
        (true, _) => (p.selected, p.accent),
        (false, true) => (p.hovered, p.strong),
        (false, false) => (Color32::TRANSPARENT, p.text),
    };
    ui.painter().rect_filled(rect.shrink(1.0), CornerRadius::same(4), fill);
    icon::paint(ui.painter(), rect, icon, color);
}
