//! A proven bound of the distance between the surface over a triangle of parameters and the plane of its corners.
//!
//! For a patch `A / w`, a plane through `p` with the normal `n`: `F = n . (A - w p)` is a polynomial whose Bernstein
//! coefficients on the triangle's box are at hand, so that nothing is lost to how the surface runs within the plane. With
//! constant second derivatives `F = linear - 1/2 sum_ij l_i l_j F''[e_ij, e_ij]` in barycentric coordinates l and edges
//! e_ij; what they vary over the box adds an eighth of it per squared extent (Filip, Magedson & Markot 1986). Where that
//! does not decide, the triangle is divided into four and bounded again against the same plane. Lines between
//! patches that are not smooth add the jump of the derivative. So the bound holds for rational surfaces and tends to the
//! true distance.

use glam::{DVec2, DVec3, DVec4};

use super::outline::Ground;
use crate::kernel::bezier::BezierPatch;
use crate::kernel::query::Sheet;

/// A plane: a point of it and the unit normal.
pub type Supporting = (DVec3, DVec3);

/// Part of a patch: homogeneous control points about the face's origin.
struct Net {
    degrees: [usize; 2],
    points: Vec<DVec4>,
    /// Native extent.
    size: DVec2,
}

impl Net {
    /// The part of `patch` over native `low..high`.
    fn new(patch: &BezierPatch, origin: DVec3, low: DVec2, high: DVec2) -> Self {
        let (m, n) = (patch.degree_u, patch.degree_v);
        let home = patch.points.iter().zip(&patch.weights);
        let mut points: Vec<DVec4> = home.map(|(p, w)| ((*p - origin) * *w).extend(*w)).collect();
        let a = patch.local(low).clamp(DVec2::ZERO, DVec2::ONE);
        let b = patch.local(high).clamp(a, DVec2::ONE);
        for row in 0..=m {
            cut(&mut points, row * (n + 1), 1, n + 1, (a.y, b.y));
        }
        for column in 0..=n {
            cut(&mut points, column, n + 1, m + 1, (a.x, b.x));
        }
        Self { degrees: [m, n], points, size: high - low }
    }

    fn weights(&self) -> (f64, f64) {
        let all = self.points.iter().map(|h| h.w);
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), w| (a.min(w), b.max(w)))
    }
}

/// Control points of the part `from..to` of a curve whose points stand `stride` apart.
fn cut(points: &mut [DVec4], start: usize, stride: usize, count: usize, (from, to): (f64, f64)) {
    let at = |i: usize| start + i * stride;
    if to < 1.0 {
        for r in 1..count {
            for i in (r..count).rev() {
                points[at(i)] = points[at(i - 1)].lerp(points[at(i)], to);
            }
        }
    }
    if from > 0.0 && to > 0.0 {
        let t = from / to;
        for r in 1..count {
            for i in 0..count - r {
                points[at(i)] = points[at(i)].lerp(points[at(i + 1)], t);
            }
        }
    }
}

/// Ranges of the second derivatives of a scalar over a box, native parameters: uu, uv, vv.
struct Curvature {
    low: DVec3,
    high: DVec3,
    /// Largest value of a control point over its weight.
    hull: f64,
}

