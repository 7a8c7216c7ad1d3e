//! Trim curves, their control polygons and control points.

use bevy_egui::egui::{
    Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, vec2,
};
use glam::DVec2;

use super::colors::Colors;
use super::draw_plane::{canvas, pos};
use super::flat::FlatCurve;
use super::geometry::UvGeometry;
use super::hit::{ShownPoints, spacing_px};
use super::view::UvView;
use crate::editor::elements::{Element, ElementSelection, FaceInHand};

/// Width of curves, logical pixels.
const CURVE_PX: f32 = 1.6;
/// Width of curves that are selected or under the pointer.
const MARKED_PX: f32 = 2.6;
/// Half the side of a control point's square.
const POINT_PX: f32 = 3.2;
/// Vertices closer together than this are one on the screen.
const SAME_PX: f32 = 0.05;

/// A polyline on the screen, without what is far off it.
pub fn on_screen(flat: &FlatCurve, view: &UvView) -> Vec<Vec<Pos2>> {
    const ROOM_PX: f64 = 40.0;
    let (low, high) = (view.min_px - ROOM_PX, view.min_px + view.size_px + ROOM_PX);
    let mut runs: Vec<Vec<Pos2>> = Vec::new();
    let mut open = false;
    let mut before: Option<DVec2> = None;
    for point in &flat.points {
        let b = view.to_screen(*point);
        if let Some(a) = before {
            let apart = a.max(b).cmplt(low).any() || a.min(b).cmpgt(high).any();
            if apart {
                open = false;
            } else {
                // Long segments are cut near the canvas: egui works in f32.
                let (a, b) = cut(a, b, low - 200.0, high + 200.0);
                if !open {
                    runs.push(vec![pos(a)]);
                }
                if let Some(run) = runs.last_mut()
                    && run.last().is_none_or(|p| p.distance(pos(b)) > SAME_PX)
                {
                    run.push(pos(b));
                }
                open = true;
            }
        }
        before = Some(b);
    }
    runs.retain(|run| run.len() > 1);
    runs
}

/// The part of a segment within a box (Liang & Barsky 1984); the segment itself where that is empty.
fn cut(a: DVec2, b: DVec2, low: DVec2, high: DVec2) -> (DVec2, DVec2) {
    if a == a.clamp(low, high) && b == b.clamp(low, high) {
        return (a, b);
    }
    let d = b - a;
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        if d[axis] != 0.0 {
            let (t0, t1) = ((low[axis] - a[axis]) / d[axis], (high[axis] - a[axis]) / d[axis]);
            enter = enter.max(t0.min(t1));
            leave = leave.min(t0.max(t1));
        }
    }
    if enter < leave { (a + d * enter, a + d * leave) } else { (a.clamp(low, high), b.clamp(low, high)) }
}

/// All curves: what is not selected first, so that what is selected lies on top.
pub fn curves(
    shapes: &mut Vec<Shape>,
    view: &UvView,
    geometry: &UvGeometry,
    selection: &ElementSelection,
    colors: &Colors,
) {
    for pass in [false, true] {
        for (trim_loop, curves) in geometry.curves.iter().enumerate() {
            let hole = geometry.holes.get(trim_loop).copied().unwrap_or_default();
            for (curve, flat) in curves.iter().enumerate() {
                let selected = selection.covers(Element::Curve { trim_loop, curve });
                if selected == pass {
                    let color = if selected { colors.selected } else { colors.of_loop(hole) };
                    let stroke = Stroke::new(if selected { MARKED_PX } else { CURVE_PX }, color);
                    shapes.extend(on_screen(flat, view).into_iter().map(|run| Shape::line(run, stroke)));
                }
            }
        }
    }
}

/// Control polygons and control points of the loops that show them.
pub fn points(
    shapes: &mut Vec<Shape>,
    view: &UvView,
    face: &FaceInHand,
    selection: &ElementSelection,
    shown: &ShownPoints,
    colors: &Colors,
) {
    let area = canvas(view).expand(20.0);
    let mut marks = Vec::new();
    for (trim_loop, record) in face.loops.iter().enumerate().filter(|(l, _)| shown.includes(*l)) {
        for (curve, spline) in record.curves.iter().enumerate() {
            let places: Vec<Pos2> = spline.points().iter().map(|p| clamped(view, *p)).collect();
            if spline.degree() > 1 {
                for ends in places.windows(2).filter(|e| area.intersects(Rect::from_two_pos(e[0], e[1]))) {
                    shapes.push(Shape::line_segment([ends[0], ends[1]], Stroke::new(1.0, colors.polygon)));
                }
            }
            let last = places.len() - 1;
            // Marks shrink where points are crowded, down to dots.
            let size = (0.28 * spacing_px(spline, view) as f32).clamp(1.4, POINT_PX);
            for (point, place) in places.iter().enumerate().filter(|(_, p)| area.contains(**p)) {
                let selected = selection.covers(Element::Point { trim_loop, curve, point });
                marks.push((selected, *place, point == 0 || point == last, size));
            }
        }
    }
    // Of joined ends the selected one is on top.
    marks.sort_by_key(|m| m.0);
    for (selected, place, is_end, size) in marks {
        point_mark(shapes, place, size, selected, is_end, colors);
    }
}

