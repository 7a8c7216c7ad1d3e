//! The patches of one face as one surface over native parameters.
//!
//! Patches of a face tile a rectangle of parameters along common u- and v-lines (copies of periodic
//! surfaces included), so a point is located by two binary searches.

use glam::{DVec2, DVec3};

use crate::kernel::bezier::{BezierPatch, Tangents};

/// Patches found by their parameters.
#[derive(Debug, Clone)]
pub struct Sheet<'a> {
    patches: &'a [BezierPatch],
    u_lines: Vec<f64>,
    v_lines: Vec<f64>,
    /// Patch of each cell, u-major; `None` where no patch lies.
    cells: Vec<Option<u32>>,
}

impl<'a> Sheet<'a> {
    /// Arranges `patches`; where two overlap the later one counts.
    pub fn new(patches: &'a [BezierPatch]) -> Self {
        let lines = |ends: &dyn Fn(&BezierPatch) -> [f64; 2]| {
            let mut lines: Vec<f64> = patches.iter().flat_map(ends).collect();
            lines.sort_unstable_by(f64::total_cmp);
            lines.dedup();
            lines
        };
        let u_lines = lines(&|p| [p.uv_min.x, p.uv_max.x]);
        let v_lines = lines(&|p| [p.uv_min.y, p.uv_max.y]);
        let columns = v_lines.len().saturating_sub(1);
        let mut cells = vec![None; u_lines.len().saturating_sub(1) * columns];
        for (number, patch) in patches.iter().enumerate() {
            let at = |lines: &[f64], x: f64| lines.partition_point(|l| *l < x);
            for i in at(&u_lines, patch.uv_min.x)..at(&u_lines, patch.uv_max.x) {
                for j in at(&v_lines, patch.uv_min.y)..at(&v_lines, patch.uv_max.y) {
                    cells[i * columns + j] = Some(number as u32);
                }
            }
        }
        Self { patches, u_lines, v_lines, cells }
    }

    /// The u-values at which patches begin or end, sorted.
    pub fn u_lines(&self) -> &[f64] {
        &self.u_lines
    }

    /// The v-values at which patches begin or end, sorted.
    pub fn v_lines(&self) -> &[f64] {
        &self.v_lines
    }

    /// How many patches a row of constant v passes through between two values of u.
    pub(crate) fn columns(&self, from: f64, to: f64) -> usize {
        interval(&self.u_lines, to) - interval(&self.u_lines, from).min(interval(&self.u_lines, to)) + 1
    }

    /// The patch over the cell between `u_lines[i]`, `u_lines[i + 1]` and `v_lines[j]`, `v_lines[j + 1]`.
    pub fn cell(&self, i: usize, j: usize) -> Option<&'a BezierPatch> {
        let cell = self.cells.get(i * (self.v_lines.len() - 1) + j)?;
        cell.map(|number| &self.patches[number as usize])
    }

    /// The patch at `uv` (clamped to the rectangle) and the parameters on it.
    pub fn locate(&self, uv: DVec2) -> Option<(&'a BezierPatch, DVec2)> {
        let patch = self.cell(interval(&self.u_lines, uv.x), interval(&self.v_lines, uv.y))?;
        Some((patch, patch.local(uv).clamp(DVec2::ZERO, DVec2::ONE)))
    }

    /// The point at native `uv`, if a patch lies there.
    pub fn point(&self, uv: DVec2) -> Option<DVec3> {
        self.locate(uv).map(|(patch, local)| patch.point(local.x, local.y))
    }

    /// Point and derivatives with respect to native parameters, if a patch lies there.
    pub fn tangents(&self, uv: DVec2) -> Option<Tangents> {
        self.locate(uv).map(|(patch, local)| {
            let at = patch.tangents(local.x, local.y);
            let size = patch.uv_max - patch.uv_min;
            Tangents { point: at.point, du: at.du / size.x, dv: at.dv / size.y }
        })
    }
}

/// Position of the interval of `lines` that holds `x`, clamped to the first and last.
pub(crate) fn interval(lines: &[f64], x: f64) -> usize {
    lines.partition_point(|l| *l <= x).clamp(1, lines.len().max(2) - 1) - 1
}