impl Curvature {
    /// Of `functional` applied to homogeneous points.
    fn new(nets: &[Net], functional: DVec4) -> Self {
        let mut result = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, hull: 0.0 };
        let mut values = Vec::new();
        for net in nets {
            let [m, n] = net.degrees;
            values.clear();
            values.extend(net.points.iter().map(|h| functional.dot(*h)));
            let at = |i: usize, j: usize| values[i * (n + 1) + j];
            for (value, h) in values.iter().zip(&net.points) {
                result.hull = result.hull.max(value.abs() / h.w);
            }
            let (mf, nf) = (m as f64, n as f64);
            let unit = net.size * net.size;
            let mut ranges = [(f64::INFINITY, f64::NEG_INFINITY); 3];
            let mut note = |k: usize, x: f64| ranges[k] = (ranges[k].0.min(x), ranges[k].1.max(x));
            for i in 0..=m {
                for j in 0..=n {
                    if i + 2 <= m {
                        note(0, at(i + 2, j) - 2.0 * at(i + 1, j) + at(i, j));
                    }
                    if i < m && j < n {
                        note(1, at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j));
                    }
                    if j + 2 <= n {
                        note(2, at(i, j + 2) - 2.0 * at(i, j + 1) + at(i, j));
                    }
                }
            }
            let factor =
                [mf * (mf - 1.0) / unit.x, mf * nf / (net.size.x * net.size.y), nf * (nf - 1.0) / unit.y];
            for k in 0..3 {
                // Of a degree too low to have this derivative: none.
                let (low, high) = if ranges[k].0 <= ranges[k].1 { ranges[k] } else { (0.0, 0.0) };
                result.low[k] = result.low[k].min(low * factor[k]);
                result.high[k] = result.high[k].max(high * factor[k]);
            }
        }
        result
    }

    /// The second derivative along `d` in the middle of the ranges.
    fn along(&self, d: DVec2) -> f64 {
        let middle = 0.5 * (self.low + self.high);
        middle.dot(DVec3::new(d.x * d.x, 2.0 * d.x * d.y, d.y * d.y))
    }

    /// What the rest of the ranges may add over a box.
    fn slack(&self, extent: DVec2) -> f64 {
        let half = 0.5 * (self.high - self.low);
        let (x, y) = (extent.x, extent.y);
        half.dot(DVec3::new(x * x, 2.0 * x * y, y * y)) / 8.0
    }
}

/// A line between patches across which the derivative jumps.
struct Crease {
    axis: usize,
    at: f64,
    from: f64,
    to: f64,
    /// Largest jump of the derivative across it.
    jump: f64,
    /// Largest jump of the weight's derivative.
    weight_jump: f64,
}

/// Bounds for the triangles of one face.
pub struct Flatness<'a> {
    sheet: Sheet<'a>,
    ground: Ground<'a>,
    creases: Vec<Crease>,
    origin: DVec3,
    domain: (DVec2, DVec2),
}

/// Jumps below this part of the derivative are rounding.
const SMOOTH: f64 = 1e-9;
/// Divisions into four of a triangle, and into two of a chord, that bounds go down.
const DEPTH: u32 = 3;
const CHORD_DEPTH: u32 = 4;

