//! The properties of what is selected.

use bevy::prelude::Entity;
use bevy_egui::egui::{
    self, Align2, CornerRadius, FontId, Frame, Grid, Label, Margin, RichText, Sense, Ui, vec2,
};

use super::format::{coordinate, count, number, plural};
use super::tree_look::srgb;
use super::{FaceViewItem, Reads};
use crate::editor::selection::Selection;
use crate::editor::theme::size as text;
use crate::kernel::nurbs::KnotVector;
use crate::kernel::view::Bounds;

/// Shows the panel.
pub(super) fn show(root: &mut Ui, reads: &Reads, selection: &Selection) {
    let frame = Frame::new().inner_margin(Margin { left: 14, right: 10, top: 10, bottom: 8 });
    let panel =
        egui::Panel::right("properties").frame(frame).default_size(280.0).min_size(220.0).max_size(480.0);
    panel.show(root, |ui| {
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| match selection.faces() {
            [] => scene(ui, reads),
            [face] => single(ui, reads, *face),
            faces => several(ui, reads, faces),
        });
    });
}

fn section(ui: &mut Ui, reads: &Reads, title: &str) {
    ui.add_space(10.0);
    ui.label(RichText::new(title).small().color(reads.palette.weak));
    ui.add_space(2.0);
}

fn rows(ui: &mut Ui, id: &str, reads: &Reads, rows: &[(&str, String)]) {
    Grid::new(id).num_columns(2).min_col_width(92.0).spacing(vec2(10.0, 5.0)).show(ui, |ui| {
        for (label, value) in rows {
            ui.label(RichText::new(*label).color(reads.palette.weak));
            ui.add(Label::new(RichText::new(value).color(reads.palette.strong)).selectable(true).wrap());
            ui.end_row();
        }
    });
}

fn bounds_table(ui: &mut Ui, reads: &Reads, bounds: Bounds) {
    if bounds.is_empty() {
        return;
    }
    section(ui, reads, "Bounding box");
    let size = bounds.max - bounds.min;
    let cell = ((ui.available_width() - 18.0) / 3.0).clamp(40.0, 110.0);
    let line = |ui: &mut Ui, name: &str, cells: [String; 3], head: bool| {
        let (rect, _) = ui.allocate_exact_size(vec2(18.0 + 3.0 * cell, 20.0), Sense::hover());
        let (font, color) = match head {
            true => (FontId::proportional(text::SMALL), reads.palette.weak),
            false => (FontId::proportional(text::BODY), reads.palette.strong),
        };
        let painter = ui.painter();
        painter.text(
            rect.left_center(),
            Align2::LEFT_CENTER,
            name,
            FontId::proportional(text::BODY),
            reads.palette.weak,
        );
        for (k, value) in cells.iter().enumerate() {
            let right = rect.left_center() + vec2(18.0 + cell * (k + 1) as f32 - 4.0, 0.0);
            painter.text(right, Align2::RIGHT_CENTER, value, font.clone(), color);
        }
    };
    line(ui, "", ["min", "max", "size"].map(str::to_owned), true);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        line(ui, name, [bounds.min[axis], bounds.max[axis], size[axis]].map(coordinate), false);
    }
}

fn scene(ui: &mut Ui, reads: &Reads) {
    ui.heading("Scene");
    if reads.scene.is_empty() {
        ui.add_space(6.0);
        ui.label(RichText::new("Nothing open").color(reads.palette.weak));
        return;
    }
    let all: Vec<Entity> = reads.scene.faces().collect();
    let (mut loops, mut curves, mut area) = (0, 0, Some(0.0));
    for FaceViewItem { authored, derived, .. } in reads.faces.iter_many(&all) {
        loops += authored.loops.len();
        curves += derived.map_or(0, |d| d.0.curves);
        area = area.zip(derived.and_then(|d| d.0.measures()).map(|m| m.area)).map(|(a, b)| a + b);
    }
    for (index, entry) in reads.scene.models.iter().enumerate() {
        let Ok(model) = reads.models.get(entry.entity) else { continue };
        section(ui, reads, "Model");
        let origin = &model.report.origin;
        let mut list = vec![("Name", model.name.clone())];
        if !origin.is_empty() {
            list.push(("Origin", origin.clone()));
        }
        list.push(("Unit", model.unit.name.clone()));
        list.push(("Parts", count(entry.parts.len())));
        list.push(("Faces", count(entry.faces().count())));
        rows(ui, &format!("model {index}"), reads, &list);
    }
    section(ui, reads, "Totals");
    let unit = unit_of_all(reads);
    let area = area.map_or("–".into(), |a| format!("{} {unit}²", number(a)));
    rows(
        ui,
        "totals",
        reads,
        &[
            ("Faces", count(all.len())),
            ("Loops", count(loops)),
            ("Trim curves", count(curves)),
            ("Area", area),
        ],
    );
    let bounds =
        reads.faces.iter().filter_map(|f| f.derived).fold(Bounds::EMPTY, |b, d| b.union(d.0.best_bounds()));
    bounds_table(ui, reads, bounds);
}

/// The unit, if all models have the same.
fn unit_of_all(reads: &Reads) -> String {
    let mut units = reads.models.iter().map(|m| m.unit.name.clone());
    let first = units.next().unwrap_or_default();
    if units.all(|u| u == first) { first } else { "units".into() }
}

fn direction(knots: &KnotVector) -> String {
    let (start, end) = knots.domain();
    format!("{} to {}", number(start), number(end))
}

