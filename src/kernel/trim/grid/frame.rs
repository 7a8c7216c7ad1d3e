//! Where a block of cells lies, in exactly the arithmetic of the query.
//!
//! Points, vertices and ranges all go through the same monotone f32 function to a row and a column;
//! that alone makes the bits of the entries consistent, whatever the rounding.

/// A block of `columns x rows` cells: the outer one or the child of a cell.
#[derive(Debug, Clone)]
pub struct Frame {
    /// Number of columns.
    pub columns: i32,
    /// Number of rows.
    pub rows: i32,
    /// Lower left corner (u, v).
    origin: [f64; 2],
    /// Size of a cell (u, v).
    cell: [f64; 2],
    scale: [f32; 2],
    /// Of each enclosing block: the cell (column, row) that is refined, and into how many.
    parents: Vec<([i32; 2], f32)>,
}

impl Frame {
    /// The outer block.
    pub fn outer(columns: u32, rows: u32) -> Self {
        Self {
            columns: columns as i32,
            rows: rows as i32,
            origin: [0.0; 2],
            cell: [1.0 / f64::from(columns), 1.0 / f64::from(rows)],
            scale: [columns as f32, rows as f32],
            parents: Vec::new(),
        }
    }

    /// The block of k x k cells inside one cell.
    pub fn child(&self, column: i32, row: i32, k: u32) -> Self {
        let mut parents = self.parents.clone();
        parents.push(([column, row], k as f32));
        Self {
            columns: k as i32,
            rows: k as i32,
            origin: [
                self.origin[0] + f64::from(column) * self.cell[0],
                self.origin[1] + f64::from(row) * self.cell[1],
            ],
            cell: self.cell.map(|c| c / f64::from(k)),
            scale: self.scale,
            parents,
        }
    }

    /// Column of `u`; -1 or `columns` when it is outside of the block.
    pub fn column(&self, u: f32) -> i32 {
        self.position(u, 0, self.columns)
    }

    /// Row of `v`; -1 or `rows` when it is outside of the block.
    pub fn row(&self, v: f32) -> i32 {
        self.position(v, 1, self.rows)
    }

    fn position(&self, value: f32, axis: usize, count: i32) -> i32 {
        let mut x = value * self.scale[axis];
        for (at, k) in &self.parents {
            let index = x as i32;
            match index.cmp(&at[axis]) {
                std::cmp::Ordering::Less => return -1,
                std::cmp::Ordering::Greater => return count,
                std::cmp::Ordering::Equal => x = (x - index as f32) * k,
            }
        }
        (x as i32).min(count)
    }

    /// Heights between which row `row` lies.
    pub fn strip(&self, row: i32) -> (f64, f64) {
        let low = self.origin[1] + f64::from(row) * self.cell[1];
        (low, low + self.cell[1])
    }

    /// Width of a cell.
    pub fn cell_width(&self) -> f64 {
        self.cell[0]
    }

    /// The smaller side of a cell.
    pub fn cell_size(&self) -> f64 {
        self.cell[0].min(self.cell[1])
    }

    /// Nesting depth, 1 for the outer block.
    pub fn level(&self) -> u32 {
        self.parents.len() as u32 + 1
    }
}
