//! The u-intervals as rectangles, for looking at (P1, figures 7 and 8).

use glam::Vec2;

use super::IntervalLists;

/// A u-interval within its v-interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntervalCell {
    /// Lower left corner, normalised.
    pub min: Vec2,
    /// Upper right corner.
    pub max: Vec2,
    /// Winding of everything entirely to the right.
    pub definite: i32,
    /// Number of curves that have to be asked.
    pub candidates: usize,
}

impl IntervalLists {
    /// Number of v-intervals.
    pub fn row_count(&self) -> usize {
        self.rows.len().saturating_sub(1)
    }

    /// All u-intervals, v-interval by v-interval from below, cut to the unit square.
    pub fn cells(&self) -> impl Iterator<Item = IntervalCell> + '_ {
        (0..self.row_count()).flat_map(move |row| {
            let (first, end) = (self.rows[row] as usize, self.rows[row + 1] as usize);
            let (low, high) = (self.heights[row], self.heights[row + 1]);
            (first..end).map(move |index| {
                let (interval, after) = (self.intervals[index], self.intervals[index + 1]);
                let right = if index + 1 == end { 1.0 } else { after.start };
                IntervalCell {
                    min: Vec2::new(interval.start.clamp(0.0, 1.0), low),
                    max: Vec2::new(right.clamp(0.0, 1.0), high),
                    definite: interval.definite,
                    candidates: (after.candidates - interval.candidates) as usize,
                }
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::trim::{FillRule, TrimStructure};
    use crate::scene::demo;

    /// Cells without candidates say inside or outside for all of their points.
    #[test]
    fn cells_tile_the_square_and_those_without_candidates_are_right() {
        let model = demo::model();
        let face = model.faces.iter().filter_map(|f| f.derive().ok()).max_by_key(|f| f.counts.kept);
        let face = face.expect("the demo has trimmed faces");
        let lists = IntervalLists::new(&face.pieces, &face.segments, FillRule::EvenOdd);
        let cells: Vec<IntervalCell> = lists.cells().collect();
        let area: f32 = cells.iter().map(|c| (c.max - c.min).element_product()).sum();
        assert!((area - 1.0).abs() < 1e-4, "{area}");
        for cell in cells.iter().filter(|c| c.candidates == 0 && (c.max - c.min).min_element() > 1e-6) {
            assert_eq!(lists.classify(0.5 * (cell.min + cell.max)), cell.definite & 1 != 0);
        }
        assert!(cells.iter().any(|c| c.candidates > 0));
    }
}
