//! Figures of the tessellation, its progress, and the question when there would be too many triangles.

use std::time::Duration;

use bevy_egui::egui::{Button, Color32, CornerRadius, Label, Rect, RichText, Sense, Ui, vec2};

use super::{TessellationPanel, weak};
use crate::editor::inspection::ramp;
use crate::editor::panels::format::{count, plural};
use crate::editor::panels::{Reads, Writes};
use crate::editor::tessellation::{Figures, Made, Progress, Stop, TessellationChoices, TessellationRequest};
use crate::inspect::Length;

/// More triangles are not offered: graphics drivers bind no larger buffers.
const MOST: usize = 4_000_000;
/// Faces without triangles that are named.
const NAMED: usize = 6;

/// Shows the figures.
pub(super) fn show(ui: &mut Ui, reads: &Reads, writes: &mut Writes, panel: &mut TessellationPanel) {
    let Some(made) = panel.state.made().cloned() else { return };
    let figures = &made.figures;
    // Rows with a button in them are as high as those without.
    (ui.spacing_mut().item_spacing.y, ui.spacing_mut().interact_size.y) = (3.0, 18.0);
    ui.spacing_mut().button_padding.y = 1.0;
    let text = format!("{}, {}", plural(figures.triangles, "triangle"), plural(figures.edges, "edge"));
    ui.horizontal(|ui| {
        ui.label(RichText::new(text).color(reads.palette.strong));
        match figures.open_edges {
            0 => weak(ui, reads, "watertight"),
            n => {
                let [r, g, b] = ramp::NAKED;
                ui.label(RichText::new(format!("{} open", count(n))).color(Color32::from_rgb(r, g, b)))
                    .on_hover_text("Edges with a triangle on one side only, drawn in this colour");
            }
        }
    });
    ui.horizontal(|ui| largest(ui, reads, writes, panel, &made));
    let mut times = format!("{} in {}", plural(figures.faces, "face"), seconds(figures.mesh_time));
    if let Some(time) = figures.measure_time {
        times += &format!(", measured in {}", seconds(time));
    }
    if figures.remade < figures.faces {
        times += &format!("; {} made again", count(figures.remade));
    }
    weak(ui, reads, times);
    doubts(ui, reads, &made);
}

fn largest(ui: &mut Ui, reads: &Reads, writes: &mut Writes, panel: &mut TessellationPanel, made: &Made) {
    let figures = &made.figures;
    let Some(largest) = figures.largest else {
        weak(ui, reads, "Error not measured yet");
        return;
    };
    let share = 100.0 * largest.mm / figures.tolerance_mm;
    let text = format!("Largest error {}, {share:.0} % of the tolerance", Length { mm: largest.mm });
    let colour = if largest.mm > figures.tolerance_mm { reads.palette.warning } else { reads.palette.text };
    ui.label(RichText::new(text).color(colour));
    let place = number(reads, made, largest.face);
    if ui.button("Show").on_hover_text(format!("Fly to the place, on {place}")).clicked() {
        panel.ask(TessellationRequest::ShowLargest, writes);
    }
}

/// Faces without triangles, and triangles without a proof.
fn doubts(ui: &mut Ui, reads: &Reads, made: &Made) {
    let figures: &Figures = &made.figures;
    if !figures.left_out.is_empty() {
        let names: Vec<String> =
            figures.left_out.iter().take(NAMED).map(|(face, _)| number(reads, made, *face)).collect();
        let more = if figures.left_out.len() > NAMED { ", …" } else { "" };
        let text = format!(
            "{} without triangles: {}{more}",
            plural(figures.left_out.len(), "face"),
            names.join(", ")
        );
        let reasons: Vec<String> = figures
            .left_out
            .iter()
            .take(20)
            .map(|(face, why)| format!("{}: {why}", number(reads, made, *face)))
            .collect();
        let label = Label::new(RichText::new(text).color(reads.palette.warning)).truncate();
        ui.add(label).on_hover_text(reasons.join("\n"));
    } else if figures.conservative && figures.over_tolerance > 0 {
        let text = format!("{} not proved to keep it", plural(figures.over_tolerance, "triangle"));
        let hint = "The bounds are too coarse there; what was measured counts";
        ui.add(Label::new(RichText::new(text).color(reads.palette.warning)).truncate()).on_hover_text(hint);
    }
}

