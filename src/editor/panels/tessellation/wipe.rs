//! The divider of the wipe with the names of both halves.

use bevy_egui::egui::{Align2, Color32, Context, CursorIcon, FontId, Painter, Rect, Stroke, pos2, vec2};

use crate::editor::panels::Reads;
use crate::editor::panels::format::plural;
use crate::editor::panels::view_cube;
use crate::editor::tessellation::{Figures, Wipe};
use crate::editor::theme::size;
use crate::editor::viewport::Viewport;
use crate::inspect::Length;

/// Room between a name and the divider, points.
const ROOM: f32 = 12.0;

/// Draws it.
pub(super) fn show(
    ctx: &Context,
    painter: &Painter,
    rect: Rect,
    reads: &Reads,
    (viewport, wipe): (&Viewport, &Wipe),
    figures: &Figures,
) {
    let palette = &reads.palette;
    // On whole pixels, where the pictures meet.
    let scale = viewport.scale_factor.max(0.1);
    let x = (wipe.x(viewport) * scale).round() / scale;
    let colour = match (wipe.hovered, palette.light) {
        (true, _) => palette.accent,
        (false, true) => Color32::from_gray(96),
        (false, false) => Color32::from_gray(235),
    };
    let halo = if palette.light { Color32::from_white_alpha(150) } else { Color32::from_black_alpha(90) };
    painter.vline(x, rect.y_range(), Stroke::new(4.0, halo));
    painter.vline(x, rect.y_range(), Stroke::new(1.5, colour));
    let grip = Rect::from_center_size(pos2(x, rect.center().y), vec2(14.0, 34.0));
    painter.rect(grip, 7, palette.raised, Stroke::new(1.5, colour), bevy_egui::egui::StrokeKind::Inside);
    for k in [-2.5, 2.5] {
        painter.vline(x + k, grip.center().y - 7.0..=grip.center().y + 7.0, Stroke::new(1.5, colour));
    }
    let triangles =
        format!("{}, {}", plural(figures.triangles, "triangle"), Length { mm: figures.tolerance_mm });
    let font = FontId::proportional(size::BODY);
    for (text, right) in [("Exact".to_owned(), false), (triangles, true)] {
        let galley = painter.layout_no_wrap(text, font.clone(), palette.strong);
        let whole = galley.size() + vec2(16.0, 8.0);
        // Below the upper border, beside the divider.
        let (anchor, at) = match right {
            false => (Align2::RIGHT_TOP, pos2(x - ROOM, rect.min.y + 10.0)),
            true => (Align2::LEFT_TOP, pos2(x + ROOM, rect.min.y + 10.0)),
        };
        let label = anchor.anchor_size(at, whole);
        let meets_cube = label.max.x > rect.max.x - view_cube::ROOM - 6.0;
        let label = if meets_cube { label.translate(vec2(0.0, view_cube::ROOM + 6.0)) } else { label };
        painter.rect_filled(label, 4, palette.raised.gamma_multiply(0.92));
        painter.galley(label.center() - galley.size() / 2.0, galley, palette.strong);
    }
    if wipe.hovered {
        ctx.set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
}
