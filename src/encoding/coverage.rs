//! How much of a parameter rectangle the trim loops keep: cells with nothing to show are never packed, and
//! cells kept whole need no trimming.

use glam::{DVec2, Vec2};

use crate::kernel::trim::grid::layout::{CELL_REFINED, CELL_SHIFT, ENTRY_SHIFT, GridHeader, MAX_LEVELS};
use crate::kernel::trim::record::{crossing, load};
use crate::kernel::trim::{ParityGrid, TrimStructure};

/// What trimming leaves of a rectangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coverage {
    /// Nothing.
    Empty,
    /// Everything.
    Whole,
    /// Something, as far as the grid tells.
    Mixed,
}

/// Looks at the segments in the grid's cells under the rectangle `min..max` (normalised), which is
/// widened by a little for the rounding of points on its border.
pub fn coverage(grid: &ParityGrid, min: DVec2, max: DVec2) -> Coverage {
    let header = &grid.header;
    if header.columns == 0 || header.rows == 0 {
        return Coverage::Empty;
    }
    let rect = Rect { min: (min - MARGIN).as_vec2(), max: (max + MARGIN).as_vec2() };
    if Block::outer(grid).visit(grid, &rect, MAX_LEVELS, &mut |_| true) {
        return Coverage::Mixed;
    }
    let middle = (0.5 * (min + max)).as_vec2();
    if grid.classify(middle) { Coverage::Whole } else { Coverage::Empty }
}

/// By how much rectangles are widened at least.
pub(super) const MARGIN: f64 = 1e-5;

struct Rect {
    min: Vec2,
    max: Vec2,
}

/// Looks at the segments that touch the rectangle `min..max` (normalised), widened by `margin`, entry word by entry word, some of
/// them more than once. Stops, and says so, when `stop` does or where the grid cannot tell.
pub(super) fn any_touching(
    grid: &ParityGrid,
    (min, max): (DVec2, DVec2),
    margin: DVec2,
    stop: &mut impl FnMut(u32) -> bool,
) -> bool {
    let rect = Rect { min: (min - margin).as_vec2(), max: (max + margin).as_vec2() };
    let header = &grid.header;
    header.columns == 0 || header.rows == 0 || Block::outer(grid).visit(grid, &rect, MAX_LEVELS, stop)
}

/// What trimming leaves of a triangle in parameters: of the boxes of its quarters, and of theirs.
pub fn triangle_coverage(grid: &ParityGrid, [a, b, c]: [DVec2; 3]) -> Coverage {
    /// The boxes of sixteenths cover a quarter more than the triangle.
    const QUARTERINGS: u32 = 2;
    quarters(grid, [a, b, c], QUARTERINGS)
}

fn quarters(grid: &ParityGrid, [a, b, c]: [DVec2; 3], times: u32) -> Coverage {
    let found = coverage(grid, a.min(b).min(c), a.max(b).max(c));
    if found != Coverage::Mixed || times == 0 {
        return found;
    }
    let (p, q, r) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a));
    let first = quarters(grid, [p, q, r], times - 1);
    let same = |t: [DVec2; 3]| first != Coverage::Mixed && quarters(grid, t, times - 1) == first;
    if same([a, p, r]) && same([p, b, q]) && same([r, q, c]) { first } else { Coverage::Mixed }
}

/// Cells of the grid, side by side over a rectangle of parameters.
struct Block {
    /// Position of the first cell.
    first: u32,
    columns: u32,
    rows: u32,
    min: Vec2,
    size: Vec2,
}

impl Block {
    fn outer(grid: &ParityGrid) -> Self {
        let GridHeader { cell_base, columns, rows, .. } = grid.header;
        Self { first: cell_base, columns, rows, min: Vec2::ZERO, size: Vec2::ONE }
    }

    /// Looks at segments listed in cells under the rectangle that touch it, as far as `levels` of blocks tell, until `stop` says
    /// so. Whether it did, or blocks are nested deeper or broken.
    fn visit(&self, grid: &ParityGrid, rect: &Rect, levels: u32, stop: &mut impl FnMut(u32) -> bool) -> bool {
        let header = &grid.header;
        let cell_size = self.size / Vec2::new(self.columns as f32, self.rows as f32);
        let range = |low: f32, high: f32, count: u32| {
            let at = |x: f32| (x.max(0.0) as u32).min(count - 1);
            at(low)..=at(high)
        };
        let (low, high) = ((rect.min - self.min) / cell_size, (rect.max - self.min) / cell_size);
        for row in range(low.y, high.y, self.rows) {
            for column in range(low.x, high.x, self.columns) {
                let index = (self.first + row * self.columns + column) as usize;
                let (Some(cell), Some(next)) = (grid.cells.get(index), grid.cells.get(index + 1)) else {
                    return true;
                };
                if cell & CELL_REFINED != 0 {
                    let child = (header.entry_base + (cell >> CELL_SHIFT)) as usize;
                    let Some([start, k, ..]) = grid.entries.get(child..) else { return true };
                    let min = self.min + cell_size * Vec2::new(column as f32, row as f32);
                    let first = header.cell_base + start;
                    let inner = Self { first, columns: *k, rows: *k, min, size: cell_size };
                    if levels <= 1 || *k == 0 || inner.visit(grid, rect, levels - 1, stop) {
                        return true;
                    }
                    continue;
                }
                let list = (cell >> CELL_SHIFT) as usize..(next >> CELL_SHIFT) as usize;
                let Some(entries) = grid.entries.get(list) else { return true };
                if entries.iter().any(|e| passes(grid, *e, rect) && stop(*e)) {
                    return true;
                }
            }
        }
        false
    }
}

