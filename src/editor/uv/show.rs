//! The panel itself: header, canvas, line of fields. Draws from what is cached and writes messages.

use std::sync::Arc;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::window::RequestRedraw;
use bevy_egui::egui::{
    self, Align2, CursorIcon, FontId, Frame, Margin, Mesh, Painter, Rect, RichText, Sense, Shape, Ui,
};
use glam::DVec2;

use super::colors::Colors;
use super::draw_structure::{self, Structure};
use super::geometry::UvGeometry;
use super::gesture::Gesture;
use super::hit::ShownPoints;
use super::panel::{Overlay, UvPanel};
use super::view::UvView;
use super::{draw_hand, draw_loops, draw_plane, draw_problems, fields, fill, header, menu};
use crate::editor::editing::{Clipboard, EditRequest};
use crate::editor::elements::{ActiveFace, Element, ElementRequest, ElementSelection, FaceInHand};
use crate::editor::picking::Picker;
use crate::editor::selection::SelectMode;
use crate::editor::settings::Settings;
use crate::editor::theme::Palette;
use crate::editor::tools::{Action, CommandRequest};

/// What the panel reads and writes.
#[derive(SystemParam)]
pub struct UvParams<'w> {
    pub(super) panel: ResMut<'w, UvPanel>,
    pub(super) cache: ResMut<'w, UvDrawing>,
    pub(super) settings: Res<'w, Settings>,
    pub(super) palette: Res<'w, Palette>,
    pub(super) active: Res<'w, ActiveFace>,
    pub(super) geometry: ResMut<'w, UvGeometry>,
    pub(super) selection: Res<'w, ElementSelection>,
    pub(super) picker: Res<'w, Picker>,
    pub(super) clipboard: ResMut<'w, Clipboard>,
    pub(super) out: ResMut<'w, Outbox>,
}

/// Messages of the panel on their way: panels share one system, which can write each kind only once.
#[derive(Resource, Debug, Default)]
pub struct Outbox {
    commands: Vec<Action>,
    elements: Vec<ElementRequest>,
    edits: Vec<EditRequest>,
    redraw: bool,
}

/// Sends what the panel wrote; it is served in the next frame.
pub(super) fn send(
    mut out: ResMut<Outbox>,
    mut commands: MessageWriter<CommandRequest>,
    mut elements: MessageWriter<ElementRequest>,
    mut edits: MessageWriter<EditRequest>,
    mut redraw: MessageWriter<RequestRedraw>,
) {
    let out = out.bypass_change_detection();
    let any = out.redraw || !(out.commands.is_empty() && out.elements.is_empty() && out.edits.is_empty());
    commands.write_batch(out.commands.drain(..).map(CommandRequest));
    elements.write_batch(out.elements.drain(..));
    edits.write_batch(out.edits.drain(..));
    if any {
        out.redraw = false;
        redraw.write(RequestRedraw);
    }
}

/// What a drawing depends on.
#[derive(Debug, Clone, PartialEq)]
struct DrawingKey {
    view: UvView,
    geometry: u64,
    face: u64,
    derived: u64,
    selection: u64,
    shown: ShownPoints,
    overlay: Overlay,
    light: bool,
    pixels_per_point: f32,
}

/// The canvas as triangles, kept until something on it changes.
#[derive(Resource, Default)]
pub struct UvDrawing {
    key: Option<DrawingKey>,
    meshes: Vec<Arc<Mesh>>,
    structure: Structure,
}

impl UvParams<'_> {
    /// The active face.
    pub fn active(&self) -> &ActiveFace {
        &self.active
    }

    /// Asks for a change of the face.
    pub(super) fn edit(&mut self, request: EditRequest) {
        self.out.edits.push(request);
    }

    /// Asks for another selection of elements.
    pub(super) fn select(&mut self, elements: Vec<Element>, mode: SelectMode) {
        self.out.elements.push(ElementRequest { elements, mode });
    }

    /// Asks for a command.
    pub(super) fn command(&mut self, action: Action) {
        self.out.commands.push(action);
    }
}

