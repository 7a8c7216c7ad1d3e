//! The model tree: models > parts > faces > loops, with visibility, selection and search.

use bevy::prelude::*;
use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Frame, Margin, Rect, Response, RichText, Sense, Ui, pos2, vec2};

use super::icon::{self, Icon};
use super::tree_look::{look, paint_row};
use super::tree_rows::{Row, Rows};
use super::{Owned, Reads, Writes};
use crate::editor::camera::CameraRequest;
use crate::editor::selection::{SelectMode, SelectRequest, VisibilityRequest};
use crate::editor::theme::size;
use crate::editor::tools::Modifiers;

/// What the tree remembers.
#[derive(Default)]
pub struct TreeState {
    filter: String,
    pub(super) rows: Rows,
    /// Where a range selection starts.
    anchor: Option<Entity>,
    /// The selection already scrolled to.
    revealed: u64,
    pub(super) focus_search: bool,
}

/// Shows the panel.
pub(super) fn show(root: &mut Ui, reads: &Reads, writes: &mut Writes, owned: &mut Owned) {
    let frame = Frame::new().inner_margin(Margin { left: 0, right: 0, top: 8, bottom: 0 });
    let panel = egui::Panel::left("tree").frame(frame).default_size(270.0).min_size(180.0).max_size(520.0);
    panel.show(root, |ui| {
        search(ui, reads, &mut owned.state.tree);
        let state = &mut owned.state.tree;
        state.rows.update(&reads.scene, &state.filter, |e| reads.faces.get(e).ok());
        if state.rows.rows.is_empty() {
            ui.add_space(24.0);
            let text = if reads.scene.is_empty() { "Nothing open" } else { "No face matches" };
            ui.vertical_centered(|ui| ui.label(RichText::new(text).color(reads.palette.weak)));
            ui.allocate_space(ui.available_size());
            return;
        }
        rows(ui, reads, writes, owned);
    });
}

fn search(ui: &mut Ui, reads: &Reads, state: &mut TreeState) {
    Frame::new().inner_margin(Margin { left: 10, right: 10, top: 0, bottom: 8 }).show(ui, |ui| {
        let edit = egui::TextEdit::singleline(&mut state.filter)
            .hint_text("Find by number, name, layer or D-number")
            .margin(Margin { left: 26, right: 8, top: 5, bottom: 5 })
            .desired_width(f32::INFINITY);
        let response = ui.add(edit);
        let place = Rect::from_min_size(response.rect.min, vec2(26.0, response.rect.height()));
        icon::paint(ui.painter(), place, Icon::Search, reads.palette.weak);
        if std::mem::take(&mut state.focus_search) {
            response.request_focus();
        }
    });
}

fn rows(ui: &mut Ui, reads: &Reads, writes: &mut Writes, owned: &mut Owned) {
    let height = size::ROW;
    ui.spacing_mut().item_spacing.y = 0.0;
    let mut area = egui::ScrollArea::vertical().auto_shrink(false);
    if let Some(offset) = reveal(ui, owned, height) {
        area = area.vertical_scroll_offset(offset);
    }
    let mut hovered = None;
    let count = owned.state.tree.rows.rows.len();
    area.show_rows(ui, height, count, |ui, range| {
        for index in range {
            let Some(row) = owned.state.tree.rows.rows.get(index).copied() else { continue };
            if let Some(face) = show_row(ui, row, reads, writes, owned) {
                hovered = Some(face);
            }
        }
    });
    let over_panel = ui.ui_contains_pointer();
    if over_panel && owned.selection.hovered != hovered {
        owned.selection.hovered = hovered;
        writes.redraw.write(RequestRedraw);
    }
}

/// Scroll offset that brings a face selected elsewhere into view.
fn reveal(ui: &Ui, owned: &mut Owned, height: f32) -> Option<f32> {
    if owned.state.tree.revealed == owned.selection.revision {
        return None;
    }
    owned.state.tree.revealed = owned.selection.revision;
    let last = *owned.selection.faces().last()?;
    if owned.state.tree.anchor == Some(last) {
        return None;
    }
    owned.state.tree.anchor = Some(last);
    let index = owned.state.tree.rows.rows.iter().position(|r| *r == Row::Face(last))?;
    Some((index as f32 * height - 0.4 * ui.available_height()).max(0.0))
}

