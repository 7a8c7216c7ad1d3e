//! How triangles are made: tolerance, angle, guaranteed or estimated.

use bevy_egui::egui::{DragValue, Grid, Ui, vec2};

use super::{TessellationPanel, toggle, weak};
use crate::editor::panels::{Reads, Writes};
use crate::editor::tessellation::TessellationChoices;
use crate::inspect::Length;

/// Change of the tolerance per point of dragging, as a part of it.
const SPEED: f64 = 0.01;
/// The angle that is offered first, degrees.
const ANGLE: f64 = 15.0;

/// Shows them.
pub(super) fn show(ui: &mut Ui, reads: &Reads, writes: &mut Writes, panel: &mut TessellationPanel) {
    let before = &reads.settings.tessellation;
    let mut now = before.clone();
    Grid::new("tessellation choices").num_columns(2).min_col_width(70.0).spacing(vec2(10.0, 4.0)).show(
        ui,
        |ui| {
            weak(ui, reads, "Tolerance");
            ui.horizontal(|ui| tolerance(ui, reads, &mut now, panel.state.size_mm()));
            ui.end_row();
            weak(ui, reads, "Angle");
            ui.horizontal(|ui| angle(ui, reads, &mut now));
            ui.end_row();
            weak(ui, reads, "Error is");
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 2.0;
                let kinds = [
                    (true, "Guaranteed", "Bounds prove that no triangle is farther off than the tolerance"),
                    (false, "Estimated", "Judged at points of the surface: fewer triangles, no proof"),
                ];
                for (conservative, name, hint) in kinds {
                    if toggle(ui, &reads.palette, now.conservative == conservative, true, name, hint) {
                        now.conservative = conservative;
                    }
                }
            });
            ui.end_row();
        },
    );
    if now != *before {
        panel.choose(now, writes);
    }
}

fn tolerance(ui: &mut Ui, reads: &Reads, choices: &mut TessellationChoices, size_mm: f64) {
    let shown = choices.tolerance(size_mm);
    let mut value = shown;
    let field = DragValue::new(&mut value)
        .speed(SPEED * shown)
        .update_while_editing(false)
        .custom_formatter(|mm, _| Length { mm }.to_string())
        .custom_parser(|text| text.parse::<Length>().ok().map(|l| l.mm));
    let hint = "Largest distance between triangles and exact surfaces. Drag, or type a length: 10um, 0.5mm";
    let response = ui.add_sized(vec2(92.0, 22.0), field).on_hover_text(hint);
    // What is shown is rounded: looking at it without a change must not change it.
    if response.changed() && value.is_finite() && value > 0.0 && (value - shown).abs() > 1e-9 * shown {
        choices.tolerance_mm = Some(value);
    }
    let automatic = choices.tolerance_mm.is_none();
    if toggle(ui, &reads.palette, automatic, true, "Automatic", "A thousandth of the size of the model") {
        choices.tolerance_mm = if automatic { Some(shown) } else { None };
    }
}

fn angle(ui: &mut Ui, reads: &Reads, choices: &mut TessellationChoices) {
    let mut value = choices.angle_deg.unwrap_or(ANGLE);
    let field = DragValue::new(&mut value)
        .speed(0.2)
        .range(0.5..=90.0)
        .max_decimals(1)
        .suffix("°")
        .update_while_editing(false);
    let on = choices.angle_deg.is_some();
    let hint = "Largest angle between the normals of the surface within a triangle";
    let response = ui.add_enabled_ui(on, |ui| ui.add_sized(vec2(92.0, 22.0), field)).inner;
    if response.on_hover_text(hint).changed() {
        choices.angle_deg = Some(value);
    }
    if toggle(ui, &reads.palette, !on, true, "Any", "Only the tolerance counts") {
        choices.angle_deg = if on { None } else { Some(ANGLE) };
    }
}
