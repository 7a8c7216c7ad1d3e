//! Marks where something is wrong with the loops: a ring and a few words, in the panel and over the 3D view.
//! Notes are in the list of problems alone: nothing is drawn wrong there.

use bevy_egui::egui::{Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Stroke, vec2};

use super::colors::Colors;
use super::draw_plane::{canvas, pos};
use super::view::UvView;
use crate::editor::theme::{Palette, size};
use crate::kernel::trim::validity::{LoopProblem, ProblemKind, Severity};

/// Radius of a ring, logical pixels.
pub const RING_PX: f32 = 9.0;
/// Most rings drawn; most of them with words.
pub const MOST: usize = 200;
const MOST_LABELS: usize = 12;

/// The colour of a problem.
pub fn color(problem: &LoopProblem, palette: &Palette) -> Color32 {
    match problem.severity() {
        Severity::Error => palette.error,
        Severity::Warning => palette.warning,
        Severity::Note => palette.note,
    }
}

/// What is wrong, in a word or two.
pub fn label(problem: &LoopProblem) -> &'static str {
    match problem.kind {
        ProblemKind::Empty => "empty loop",
        ProblemKind::Open { .. } => "open",
        ProblemKind::CrossesItself { .. } => "crosses itself",
        ProblemKind::Crosses { .. } => "loops cross",
        ProblemKind::LeavesDomain { .. } => "leaves the surface",
        ProblemKind::OuterInside { .. } => "drawn as a hole",
        ProblemKind::HoleOutside => "drawn as a face",
        ProblemKind::ZeroLength => "no length",
        ProblemKind::NoDirection { .. } => "points coincide",
    }
}

/// Rings and words on the canvas.
pub fn draw(painter: &Painter, view: &UvView, problems: &[LoopProblem], palette: &Palette, colors: &Colors) {
    let area = canvas(view);
    let serious = problems.iter().filter(|p| p.is_serious());
    let mut labels = Labels::default();
    let places = serious.take(MOST).map(|p| (p, pos(view.to_screen(p.uv))));
    for (problem, place) in places.filter(|(_, at)| area.expand(RING_PX).contains(*at)) {
        painter.circle_stroke(place, RING_PX, Stroke::new(2.0, color(problem, palette)));
        labels.words(painter, place, label(problem), color(problem, palette), colors.ruler);
    }
}

/// Where words are already.
#[derive(Debug, Default)]
pub struct Labels(Vec<Rect>);

impl Labels {
    /// Words beside a ring, on ground that they can be read on; none where others are.
    pub fn words(&mut self, painter: &Painter, place: Pos2, text: &str, color: Color32, ground: Color32) {
        let font = FontId::proportional(size::SMALL);
        let galley = painter.layout_no_wrap(text.to_owned(), font, color);
        let at = Align2::LEFT_CENTER.anchor_size(place + vec2(RING_PX + 6.0, 0.0), galley.size()).min;
        let rect = Rect::from_min_size(at, galley.size()).expand2(vec2(4.0, 1.0));
        if self.0.len() >= MOST_LABELS || self.0.iter().any(|other| other.intersects(rect)) {
            return;
        }
        painter.rect_filled(rect, CornerRadius::same(3), ground);
        painter.galley(at, galley, color);
        self.0.push(rect);
    }
}