/// Shows the panel below or beside the viewport, if it is open.
pub fn show(root: &mut Ui, params: &mut UvParams) {
    if !params.settings.uv {
        if params.panel.open {
            params.panel.open = false;
            params.panel.pointer = None;
            params.panel.gesture = Gesture::None;
        }
        return;
    }
    let frame = Frame::new().inner_margin(Margin::ZERO);
    let room = root.available_rect_before_wrap();
    let panel = if params.settings.uv_beside {
        egui::Panel::right("uv beside")
            .default_size(0.46 * room.width())
            .min_size(240.0)
            .max_size((room.width() - 160.0).max(240.0))
    } else {
        egui::Panel::bottom("uv below")
            .default_size(0.48 * room.height())
            .min_size(180.0)
            .max_size((room.height() - 120.0).max(180.0))
    };
    panel.frame(frame).resizable(true).show(root, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        header::show(ui, params);
        let rest = ui.available_rect_before_wrap();
        let line = Rect::from_min_max(egui::pos2(rest.left(), rest.bottom() - fields::HEIGHT_PX), rest.max);
        let canvas = Rect::from_min_max(rest.min, egui::pos2(rest.right(), line.top()));
        show_canvas(ui, canvas, params);
        fields::show(ui, line, params);
        ui.advance_cursor_after_rect(rest);
    });
}

fn show_canvas(ui: &mut Ui, rect: Rect, params: &mut UvParams) {
    let response = ui.allocate_rect(rect, Sense::hover());
    let (min, size) = (
        DVec2::new(rect.min.x.into(), rect.min.y.into()),
        DVec2::new(rect.width().into(), rect.height().into()),
    );
    if params.panel.place(min, size) {
        params.out.redraw = true;
        params.panel.attend(params.active.face.as_ref());
        params.geometry.update(params.active.face.as_ref(), &params.panel.view);
    }
    let colors = Colors::of(&params.palette);
    let painter = ui.painter().with_clip_rect(rect);
    let Some(face) = params.active.face.clone() else {
        painter.rect_filled(rect, 0.0, colors.canvas);
        let text = "Select a face to see and edit its trim loops";
        painter.text(
            rect.center(),
            Align2::CENTER_CENTER,
            text,
            FontId::proportional(13.0),
            params.palette.weak,
        );
        return;
    };
    redraw(ui, &face, params, &colors);
    for mesh in &params.cache.meshes {
        painter.add(Shape::mesh(Arc::clone(mesh)));
    }
    let panel = &*params.panel;
    draw_structure::numbers(&painter, &params.cache.structure, &colors);
    draw_loops::weights(&painter, &panel.view, &face, &panel.shown, &colors);
    if let Some(element) = params.selection.hovered.filter(|_| !matches!(panel.gesture, Gesture::Drag(_))) {
        draw_loops::hovered(&painter, &panel.view, &face, &params.geometry, element, &colors);
    }
    let in_space = params.picker.answer.and_then(|a| a.1).filter(|hit| hit.face == face.entity);
    if let Some(hit) = in_space.filter(|_| panel.pointer.is_none() && params.picker.wanted.is_some()) {
        draw_hand::crosshair(&painter, panel, hit.uv, colors.snap);
    }
    draw_problems::draw(&painter, &panel.view, &face.problems, &params.palette, &colors);
    draw_hand::draw(&painter, panel, &colors);
    draw_plane::rulers(&painter, &panel.view, panel.pointer, &colors, params.palette.accent);
    captions(&painter, rect, params, &colors);
    if params.panel.pointer.is_some() && !ui.ctx().any_popup_open() {
        ui.ctx().set_cursor_icon(cursor(&params.panel));
    }
    menu::show(ui, &response, &face, params);
}

