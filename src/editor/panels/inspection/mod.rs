//! The inspection panel: counts, the histogram of gaps with the tolerance, and the table of edges.

mod histogram;
mod holes;
mod legend;
mod measure;
mod mend;
mod pinholes;
mod table;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Align, CornerRadius, Frame, Layout, Margin, Rect, RichText, Sense, Ui, vec2};

use super::format::{count, plural};
use super::icon::{self, Icon};
use super::{Reads, Writes};
use crate::editor::inspection::{
    Chosen, CloseGap, Findings, InspectRequest, InspectionChoices, LatestPicture, MendChoices, MendOutcome,
    PinHoles, Probe, Progress, Rows, ramp,
};
use crate::editor::theme::Palette;
use crate::editor::tools::{Action, CommandRequest};
use crate::editor::viewport::Viewport;
use crate::inspect::Length;
use crate::inspect::statistics::Tally;
pub(super) use holes::colour as hole_colour;

/// What the panel reads and writes of the inspection.
#[derive(SystemParam)]
pub(super) struct InspectionState<'w, 's> {
    findings: Res<'w, Findings>,
    rows: Res<'w, Rows>,
    chosen: Res<'w, Chosen>,
    probe: Res<'w, Probe>,
    pub holes: Res<'w, PinHoles>,
    pub picture: Res<'w, LatestPicture>,
    /// Whether pin holes are listed in place of edges.
    list_holes: Local<'s, bool>,
    choices: ResMut<'w, InspectionChoices>,
    mend: ResMut<'w, MendChoices>,
    outcome: Res<'w, MendOutcome>,
    requests: MessageWriter<'w, InspectRequest>,
    close: MessageWriter<'w, CloseGap>,
}

/// Width of the summary, points.
const SUMMARY: f32 = 300.0;

/// Shows the panel.
pub(super) fn show(root: &mut Ui, reads: &Reads, writes: &mut Writes, state: &mut InspectionState) {
    let frame = Frame::new().inner_margin(Margin { left: 12, right: 8, top: 8, bottom: 6 });
    let panel =
        egui::Panel::bottom("inspection").frame(frame).default_size(270.0).min_size(150.0).max_size(600.0);
    panel.resizable(true).show(root, |ui| {
        // As high while there is nothing to show yet.
        ui.set_min_height(ui.available_height());
        head(ui, reads, writes, state);
        ui.add_space(4.0);
        match state.findings.progress() {
            Progress::Off => hint(ui, reads, "Nothing open"),
            Progress::Failed(text) => hint(ui, reads, &text),
            Progress::Measuring if state.findings.inspection().is_none() => hint(ui, reads, "Measuring…"),
            Progress::Measuring | Progress::Ready => {
                ui.horizontal_top(|ui| {
                    let height = ui.available_height();
                    ui.allocate_ui_with_layout(vec2(SUMMARY, height), Layout::top_down(Align::Min), |ui| {
                        ui.set_width(SUMMARY);
                        summary(ui, reads, state);
                        histogram::show(ui, &reads.palette, state);
                    });
                    ui.add_space(10.0);
                    ui.vertical(|ui| {
                        mend::show(ui, reads, writes, state);
                        match *state.list_holes {
                            true => pinholes::show(ui, reads, writes, state),
                            false => table::show(ui, reads, writes, state),
                        }
                    });
                });
            }
        }
    });
}

/// What is drawn over the viewport: the legend, and dimension lines of the chosen edge and the probe.
pub(super) fn overlay(root: &Ui, rect: Rect, reads: &Reads, viewport: &Viewport, state: &InspectionState) {
    if !reads.settings.inspection || state.findings.inspection().is_none() {
        return;
    }
    let painter = root.ctx().layer_painter(egui::LayerId::background()).with_clip_rect(rect);
    if state.choices.colours {
        legend::show(&painter, rect, &reads.palette);
    }
    if reads.settings.pin_holes {
        let legend = legend::place(rect).filter(|_| state.choices.colours);
        holes::show(&painter, (rect, legend), reads, viewport, &state.holes);
    }
    measure::show(&painter, reads, viewport, state);
}

/// What of the viewport the legend leaves to others.
pub(super) fn beside_legend(rect: Rect, reads: &Reads, state: &InspectionState) -> Rect {
    let shown = reads.settings.inspection && state.choices.colours && state.findings.inspection().is_some();
    let height = if shown { legend::HEIGHT } else { 0.0 };
    Rect::from_min_max(rect.min, rect.max - vec2(0.0, height))
}

fn hint(ui: &mut Ui, reads: &Reads, text: &str) {
    ui.add_space(10.0);
    ui.label(RichText::new(text).color(reads.palette.weak));
}

