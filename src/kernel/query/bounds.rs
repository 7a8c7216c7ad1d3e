//! The tight box around a trimmed face.
//!
//! A coordinate is largest on the boundary, at a critical point inside, or on a crease between patches. Boundary
//! curves and patch lines are sampled and refined by golden sections; patches whose control hull reaches
//! further are bisected, and parts dropped whose hull no longer does or on which the coordinate has a slope of
//! one sign (no critical point; walking uphill leads out of the part). Slopes that vanish on the edge of a
//! bisected part prove nothing: the peak may lie on the cut. What is dropped exceeds the box by [`SLACK`]
//! times its diagonal at most.

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

use super::boundary::Boundary;
use super::sheet::Sheet;
use crate::kernel::bezier::BezierPatch;
use crate::kernel::face::Face;
use crate::kernel::view::Bounds;

/// Accuracy relative to the diagonal of the box.
pub const SLACK: f64 = 1e-8;
/// Patch parts looked at for one face; reached only where a coordinate is largest along an oblique curve.
const BUDGET: usize = 4_000;
/// Samples on each boundary curve.
const SAMPLES: usize = 13;

/// The tight box around a derived face.
pub fn face_bounds(face: &Face) -> Bounds {
    trimmed_bounds(&Sheet::new(&face.patches), &Boundary::new(&face.pieces, &face.domain))
}

/// The tight box around the part of `sheet` inside `boundary`; around all of it when the boundary has no
/// edges. Empty where there is nothing.
pub fn trimmed_bounds(sheet: &Sheet, boundary: &Boundary) -> Bounds {
    let whole = Boundary::rectangle(sheet);
    let boundary = if boundary.edges().is_empty() { &whole } else { boundary };
    let mut search = Search { sheet, boundary, best: Bounds::EMPTY };
    let curves: Vec<_> = boundary.edges().iter().map(|e| |t: f64| e.curve.point(t)).collect();
    let samples: Vec<Vec<DVec3>> = curves.iter().map(|c| search.sample(c)).collect();
    for point in samples.iter().flatten() {
        search.best = search.best.union(Bounds { min: *point, max: *point });
    }
    for (curve, samples) in curves.iter().zip(&samples) {
        search.refine(curve, samples, false);
    }
    search.creases();
    search.inside();
    search.best
}

struct Search<'a> {
    sheet: &'a Sheet<'a>,
    boundary: &'a Boundary,
    best: Bounds,
}

