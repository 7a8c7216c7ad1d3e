//! What the hand is doing: boxes, shapes being drawn, snapping, the place of the pointer in 3D.

use bevy_egui::egui::{
    Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, pos2, vec2,
};
use glam::DVec2;

use super::colors::Colors;
use super::draw_plane::{canvas, pos};
use super::draw_shape::{CLOSE_REACH_PX, circle_radii};
use super::gesture::Gesture;
use super::panel::UvPanel;
use super::tool::Tool;

/// Draws it.
pub fn draw(painter: &Painter, panel: &UvPanel, colors: &Colors) {
    let view = &panel.view;
    let at = |uv: DVec2| pos(view.to_screen(uv));
    let stroke = Stroke::new(1.6, colors.drawing);
    match &panel.gesture {
        Gesture::Box { from, to, .. } => {
            let rect = Rect::from_two_pos(pos(*from), pos(*to));
            painter.rect_filled(rect, CornerRadius::ZERO, colors.drawing.gamma_multiply(0.08));
            let line = Stroke::new(1.0, colors.drawing);
            if to.x < from.x {
                // From right to left takes what it touches: drawn dashed, as CAD systems do.
                let corners = [
                    rect.left_top(),
                    rect.right_top(),
                    rect.right_bottom(),
                    rect.left_bottom(),
                    rect.left_top(),
                ];
                painter.extend(Shape::dashed_line(&corners, line, 5.0, 4.0));
            } else {
                painter.rect_stroke(rect, CornerRadius::ZERO, line, StrokeKind::Middle);
            }
        }
        Gesture::Shape { from, to } if panel.tool == Tool::Circle => {
            let radii = circle_radii(view.scale, *from, *to);
            let radius = (radii * view.scale).x as f32;
            painter.circle_stroke(at(*from), radius, stroke);
            painter.line_segment([at(*from), at(*to)], Stroke::new(1.0, colors.drawing.gamma_multiply(0.5)));
            cross(painter, at(*from), 4.0, colors.drawing);
            let text = if (radii.x - radii.y).abs() <= 1e-12 * radii.x {
                format!("r {:.5}", radii.x)
            } else {
                format!("r {:.5} × {:.5}", radii.x, radii.y)
            };
            note(painter, at(*to), &text, colors.drawing);
        }
        Gesture::Shape { from, to } => {
            let rect = Rect::from_two_pos(at(*from), at(*to));
            painter.rect_stroke(rect, CornerRadius::ZERO, stroke, StrokeKind::Middle);
            let size = (*to - *from).abs();
            note(painter, at(*to), &format!("{:.5} × {:.5}", size.x, size.y), colors.drawing);
        }
        Gesture::Polyline { corners } => polyline(painter, panel, corners, colors),
        Gesture::Freehand { points } => {
            painter.add(Shape::line(points.iter().map(|p| at(*p)).collect(), stroke));
            if let (Some(first), Some(last)) = (points.first(), points.last()) {
                let line = Stroke::new(1.0, colors.drawing.gamma_multiply(0.6));
                painter.extend(Shape::dashed_line(&[at(*last), at(*first)], line, 4.0, 4.0));
            }
        }
        Gesture::Drag(drag) => {
            let (from, to) = (at(drag.grip), at(drag.grip + drag.by));
            painter.extend(Shape::dashed_line(&[from, to], Stroke::new(1.0, colors.selected), 3.0, 4.0));
            cross(painter, from, 3.0, colors.selected.gamma_multiply(0.7));
            let by = drag.by;
            note(painter, to, &format!("Δu {:+.6}   Δv {:+.6}", by.x, by.y), colors.selected);
        }
        _ => {}
    }
    snapped(painter, panel, colors);
    if panel.tool.takes_place()
        && let Some(hit) = panel.hit.filter(|h| h.parameter.is_some())
    {
        let place = at(hit.uv);
        painter.circle_filled(place, 3.0, colors.drawing);
        painter.circle_stroke(place, 6.0, Stroke::new(1.4, colors.drawing));
        note(painter, place, &format!("t {:.5}", hit.parameter.unwrap_or_default()), colors.drawing);
    }
}

