//! How many divisions a face may take before it is left as it is.
//!
//! Refinement ends by itself where a surface is smooth. It does not where a surface has a cusp, or folds back on itself
//! within less than any triangle: there every division leaves as much to do. What a face can need is known beforehand, by
//! its second derivatives (Filip, Magedson & Markot 1986): when that many do not get it within the tolerance nothing
//! will, and what is left is said not to be proved. Triangles that look away from the surface are divided for that only so
//! often; after that it is the surface that is folded, and distance alone counts.

use std::cell::Cell;

use super::outline::Ground;
use crate::kernel::bezier::BezierPatch;

/// Divisions of triangles that look away, of a face with hardly any vertices; and for each vertex there is to begin with.
const FEW_FOLDS: usize = 256;
const FOLDS: usize = 2;
/// Divisions for the distance that are not worth counting what the face can need.
const FEW: usize = 1000;
const EACH: usize = 10;
/// Weights that differ by more than this are not taken to bend a surface by more.
const WIDEST: f64 = 16.0;

/// Divisions left to a face.
#[derive(Debug, Clone)]
pub struct Patience {
    folds: Cell<usize>,
    divisions: Cell<usize>,
    /// Whether it is known what the face can need.
    counted: Cell<bool>,
}

impl Patience {
    /// For a face that has so many vertices to begin with.
    pub fn new(vertices: usize) -> Self {
        Self {
            folds: Cell::new(FEW_FOLDS + FOLDS * vertices),
            divisions: Cell::new(FEW + EACH * vertices),
            counted: Cell::new(false),
        }
    }

    /// Whether triangles that look away from the surface are still divided for it.
    pub fn has_folds(&self) -> bool {
        self.folds.get() > 0
    }

    /// Counts a division for a fold.
    pub fn fold(&self) {
        self.folds.set(self.folds.get().saturating_sub(1));
    }

    /// Counts a division for the distance from the `ground`; whether it may still be made.
    pub fn divide(&self, ground: &Ground, tolerance: f64) -> bool {
        if self.divisions.get() == 0 && !self.counted.replace(true) {
            // Larger numbers than any limit of triangles are as good as the largest.
            self.divisions.set(enough(ground, tolerance).min(1e15) as usize);
        }
        let left = self.divisions.get();
        self.divisions.set(left.saturating_sub(1));
        left > 0
    }
}

/// Triangles that are surely enough for a surface.
pub(super) fn enough(ground: &Ground, tolerance: f64) -> f64 {
    ground.patches().iter().map(|p| needed(p, tolerance)).sum()
}

/// The same for a patch, were its grid even.
fn needed(patch: &BezierPatch, tolerance: f64) -> f64 {
    let (m, n) = (patch.degree_u, patch.degree_v);
    let at = |i: usize, j: usize| patch.points[i * (n + 1) + j];
    let (mut uu, mut uv, mut vv) = (0.0f64, 0.0f64, 0.0f64);
    for i in 0..=m {
        for j in 0..=n {
            if i + 2 <= m {
                uu = uu.max((at(i + 2, j) - 2.0 * at(i + 1, j) + at(i, j)).length());
            }
            if i < m && j < n {
                uv = uv.max((at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j)).length());
            }
            if j + 2 <= n {
                vv = vv.max((at(i, j + 2) - 2.0 * at(i, j + 1) + at(i, j)).length());
            }
        }
    }
    let (m, n) = (m as f64, n as f64);
    let (least, most) =
        patch.weights.iter().fold((f64::INFINITY, 0.0f64), |(a, b), w| (a.min(*w), b.max(*w)));
    let per = (most / least).min(WIDEST) / (8.0 * tolerance);
    // Cells of the grid along u and v; what twists is shared out between them.
    let (along, twist, across) = (m * (m - 1.0) * uu * per, m * n * uv * per, n * (n - 1.0) * vv * per);
    2.0 * (1.0 + (along + twist).sqrt()) * (1.0 + (across + twist).sqrt())
}