fn show_row(ui: &mut Ui, row: Row, reads: &Reads, writes: &mut Writes, owned: &mut Owned) -> Option<Entity> {
    let faces = faces_of(row, reads);
    let Some(look) = look(row, &faces, reads, owned) else {
        ui.allocate_space(vec2(ui.available_width(), size::ROW));
        return None;
    };
    let width = ui.available_width();
    let (rect, response) = ui.allocate_exact_size(vec2(width, size::ROW), Sense::click());
    let hover_elsewhere = matches!(row, Row::Face(f) if owned.selection.hovered == Some(f));
    paint_row(ui, rect, &look, response.hovered() || hover_elsewhere, reads);

    let chevron = Rect::from_min_size(
        pos2(rect.min.x + 4.0 + 14.0 * look.depth, rect.min.y),
        vec2(18.0, rect.height()),
    );
    let eye = Rect::from_min_size(pos2(rect.max.x - 32.0, rect.min.y), vec2(26.0, rect.height()));
    if response.clicked()
        && let Some(pointer) = response.interact_pointer_pos()
    {
        if look.open.is_some() && chevron.contains(pointer) {
            toggle_open(row, reads, &mut owned.state.tree.rows);
            writes.redraw.write(RequestRedraw);
        } else if look.eye.is_some() && eye.contains(pointer) {
            let request =
                if look.eye == Some(true) { VisibilityRequest::Hide } else { VisibilityRequest::Show };
            writes.visibility.write(request(faces.clone()));
            writes.redraw.write(RequestRedraw);
        } else {
            select(row, &faces, reads.left.held, writes, owned);
        }
    }
    if response.double_clicked() {
        fit(&faces, reads, writes);
    }
    context_menu(&response, &faces, reads, writes, owned);
    match row {
        Row::Face(face) | Row::Loop(face, _) if response.hovered() => Some(face),
        _ => None,
    }
}

/// The faces a row stands for.
fn faces_of(row: Row, reads: &Reads) -> Vec<Entity> {
    match row {
        Row::Model(m) => reads.scene.models.get(m).map(|m| m.faces().collect()).unwrap_or_default(),
        Row::Part(m, p) => reads
            .scene
            .models
            .get(m)
            .and_then(|m| m.parts.get(p))
            .map(|p| p.faces.clone())
            .unwrap_or_default(),
        Row::Face(face) | Row::Loop(face, _) => vec![face],
    }
}

fn toggle_open(row: Row, reads: &Reads, rows: &mut Rows) {
    match row {
        Row::Face(face) => rows.toggle(|r| &mut r.open_faces, face),
        Row::Model(m) => {
            if let Some(model) = reads.scene.models.get(m) {
                rows.toggle(|r| &mut r.closed, model.entity);
            }
        }
        Row::Part(m, p) => {
            if let Some(part) = reads.scene.models.get(m).and_then(|m| m.parts.get(p)) {
                rows.toggle(|r| &mut r.closed, part.entity);
            }
        }
        Row::Loop(..) => {}
    }
}

/// Click: these. Ctrl: toggle these. Shift: everything from the last clicked face to this one.
fn select(row: Row, faces: &[Entity], held: Modifiers, writes: &mut Writes, owned: &mut Owned) {
    let tree = &mut owned.state.tree;
    let request = match (row, tree.anchor) {
        (Row::Face(face), Some(anchor)) if held.shift => {
            let place = |entity| tree.rows.rows.iter().position(|r| *r == Row::Face(entity));
            let range = match (place(anchor), place(face)) {
                (Some(a), Some(b)) => a.min(b)..=a.max(b),
                _ => 0..=0,
            };
            let between = tree.rows.rows[range].iter().filter_map(|r| match r {
                Row::Face(f) => Some(*f),
                _ => None,
            });
            let mode = if held.ctrl { SelectMode::Add } else { SelectMode::Replace };
            SelectRequest { faces: between.collect(), mode }
        }
        _ => {
            tree.anchor = faces.last().copied();
            let mode = if held.ctrl { SelectMode::Toggle } else { SelectMode::Replace };
            SelectRequest { faces: faces.to_vec(), mode }
        }
    };
    writes.select.write(request);
    writes.redraw.write(RequestRedraw);
}

fn fit(faces: &[Entity], reads: &Reads, writes: &mut Writes) {
    let boxes = reads.faces.iter_many(faces).filter_map(|f| f.derived).map(|d| d.0.bounds);
    let bounds = boxes.fold(crate::kernel::view::Bounds::EMPTY, |b, other| b.union(other));
    writes.camera.write(CameraRequest::FitBounds(bounds));
    writes.redraw.write(RequestRedraw);
}

fn context_menu(response: &Response, faces: &[Entity], reads: &Reads, writes: &mut Writes, owned: &Owned) {
    response.context_menu(|ui| {
        // On a selected row the menu is about the whole selection.
        let selected = faces.iter().all(|f| owned.selection.contains(*f)) && !faces.is_empty();
        let faces = if selected { owned.selection.faces().to_vec() } else { faces.to_vec() };
        let item = |ui: &mut Ui, label: &str| {
            let clicked = ui.add(egui::Button::new(label).min_size(vec2(140.0, 24.0))).clicked();
            if clicked {
                ui.close();
            }
            clicked
        };
        let request = if item(ui, "Fit") {
            fit(&faces, reads, writes);
            None
        } else if item(ui, "Select") {
            writes.select.write(SelectRequest { faces, mode: SelectMode::Replace });
            None
        } else if item(ui, "Isolate") {
            Some(VisibilityRequest::Isolate(faces))
        } else if item(ui, "Hide") {
            Some(VisibilityRequest::Hide(faces))
        } else if item(ui, "Show") {
            Some(VisibilityRequest::Show(faces))
        } else if item(ui, "Show all") {
            Some(VisibilityRequest::ShowAll)
        } else {
            return;
        };
        if let Some(request) = request {
            writes.visibility.write(request);
        }
        writes.redraw.write(RequestRedraw);
    });
}