fn polyline(painter: &Painter, panel: &UvPanel, corners: &[DVec2], colors: &Colors) {
    let view = &panel.view;
    let at = |uv: DVec2| pos(view.to_screen(uv));
    let stroke = Stroke::new(1.6, colors.drawing);
    let mut places: Vec<Pos2> = corners.iter().map(|p| at(*p)).collect();
    let next = panel.snapped.map(|s| at(s.uv)).or(panel.pointer.map(pos));
    if let (Some(next), Some(first)) = (next, places.first().copied()) {
        let closing = corners.len() >= 3 && first.distance(next) <= CLOSE_REACH_PX as f32;
        if closing {
            painter.circle_stroke(first, 7.0, stroke);
        } else if corners.len() >= 2 {
            let line = Stroke::new(1.0, colors.drawing.gamma_multiply(0.5));
            painter.extend(Shape::dashed_line(&[next, first], line, 4.0, 4.0));
        }
        places.push(if closing { first } else { next });
    }
    painter.add(Shape::line(places.clone(), stroke));
    for place in &places[..corners.len().min(places.len())] {
        painter.circle_filled(*place, 3.0, colors.drawing);
    }
}

fn snapped(painter: &Painter, panel: &UvPanel, colors: &Colors) {
    let Some(snapped) = panel.snapped else { return };
    let (rect, place) = (canvas(&panel.view), pos(panel.view.to_screen(snapped.uv)));
    let line = Stroke::new(1.0, colors.snap.gamma_multiply(0.6));
    if snapped.axes[0] {
        painter.vline(place.x, rect.y_range(), line);
    }
    if snapped.axes[1] {
        painter.hline(rect.x_range(), place.y, line);
    }
    if let Some(kind) = snapped.kind {
        let mark = Rect::from_center_size(place, vec2(11.0, 11.0));
        painter.rect_stroke(mark, CornerRadius::same(1), Stroke::new(1.6, colors.snap), StrokeKind::Middle);
        let font = FontId::proportional(11.0);
        painter.text(place + vec2(10.0, 8.0), Align2::LEFT_TOP, kind.label(), font, colors.snap);
    }
}

fn cross(painter: &Painter, place: Pos2, reach: f32, color: Color32) {
    let stroke = Stroke::new(1.0, color);
    painter.line_segment([place - vec2(reach, 0.0), place + vec2(reach, 0.0)], stroke);
    painter.line_segment([place - vec2(0.0, reach), place + vec2(0.0, reach)], stroke);
}

/// A short text above and to the right of a place.
fn note(painter: &Painter, place: Pos2, text: &str, color: Color32) {
    let font = FontId::proportional(11.5);
    let galley = painter.layout_no_wrap(text.to_owned(), font, color);
    let at = place + vec2(12.0, -12.0 - galley.size().y);
    let rect = Rect::from_min_size(at, galley.size()).expand2(vec2(5.0, 2.0));
    painter.rect_filled(rect, CornerRadius::same(3), Color32::from_black_alpha(150));
    painter.galley(at, galley, color);
}

/// Where the pointer is on the surface in the 3D view.
pub fn crosshair(painter: &Painter, panel: &UvPanel, uv: DVec2, color: Color32) {
    let rect = canvas(&panel.view);
    let place = pos(panel.view.to_screen(uv));
    if !rect.contains(place) {
        return;
    }
    let faint = Stroke::new(1.0, color.gamma_multiply(0.35));
    painter.vline(place.x, rect.y_range(), faint);
    painter.hline(rect.x_range(), place.y, faint);
    painter.circle_stroke(pos2(place.x, place.y), 5.0, Stroke::new(1.6, color));
}
