//! Marks of the pin holes in the picture, and how many there are.

use bevy_egui::egui::{Align2, Color32, FontId, Painter, Rect, Stroke, pos2, vec2};

use crate::editor::inspection::PinHoles;
use crate::editor::panels::Reads;
use crate::editor::panels::format::plural;
use crate::editor::settings::HoleMarks;
use crate::editor::theme::size;
use crate::editor::viewport::Viewport;
use crate::inspect::HoleClass;

/// Radius of a ring, points.
const RADIUS: f32 = 5.0;
/// Side of a square over a hole, points.
const DILATED: f32 = 5.0;
/// Marks drawn at most: more would cover the picture.
const MOST: usize = 4_000;

/// The classes with their names, as they are counted.
pub(super) const CLASSES: [(HoleClass, &str, &str); 3] = [
    (HoleClass::Gap, "gap", "The sides stand apart"),
    (HoleClass::Overlap, "overlap", "The sides overlap, one above the other, and one looks in between"),
    (HoleClass::Solver, "our own", "The exact surfaces have no hole there: our own solver failed"),
];

/// Draws them.
pub(super) fn show(painter: &Painter, rect: Rect, reads: &Reads, viewport: &Viewport, found: &PinHoles) {
    let moving = reads.settings.holes_moving;
    let known = found.of(&reads.camera.now).is_some() || (moving && found.camera.is_some());
    if !known {
        return;
    }
    let style = reads.settings.hole_marks;
    let mut last: Option<[u32; 2]> = None;
    let places = found.places(&reads.camera.now, viewport, moving);
    for (hole, at) in places.take(if found.lit { MOST } else { 0 }) {
        let (at, colour) = (pos2(at.x, at.y), colour(hole.class));
        if style == HoleMarks::Dilated {
            let square = Rect::from_center_size(at, vec2(DILATED, DILATED));
            painter.rect_filled(square, 0, colour);
            continue;
        }
        // One ring for neighbours in a row.
        let [x, y] = hole.pixel;
        let goes_on = last.is_some_and(|[lx, ly]| ly == y && lx + 1 == x);
        last = Some(hole.pixel);
        if !goes_on {
            painter.circle_stroke(at, RADIUS, Stroke::new(1.5, colour));
        }
    }
    let font = FontId::proportional(size::BODY);
    let galley = painter.layout_no_wrap(summary(found), font, reads.palette.strong);
    let label = Align2::CENTER_BOTTOM
        .anchor_size(rect.center_bottom() - vec2(0.0, 10.0), galley.size() + vec2(16.0, 8.0));
    painter.rect_filled(label, 4, reads.palette.raised.gamma_multiply(0.9));
    painter.galley(label.center() - galley.size() / 2.0, galley, reads.palette.strong);
}

/// How many there are, by class.
pub(super) fn summary(found: &PinHoles) -> String {
    let parts: Vec<String> = CLASSES
        .into_iter()
        .map(|(class, name, _)| (found.count(class), name))
        .filter(|(count, _)| *count > 0)
        .map(|(count, name)| format!("{count} {name}"))
        .collect();
    match parts.as_slice() {
        [] => "No pin holes".to_owned(),
        parts => format!("{}: {}", plural(found.holes.len(), "pin hole"), parts.join(", ")),
    }
}

/// The colour of a class.
pub(in crate::editor::panels) fn colour(class: HoleClass) -> Color32 {
    match class {
        HoleClass::Gap => Color32::from_rgb(255, 72, 72),
        HoleClass::Overlap => Color32::from_rgb(255, 190, 60),
        HoleClass::Solver => Color32::from_rgb(90, 160, 255),
    }
}
