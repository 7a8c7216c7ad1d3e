//! What the renderer draws of the handles: lines and marks with their colours, made anew when something changed.

use std::sync::Arc;

use bevy::prelude::*;
use bevy_egui::egui::Color32;
use glam::DVec3;

use super::drag::HandleDrag;
use super::input::{Grip, HandleHand};
use super::shapes::{HandleShapes, MOST_POINTS};
use crate::editor::elements::{ActiveFace, Element, ElementSelection};
use crate::editor::theme::Palette;
use crate::editor::uv::{Colors, UvGeometry, UvPanel, draw_problems};

/// Width of trim curves, logical pixels.
const CURVE_PX: f32 = 2.0;
/// Width of curves that are selected or under the pointer.
const MARKED_PX: f32 = 3.0;
/// Side of a control point's mark.
const POINT_PX: f32 = 8.0;

/// Ring around what a drag meets.
const SNAP_PX: f32 = 16.0;

/// A straight line in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandleLine {
    /// One end.
    pub start: DVec3,
    /// The other end.
    pub end: DVec3,
    /// Its colour.
    pub color: Color32,
    /// Its width, logical pixels.
    pub width_px: f32,
}

/// A mark of constant size on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandleMark {
    /// Its place.
    pub at: DVec3,
    /// Inside.
    pub fill: Color32,
    /// Border.
    pub line: Color32,
    /// Width, logical pixels.
    pub size_px: f32,
    /// A disc instead of a square.
    pub round: bool,
}

/// Everything to draw.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct HandlePicture {
    /// Lines, in order.
    pub lines: Vec<HandleLine>,
    /// Marks, in order.
    pub marks: Vec<HandleMark>,
}

/// The picture for the renderer.
#[derive(Resource, Debug, Default)]
pub struct HandleDrawing {
    /// What to draw.
    pub picture: Arc<HandlePicture>,
    key: Option<Key>,
}

#[derive(Debug, Clone, PartialEq)]
struct Key {
    shapes: u64,
    selection: u64,
    hovered: Option<Element>,
    light: bool,
    linked: Option<DVec3>,
    axis: Option<(usize, DVec3)>,
    met: Option<DVec3>,
    problems: u64,
    face: u64,
}

/// Makes the picture anew when something in it changed.
pub(super) fn draw(
    mut drawing: ResMut<HandleDrawing>,
    shapes: Res<HandleShapes>,
    hand: Res<HandleHand>,
    selection: Res<ElementSelection>,
    active: Res<ActiveFace>,
    palette: Option<Res<Palette>>,
    panel: Res<UvPanel>,
    geometry: Res<UvGeometry>,
) {
    let palette = palette.map_or_else(Palette::default, |p| *p);
    let linked = panel.pointer_uv().zip(active.face.as_ref()).map(|(uv, face)| {
        let domain = crate::kernel::trim::UvRect::of_surface(&face.surface);
        let uv = shapes.map.as_ref().map_or(uv.clamp(domain.min, domain.max), |m| m.inside(uv));
        face.surface.point(uv.x, uv.y)
    });
    let axis = match &hand.grip {
        Grip::Drag(HandleDrag::Net { axis: Some(axis), grip, .. }) => Some((*axis, *grip)),
        _ => None,
    };
    let met = match &hand.grip {
        Grip::Drag(HandleDrag::Trim { met: Some(uv), .. }) => shapes.map.as_ref().map(|m| m.point(*uv)),
        _ => None,
    };
    let key = Key {
        shapes: shapes.revision,
        selection: selection.revision,
        hovered: selection.hovered,
        light: palette.light,
        linked,
        axis,
        met,
        problems: active.problems_revision,
        face: active.revision,
    };
    if drawing.key.as_ref() == Some(&key) {
        return;
    }
    let mut painter =
        Painter { picture: HandlePicture::default(), colors: Colors::of(&palette), selection: &selection };
    painter.curves(&shapes, &geometry);
    painter.net(&shapes);
    painter.problems(&active, &palette);
    if let Some((axis, at)) = axis {
        painter.axis(&shapes, axis, at, &palette);
    }
    if let Some(at) = met {
        let (fill, line) = (Color32::TRANSPARENT, painter.colors.snap);
        painter.picture.marks.push(HandleMark { at, fill, line, size_px: SNAP_PX, round: true });
    }
    if let Some(at) = linked {
        let (fill, line) = (painter.colors.snap, painter.colors.point);
        painter.picture.marks.push(HandleMark { at, fill, line, size_px: 9.0, round: true });
    }
    drawing.picture = Arc::new(painter.picture);
    drawing.key = Some(key);
}

