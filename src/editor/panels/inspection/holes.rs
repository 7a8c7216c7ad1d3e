//! Marks of the pin holes in the picture at rest, and how many there are.

use bevy_egui::egui::{Align2, Color32, FontId, Painter, Rect, Stroke, pos2, vec2};

use crate::editor::inspection::PinHoles;
use crate::editor::panels::Reads;
use crate::editor::panels::format::plural;
use crate::inspect::HoleClass;

/// Radius of a mark, points.
const RADIUS: f32 = 5.0;
/// Marks drawn at most: more would cover the picture.
const MOST: usize = 2_000;

/// Draws them, while the view is the one that they were found in.
pub(super) fn show(painter: &Painter, rect: Rect, reads: &Reads, found: &PinHoles) {
    let Some(holes) = found.of(&reads.camera.now) else { return };
    let scale = vec2(rect.width() / found.size.x.max(1) as f32, rect.height() / found.size.y.max(1) as f32);
    let mut last: Option<[u32; 2]> = None;
    for hole in holes.iter().take(MOST) {
        let [x, y] = hole.pixel;
        // One ring for neighbours in a row.
        if last.is_some_and(|[lx, ly]| ly == y && lx + 1 == x) {
            last = Some(hole.pixel);
            continue;
        }
        last = Some(hole.pixel);
        let at = pos2(rect.min.x + (x as f32 + 0.5) * scale.x, rect.min.y + (y as f32 + 0.5) * scale.y);
        painter.circle_stroke(at, RADIUS, Stroke::new(1.5, colour(hole.class)));
    }
    let parts: Vec<String> =
        [(HoleClass::Gap, "gap"), (HoleClass::Overlap, "overlap"), (HoleClass::Solver, "solver")]
            .into_iter()
            .map(|(class, name)| (found.count(class), name))
            .filter(|(count, _)| *count > 0)
            .map(|(count, name)| format!("{count} {name}"))
            .collect();
    let text = match parts.as_slice() {
        [] => "No pin holes".to_owned(),
        parts => format!("{}: {}", plural(holes.len(), "pin hole"), parts.join(", ")),
    };
    let font = FontId::proportional(12.0);
    painter.text(
        rect.center_bottom() - vec2(0.0, 10.0),
        Align2::CENTER_BOTTOM,
        text,
        font,
        reads.palette.text,
    );
}

fn colour(class: HoleClass) -> Color32 {
    match class {
        HoleClass::Gap => Color32::from_rgb(255, 72, 72),
        HoleClass::Overlap => Color32::from_rgb(255, 190, 60),
        HoleClass::Solver => Color32::from_rgb(90, 160, 255),
    }
}
