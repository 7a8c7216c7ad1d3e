//! Dimension lines over the viewport: the largest gap of the chosen edge, and the gap at the pointer.

use bevy_egui::egui::{
    Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Stroke, StrokeKind, Vec2, vec2,
};
use glam::DVec3;

use super::InspectionState;
use crate::editor::camera::motion::project;
use crate::editor::panels::Reads;
use crate::editor::theme::size;
use crate::editor::viewport::Viewport;
use crate::inspect::{GapSense, Length};

/// Below this the two ends are one dot, points.
const APART: f32 = 5.0;

/// Draws the lines.
pub(super) fn show(painter: &Painter, reads: &Reads, viewport: &Viewport, state: &InspectionState) {
    let unit = state.findings.unit();
    let chosen = state.chosen.edge.and_then(|key| state.findings.edge(&key)).and_then(|edge| edge.gap);
    if let Some(gap) = chosen {
        let [a, b] = gap.between.map(|end| end.point);
        let text = format!("{} {}", Length { mm: unit * gap.maximum }, sense(gap.sense));
        dimension(painter, reads, viewport, [a, b], &text, reads.palette.accent, true);
    }
    if let Some((_, points)) = state.probe.reading {
        let text = Length { mm: unit * points[0].distance(points[1]) }.to_string();
        dimension(painter, reads, viewport, points, &text, reads.palette.strong, chosen.is_none());
    }
}

/// How the two sides of a gap lie to each other, in words.
pub(super) fn sense(sense: GapSense) -> &'static str {
    match sense {
        GapSense::Closed => "closed",
        GapSense::Opening => "opening",
        GapSense::Overlap => "overlap",
        GapSense::Step => "step",
    }
}

/// A line between two model points with ticks at its ends, or a ring where they are one on the screen.
fn dimension(
    painter: &Painter,
    reads: &Reads,
    viewport: &Viewport,
    ends: [DVec3; 2],
    text: &str,
    colour: Color32,
    above: bool,
) {
    let on_screen = |p: DVec3| -> Option<Pos2> {
        let (ndc, _) = project(&reads.camera.now, p, viewport.aspect())?;
        (ndc.abs().max_element() < 1.2).then(|| {
            let at = viewport.position(ndc);
            Pos2::new(at.x, at.y)
        })
    };
    let (Some(a), Some(b)) = (on_screen(ends[0]), on_screen(ends[1])) else { return };
    let (halo, stroke) = (Stroke::new(4.0, Color32::from_black_alpha(110)), Stroke::new(1.6, colour));
    let along = b - a;
    let middle = a + along / 2.0;
    if along.length() >= APART {
        let across = Vec2::new(-along.y, along.x).normalized() * 6.0;
        for line in [[a, b], [a - across, a + across], [b - across, b + across]] {
            painter.line_segment(line, halo);
            painter.line_segment(line, stroke);
        }
    } else {
        painter.circle_stroke(middle, 6.0, halo);
        painter.circle_stroke(middle, 6.0, stroke);
    }
    let font = FontId::proportional(size::BODY);
    let galley = painter.layout_no_wrap(text.to_owned(), font.clone(), reads.palette.strong);
    let up = if above { -1.0 } else { 1.0 };
    let centre = middle + vec2(0.0, up * (along.y.abs() / 2.0 + 30.0));
    let label = Rect::from_center_size(centre, galley.size() + vec2(14.0, 8.0));
    painter.line_segment([middle + vec2(0.0, up * 8.0), centre], Stroke::new(1.0, colour));
    painter.rect(
        label,
        CornerRadius::same(4),
        reads.palette.raised,
        Stroke::new(1.0, colour),
        StrokeKind::Inside,
    );
    painter.text(label.center(), Align2::CENTER_CENTER, text, font, reads.palette.strong);
}