fn number(reads: &Reads, made: &Made, position: usize) -> String {
    let view = made.face(position).and_then(|face| reads.faces.get(face).ok());
    view.map_or_else(|| "a face that is gone".to_owned(), |view| format!("face {}", view.place.number))
}

fn seconds(time: Duration) -> String {
    let s = time.as_secs_f64();
    match s {
        s if s < 0.0995 => format!("{:.1} ms", 1e3 * s),
        s if s < 9.95 => format!("{s:.2} s"),
        s => format!("{s:.0} s"),
    }
}

/// Shows how far the work is, or why there is none.
pub(super) fn progress(ui: &mut Ui, reads: &Reads, writes: &mut Writes, panel: &mut TessellationPanel) {
    ui.spacing_mut().item_spacing.y = 4.0;
    match panel.state.progress() {
        Progress::Off | Progress::Ready => {}
        Progress::Meshing(part) => bar(ui, reads, writes, panel, "Meshing", part),
        Progress::Measuring(part) => bar(ui, reads, writes, panel, "Measuring", part),
        Progress::Stopped(Stop::TooMany(limit)) => question(ui, reads, writes, panel, limit),
        Progress::Stopped(stop) => {
            let (text, colour) = match stop {
                Stop::Failed(text) => (text, reads.palette.error),
                _ => ("Cancelled".to_owned(), reads.palette.weak),
            };
            ui.add(Label::new(RichText::new(text).color(colour)).wrap());
            if ui.button("Again").clicked() {
                panel.ask(TessellationRequest::Again, writes);
            }
        }
    }
}

fn bar(
    ui: &mut Ui,
    reads: &Reads,
    writes: &mut Writes,
    panel: &mut TessellationPanel,
    what: &str,
    part: f32,
) {
    let p = &reads.palette;
    ui.label(RichText::new(format!("{what} {:.0} %", 100.0 * part)).color(p.text));
    let width = ui.available_width().clamp(60.0, 260.0);
    let (trough, _) = ui.allocate_exact_size(vec2(width, 6.0), Sense::hover());
    let radius = CornerRadius::same(3);
    ui.painter().rect_filled(trough, radius, p.sunken);
    let filled = Rect::from_min_size(trough.min, vec2(trough.width() * part.clamp(0.0, 1.0), 6.0));
    ui.painter().rect_filled(filled, radius, p.accent);
    if ui.button("Cancel").clicked() {
        panel.ask(TessellationRequest::Cancel, writes);
    }
}

/// The machine is not frozen unasked.
fn question(ui: &mut Ui, reads: &Reads, writes: &mut Writes, panel: &mut TessellationPanel, limit: usize) {
    let choices = &reads.settings.tessellation;
    let tolerance = choices.tolerance(panel.state.size_mm());
    let text = format!("{} takes more than {} triangles.", Length { mm: tolerance }, count(limit));
    ui.add(Label::new(RichText::new(text).color(reads.palette.warning)).wrap());
    ui.horizontal_wrapped(|ui| {
        let coarser = 4.0 * tolerance;
        if ui.button(format!("Use {}", Length { mm: coarser })).clicked() {
            let choices = TessellationChoices { tolerance_mm: Some(coarser), ..choices.clone() };
            panel.choose(choices, writes);
        }
        let more = 4 * limit;
        let allowed = more <= MOST;
        let button =
            Button::new(if allowed { format!("Allow {}", count(more)) } else { "Allow more".into() });
        let response = ui.add_enabled(allowed, button);
        let hint = if allowed {
            "May take minutes, and a lot of memory"
        } else {
            "Too many to be drawn: see `hairline tessellate --limit`"
        };
        if response.on_hover_text(hint).on_disabled_hover_text(hint).clicked() {
            panel.ask(TessellationRequest::Allow(more), writes);
        }
    });
}
