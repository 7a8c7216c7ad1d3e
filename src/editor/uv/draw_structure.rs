//! The trimming structures over the face: P1's intervals (figures 7 and 8) or the cells of the parity grid.
//!
//! The more curves a point of a cell has to ask, the stronger its colour; cells that ask none are only
//! outlined. Numbers appear where there is room for them.

use bevy_egui::egui::{Align2, CornerRadius, FontId, Painter, Rect, Shape, Stroke, StrokeKind};
use glam::Vec2;

use super::colors::Colors;
use super::draw_plane::{canvas, pos};
use super::panel::Overlay;
use super::view::UvView;
use crate::kernel::face::Face;
use crate::kernel::trim::{FillRule, IntervalLists};

/// P1's lists of more clipped curves than this are not built for looking at.
const MOST_CLIPPED: usize = 200_000;
/// Cells smaller than this on the screen are not drawn, logical pixels.
const SMALLEST_PX: f32 = 1.5;
/// Cells with more room than this get their number, logical pixels.
const NUMBER_PX: f32 = 18.0;
/// Most cells drawn.
const MOST_CELLS: usize = 60_000;

/// A cell on the screen.
struct Cell {
    rect: Rect,
    count: usize,
}

/// What is drawn: rectangles to keep, numbers to write each time.
#[derive(Debug, Clone, Default)]
pub struct Structure {
    /// Places and numbers.
    pub numbers: Vec<(bevy_egui::egui::Pos2, usize)>,
    /// What to say about it.
    pub caption: String,
}

/// Draws the structure of `face` and says what it is.
pub fn draw(
    shapes: &mut Vec<Shape>,
    view: &UvView,
    face: &Face,
    overlay: Overlay,
    colors: &Colors,
) -> Structure {
    let (cells, caption) = match overlay {
        Overlay::None => return Structure::default(),
        Overlay::Intervals => intervals(view, face),
        Overlay::Grid => grid(view, face),
    };
    let line = Stroke::new(1.0, colors.structure.gamma_multiply(0.35));
    let mut structure = Structure { numbers: Vec::new(), caption };
    for cell in cells.iter().take(MOST_CELLS) {
        if cell.count > 0 {
            let strength = 0.12 + 0.11 * (cell.count.min(6) as f32);
            shapes.push(Shape::rect_filled(
                cell.rect,
                CornerRadius::ZERO,
                colors.structure.gamma_multiply(0.5 * strength),
            ));
        }
        if cell.rect.width() > 3.0 && cell.rect.height() > 3.0 {
            shapes.push(Shape::rect_stroke(cell.rect, CornerRadius::ZERO, line, StrokeKind::Middle));
        }
        if cell.count > 0 && cell.rect.width() > NUMBER_PX && cell.rect.height() > NUMBER_PX {
            structure.numbers.push((cell.rect.center(), cell.count));
        }
    }
    structure
}

/// Writes the numbers and the caption.
pub fn numbers(painter: &Painter, structure: &Structure, colors: &Colors) {
    const MOST: usize = 600;
    for (place, count) in structure.numbers.iter().take(MOST) {
        let font = FontId::proportional(10.5);
        painter.text(*place, Align2::CENTER_CENTER, count.to_string(), font, colors.structure);
    }
}

fn on_screen(view: &UvView, face: &Face, min: Vec2, max: Vec2) -> Option<Rect> {
    let at = |p: Vec2| pos(view.to_screen(face.domain.native(p.as_dvec2())));
    let rect = Rect::from_two_pos(at(min), at(max));
    let large = rect.width() >= SMALLEST_PX || rect.height() >= SMALLEST_PX;
    (large && rect.intersects(canvas(view))).then(|| rect.intersect(canvas(view).expand(4.0)))
}

fn intervals(view: &UvView, face: &Face) -> (Vec<Cell>, String) {
    let lists = IntervalLists::bounded(&face.pieces, &face.segments, FillRule::EvenOdd, MOST_CLIPPED);
    let Some(lists) = lists else {
        return (Vec::new(), format!("More than {MOST_CLIPPED} clipped curves: not shown"));
    };
    let cells = lists
        .cells()
        .filter_map(|c| Some(Cell { rect: on_screen(view, face, c.min, c.max)?, count: c.candidates }));
    let caption = format!(
        "{} v-intervals, {} u-intervals, {} clipped curves",
        lists.row_count(),
        lists.cells().count(),
        lists.clipped_count()
    );
    (cells.collect(), caption)
}

fn grid(view: &UvView, face: &Face) -> (Vec<Cell>, String) {
    let leaves = face.grid.leaves();
    let caption = format!(
        "{} × {} cells, {} with the refined ones, {} list entries",
        face.grid.header.columns,
        face.grid.header.rows,
        leaves.len(),
        leaves.iter().map(|l| l.entries).sum::<usize>()
    );
    let cells = leaves.iter().filter_map(|leaf| {
        Some(Cell { rect: on_screen(view, face, leaf.min, leaf.max)?, count: leaf.entries })
    });
    (cells.collect(), caption)
}
