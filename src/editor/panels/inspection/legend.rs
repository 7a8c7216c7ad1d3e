//! The legend of the colours along edges, in the lower left corner of the viewport.

use bevy_egui::egui::{Align2, Color32, CornerRadius, FontId, Painter, Rect, Stroke, StrokeKind, pos2, vec2};

use crate::editor::inspection::ramp;
use crate::editor::theme::{Palette, size};

/// Height of it with the margin below.
pub(super) const HEIGHT: f32 = 66.0;

/// Where it is, if there is room.
pub(super) fn place(viewport: Rect) -> Option<Rect> {
    let area = Rect::from_min_size(pos2(viewport.min.x + 14.0, viewport.max.y - HEIGHT), vec2(340.0, 56.0));
    (viewport.width() >= area.width() + 40.0 && viewport.height() >= 160.0).then_some(area)
}

/// Draws it.
pub(super) fn show(painter: &Painter, viewport: Rect, palette: &Palette) {
    let Some(area) = place(viewport) else { return };
    painter.rect(
        area,
        CornerRadius::same(6),
        palette.raised.gamma_multiply(0.92),
        Stroke::new(1.0, palette.line),
        StrokeKind::Inside,
    );
    let font = FontId::proportional(size::SMALL);
    let bar = Rect::from_min_size(area.min + vec2(22.0, 12.0), vec2(180.0, 10.0));
    let (first, last) = (*ramp::DECADES.start(), *ramp::DECADES.end());
    let steps = 60;
    for k in 0..steps {
        let part = (k as f32 + 0.5) / steps as f32;
        let exponent = f64::from(first) + f64::from(last - first) * f64::from(part);
        let left = bar.min.x + bar.width() * k as f32 / steps as f32;
        let cell =
            Rect::from_min_size(pos2(left, bar.min.y), vec2(bar.width() / steps as f32 + 0.5, bar.height()));
        painter.rect_filled(cell, CornerRadius::ZERO, colour(ramp::colour(10f64.powf(exponent))));
    }
    for (exponent, text) in [(-6, "1 nm"), (-3, "1 um"), (0, "1 mm")] {
        let x = bar.min.x + bar.width() * (exponent - first) as f32 / (last - first) as f32;
        painter.text(pos2(x, bar.max.y + 4.0), Align2::CENTER_TOP, text, font.clone(), palette.text);
    }
    let entries = [(ramp::NAKED, "naked"), (ramp::NON_MANIFOLD, "non-manifold"), (ramp::CLOSED, "closed")];
    for (k, (rgb, text)) in entries.into_iter().enumerate() {
        let at = pos2(bar.max.x + 26.0, area.min.y + 10.0 + 16.0 * k as f32);
        painter.hline(at.x..=at.x + 14.0, at.y, Stroke::new(3.0, colour(rgb)));
        painter.text(at + vec2(20.0, 0.0), Align2::LEFT_CENTER, text, font.clone(), palette.text);
    }
}

fn colour([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}