impl<'a> Flatness<'a> {
    /// Prepares bounds over `ground`.
    pub fn new(ground: &Ground<'a>) -> Self {
        let all = ground.patches();
        let around = |(low, high): (DVec2, DVec2), p: &BezierPatch| (low.min(p.uv_min), high.max(p.uv_max));
        let domain = all.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), around);
        let origin = all.first().map_or(DVec3::ZERO, |p| p.bounds().centre());
        Self { sheet: ground.sheet.clone(), ground: ground.clone(), creases: creases(ground), origin, domain }
    }

    /// Bound of the distance of the surface over a triangle of native `uv` from a plane that its corners lie in. Stops as
    /// soon as it is known to be above `limit`, or when halving further would cost more than it is worth.
    pub fn triangle(&self, uv: [DVec2; 3], plane: Supporting, limit: f64) -> f64 {
        self.part(uv, [0.0; 3], plane, limit, DEPTH)
    }

    fn part(&self, uv: [DVec2; 3], heights: [f64; 3], plane: Supporting, limit: f64, depth: u32) -> f64 {
        let (low, high) = self.boxed(&uv);
        let nets = self.nets(low, high);
        let functional = plane.1.extend(-plane.1.dot(plane.0 - self.origin));
        let curvature = Curvature::new(&nets, functional);
        let bent = [0, 1, 2].map(|k| curvature.along(uv[(k + 1) % 3] - uv[k]));
        let up = largest(bent.map(|x| x.max(0.0)));
        let down = largest(bent.map(|x| (-x).max(0.0)));
        let weights = weights(&nets);
        let corners = heights.iter().fold(0.0f64, |m, h| m.max(h.abs())) * weights.1;
        let (kink, feedback) = self.kinks(low, high);
        let over = corners + 0.5 * up.max(down) + curvature.slack(high - low) + kink * weights.0;
        let bound = finish(over / weights.0, feedback / weights.0).min(curvature.hull);
        if bound <= limit || depth == 0 || bound.is_nan() {
            return bound;
        }
        let middles = [0, 1, 2].map(|k| 0.5 * (uv[k] + uv[(k + 1) % 3]));
        let off = middles.map(|m| (self.ground.point(m) - plane.0).dot(plane.1));
        let most = off.iter().fold(0.0f64, |m, h| m.max(h.abs()));
        if !(most <= limit) {
            return most.min(bound);
        }
        let parts = [
            ([uv[0], middles[0], middles[2]], [heights[0], off[0], off[2]]),
            ([middles[0], uv[1], middles[1]], [off[0], heights[1], off[1]]),
            ([middles[2], middles[1], uv[2]], [off[2], off[1], heights[2]]),
            ([middles[0], middles[1], middles[2]], off),
        ];
        let mut worst = 0.0f64;
        for (uv, heights) in parts {
            worst = worst.max(self.part(uv, heights, plane, limit, depth - 1));
            if !(worst <= limit) {
                break;
            }
        }
        worst.min(bound)
    }

    /// Bound of the distance between the chord from `a` to `b` and the image of the straight line between their
    /// parameters; not followed further once it is known to be above `limit`.
    pub fn chord(&self, uv: [DVec2; 2], p: [DVec3; 2], limit: f64) -> f64 {
        let along = (p[1] - p[0]).normalize_or_zero();
        let Some(x) = along.any_orthonormal_vector().try_normalize().filter(|_| along != DVec3::ZERO) else {
            // A chord of no length: as far as the curve goes.
            return self.ground.point(0.5 * (uv[0] + uv[1])).distance(p[0]);
        };
        self.piece(uv, [0.0; 2], p[0], [x, along.cross(x)], limit, CHORD_DEPTH)
    }

    fn piece(
        &self,
        uv: [DVec2; 2],
        offsets: [f64; 2],
        from: DVec3,
        frame: [DVec3; 2],
        limit: f64,
        depth: u32,
    ) -> f64 {
        let (low, high) = self.boxed(&uv);
        let nets = self.nets(low, high);
        let weights = weights(&nets);
        let [x, y] = frame.map(|axis| {
            let found = Curvature::new(&nets, axis.extend(-axis.dot(from - self.origin)));
            (found.along(uv[1] - uv[0]).abs() / 8.0 + found.slack(high - low), found.hull)
        });
        let (kink, feedback) = self.kinks(low, high);
        let corners = offsets[0].max(offsets[1]) * weights.1;
        let over = corners + x.0.hypot(y.0) + kink * weights.0;
        let bound = finish(over / weights.0, feedback / weights.0).min(x.1.hypot(y.1));
        if bound <= limit || depth == 0 || bound.is_nan() {
            return bound;
        }
        let middle = 0.5 * (uv[0] + uv[1]);
        let d = self.ground.point(middle) - from;
        let off = d.dot(frame[0]).hypot(d.dot(frame[1]));
        if !(off <= limit) {
            return off.min(bound);
        }
        let left = self.piece([uv[0], middle], [offsets[0], off], from, frame, limit, depth - 1);
        if !(left <= limit) {
            return left;
        }
        left.max(self.piece([middle, uv[1]], [off, offsets[1]], from, frame, limit, depth - 1)).min(bound)
    }

    fn boxed(&self, uv: &[DVec2]) -> (DVec2, DVec2) {
        let low = uv.iter().fold(DVec2::INFINITY, |a, b| a.min(*b));
        let high = uv.iter().fold(DVec2::NEG_INFINITY, |a, b| a.max(*b));
        // Rounding may put vertices a hair outside of all patches.
        (low.clamp(self.domain.0, self.domain.1), high.clamp(self.domain.0, self.domain.1))
    }

    /// The parts of patches over a box.
    fn nets(&self, low: DVec2, high: DVec2) -> Vec<Net> {
        let range = |lines: &[f64], from: f64, to: f64| {
            let cells = lines.len().saturating_sub(1);
            let first = lines.partition_point(|x| *x <= from).saturating_sub(1).min(cells.saturating_sub(1));
            let end = lines.partition_point(|x| *x < to).min(cells).max(first + 1);
            first..end
        };
        let (us, vs) = (self.sheet.u_lines(), self.sheet.v_lines());
        let mut nets = Vec::with_capacity(1);
        for i in range(us, low.x, high.x) {
            for j in range(vs, low.y, high.y) {
                let Some(patch) = self.sheet.cell(i, j) else { continue };
                let from = low.max(DVec2::new(us[i], vs[j]));
                let to = high.min(DVec2::new(us[i + 1], vs[j + 1])).max(from);
                nets.push(Net::new(patch, self.origin, from, to));
            }
        }
        nets
    }

    /// What creases across a box add to the distance, and to itself through jumps of the weight's derivative.
    fn kinks(&self, low: DVec2, high: DVec2) -> (f64, f64) {
        let (mut kink, mut feedback) = (0.0, 0.0);
        for crease in &self.creases {
            let (other, x) = (1 - crease.axis, crease.at);
            let (below, above) = (x - low[crease.axis], high[crease.axis] - x);
            if below > 0.0 && above > 0.0 && crease.from < high[other] && crease.to > low[other] {
                let reach = below * above / (below + above);
                kink += crease.jump * reach;
                feedback += crease.weight_jump * reach;
            }
        }
        (kink, feedback)
    }

    /// Where a triangle is crossed by creases of the surface that bring in more than `limit`.
    pub fn crossed(&self, uv: &[DVec2; 3], limit: f64) -> Option<(usize, f64)> {
        if self.creases.iter().all(|c| c.jump <= 0.0) {
            return None;
        }
        let (low, high) = self.boxed(uv);
        if self.kinks(low, high).0 > limit { self.cut(uv, (low, high)) } else { None }
    }

    /// The edge of a triangle that is crossed most in the middle by a crease of the surface, and where.
    fn cut(&self, uv: &[DVec2; 3], (low, high): (DVec2, DVec2)) -> Option<(usize, f64)> {
        let mut best: Option<(f64, (usize, f64))> = None;
        for crease in self.creases.iter().filter(|c| c.jump > 0.0) {
            let (axis, other) = (crease.axis, 1 - crease.axis);
            if !(crease.at > low[axis] && crease.at < high[axis]) {
                continue;
            }
            if !(crease.from < high[other] && crease.to > low[other]) {
                continue;
            }
            for k in 0..3 {
                let (a, b) = (uv[k], uv[(k + 1) % 3]);
                let t = (crease.at - a[axis]) / (b[axis] - a[axis]);
                let reach = t.min(1.0 - t) * (b[axis] - a[axis]).abs();
                if reach > 0.0 && best.is_none_or(|b| reach > b.0) {
                    best = Some((reach, (k, t)));
                }
            }
        }
        best.map(|b| b.1)
    }
}

