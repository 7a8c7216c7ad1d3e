//! The cells of a parity grid as rectangles, for looking at.

use glam::Vec2;

use super::ParityGrid;
use super::layout::{CELL_REFINED, CELL_SHIFT, MAX_LEVELS};

/// A cell that has no finer ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridLeaf {
    /// Lower left corner, normalised.
    pub min: Vec2,
    /// Upper right corner.
    pub max: Vec2,
    /// Number of segments in its list.
    pub entries: usize,
    /// Whether it is inside where its list is empty.
    pub inside: bool,
}

impl ParityGrid {
    /// All cells that have no finer ones.
    pub fn leaves(&self) -> Vec<GridLeaf> {
        let mut leaves = Vec::new();
        let header = &self.header;
        if header.columns > 0 && header.rows > 0 {
            let size = Vec2::new(1.0 / header.columns as f32, 1.0 / header.rows as f32);
            self.block(0, (header.columns, header.rows), (Vec2::ZERO, size), MAX_LEVELS, &mut leaves);
        }
        leaves
    }

    fn block(
        &self,
        first: usize,
        (columns, rows): (u32, u32),
        (origin, size): (Vec2, Vec2),
        levels: u32,
        leaves: &mut Vec<GridLeaf>,
    ) {
        for row in 0..rows {
            for column in 0..columns {
                let index = first + (row * columns + column) as usize;
                let min = origin + size * Vec2::new(column as f32, row as f32);
                let (word, next) = (self.cells[index], self.cells[index + 1]);
                let list = (word >> CELL_SHIFT) as usize;
                if word & CELL_REFINED != 0 && levels > 1 {
                    let (child, k) = (self.entries[list] as usize, self.entries[list + 1]);
                    self.block(child, (k, k), (min, size / k as f32), levels - 1, leaves);
                } else {
                    let entries = (next >> CELL_SHIFT) as usize - list;
                    leaves.push(GridLeaf { min, max: min + size, entries, inside: word & 1 != 0 });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::kernel::trim::TrimStructure;
    use crate::scene::demo;

    #[test]
    fn leaves_tile_the_square_and_empty_ones_are_right() {
        for record in demo::model().faces {
            let Ok(face) = record.derive() else { continue };
            let leaves = face.grid.leaves();
            let area: f64 = leaves.iter().map(|l| f64::from((l.max - l.min).element_product())).sum();
            assert!((area - 1.0).abs() < 1e-3, "{area}");
            for leaf in leaves.iter().filter(|l| l.entries == 0) {
                assert_eq!(face.grid.classify(0.5 * (leaf.min + leaf.max)), leaf.inside, "{leaf:?}");
            }
        }
    }
}
