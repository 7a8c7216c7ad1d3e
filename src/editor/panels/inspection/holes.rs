//! Marks of the pin holes in the picture, and how many there are.

use bevy_egui::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, pos2, vec2};

use crate::editor::inspection::PinHoles;
use crate::editor::panels::Reads;
use crate::editor::panels::format::{count, plural};
use crate::editor::settings::HoleMarks;
use crate::editor::theme::size;
use crate::editor::viewport::Viewport;
use crate::inspect::{HoleClass, PinHole};

/// Radius of a ring, points.
const RADIUS: f32 = 5.0;
/// Longer runs, points, get a line along them in place of a ring: a wide gap is shaded.
const LONGEST: f32 = 8.0;
/// Side of a square over a hole, points.
const DILATED: f32 = 5.0;
/// Between the legend and the count, points.
const BESIDE: f32 = 8.0;
/// Marks drawn at most: more would cover the picture.
const MOST: usize = 20_000;

/// The classes with their names, as they are counted.
pub(super) const CLASSES: [(HoleClass, &str, &str); 4] = [
    (HoleClass::Gap, "gap", "The sides stand apart"),
    (HoleClass::Overlap, "overlap", "The sides overlap, one above the other, and one looks in between"),
    (HoleClass::Solver, "our own", "The exact surfaces have no hole there: our own solver failed"),
    (
        HoleClass::Rounding,
        "rounding, too close to tell",
        "The exact surfaces have no hole there: a pixel is finer than the picture's single precision",
    ),
];

/// Neighbouring holes in a row of the picture: one mark for all.
struct Run {
    class: HoleClass,
    last: [u32; 2],
    from: Pos2,
    to: Pos2,
}

impl Run {
    fn goes_on(&self, hole: &PinHole) -> bool {
        let [x, y] = self.last;
        hole.class == self.class && hole.pixel == [x + 1, y]
    }
}

/// Draws them, and how many there are: beside `legend`, or above it.
pub(super) fn show(
    painter: &Painter,
    (rect, legend): (Rect, Option<Rect>),
    reads: &Reads,
    viewport: &Viewport,
    found: &PinHoles,
) {
    let moving = reads.settings.holes_moving;
    let known = found.of(&reads.camera.now).is_some() || (moving && found.camera.is_some());
    if !known {
        return;
    }
    let style = reads.settings.hole_marks;
    let places = found.places(&reads.camera.now, viewport, moving).take(if found.lit { MOST } else { 0 });
    let mut runs: Vec<Run> = Vec::new();
    for (hole, at) in places {
        let at = pos2(at.x, at.y);
        if style == HoleMarks::Dilated {
            let square = Rect::from_center_size(at, vec2(DILATED, DILATED));
            painter.rect_filled(square, 0, colour(hole.class));
            continue;
        }
        match runs.last_mut() {
            Some(run) if run.goes_on(hole) => (run.last, run.to) = (hole.pixel, at),
            _ => runs.push(Run { class: hole.class, last: hole.pixel, from: at, to: at }),
        }
    }
    for run in runs {
        let ink = colour(run.class);
        if run.from.distance(run.to) > LONGEST {
            painter.line_segment([run.from, run.to], Stroke::new(1.0, ink.gamma_multiply(0.7)));
        } else {
            let centre = run.from + (run.to - run.from) / 2.0;
            painter.circle_stroke(centre, RADIUS, Stroke::new(1.5, ink));
        }
    }
    let font = FontId::proportional(size::BODY);
    let galley = painter.layout_no_wrap(summary(found), font, reads.palette.strong);
    let size = galley.size() + vec2(16.0, 8.0);
    let mut label = Align2::CENTER_BOTTOM.anchor_size(rect.center_bottom() - vec2(0.0, 10.0), size);
    if let Some(legend) = legend.filter(|l| l.expand(BESIDE).intersects(label)) {
        label = match legend.max.x + BESIDE + size.x < rect.max.x {
            true => label.translate(vec2(legend.max.x + BESIDE - label.min.x, 0.0)),
            false => label.translate(vec2(0.0, legend.min.y - BESIDE - label.max.y)),
        };
    }
    painter.rect_filled(label, 4, reads.palette.raised.gamma_multiply(0.9));
    painter.galley(label.center() - galley.size() / 2.0, galley, reads.palette.strong);
}

/// How many there are, by class.
pub(super) fn summary(found: &PinHoles) -> String {
    let parts: Vec<String> = CLASSES
        .into_iter()
        .map(|(class, name, _)| (found.count(class), name))
        .filter(|(number, _)| *number > 0)
        .map(|(number, name)| format!("{} {name}", count(number)))
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
        HoleClass::Rounding => Color32::from_rgb(150, 150, 150),
    }
}