/// Least and largest weight over some parts.
fn weights(nets: &[Net]) -> (f64, f64) {
    let all = nets.iter().map(Net::weights);
    all.fold((f64::INFINITY, 0.0), |(a, b), (low, high)| (a.min(low), b.max(high)))
}

/// The distance that follows from a bound of which `feedback` times the distance itself is a part.
fn finish(error: f64, feedback: f64) -> f64 {
    if feedback < 1.0 { error / (1.0 - feedback) } else { f64::INFINITY }
}

/// The largest `sum_(i<j) l_i l_j a_ij` over barycentric coordinates: the squared radius of the smallest circle around a
/// triangle whose squared sides are `a`.
fn largest(a: [f64; 3]) -> f64 {
    let sum = a[0] + a[1] + a[2];
    let most = a[0].max(a[1]).max(a[2]);
    let area = 2.0 * (a[0] * a[1] + a[1] * a[2] + a[2] * a[0]) - (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    if most >= sum - most || area <= 0.0 { 0.25 * most } else { a[0] * a[1] * a[2] / area }
}

/// The lines between patches across which the surface or its weight is not smooth.
fn creases(ground: &Ground) -> Vec<Crease> {
    let (us, vs) = (ground.sheet.u_lines(), ground.sheet.v_lines());
    let mut creases = Vec::new();
    for i in 0..us.len().saturating_sub(1) {
        for j in 0..vs.len().saturating_sub(1) {
            let Some(here) = ground.sheet.cell(i, j) else { continue };
            let right = (i + 2 < us.len()).then(|| ground.sheet.cell(i + 1, j)).flatten();
            let above = (j + 2 < vs.len()).then(|| ground.sheet.cell(i, j + 1)).flatten();
            if let Some(right) = right {
                creases.extend(crease(0, here, right));
            }
            if let Some(above) = above {
                creases.extend(crease(1, &here.swap(), &above.swap()));
            }
        }
    }
    creases
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
