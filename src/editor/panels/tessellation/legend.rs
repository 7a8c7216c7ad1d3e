//! The legend of the error heat map in the lower left corner of the viewport, and a ring where the error is largest.

use bevy_egui::egui::{
    Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Rgba, Stroke, StrokeKind, pos2, vec2,
};

use crate::editor::camera::motion::project;
use crate::editor::panels::Reads;
use crate::editor::tessellation::Figures;
use crate::editor::theme::size;
use crate::editor::viewport::Viewport;
use crate::encoding::tessellation::{LARGEST_LEVEL, LEVEL_OF_TOLERANCE, UNMEASURED};
use crate::inspect::Length;
use crate::reference::shade::deviation_colour;

/// Height of it with the margin below.
pub(super) const HEIGHT: f32 = 72.0;

fn colour(level: u32) -> Color32 {
    let c = deviation_colour(level);
    // As it looks in the light: surfaces that face the viewer are about as bright as this.
    Color32::from(Rgba::from_rgb(c.x, c.y, c.z))
}

/// Draws it.
pub(super) fn show(painter: &Painter, viewport: Rect, reads: &Reads, figures: &Figures) {
    let palette = &reads.palette;
    let area = Rect::from_min_size(pos2(viewport.min.x + 14.0, viewport.max.y - HEIGHT), vec2(330.0, 62.0));
    if viewport.width() < area.width() + 40.0 || viewport.height() < 160.0 {
        return;
    }
    let fill = palette.raised.gamma_multiply(0.92);
    painter.rect(area, CornerRadius::same(6), fill, Stroke::new(1.0, palette.line), StrokeKind::Inside);
    let font = FontId::proportional(size::SMALL);
    if figures.largest.is_none() {
        let swatch = Rect::from_min_size(area.min + vec2(14.0, 22.0), vec2(18.0, 18.0));
        painter.rect_filled(swatch, 2, colour(UNMEASURED));
        let at = swatch.right_center() + vec2(10.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, "not measured yet", font, palette.text);
        return;
    }
    let title = "Distance from the exact surfaces";
    painter.text(area.min + vec2(14.0, 7.0), Align2::LEFT_TOP, title, font.clone(), palette.weak);
    let bar = Rect::from_min_size(area.min + vec2(14.0, 25.0), vec2(302.0, 10.0));
    let step = bar.width() / LARGEST_LEVEL as f32;
    for level in 0..LARGEST_LEVEL {
        let left = pos2(bar.min.x + step * level as f32, bar.min.y);
        let cell = Rect::from_min_size(left, vec2(step + 1.5, bar.height()));
        painter.rect_filled(cell.intersect(bar), CornerRadius::ZERO, colour(level));
    }
    let tick = |level: f32, text: String, anchor: Align2, strong: bool| {
        let x = bar.min.x + step * level;
        let ink = if strong { palette.strong } else { palette.text };
        if strong {
            painter.vline(x, bar.min.y - 3.0..=bar.max.y + 3.0, Stroke::new(1.5, ink));
        }
        painter.text(pos2(x, bar.max.y + 5.0), anchor, text, font.clone(), ink);
    };
    let tolerance = figures.tolerance_mm;
    tick(0.0, "0".into(), Align2::LEFT_TOP, false);
    let half = Length { mm: 0.5 * tolerance }.to_string();
    tick(0.5 * LEVEL_OF_TOLERANCE as f32, half, Align2::CENTER_TOP, false);
    let full = format!("tolerance {}", Length { mm: tolerance });
    tick(LEVEL_OF_TOLERANCE as f32, full, Align2::CENTER_TOP, true);
}

/// Rings the place where the error is largest.
pub(super) fn largest(painter: &Painter, rect: Rect, reads: &Reads, viewport: &Viewport, figures: &Figures) {
    let Some(largest) = figures.largest else { return };
    let Some((ndc, _)) = project(&reads.camera.now, largest.place, viewport.aspect()) else { return };
    let at = viewport.position(ndc);
    let at = Pos2::new(at.x, at.y);
    if ndc.abs().max_element() > 1.0 || !rect.contains(at) {
        return;
    }
    let palette = &reads.palette;
    let halo = Stroke::new(4.0, Color32::from_black_alpha(110));
    for stroke in [halo, Stroke::new(1.6, palette.accent)] {
        painter.circle_stroke(at, 9.0, stroke);
    }
    let font = FontId::proportional(size::BODY);
    let text = format!("largest {}", Length { mm: largest.mm });
    let galley = painter.layout_no_wrap(text, font, palette.strong);
    let up = if at.y - rect.min.y > 60.0 { -1.0 } else { 1.0 };
    let label = Rect::from_center_size(at + vec2(0.0, 28.0 * up), galley.size() + vec2(14.0, 6.0));
    painter.rect_filled(label, 4, palette.raised.gamma_multiply(0.92));
    painter.galley(label.center() - galley.size() / 2.0, galley, palette.strong);
}