impl Search<'_> {
    fn sample(&self, curve: &impl Fn(f64) -> DVec2) -> Vec<DVec3> {
        let at = |k: usize| self.sheet.point(curve(k as f64 / (SAMPLES - 1) as f64));
        (0..SAMPLES).filter_map(at).collect()
    }

    fn include(&mut self, point: DVec3) {
        self.best = self.best.union(Bounds { min: point, max: point });
    }

    /// Looks for extremes between the samples of a curve that may reach past the best.
    fn refine(&mut self, curve: &impl Fn(f64) -> DVec2, samples: &[DVec3], check: bool) {
        if samples.len() < SAMPLES {
            // Part of the curve runs where no patch lies.
            samples.iter().filter(|_| !check).for_each(|p| self.include(*p));
            return;
        }
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let height = |k: usize| sign * samples[k][axis];
                let top = (0..SAMPLES).max_by(|a, b| height(*a).total_cmp(&height(*b))).unwrap_or(0);
                let middle = top.clamp(1, SAMPLES - 2);
                let bend = height(middle - 1) - 2.0 * height(middle) + height(middle + 1);
                let best = if sign > 0.0 { self.best.max[axis] } else { -self.best.min[axis] };
                // A parabola through three samples rises at most |bend| / 8 above them; four times that.
                let reach = height(top) + 0.5 * bend.abs();
                if reach <= best || bend.abs() <= 1e-13 * samples[top].abs().max_element() {
                    continue;
                }
                let step = 1.0 / (SAMPLES - 1) as f64;
                let around =
                    (top.saturating_sub(1) as f64 * step, ((top + 1).min(SAMPLES - 1)) as f64 * step);
                let t = golden(around, |t| {
                    self.sheet.point(curve(t)).map_or(f64::NEG_INFINITY, |p| sign * p[axis])
                });
                if check && !self.boundary.contains(curve(t)) {
                    continue;
                }
                if let Some(point) = self.sheet.point(curve(t)) {
                    self.include(point);
                }
            }
        }
    }

    /// Patch lines inside the region, where a coordinate may peak on a crease.
    fn creases(&mut self) {
        let (us, vs) = (self.sheet.u_lines(), self.sheet.v_lines());
        for (i, u) in us.iter().enumerate() {
            for (j, v) in vs.iter().enumerate() {
                let corner = DVec2::new(*u, *v);
                if let Some(point) = self.sheet.point(corner)
                    && self.exceeds(point)
                    && self.boundary.contains(corner)
                {
                    self.include(point);
                }
                let mut line = |to: Option<DVec2>| {
                    let Some(to) = to else { return };
                    let curve = |t: f64| corner.lerp(to, t);
                    let samples = self.sample(&curve);
                    self.refine(&curve, &samples, true);
                };
                line(us.get(i + 1).filter(|_| j > 0 && j + 1 < vs.len()).map(|u| DVec2::new(*u, *v)));
                line(vs.get(j + 1).filter(|_| i > 0 && i + 1 < us.len()).map(|v| DVec2::new(*u, *v)));
            }
        }
    }

    fn exceeds(&self, p: DVec3) -> bool {
        !(p.cmpge(self.best.min).all() && p.cmple(self.best.max).all())
    }

    /// Critical points inside patches.
    fn inside(&mut self) {
        let mut parts: VecDeque<BezierPatch> = VecDeque::new();
        let (us, vs) = (self.sheet.u_lines().len(), self.sheet.v_lines().len());
        for (i, j) in (1..us).flat_map(|i| (1..vs).map(move |j| (i - 1, j - 1))) {
            if let Some(patch) = self.sheet.cell(i, j) {
                self.consider(patch, true, &mut parts);
            }
        }
        for _ in 0..BUDGET {
            let Some(part) = parts.pop_front() else { break };
            part.quarters().iter().for_each(|quarter| self.consider(quarter, false, &mut parts));
        }
    }

    /// Drops `part` or keeps it to be bisected. The edges of a `whole` patch have been searched before.
    fn consider(&mut self, part: &BezierPatch, whole: bool, parts: &mut VecDeque<BezierPatch>) {
        let hull = part.bounds();
        let slack = SLACK * self.best.diagonal();
        let above = hull.max.cmpgt(self.best.max + slack);
        let below = hull.min.cmplt(self.best.min - slack);
        if !(above | below).any() {
            return;
        }
        let (us, vs) = part.slopes();
        let flat = DVec3::max(one_sided(&us, whole), one_sided(&vs, whole));
        let open = (above | below) & flat.cmplt(DVec3::splat(0.5));
        if !open.any() {
            return;
        }
        let middle = 0.5 * (part.uv_min + part.uv_max);
        let point = part.point(0.5, 0.5);
        if self.exceeds(point) && self.boundary.contains(middle) {
            self.include(point);
        }
        parts.push_back(part.clone());
    }
}

/// 1 in each coordinate in which the slopes show that there is no peak inside, else 0: none has the
/// opposite sign, up to rounding, and unless `may_touch` none vanishes or all do.
fn one_sided(slopes: &[DVec3], may_touch: bool) -> DVec3 {
    let (low, high) =
        slopes.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), s| (l.min(*s), h.max(*s)));
    let zero = 1e-13 * low.abs().max(high.abs()).max_element();
    let one = |axis: usize| {
        let (low, high) = (low[axis], high[axis]);
        let level = low >= -zero && high <= zero;
        let room = if may_touch { -zero } else { zero };
        f64::from(u8::from(level || low >= room || high <= -room))
    };
    DVec3::new(one(0), one(1), one(2))
}

/// Where `height` is largest in the interval, if it has one peak there.
fn golden((mut a, mut b): (f64, f64), height: impl Fn(f64) -> f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_9;
    let (mut c, mut d) = (b - RATIO * (b - a), a + RATIO * (b - a));
    let (mut at_c, mut at_d) = (height(c), height(d));
    // 0.618^40: the position to 4e-9 of the interval, the value to its square.
    for _ in 0..40 {
        if at_c >= at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - RATIO * (b - a);
            at_c = height(c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + RATIO * (b - a);
            at_d = height(d);
        }
    }
    0.5 * (a + b)
}
