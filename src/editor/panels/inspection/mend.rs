//! The line above the table about the chosen edge: closing its gap, and what came of it.

use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Align, Layout, RichText, Ui, vec2};

use super::InspectionState;
use super::measure::sense;
use crate::editor::inspection::{CloseGap, can_close};
use crate::editor::panels::{Reads, Writes};
use crate::editor::tools::Action;
use crate::inspect::{Edge, EdgeKind, Length};

/// Height of the line, points.
const HEIGHT: f32 = 26.0;
/// Below this width what came of closing is told in the notice alone, points.
const ROOM: f32 = 90.0;

/// Shows the line.
pub(super) fn show(ui: &mut Ui, reads: &Reads, writes: &mut Writes, state: &mut InspectionState) {
    let chosen = state.chosen.edge.and_then(|key| Some((key, state.findings.edge(&key)?.clone())));
    let palette = &reads.palette;
    ui.allocate_ui_with_layout(
        vec2(ui.available_width(), HEIGHT),
        Layout::left_to_right(Align::Center),
        |ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            let Some((key, edge)) = chosen else {
                ui.label(RichText::new("Choose an edge to close its gap").small().color(palette.weak));
                return;
            };
            let numbers = numbers(&edge, reads, state);
            ui.label(RichText::new(title(&edge, &numbers)).color(palette.strong));
            if let Some(gap) = edge.gap {
                let size = Length { mm: state.findings.unit() * gap.maximum };
                ui.label(RichText::new(format!("{size} {}", sense(gap.sense))).color(palette.text));
            }
            if !can_close(&edge) {
                return;
            }
            ui.add_space(4.0);
            let key_shown = Action::CloseGap.command().and_then(|c| c.keys.first()).map(ToString::to_string);
            let hint = format!(
                "Fit the trim of one side to the other side's curve   {}",
                key_shown.unwrap_or_default()
            );
            if ui.button("Close gap").on_hover_text(hint).clicked() {
                state.close.write(CloseGap(key));
                writes.redraw.write(RequestRedraw);
            }
            ui.label(RichText::new("to").color(palette.weak));
            tolerance(ui, state);
            side(ui, &edge, &numbers, state);
            if let Some((of, text)) = &state.outcome.last
                && *of == key
                && ui.available_width() > ROOM
            {
                let label = egui::Label::new(RichText::new(text).small().color(palette.weak)).truncate();
                ui.add(label).on_hover_text(text);
            }
        },
    );
}

/// Numbers of the faces of the two sides.
fn numbers(edge: &Edge, reads: &Reads, state: &InspectionState) -> Vec<usize> {
    let number = |face: usize| {
        let entity = state.findings.face(face)?;
        reads.faces.get(entity).ok().map(|f| f.place.number)
    };
    edge.uses.iter().map(|u| number(u.curve.face).unwrap_or_default()).collect()
}

fn title(edge: &Edge, numbers: &[usize]) -> String {
    let mut faces = numbers.to_vec();
    faces.sort_unstable();
    faces.dedup();
    let list = faces.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    match edge.kind {
        EdgeKind::Shared | EdgeKind::NonManifold => format!("Faces {list}"),
        EdgeKind::Naked => format!("Naked edge of face {list}"),
        EdgeKind::Seam => format!("Seam of face {list}"),
        EdgeKind::Degenerate => format!("Point of face {list}"),
    }
}

/// How small the gap is to be.
fn tolerance(ui: &mut Ui, state: &mut InspectionState) {
    let mut exponent = state.mend.tolerance.log10();
    let field = egui::DragValue::new(&mut exponent)
        .speed(0.02)
        .range(-7.0..=0.0)
        .custom_formatter(|e, _| Length { mm: 10f64.powf(e) }.to_string())
        .custom_parser(|text| text.parse::<Length>().ok().map(|l| l.mm.log10()));
    let response = ui.add(field).on_hover_text("Largest gap that may be left. Drag, or type a length: 10nm");
    if response.changed() && exponent.is_finite() {
        state.mend.tolerance = 10f64.powf(exponent);
    }
}

/// Whose trim moves.
fn side(ui: &mut Ui, edge: &Edge, numbers: &[usize], state: &mut InspectionState) {
    let name = |side: Option<usize>| match side {
        None => "Either side moves".to_owned(),
        Some(side) => {
            let number = numbers.get(side).copied().unwrap_or_default();
            let both = numbers.iter().filter(|n| **n == number).count() > 1;
            let curve = edge.uses.get(side).map_or(0, |u| u.curve.curve + 1);
            if both { format!("Face {number}, curve {curve} moves") } else { format!("Face {number} moves") }
        }
    };
    let mut wanted = state.mend.side;
    egui::ComboBox::from_id_salt("side").width(120.0).selected_text(name(wanted)).show_ui(ui, |ui| {
        for side in [None, Some(0), Some(1)] {
            ui.selectable_value(&mut wanted, side, name(side));
        }
    });
    if state.mend.side != wanted {
        state.mend.side = wanted;
    }
}