/// A point on the screen, kept within what egui's `f32` can take.
fn clamped(view: &UvView, uv: DVec2) -> Pos2 {
    pos(view.to_screen(uv).clamp(DVec2::splat(-1e5), DVec2::splat(1e5)))
}

/// Ends are discs, the other control points squares.
fn point_mark(
    shapes: &mut Vec<Shape>,
    place: Pos2,
    size: f32,
    selected: bool,
    is_end: bool,
    colors: &Colors,
) {
    let (fill, line) =
        if selected { (colors.selected, colors.selected) } else { (colors.point, colors.outer) };
    let size = if selected { POINT_PX } else { size };
    let stroke = Stroke::new(if size < 2.5 { 1.0 } else { 1.3 }, line);
    if is_end {
        shapes.push(Shape::circle_filled(place, size + 0.6, fill));
        shapes.push(Shape::circle_stroke(place, size + 0.6, stroke));
    } else {
        let rect = Rect::from_center_size(place, vec2(2.0 * size, 2.0 * size));
        shapes.push(Shape::rect_filled(rect, CornerRadius::same(1), fill));
        shapes.push(Shape::rect_stroke(rect, CornerRadius::same(1), stroke, StrokeKind::Middle));
    }
}

/// What is under the pointer, here or in 3D, with the direction of its curve; weights beside the points.
pub fn hovered(
    painter: &Painter,
    view: &UvView,
    face: &FaceInHand,
    geometry: &UvGeometry,
    element: Element,
    colors: &Colors,
) {
    let stroke = Stroke::new(MARKED_PX, colors.hovered);
    let draw = |l: usize, c: usize| {
        let flat = geometry.curves.get(l).and_then(|l| l.get(c));
        flat.into_iter().flat_map(|f| on_screen(f, view)).for_each(|run| {
            painter.add(Shape::line(run, stroke));
        });
    };
    match element {
        Element::Loop { trim_loop } => {
            let count = geometry.curves.get(trim_loop).map_or(0, Vec::len);
            (0..count).for_each(|c| draw(trim_loop, c));
        }
        Element::Curve { trim_loop, curve } => {
            draw(trim_loop, curve);
            direction(painter, view, geometry, (trim_loop, curve), colors.hovered);
        }
        Element::Point { trim_loop, curve, point } => {
            let Some(uv) = face.point((trim_loop, curve, point)) else { return };
            painter.circle_stroke(clamped(view, uv), POINT_PX + 4.0, Stroke::new(1.6, colors.hovered));
        }
        Element::SurfacePoint { .. } => {}
    }
}

/// An arrow head in the middle of a curve.
fn direction(
    painter: &Painter,
    view: &UvView,
    geometry: &UvGeometry,
    (l, c): (usize, usize),
    color: Color32,
) {
    let Some(flat) = geometry.curves.get(l).and_then(|l| l.get(c)) else { return };
    let at = flat.points.len() / 2;
    let (Some(a), Some(b)) = (flat.points.get(at.saturating_sub(1)), flat.points.get(at)) else { return };
    let (a, b) = (view.to_screen(*a), view.to_screen(*b));
    let Some(along) = (b - a).try_normalize() else { return };
    let (tip, across) = (0.5 * (a + b) + along * 5.0, along.perp() * 4.5);
    let base = tip - along * 9.0;
    let corners = vec![pos(tip), pos(base + across), pos(base - across)];
    painter.add(Shape::convex_polygon(corners, color, Stroke::NONE));
}

/// Weights that differ from the others of their curve, beside their control points.
pub fn weights(painter: &Painter, view: &UvView, face: &FaceInHand, shown: &ShownPoints, colors: &Colors) {
    const MOST: usize = 120;
    let area = canvas(view);
    let font = FontId::proportional(10.5);
    let (mut count, mut taken) = (0, Vec::new());
    for (_, record) in face.loops.iter().enumerate().filter(|(l, _)| shown.includes(*l)) {
        for curve in record.curves.iter().filter(|c| c.is_rational()) {
            for (uv, weight) in curve.points().iter().zip(curve.weights()) {
                let place = clamped(view, *uv);
                if !area.contains(place) || *weight == 1.0 {
                    continue;
                }
                count += 1;
                if count > MOST {
                    return;
                }
                let text = format!("{weight:.3}");
                let text = text.trim_end_matches('0').trim_end_matches('.');
                let galley = painter.layout_no_wrap(text.to_owned(), font.clone(), colors.ruler_text);
                let rect = Align2::LEFT_BOTTOM.anchor_size(place + vec2(7.0, -4.0), galley.size());
                // Where points are close to each other one has to zoom in anyway.
                if taken.iter().all(|other: &Rect| !other.intersects(rect)) {
                    painter.galley(rect.min, galley, colors.ruler_text);
                    taken.push(rect);
                }
            }
        }
    }
}
