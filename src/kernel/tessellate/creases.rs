//! Lines between the patches of a face across which the surface is not smooth.

use glam::DVec4;

use crate::kernel::bezier::BezierPatch;

use super::outline::Ground;

/// Jumps below this part of the derivative are rounding.
const SMOOTH: f64 = 1e-9;

/// A line between patches across which the derivative jumps.
pub(super) struct Crease {
    pub(super) axis: usize,
    pub(super) at: f64,
    pub(super) from: f64,
    pub(super) to: f64,
    /// Largest jump of the derivative across it.
    pub(super) jump: f64,
    /// Largest jump of the weight's derivative.
    pub(super) weight_jump: f64,
}

/// The lines between patches across which the surface or its weight is not smooth.
pub(super) fn creases(ground: &Ground) -> Vec<Crease> {
    let (us, vs) = (ground.sheet.u_lines(), ground.sheet.v_lines());
    let mut creases = Vec::new();
    for i in 0..us.len().saturating_sub(1) {
        for j in 0..vs.len().saturating_sub(1) {
            let Some(here) = ground.sheet.cell(i, j) else { continue };
            let right = (i + 2 < us.len()).then(|| ground.sheet.cell(i + 1, j)).flatten();
            let above = (j + 2 < vs.len()).then(|| ground.sheet.cell(i, j + 1)).flatten();
            if let Some(right) = right.filter(|right| !runs_on(0, here, right)) {
                creases.extend(crease(0, here, right));
            }
            if let Some(above) = above.filter(|above| !runs_on(1, here, above)) {
                creases.extend(crease(1, &here.swap(), &above.swap()));
            }
        }
    }
    creases
}

/// Whether points times weights, and weights, are smooth where `b` follows `a` along an axis, as they are at simple knots: then
/// so is the surface.
fn runs_on(axis: usize, a: &BezierPatch, b: &BezierPatch) -> bool {
    if [a.degree_u, a.degree_v] != [b.degree_u, b.degree_v] {
        return false;
    }
    let (m, n) = (a.degree_u, a.degree_v);
    // The last two control points of `a` along the axis and the first two of `b`, for line `k` of them.
    let (step, lines, last) = if axis == 0 { (n + 1, n + 1, m) } else { (1, m + 1, n) };
    let start = |k: usize| if axis == 0 { k } else { k * (n + 1) };
    let home = |p: &BezierPatch, at: usize| {
        let w = p.weights[at];
        ((p.points[at] - a.points[0]) * w).extend(w)
    };
    let [wa, wb] = [a, b].map(|p| p.uv_max[axis] - p.uv_min[axis]);
    let (mut jump, mut speed) = (DVec4::ZERO, DVec4::ZERO);
    for k in 0..lines {
        let end = start(k) + last * step;
        let before = (home(a, end) - home(a, end - step)) / wa;
        let after = (home(b, start(k) + step) - home(b, start(k))) / wb;
        jump = jump.max((before - after).abs());
        speed = speed.max(before.abs());
    }
    let along = SMOOTH * speed.truncate().max_element();
    jump.truncate().max_element() <= along && jump.w <= SMOOTH * speed.w
}

/// The line where `b` follows `a` in u.
fn crease(axis: usize, a: &BezierPatch, b: &BezierPatch) -> Option<Crease> {
    let (wa, wb) = (a.uv_max.x - a.uv_min.x, b.uv_max.x - b.uv_min.x);
    let (mut jump, mut weight_jump, mut speed) = (0.0f64, 0.0f64, 0.0f64);
    let rational = a.is_rational() || b.is_rational();
    let (m, rows) = (a.degree_u, a.degree_v + 1);
    if !rational && a.degree_v == b.degree_v {
        for j in 0..rows {
            let before = (a.points[m * rows + j] - a.points[(m - 1) * rows + j]) * (m as f64 / wa);
            let after = (b.points[rows + j] - b.points[j]) * (b.degree_u as f64 / wb);
            jump = jump.max(before.distance(after));
            speed = speed.max(before.length());
        }
    } else {
        let samples = 2 * rows;
        for k in 0..=samples {
            let v = k as f64 / samples as f64;
            let (before, after) = (a.tangents(1.0, v).du / wa, b.tangents(0.0, v).du / wb);
            jump = jump.max(1.2 * before.distance(after));
            speed = speed.max(before.length());
        }
        for j in 0..rows.min(b.degree_v + 1) {
            let before = (a.weights[m * rows + j] - a.weights[(m - 1) * rows + j]) * (m as f64 / wa);
            let after = (b.weights[b.degree_v + 1 + j] - b.weights[j]) * (b.degree_u as f64 / wb);
            weight_jump = weight_jump.max((before - after).abs());
        }
    }
    if jump <= SMOOTH * speed {
        jump = 0.0;
    }
    let (from, to) = (a.uv_min.y, a.uv_max.y);
    (jump > 0.0 || weight_jump > 0.0).then_some(Crease { axis, at: a.uv_max.x, from, to, jump, weight_jump })
}