/// Whether a segment touches the rectangle. It is bi-monotone, so over the heights it shares with the
/// rectangle its u runs between its values at the two ends.
fn passes(grid: &ParityGrid, entry: u32, rect: &Rect) -> bool {
    let address = (grid.header.data_base + (entry >> ENTRY_SHIFT)) as usize;
    let ends = load(&grid.data, address);
    let (low, high) = (rect.min.y.max(ends[1]), rect.max.y.min(ends[3]));
    if low > high || ends[0].max(ends[2]) < rect.min.x || ends[0].min(ends[2]) > rect.max.x {
        return false;
    }
    // Along the border of the parameters nothing is cut off: points are clamped to them. Between equal ends it is straight.
    let along = |p: f32, q: f32| p == q && (p <= 0.0 || p >= 1.0);
    if along(ends[0], ends[2]) || along(ends[1], ends[3]) {
        return false;
    }
    if ends[1] == ends[3] {
        return true;
    }
    // Crossings are asked for below the upper end only.
    let high = high.min(ends[3].next_down());
    let low = low.min(high);
    let (least_at, most_at) = if ends[0] <= ends[2] { (low, high) } else { (high, low) };
    let right_of = |u: f32, v: f32| crossing(&grid.data, address, ends, entry, u, v, &mut ());
    !right_of(rect.max.x, least_at) && right_of(rect.min.x, most_at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::trim::grid::GridOptions;
    use crate::kernel::trim::pack::PackedSegments;
    use crate::kernel::trim::{PieceList, SegmentSet};

    fn polygon(corners: &[(f64, f64)]) -> ParityGrid {
        let mut pieces = PieceList::default();
        let corner = |i: usize| DVec2::from(corners[i % corners.len()]);
        for i in 0..corners.len() {
            pieces.push(&[corner(i), corner(i + 1)], &[1.0, 1.0], None);
        }
        pieces.close_chain();
        let set = SegmentSet::new(&pieces);
        let packed = PackedSegments::new(&pieces, &set).expect("few segments");
        ParityGrid::new(&set, &packed, &GridOptions::default())
    }

    #[test]
    fn loops_along_the_border_cut_off_nothing_but_where_they_leave_it() {
        let all = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert_eq!(coverage(&all, DVec2::ZERO, DVec2::ONE), Coverage::Whole);
        // A corner is missing.
        let part = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.75), (0.75, 0.75), (0.75, 1.0), (0.0, 1.0)]);
        let cover = |u: f64, v: f64| coverage(&part, DVec2::new(u, v), DVec2::new(u + 0.25, v + 0.2));
        assert_eq!(cover(0.0, 0.0), Coverage::Whole);
        assert_eq!(cover(0.75, 0.5), Coverage::Whole);
        assert_eq!(cover(0.0, 0.8), Coverage::Whole);
        assert_eq!(cover(0.75, 0.6), Coverage::Mixed);
        assert_eq!(cover(0.76, 0.8), Coverage::Empty);
        for (u, v) in [(0.0, 0.0), (0.999_999_94, 0.0), (0.0, 0.999_999_94), (0.999_999_94, 0.7)] {
            assert!(part.classify(Vec2::new(u, v)), "{u} {v}");
        }
    }

    #[test]
    fn coverage_agrees_with_points() {
        let grid = polygon(&[(0.2, 0.3), (0.8, 0.25), (0.7, 0.9), (0.4, 0.6)]);
        let mut seen = [0; 3];
        for k in 0..400 {
            let min = DVec2::new((k % 20) as f64, (k / 20) as f64) / 20.0;
            let found = coverage(&grid, min, min + 0.05);
            let inside = |i: i32| {
                let p = min.as_vec2() + 0.05 * Vec2::new((i % 5) as f32 + 0.5, (i / 5) as f32 + 0.5) / 5.0;
                grid.classify(p)
            };
            match found {
                Coverage::Empty => assert!(!(0..25).any(inside)),
                Coverage::Whole => assert!((0..25).all(inside)),
                Coverage::Mixed => {}
            }
            seen[found as usize] += 1;
        }
        assert!(seen[0] > 150 && seen[1] > 40, "{seen:?}");
    }
}