struct Painter<'a> {
    picture: HandlePicture,
    colors: Colors,
    selection: &'a ElementSelection,
}

impl Painter<'_> {
    fn line(&mut self, points: &[DVec3], color: Color32, width_px: f32) {
        let lines = points.windows(2).map(|e| HandleLine { start: e[0], end: e[1], color, width_px });
        self.picture.lines.extend(lines);
    }

    fn curves(&mut self, shapes: &HandleShapes, geometry: &UvGeometry) {
        let total: usize = shapes.curves.iter().map(|c| c.points.len()).sum();
        for pass in 0..2 {
            for curve in &shapes.curves {
                let (trim_loop, number) = curve.address;
                let element = Element::Curve { trim_loop, curve: number };
                let selected = self.selection.covers(element);
                let hovered = match self.selection.hovered {
                    Some(Element::Loop { trim_loop: l }) => l == trim_loop,
                    other => other == Some(element),
                };
                let marked = selected || hovered;
                if marked != (pass == 1) || (shapes.passive && !marked) {
                    continue;
                }
                let hole = geometry.holes.get(trim_loop).copied().unwrap_or_default();
                let color = match (hovered, selected) {
                    (true, _) => self.colors.hovered,
                    (_, true) => self.colors.selected,
                    _ => self.colors.of_loop(hole),
                };
                self.line(&curve.line, color, if marked { MARKED_PX } else { CURVE_PX });
                for leg in curve.polygon.iter().filter(|_| !shapes.passive) {
                    self.line(leg, self.colors.polygon, 1.0);
                }
            }
        }
        for curve in &shapes.curves {
            let (trim_loop, number) = curve.address;
            if total > MOST_POINTS && !self.selection.touches(trim_loop, number) {
                continue;
            }
            let last = curve.points.len().saturating_sub(1);
            for (point, at) in curve.points.iter().enumerate() {
                let element = Element::Point { trim_loop, curve: number, point };
                let marked = self.selection.contains(element) || self.selection.hovered == Some(element);
                if shapes.passive && !marked {
                    continue;
                }
                self.mark(element, *at, point == 0 || point == last);
            }
        }
    }

    fn net(&mut self, shapes: &HandleShapes) {
        let (count_u, count_v) = shapes.counts;
        if shapes.net.len() != count_u * count_v || shapes.net.is_empty() {
            return;
        }
        let color = self.colors.polygon;
        for i in 0..count_u {
            for j in 0..count_v {
                let at = shapes.net[i * count_v + j];
                if i + 1 < count_u {
                    self.line(&[at, shapes.net[(i + 1) * count_v + j]], color, 1.2);
                }
                if j + 1 < count_v {
                    self.line(&[at, shapes.net[i * count_v + j + 1]], color, 1.2);
                }
            }
        }
        for (point, at) in shapes.net.iter().enumerate() {
            self.mark(Element::SurfacePoint { point }, *at, false);
        }
    }

    fn mark(&mut self, element: Element, at: DVec3, round: bool) {
        let hovered = self.selection.hovered == Some(element);
        let selected = self.selection.covers(element);
        let colors = &self.colors;
        let (fill, line) = match (hovered, selected) {
            (true, true) => (colors.selected, colors.hovered),
            (true, false) => (colors.hovered, colors.hovered),
            (false, true) => (colors.selected, colors.selected),
            (false, false) => (colors.point, colors.outer),
        };
        let size_px = if hovered { POINT_PX + 3.0 } else { POINT_PX };
        self.picture.marks.push(HandleMark { at, fill, line, size_px, round });
    }

    /// Rings where something is wrong. Notes are in the list of problems alone: nothing is drawn wrong there.
    fn problems(&mut self, active: &ActiveFace, palette: &Palette) {
        let Some(face) = &active.face else { return };
        for problem in face.problems.iter().filter(|p| p.is_serious()).take(draw_problems::MOST) {
            let (at, line) = (face.point_in_space(problem.uv), draw_problems::color(problem, palette));
            let size_px = 2.0 * draw_problems::RING_PX;
            self.picture.marks.push(HandleMark {
                at,
                fill: Color32::TRANSPARENT,
                line,
                size_px,
                round: true,
            });
        }
    }

    /// The axis that a drag keeps to.
    fn axis(&mut self, shapes: &HandleShapes, axis: usize, at: DVec3, palette: &Palette) {
        let color = [palette.axis_x, palette.axis_y, palette.axis_z][axis];
        let size = shapes.map.as_ref().map_or(1.0, |m| m.surface().bounds().diagonal());
        let reach = DVec3::AXES[axis] * 4.0 * size;
        self.line(&[at - reach, at + reach], color, 1.5);
    }
}
