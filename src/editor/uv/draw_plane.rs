//! The parameter plane under the face: domain, grid, knot lines, and the rulers along two sides.

use bevy_egui::egui::{
    Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, pos2, vec2,
};
use glam::DVec2;

use super::colors::Colors;
use super::ruler::Steps;
use super::view::UvView;
use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::trim::UvRect;

/// Height of the ruler along the lower side, logical pixels.
pub const RULER_HEIGHT_PX: f32 = 18.0;
/// Width of the ruler along the left side, logical pixels.
pub const RULER_WIDTH_PX: f32 = 46.0;

/// Position on the screen as egui has it.
pub fn pos(p: DVec2) -> Pos2 {
    pos2(p.x as f32, p.y as f32)
}

/// The canvas as a rectangle of egui.
pub fn canvas(view: &UvView) -> Rect {
    Rect::from_min_size(pos(view.min_px), vec2(view.size_px.x as f32, view.size_px.y as f32))
}

/// A rectangle of the plane on the screen, cut to a little more than the canvas.
pub fn rect_on_screen(view: &UvView, rect: &UvRect) -> Rect {
    let (a, b) = (view.to_screen(rect.min), view.to_screen(rect.max));
    let room = DVec2::splat(50.0);
    let (low, high) = (view.min_px - room, view.min_px + view.size_px + room);
    Rect::from_two_pos(pos(a.clamp(low, high)), pos(b.clamp(low, high)))
}

/// The domain's ground, under everything.
pub fn ground(shapes: &mut Vec<Shape>, view: &UvView, surface: &NurbsSurface, colors: &Colors) {
    shapes.push(Shape::rect_filled(canvas(view), CornerRadius::ZERO, colors.canvas));
    let domain = rect_on_screen(view, &UvRect::of_surface(surface));
    shapes.push(Shape::rect_filled(domain, CornerRadius::ZERO, colors.domain));
}

/// Grid, knot lines and the border of the domain, above the face's inside.
pub fn lines(shapes: &mut Vec<Shape>, view: &UvView, surface: &NurbsSurface, colors: &Colors) {
    let (visible, rect) = (view.visible(0.0), canvas(view));
    let steps = Steps::of(view);
    for (step, color) in [(steps.minor, colors.grid_minor), (steps.major, colors.grid_major)] {
        for u in Steps::multiples(step.x, visible.min.x, visible.max.x) {
            let x = crisp(view.to_screen(DVec2::new(u, 0.0)).x);
            shapes.push(Shape::vline(x, rect.y_range(), Stroke::new(1.0, color)));
        }
        for v in Steps::multiples(step.y, visible.min.y, visible.max.y) {
            let y = crisp(view.to_screen(DVec2::new(0.0, v)).y);
            shapes.push(Shape::hline(rect.x_range(), y, Stroke::new(1.0, color)));
        }
    }
    let domain = rect_on_screen(view, &UvRect::of_surface(surface));
    let knots = |breaks: &[f64], at: &dyn Fn(f64) -> f64| -> Vec<f32> {
        let inner = breaks.get(1..breaks.len().saturating_sub(1)).unwrap_or_default();
        let mut places: Vec<f32> = inner.iter().map(|k| crisp(at(*k))).collect();
        places.dedup_by(|a, b| (*a - *b).abs() < 2.0);
        places
    };
    let stroke = Stroke::new(1.0, colors.knot);
    for x in knots(&surface.knots_u().breaks(), &|u| view.to_screen(DVec2::new(u, 0.0)).x) {
        if rect.x_range().contains(x) {
            shapes.push(Shape::vline(x, domain.y_range(), stroke));
        }
    }
    for y in knots(&surface.knots_v().breaks(), &|v| view.to_screen(DVec2::new(0.0, v)).y) {
        if rect.y_range().contains(y) {
            shapes.push(Shape::hline(domain.x_range(), y, stroke));
        }
    }
    let border = Stroke::new(1.0, colors.border);
    shapes.push(Shape::rect_stroke(domain, CornerRadius::ZERO, border, StrokeKind::Middle));
}

/// The middle of a pixel, so that lines of one pixel are sharp.
fn crisp(x: f64) -> f32 {
    (x.floor() + 0.5) as f32
}

/// The rulers, with the place of the pointer.
pub fn rulers(painter: &Painter, view: &UvView, pointer: Option<DVec2>, colors: &Colors, accent: Color32) {
    let rect = canvas(view);
    let below = Rect::from_min_max(pos2(rect.left(), rect.bottom() - RULER_HEIGHT_PX), rect.max);
    let beside = Rect::from_min_max(rect.min, pos2(rect.left() + RULER_WIDTH_PX, below.top()));
    for strip in [below, beside] {
        painter.rect_filled(strip, CornerRadius::ZERO, colors.ruler);
    }
    let line = Stroke::new(1.0, colors.grid_major);
    painter.hline(below.x_range(), below.top() + 0.5, line);
    painter.vline(beside.right() - 0.5, beside.y_range(), line);
    let (visible, steps) = (view.visible(0.0), Steps::of(view));
    let font = FontId::proportional(10.5);
    let text = |value: f64, step: f64| {
        let value = if value.abs() < 0.01 * step { 0.0 } else { value };
        if value.abs() >= 1e7 { format!("{value:.3e}") } else { format!("{value:.*}", Steps::decimals(step)) }
    };
    let tick = Stroke::new(1.0, colors.ruler_text);
    for u in Steps::multiples(steps.major.x, visible.min.x, visible.max.x) {
        let x = crisp(view.to_screen(DVec2::new(u, 0.0)).x);
        if x > beside.right() + 2.0 {
            painter.vline(x, below.top()..=below.top() + 4.0, tick);
            let place = pos2(x, below.bottom() - 1.5);
            painter.text(
                place,
                Align2::CENTER_BOTTOM,
                text(u, steps.major.x),
                font.clone(),
                colors.ruler_text,
            );
        }
    }
    for v in Steps::multiples(steps.major.y, visible.min.y, visible.max.y) {
        let y = crisp(view.to_screen(DVec2::new(0.0, v)).y);
        if beside.y_range().shrink(6.0).contains(y) {
            painter.hline(beside.right() - 4.0..=beside.right(), y, tick);
            let place = pos2(beside.right() - 7.0, y);
            painter.text(
                place,
                Align2::RIGHT_CENTER,
                text(v, steps.major.y),
                font.clone(),
                colors.ruler_text,
            );
        }
    }
    let corner = Rect::from_min_max(pos2(rect.left(), below.top()), pos2(beside.right(), rect.bottom()));
    painter.rect_filled(corner, CornerRadius::ZERO, colors.ruler);
    painter.text(corner.center(), Align2::CENTER_CENTER, "v  u", font, colors.ruler_text);
    if let Some(p) = pointer {
        let mark = Stroke::new(1.0, accent);
        painter.vline(p.x as f32, below.y_range(), mark);
        painter.hline(beside.x_range(), p.y as f32, mark);
    }
}