/// Makes the kept triangles anew if anything on the canvas changed.
fn redraw(ui: &Ui, face: &FaceInHand, params: &mut UvParams, colors: &Colors) {
    let key = DrawingKey {
        view: params.panel.view,
        geometry: params.geometry.revision,
        face: params.active.revision,
        derived: params.active.derived_revision,
        selection: params.selection.revision,
        shown: params.panel.shown.clone(),
        overlay: params.panel.overlay,
        light: params.palette.light,
        pixels_per_point: ui.ctx().pixels_per_point(),
    };
    if params.cache.key.as_ref() == Some(&key) {
        return;
    }
    let (panel, geometry, selection) = (&*params.panel, &*params.geometry, &*params.selection);
    let view = &panel.view;
    let mut shapes = Vec::new();
    draw_plane::ground(&mut shapes, view, &face.surface, colors);
    let row_px = 1.0 / f64::from(key.pixels_per_point.max(0.5));
    shapes.push(Shape::mesh(fill::inside(&geometry.chains, view, row_px, colors.inside)));
    draw_plane::lines(&mut shapes, view, &face.surface, colors);
    let derived = face.derived.as_ref().and_then(|d| d.face.as_deref());
    let structure = derived.map(|f| draw_structure::draw(&mut shapes, view, f, panel.overlay, colors));
    draw_loops::curves(&mut shapes, view, geometry, selection, colors);
    draw_loops::points(&mut shapes, view, face, selection, &panel.shown, colors);
    let clip_rect = draw_plane::canvas(view);
    let clipped = shapes.into_iter().map(|shape| egui::epaint::ClippedShape { clip_rect, shape }).collect();
    let primitives = ui.ctx().tessellate(clipped, key.pixels_per_point);
    let meshes = primitives.into_iter().filter_map(|p| match p.primitive {
        egui::epaint::Primitive::Mesh(mesh) => Some(Arc::new(mesh)),
        egui::epaint::Primitive::Callback(_) => None,
    });
    params.cache.meshes = meshes.collect();
    params.cache.structure = structure.unwrap_or_default();
    params.cache.key = Some(key);
}

fn cursor(panel: &UvPanel) -> CursorIcon {
    match &panel.gesture {
        Gesture::Pan { moved: true, .. } => CursorIcon::Grabbing,
        Gesture::Drag(_) => CursorIcon::Grabbing,
        _ if panel.tool.draws() => CursorIcon::Crosshair,
        _ if panel.tool.takes_place() => CursorIcon::Cell,
        _ if panel.hit.is_some() => CursorIcon::PointingHand,
        _ => CursorIcon::Default,
    }
}

/// The structure's figures, the tool's hint, and what is under the pointer.
fn captions(painter: &Painter, rect: Rect, params: &UvParams, colors: &Colors) {
    let small = FontId::proportional(11.5);
    let left = rect.left() + draw_plane::RULER_WIDTH_PX + 8.0;
    let structure = &params.cache.structure.caption;
    if !structure.is_empty() {
        let place = egui::pos2(left, rect.top() + 6.0);
        painter.text(place, Align2::LEFT_TOP, structure, small.clone(), colors.structure);
    }
    let hint = params.panel.tool.hint();
    if params.panel.tool != super::Tool::Select {
        let place = egui::pos2(left, rect.bottom() - draw_plane::RULER_HEIGHT_PX - 6.0);
        painter.text(place, Align2::LEFT_BOTTOM, hint, small.clone(), params.palette.weak);
    }
    if let Some(element) = params.selection.hovered {
        let place = egui::pos2(rect.right() - 8.0, rect.top() + 6.0);
        painter.text(place, Align2::RIGHT_TOP, describe(element, params), small, colors.hovered);
    }
}

/// `Point 1.2.3`, `Curve 1.2 · degree 3 · 4 points`.
pub(super) fn describe(element: Element, params: &UvParams) -> String {
    let label = element.label();
    let Some(face) = &params.active.face else { return label };
    match element {
        Element::Curve { trim_loop, curve } => match face.curve(trim_loop, curve) {
            Some(c) => format!("{label}   degree {}, {} points", c.degree(), c.points().len()),
            None => label,
        },
        _ => label,
    }
}

/// A title in the header's style.
pub(super) fn title(text: impl Into<String>, palette: &Palette) -> RichText {
    RichText::new(text).heading().color(palette.strong)
}