fn spans(knots: &KnotVector) -> usize {
    knots.breaks().len().saturating_sub(1)
}

fn single(ui: &mut Ui, reads: &Reads, face: Entity) {
    let Ok(FaceViewItem { authored, place, derived, .. }) = reads.faces.get(face) else { return };
    let (record, surface) = (&authored.attributes, &authored.surface);
    let unit = reads.models.get(place.model).map(|m| m.unit.name.clone()).unwrap_or_default();
    ui.heading(format!("Face {}", place.number));
    let mut list = Vec::new();
    if let Some(name) = &record.name {
        list.push(("Name", name.clone()));
    }
    if let Some(source) = &record.source {
        list.push(("Source", format!("entity {} at D{}", source.entity, source.id)));
    }
    if let Some(layer) = record.layer {
        list.push(("Layer", layer.to_string()));
    }
    list.push(("Orientation", if record.reversed { "reversed".into() } else { "forward".into() }));
    section(ui, reads, "Face");
    rows(ui, "face", reads, &list);
    if let Some(colour) = record.colour {
        ui.horizontal(|ui| {
            ui.add_sized(
                vec2(92.0, 18.0),
                Label::new(RichText::new("Colour").color(reads.palette.weak)).halign(egui::Align::LEFT),
            );
            let (rect, _) = ui.allocate_exact_size(vec2(34.0, 14.0), Sense::hover());
            let color = srgb(colour);
            ui.painter().rect_filled(rect, CornerRadius::same(3), color);
            let text = format!("#{:02x}{:02x}{:02x}", color.r(), color.g(), color.b());
            ui.label(RichText::new(text).color(reads.palette.strong));
        });
    }
    section(ui, reads, "Surface");
    let (nu, nv) = surface.counts();
    let rational = if surface.is_rational() { "rational" } else { "polynomial" };
    rows(
        ui,
        "surface",
        reads,
        &[
            ("Degree", format!("{} × {}", surface.knots_u().degree(), surface.knots_v().degree())),
            ("Control points", format!("{nu} × {nv}")),
            ("Weights", rational.into()),
            ("Spans", format!("{} × {}", spans(surface.knots_u()), spans(surface.knots_v()))),
            ("u", direction(surface.knots_u())),
            ("v", direction(surface.knots_v())),
        ],
    );
    knots(ui, reads, "Knots in u", surface.knots_u());
    knots(ui, reads, "Knots in v", surface.knots_v());
    section(ui, reads, "Trimming");
    let trim_curves = || reads.records.loops(face).flat_map(|l| &l.curves);
    let curves = trim_curves().count();
    let mut list = vec![("Loops", count(authored.loops.len())), ("Curves", count(curves))];
    if authored.loops.is_empty() {
        list = vec![("Loops", "none: whole domain".into())];
    } else {
        let degrees = trim_curves().map(|c| c.degree());
        let (low, high) = degrees.fold((usize::MAX, 0), |(l, h), d| (l.min(d), h.max(d)));
        list.push(("Degrees", if low == high { low.to_string() } else { format!("{low} to {high}") }));
        let rational = trim_curves().filter(|c| c.is_rational()).count();
        list.push(("Rational", format!("{} of {}", count(rational), count(curves))));
    }
    if let Some(derived) = derived {
        list.push((
            "Area",
            derived.0.measures().map_or("–".into(), |m| format!("{} {unit}²", number(m.area))),
        ));
        if let Some(failure) = &derived.0.failure {
            list.push(("Not drawn", failure.clone()));
        }
    }
    rows(ui, "trimming", reads, &list);
    if let Some(derived) = derived {
        bounds_table(ui, reads, derived.0.best_bounds());
    }
}

fn knots(ui: &mut Ui, reads: &Reads, title: &str, knots: &KnotVector) {
    let text = RichText::new(format!("{title} ({})", knots.as_slice().len())).color(reads.palette.weak);
    egui::CollapsingHeader::new(text).id_salt(title).show(ui, |ui| {
        let breaks = knots.breaks();
        const MOST: usize = 200;
        let multiplicity = |k: f64| knots.as_slice().iter().filter(|x| **x == k).count();
        let list: Vec<String> =
            breaks.iter().take(MOST).map(|k| format!("{} ({}×)", number(*k), multiplicity(*k))).collect();
        let more = if breaks.len() > MOST { ", …" } else { "" };
        ui.add(Label::new(list.join(",  ") + more).selectable(true).wrap());
    });
}

fn several(ui: &mut Ui, reads: &Reads, faces: &[Entity]) {
    ui.heading(plural(faces.len(), "face"));
    let (mut loops, mut curves, mut area, mut bounds) = (0, 0, Some(0.0), Bounds::EMPTY);
    for FaceViewItem { authored, derived, .. } in reads.faces.iter_many(faces) {
        loops += authored.loops.len();
        curves += derived.map_or(0, |d| d.0.curves);
        area = area.zip(derived.and_then(|d| d.0.measures()).map(|m| m.area)).map(|(a, b)| a + b);
        bounds = derived.map_or(bounds, |d| bounds.union(d.0.best_bounds()));
    }
    section(ui, reads, "Selection");
    let area = area.map_or("–".into(), |a| format!("{} {}²", number(a), unit_of_all(reads)));
    rows(ui, "several", reads, &[("Loops", count(loops)), ("Trim curves", count(curves)), ("Area", area)]);
    bounds_table(ui, reads, bounds);
}
