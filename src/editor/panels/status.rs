//! The status bar: what is under the pointer on the left, figures on the right.

use bevy_egui::egui::{self, Align, Frame, Label, Layout, Margin, RichText, Ui};

use super::Reads;
use super::format::{bytes, coordinate, plural};
use crate::editor::selection::Selection;

/// Shows the bar.
pub(super) fn show(root: &mut Ui, reads: &Reads, selection: &Selection) {
    let frame = Frame::new().fill(reads.palette.bar).inner_margin(Margin::symmetric(10, 3));
    egui::Panel::bottom("status").frame(frame).show(root, |ui| {
        ui.horizontal(|ui| {
            ui.style_mut().override_text_style = Some(egui::TextStyle::Small);
            match (reads.editing.refused(), reads.saving.path()) {
                (Some(reason), _) => ui.label(RichText::new(reason).color(reads.palette.warning)),
                (None, Some(path)) => {
                    ui.label(RichText::new(format!("Saving {}", path.display())).color(reads.palette.text))
                }
                (None, None) => ui.label(RichText::new(under_pointer(reads)).color(reads.palette.text)),
            };
            if !selection.is_empty() {
                separator(ui, reads);
                let text = format!("{} selected", plural(selection.faces().len(), "face"));
                ui.label(RichText::new(text).color(reads.palette.accent));
            }
            let (all, serious) = (reads.problems.count(), reads.problems.serious_count());
            if all > 0 {
                separator(ui, reads);
                let (text, color) = match serious {
                    0 => (plural(all, "note"), reads.palette.weak),
                    _ => (plural(serious, "problem"), reads.palette.warning),
                };
                ui.label(RichText::new(format!("{text} (F3)")).color(color));
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| figures(ui, reads));
        });
    });
}

fn under_pointer(reads: &Reads) -> String {
    let Some((_, Some(hit))) = reads.picker.answer.filter(|_| reads.picker.wanted.is_some()) else {
        return if reads.scene.is_empty() {
            "Open a file with Ctrl+O, or drop one here".into()
        } else {
            "F1 shows keys and mouse".into()
        };
    };
    let number = reads.faces.get(hit.face).map_or(0, |f| f.place.number);
    let p = hit.position;
    format!(
        "Face {number}    x {}  y {}  z {}    u {:.5}  v {:.5}",
        coordinate(p.x),
        coordinate(p.y),
        coordinate(p.z),
        hit.uv.x,
        hit.uv.y
    )
}

fn figures(ui: &mut Ui, reads: &Reads) {
    let figures = *reads.figures.lock();
    let faces = reads.scene.face_count();
    let curves = reads.bounds.curves;
    let memory = match (reads.memory.resident, figures.gpu_bytes) {
        (Some(resident), 0) => bytes(resident),
        (Some(resident), gpu) => format!("{} + {} GPU", bytes(resident), bytes(gpu)),
        (None, gpu) => format!("{} GPU", bytes(gpu)),
    };
    let gpu = figures.gpu_ms.map_or("–".to_owned(), |ms| format!("{ms:.1} ms"));
    let samples = if figures.samples <= 1 && (figures.resolution < 1.0 || figures.triangles) {
        let from = if figures.triangles { "Triangles, " } else { "" };
        format!("{from}{:.0} % resolution", 100.0 * figures.resolution)
    } else {
        format!("{} / {} samples", figures.samples, figures.samples_wanted)
    };
    let entries = [
        (format!("Frame {:.1} ms", figures.frame_ms), "Time the last frame took; at rest no frame is drawn"),
        (format!("GPU {gpu}"), "Time the GPU took for the model in the last frame"),
        (memory, "Memory of the program and of the model on the GPU"),
        (plural(faces, "face"), "Faces of all open models"),
        (plural(curves, "trim curve"), "Trim curves of all open faces"),
        (samples, "Samples per pixel; the picture refines while nothing moves"),
    ];
    let edit = figures.edit;
    let cost = format!("Edit {:.2} ms, {} uploaded", 1e3 * edit.time.as_secs_f64(), bytes(edit.bytes));
    let hint = "Processor time from the last edit to its upload, and the bytes uploaded";
    let first = (edit.edits > 0).then_some((cost, hint));
    // From the right end on; what has no room is left out, so that nothing lies on what is said on the left.
    for (i, (text, hint)) in first.into_iter().chain(entries).enumerate() {
        let text = RichText::new(text).color(reads.palette.weak);
        let galley = egui::WidgetText::from(text.clone()).into_galley(
            ui,
            Some(egui::TextWrapMode::Extend),
            f32::INFINITY,
            egui::TextStyle::Small,
        );
        if galley.size().x + 3.0 * ui.spacing().item_spacing.x + 8.0 > ui.available_width() {
            break;
        }
        if i > 0 {
            separator(ui, reads);
        }
        ui.add(Label::new(text)).on_hover_text(hint);
    }
}

fn separator(ui: &mut Ui, reads: &Reads) {
    ui.label(RichText::new("·").color(reads.palette.weak));
}
