//! The tessellation panel: how triangles are shown and made, and their figures.

mod choices;
mod figures;
mod legend;
mod wipe;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Align, CornerRadius, Frame, Layout, Margin, Rect, RichText, Sense, Ui, vec2};

use super::icon::{self, Icon};
use super::inspection::InspectionState;
use super::{Reads, Writes};
use crate::editor::tessellation::{
    Tessellation, TessellationChoices, TessellationRequest, TessellationView, Wipe,
};
use crate::editor::theme::{Palette, size};
use crate::editor::tools::{Action, CommandRequest};
use crate::editor::viewport::Viewport;

/// What the panel reads and writes of the tessellation.
#[derive(SystemParam)]
pub(super) struct TessellationPanel<'w> {
    state: Res<'w, Tessellation>,
    wipe: Res<'w, Wipe>,
    pub requests: MessageWriter<'w, TessellationRequest>,
}

impl TessellationPanel<'_> {
    fn ask(&mut self, request: TessellationRequest, writes: &mut Writes) {
        self.requests.write(request);
        writes.redraw.write(RequestRedraw);
    }

    fn choose(&mut self, choices: TessellationChoices, writes: &mut Writes) {
        self.ask(TessellationRequest::Choose(choices), writes);
    }
}

/// Height of the panel, points.
const HEIGHT: f32 = 136.0;
/// Width of the choices and of the figures, points.
const CHOICES: f32 = 318.0;
const FIGURES: f32 = 400.0;

/// Shows the panel.
pub(super) fn show(root: &mut Ui, reads: &Reads, writes: &mut Writes, panel: &mut TessellationPanel) {
    if reads.settings.tessellation.view == TessellationView::Off || reads.scene.is_empty() {
        return;
    }
    let frame = Frame::new().inner_margin(Margin { left: 12, right: 8, top: 8, bottom: 6 });
    egui::Panel::bottom("tessellation").frame(frame).resizable(false).exact_size(HEIGHT).show(root, |ui| {
        head(ui, reads, writes, panel);
        ui.add_space(6.0);
        ui.horizontal_top(|ui| {
            let height = ui.available_height();
            let column = |width: f32| (vec2(width, height), Layout::top_down(Align::Min));
            let (room, layout) = column(CHOICES);
            ui.allocate_ui_with_layout(room, layout, |ui| {
                ui.set_width(CHOICES);
                choices::show(ui, reads, writes, panel);
            });
            let (room, layout) = column(FIGURES.min(ui.available_width()));
            ui.allocate_ui_with_layout(room, layout, |ui| {
                ui.set_width(room.x);
                figures::show(ui, reads, writes, panel);
            });
            ui.vertical(|ui| figures::progress(ui, reads, writes, panel));
        });
    });
}

/// What is drawn over the viewport: divider with names, legend, and where the error is largest.
pub(super) fn overlay(
    root: &Ui,
    rect: Rect,
    reads: &Reads,
    viewport: &Viewport,
    panel: &TessellationPanel,
    inspection: &InspectionState,
) {
    let Some(made) = panel.state.made() else { return };
    let painter = root.ctx().layer_painter(egui::LayerId::background()).with_clip_rect(rect);
    match reads.settings.tessellation.view {
        TessellationView::Wipe => {
            wipe::show(root.ctx(), &painter, rect, reads, (viewport, &panel.wipe), &made.figures);
        }
        TessellationView::Error => {
            let free = super::inspection::beside_legend(rect, reads, inspection);
            legend::show(&painter, free, reads, &made.figures);
            legend::largest(&painter, rect, reads, viewport, &made.figures);
        }
        TessellationView::Off | TessellationView::Overlay | TessellationView::Wireframe => {}
    }
}

/// What of the viewport the legend leaves to notices.
pub(super) fn beside_legend(rect: Rect, reads: &Reads, panel: &TessellationPanel) -> Rect {
    let shown = reads.settings.tessellation.view == TessellationView::Error && panel.state.made().is_some();
    let height = if shown { legend::HEIGHT } else { 0.0 };
    Rect::from_min_max(rect.min, rect.max - vec2(0.0, height))
}

fn head(ui: &mut Ui, reads: &Reads, writes: &mut Writes, panel: &mut TessellationPanel) {
    ui.horizontal(|ui| {
        ui.heading("Tessellation");
        ui.add_space(10.0);
        ui.spacing_mut().item_spacing.x = 2.0;
        let choices = &reads.settings.tessellation;
        for (view, name) in
            TessellationView::SHOWN.into_iter().zip(["Triangles", "Wireframe", "Wipe", "Error"])
        {
            let hint = hint(Action::Tessellation(view));
            // A click on what is on leaves it on: the panel would vanish under the pointer.
            if toggle(ui, &reads.palette, choices.view == view, true, name, &hint) && choices.view != view {
                writes.commands.write(CommandRequest(Action::Tessellation(view)));
                writes.redraw.write(RequestRedraw);
            }
        }
        ui.add_space(14.0);
        let surfaces = !matches!(choices.view, TessellationView::Wireframe);
        let extras = [
            (Action::ToggleTriangleEdges, choices.shows_edges(), "Edges"),
            (Action::ToggleFacets, choices.facets, "Flat"),
        ];
        for (action, on, name) in extras {
            if toggle(ui, &reads.palette, on, surfaces, name, &hint(action)) && surfaces {
                writes.commands.write(CommandRequest(action));
                writes.redraw.write(RequestRedraw);
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let (rect, response) = ui.allocate_exact_size(vec2(24.0, 22.0), Sense::click());
            let colour = if response.hovered() { reads.palette.strong } else { reads.palette.weak };
            icon::paint(ui.painter(), rect, Icon::Cross, colour);
            if response.on_hover_text(hint(Action::Tessellation(TessellationView::Off))).clicked() {
                panel.choose(TessellationChoices { view: TessellationView::Off, ..choices.clone() }, writes);
            }
            ui.add_space(6.0);
            if ui.button("Export…").on_hover_text(hint(Action::ExportMesh)).clicked() {
                writes.commands.write(CommandRequest(Action::ExportMesh));
                writes.redraw.write(RequestRedraw);
            }
        });
    });
}

/// The name of a command with its key.
fn hint(action: Action) -> String {
    let Some(command) = action.command() else { return String::new() };
    let key = command.keys.first().map(|k| format!("   {k}")).unwrap_or_default();
    format!("{}{key}", command.label)
}

/// A switch that is a word.
fn toggle(ui: &mut Ui, palette: &Palette, on: bool, enabled: bool, text: &str, hint: &str) -> bool {
    let font = egui::FontId::proportional(size::BODY);
    let colour = match (enabled, on) {
        (false, _) => palette.weak.gamma_multiply(0.5),
        (true, true) => palette.accent,
        (true, false) => palette.text,
    };
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, colour);
    let (rect, response) = ui.allocate_exact_size(galley.size() + vec2(16.0, 8.0), Sense::click());
    let fill = match (enabled && on, enabled && response.hovered()) {
        (true, _) => palette.selected,
        (false, true) => palette.hovered,
        (false, false) => egui::Color32::TRANSPARENT,
    };
    ui.painter().rect_filled(rect, CornerRadius::same(4), fill);
    ui.painter().galley(rect.center() - galley.size() / 2.0, galley, colour);
    response.on_hover_text(hint).clicked()
}

fn weak(ui: &mut Ui, reads: &Reads, text: impl Into<String>) {
    ui.label(RichText::new(text).color(reads.palette.weak));
}