fn head(ui: &mut Ui, reads: &Reads, writes: &mut Writes, state: &mut InspectionState) {
    ui.horizontal(|ui| {
        ui.heading("Inspection");
        ui.add_space(10.0);
        let mut tolerance = state.choices.tolerance;
        let slider = egui::Slider::new(&mut tolerance, 1e-6..=1.0)
            .logarithmic(true)
            .smallest_positive(1e-6)
            .custom_formatter(|mm, _| Length { mm }.to_string())
            .custom_parser(|text| text.parse::<Length>().ok().map(|l| l.mm));
        ui.label(RichText::new("Tolerance").color(reads.palette.weak));
        if ui.add(slider).on_hover_text("Gaps above this are defects. Type a length: 10um, 0.5mm").changed()
            && tolerance.is_finite()
            && tolerance > 0.0
        {
            state.choices.tolerance = tolerance;
            writes.redraw.write(RequestRedraw);
        }
        ui.add_space(6.0);
        let filter = &mut state.choices.filter;
        let mut changed = false;
        changed |= toggle(ui, &reads.palette, &mut filter.defects_only, "Defects only");
        changed |= toggle(ui, &reads.palette, &mut filter.shared, "Gaps");
        changed |= toggle(ui, &reads.palette, &mut filter.naked, "Naked");
        changed |= toggle(ui, &reads.palette, &mut filter.non_manifold, "Non-manifold");
        changed |= toggle(ui, &reads.palette, &mut filter.selected_only, "Selection");
        let search = egui::TextEdit::singleline(&mut filter.text).hint_text("Face").desired_width(54.0);
        changed |= ui.add(search).on_hover_text("Only edges of the face with this number").changed();
        changed |= toggle(ui, &reads.palette, &mut state.choices.colours, "Colours");
        changed |= toggle(ui, &reads.palette, &mut state.list_holes, "Pin holes");
        if changed {
            // Rows are made in `Update`, before the next time panels are built.
            writes.redraw.write(RequestRedraw);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if tool(ui, reads, Icon::Cross, "Close") {
                writes.commands.write(CommandRequest(Action::ToggleInspection));
                writes.redraw.write(RequestRedraw);
            }
            for (action, icon) in [(Action::NextDefect, Icon::Right), (Action::PreviousDefect, Icon::Left)] {
                let key = action.command().map(|c| {
                    let key = c.keys.first().map(|k| format!("   {k}")).unwrap_or_default();
                    format!("{}{key}", c.label)
                });
                if tool(ui, reads, icon, &key.unwrap_or_default()) {
                    writes.commands.write(CommandRequest(action));
                    writes.redraw.write(RequestRedraw);
                }
            }
        });
    });
}

fn tool(ui: &mut Ui, reads: &Reads, icon: Icon, hint: &str) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(24.0, 22.0), Sense::click());
    let colour = if response.hovered() { reads.palette.strong } else { reads.palette.weak };
    icon::paint(ui.painter(), rect, icon, colour);
    response.on_hover_text(hint).clicked()
}

fn toggle(ui: &mut Ui, palette: &Palette, on: &mut bool, text: &str) -> bool {
    let font = egui::FontId::proportional(crate::editor::theme::size::SMALL);
    let colour = if *on { palette.text } else { palette.weak };
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, colour);
    let (rect, response) = ui.allocate_exact_size(galley.size() + vec2(14.0, 8.0), Sense::click());
    let fill = match (*on, response.hovered()) {
        (true, _) => palette.hovered,
        (false, true) => palette.hovered.gamma_multiply(0.5),
        (false, false) => egui::Color32::TRANSPARENT,
    };
    ui.painter().rect_filled(rect, CornerRadius::same(4), fill);
    ui.painter().galley(rect.center() - galley.size() / 2.0, galley, colour);
    if response.clicked() {
        *on = !*on;
    }
    response.clicked()
}

fn summary(ui: &mut Ui, reads: &Reads, state: &InspectionState) {
    let statistics = state.findings.statistics();
    let defects = statistics.above(state.choices.tolerance);
    let colour = if defects > 0 { reads.palette.warning } else { reads.palette.strong };
    let limit = Length { mm: state.choices.tolerance };
    let measuring =
        if state.findings.progress() == Progress::Measuring { " (measuring again…)" } else { "" };
    ui.label(
        RichText::new(format!("{} above {limit}{measuring}", plural(defects, "gap"))).color(colour).strong(),
    );
    let median = Length { mm: statistics.quantile(0.5) };
    let most = Length { mm: statistics.quantile(1.0) };
    ui.label(
        RichText::new(format!("{} measured: median {median}, largest {most}", count(statistics.gaps.len())))
            .small()
            .color(reads.palette.weak),
    );
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 12.0;
        tally(ui, reads, "naked", statistics.naked, ramp::NAKED);
        tally(ui, reads, "non-manifold", statistics.non_manifold, ramp::NON_MANIFOLD);
        tally(ui, reads, "seams", statistics.seam, ramp::CLOSED);
    });
}

fn tally(ui: &mut Ui, reads: &Reads, name: &str, tally: Tally, colour: [u8; 3]) {
    let text = RichText::new(format!("{} {name}", count(tally.count))).small().color(reads.palette.text);
    let [r, g, b] = colour;
    let response = ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let (dot, _) = ui.allocate_exact_size(vec2(8.0, 14.0), Sense::hover());
        ui.painter().circle_filled(dot.center(), 3.5, egui::Color32::from_rgb(r, g, b));
        ui.label(text);
    });
    response.response.on_hover_text(format!("{:.3} mm in all", tally.length));
}
