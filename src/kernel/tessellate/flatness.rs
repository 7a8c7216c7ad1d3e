//! A proven bound of the distance between a triangle and the surface over it.
//!
//! For a patch `A / w` and the linear map M through the triangle's corners, `N = A - w M` vanishes at the corners. With
//! constant second derivatives `N = -1/2 sum_ij l_i l_j N''[e_ij, e_ij]` in barycentric coordinates l and edges e_ij; what
//! the derivatives vary over the triangle's box adds an eighth of it per squared extent (Filip, Magedson & Markot 1986).
//! Ranges of derivatives are boxes around differences of control points of parts of patches. Lines between patches that are not smooth add the jump of the derivative. So the bound holds for
//! rational surfaces and tends to the true distance as triangles shrink.

use glam::{DVec2, DVec3, DVec4};

use super::outline::Ground;
use crate::kernel::bezier::BezierPatch;

/// Error of a triangle or chord and where to divide it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleError {
    /// Bound of the distance.
    pub error: f64,
    /// Shares of the error that edge k (from corner k to the next) brings in.
    pub edges: [f64; 3],
    /// The edge, and where on it (0 to 1), that crosses a crease which matters.
    pub crease: Option<(usize, f64)>,
}

/// Range of a derivative: a ball for the point part, an interval for the weight.
#[derive(Debug, Clone, Copy, Default)]
struct Range {
    middle: DVec4,
    radius: f64,
    weight_radius: f64,
}

impl Range {
    fn around(values: impl Iterator<Item = DVec4>) -> Self {
        let (mut low, mut high) = (DVec4::INFINITY, DVec4::NEG_INFINITY);
        for v in values {
            low = low.min(v);
            high = high.max(v);
        }
        if !low.is_finite() {
            // Of a degree too low to have this derivative.
            return Self::default();
        }
        let half = 0.5 * (high - low);
        Self { middle: 0.5 * (low + high), radius: half.truncate().length(), weight_radius: half.w }
    }
}

/// A part of a patch with the ranges of its derivatives in native parameters.
struct Part {
    origin: DVec3,
    uu: Range,
    uv: Range,
    vv: Range,
    /// First derivatives of the weight: middle and radius, in u and in v.
    weight_u: (f64, f64),
    weight_v: (f64, f64),
    least_weight: f64,
    /// Bounds of the lengths of the first derivatives.
    slopes: DVec2,
}

impl Part {
    fn new(patch: &BezierPatch) -> Self {
        let (m, n) = (patch.degree_u, patch.degree_v);
        let origin = patch.bounds().centre();
        let net: Vec<DVec4> =
            patch.points.iter().zip(&patch.weights).map(|(p, w)| ((*p - origin) * *w).extend(*w)).collect();
        let at = |i: usize, j: usize| net[i * (n + 1) + j];
        let grid =
            |rows: usize, columns: usize| (0..rows).flat_map(move |i| (0..columns).map(move |j| (i, j)));
        let size = patch.uv_max - patch.uv_min;
        let (mf, nf) = (m as f64, n as f64);
        let second_u = mf * (mf - 1.0) / (size.x * size.x);
        let second_v = nf * (nf - 1.0) / (size.y * size.y);
        let mixed = mf * nf / (size.x * size.y);
        let uu = grid((m + 1).saturating_sub(2), n + 1)
            .map(|(i, j)| (at(i + 2, j) - 2.0 * at(i + 1, j) + at(i, j)) * second_u);
        let vv = grid(m + 1, (n + 1).saturating_sub(2))
            .map(|(i, j)| (at(i, j + 2) - 2.0 * at(i, j + 1) + at(i, j)) * second_v);
        let uv = grid(m, n).map(|(i, j)| (at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j)) * mixed);
        let interval = |values: &mut dyn Iterator<Item = f64>| {
            let (low, high) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            (0.5 * (low + high), 0.5 * (high - low))
        };
        let (uu, uv, vv) = (Range::around(uu), Range::around(uv), Range::around(vv));
        let weight_u =
            interval(&mut grid(m, n + 1).map(|(i, j)| (at(i + 1, j).w - at(i, j).w) * mf / size.x));
        let weight_v =
            interval(&mut grid(m + 1, n).map(|(i, j)| (at(i, j + 1).w - at(i, j).w) * nf / size.y));
        let least_weight = patch.weights.iter().copied().fold(f64::INFINITY, f64::min);
        // |S'| <= (|A'| + |w'| |S|) / w, all from the part's middle.
        let reach = patch.points.iter().map(|p| p.distance(origin)).fold(0.0, f64::max);
        let slope = |d: &mut dyn Iterator<Item = DVec4>| {
            d.map(|h| h.truncate().length() + h.w.abs() * reach).fold(0.0, f64::max) / least_weight
        };
        let slopes = DVec2::new(
            slope(&mut grid(m, n + 1).map(|(i, j)| (at(i + 1, j) - at(i, j)) * (mf / size.x))),
            slope(&mut grid(m + 1, n).map(|(i, j)| (at(i, j + 1) - at(i, j)) * (nf / size.y))),
        );
        Self { origin, uu, uv, vv, weight_u, weight_v, least_weight, slopes }
    }
}

/// A patch cut into equal parts.
struct Parts {
    min: DVec2,
    max: DVec2,
    counts: [usize; 2],
    /// Part `(i, j)` is number `i * counts[1] + j`.
    parts: Vec<Part>,
}

impl Parts {
    fn new(patch: &BezierPatch, finest: usize) -> Self {
        // Second derivatives of polynomials of low degree do not vary.
        let count = |degree: usize, other: usize| match degree {
            _ if patch.is_rational() => {
                if degree > 1 || other > 1 {
                    finest
                } else {
                    1
                }
            }
            0..=1 if other <= 2 => 1,
            2 if other <= 1 => 1,
            _ => finest,
        };
        let counts = [count(patch.degree_u, patch.degree_v), count(patch.degree_v, patch.degree_u)];
        let at = |i: usize, j: usize| DVec2::new(i as f64 / counts[0] as f64, j as f64 / counts[1] as f64);
        let mut parts = Vec::with_capacity(counts[0] * counts[1]);
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                parts.push(Part::new(&patch.restrict(at(i, j), at(i + 1, j + 1))));
            }
        }
        Self { min: patch.uv_min, max: patch.uv_max, counts, parts }
    }

    /// The parts that a box touches. Touching at a border does not count, unless the box has no width there.
    fn within(&self, low: DVec2, high: DVec2) -> impl Iterator<Item = &Part> {
        let range = |k: usize| {
            let step = (self.max[k] - self.min[k]) / self.counts[k] as f64;
            let from = (low[k] - self.min[k]) / step;
            let to = (high[k] - self.min[k]) / step;
            let slack = if to - from > 1e-9 { 1e-12 } else { -1e-12 };
            let first = (from + slack).floor().max(0.0) as usize;
            let end = ((to - slack).ceil().max(0.0) as usize).max(first + 1).min(self.counts[k]);
            first.min(self.counts[k])..end
        };
        let (rows, columns) = (range(0), range(1));
        rows.flat_map(move |i| columns.clone().map(move |j| &self.parts[i * self.counts[1] + j]))
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
pub struct Flatness {
    patches: Vec<Parts>,
    creases: Vec<Crease>,
    domain: (DVec2, DVec2),
    rational: bool,
}

/// Parts along a direction of a patch in which second derivatives vary, at most.
const FINEST: usize = 8;
/// Parts of all patches of a face, about.
const MOST_PARTS: usize = 1024;
/// Jumps below this part of the derivative are rounding.
const SMOOTH: f64 = 1e-9;

impl Flatness {
    /// Prepares bounds over `ground`.
    pub fn new(ground: &Ground) -> Self {
        let all = ground.patches();
        let finest = ((MOST_PARTS / all.len().max(1)) as f64).sqrt() as usize;
        let patches: Vec<Parts> = all.iter().map(|p| Parts::new(p, finest.clamp(1, FINEST))).collect();
        let rational = all.iter().any(BezierPatch::is_rational);
        let around = |(low, high): (DVec2, DVec2), p: &Parts| (low.min(p.min), high.max(p.max));
        let domain = patches.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), around);
        Self { patches, creases: creases(ground), domain, rational }
    }

    /// Bound for the triangle of native `uv` whose corners lie at `p` on the surface.
    pub fn triangle(&self, uv: [DVec2; 3], p: [DVec3; 3]) -> TriangleError {
        let middle = (p[0] + p[1] + p[2]) / 3.0;
        let edges = [0, 1, 2].map(|k| (uv[(k + 1) % 3] - uv[k], p[(k + 1) % 3] - p[k]));
        let spread = p.iter().map(|q| q.distance(middle)).fold(0.0, f64::max);
        let box_ = (uv[0].min(uv[1]).min(uv[2]), uv[0].max(uv[1]).max(uv[2]));
        let ranges = self.over(box_, middle, spread, &edges);
        let normal = edges[0].1.cross(-edges[2].1).normalize_or_zero();
        let signed = ranges.curved.map(|d| d.dot(normal));
        let across = [0, 1, 2].map(|k| (ranges.curved[k] - normal * signed[k]).length());
        let up = largest(signed.map(|x| x.max(0.0)));
        let down = largest(signed.map(|x| (-x).max(0.0)));
        let error = 0.5 * up.max(down).hypot(largest(across)) + ranges.slack;
        let extent = box_.1 - box_.0;
        let error = finish(error, &ranges).min(ranges.slopes.dot(extent));
        let crease = if ranges.kink * 4.0 > error * ranges.least_weight { self.cut(&uv, box_) } else { None };
        TriangleError {
            error,
            edges: ranges.curved.map(|d| d.length() / (8.0 * ranges.least_weight)),
            crease,
        }
    }

    /// Bound of the distance between the chord from `a` to `b` and the image of the straight line between their
    /// parameters.
    pub fn chord(&self, uv: [DVec2; 2], p: [DVec3; 2]) -> f64 {
        let middle = 0.5 * (p[0] + p[1]);
        let along = p[1] - p[0];
        let edges = [(uv[1] - uv[0], along)];
        let box_ = (uv[0].min(uv[1]), uv[0].max(uv[1]));
        let ranges = self.over(box_, middle, 0.5 * along.length(), &edges);
        let direction = along.normalize_or_zero();
        let bent = ranges.curved[0] - direction * ranges.curved[0].dot(direction);
        finish(bent.length() / 8.0 + ranges.slack, &ranges).min(ranges.slopes.dot(box_.1 - box_.0))
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

    /// Second derivatives of N along up to three edges over a box, with all that may add to them.
    fn over(
        &self,
        (low, high): (DVec2, DVec2),
        middle: DVec3,
        spread: f64,
        edges: &[(DVec2, DVec3)],
    ) -> Ranges {
        // Rounding may put vertices a hair outside of all patches.
        let (low, high) = (low.clamp(self.domain.0, self.domain.1), high.clamp(self.domain.0, self.domain.1));
        let extent = high - low;
        let mut result = Ranges { least_weight: f64::INFINITY, ..Ranges::default() };
        let longest = edges.iter().map(|e| e.1.length()).fold(0.0, f64::max);
        let mut hull = [(DVec3::INFINITY, DVec3::NEG_INFINITY); 3];
        let mut found: Vec<([DVec3; 3], f64)> = Vec::new();
        for patch in &self.patches {
            let apart = |k: usize| {
                patch.max[k] <= low[k] && patch.max[k] < high[k]
                    || patch.min[k] >= high[k] && patch.min[k] > low[k]
            };
            if apart(0) || apart(1) || (patch.max.cmplt(low) | patch.min.cmpgt(high)).any() {
                continue;
            }
            for part in patch.within(low, high) {
                let (curved, slack) = part.along(edges, extent, (middle, spread, longest), self.rational);
                result.least_weight = result.least_weight.min(part.least_weight);
                result.slopes = result.slopes.max(part.slopes);
                for (hull, d) in hull.iter_mut().zip(curved) {
                    *hull = (hull.0.min(d), hull.1.max(d));
                }
                found.push((curved, slack));
            }
        }
        if found.is_empty() {
            return Ranges { least_weight: 1.0, slack: f64::INFINITY, slopes: DVec2::INFINITY, ..result };
        }
        result.curved = hull.map(|(a, b)| 0.5 * (a + b));
        for (curved, slack) in &found {
            let off = (0..edges.len()).map(|k| curved[k].distance(result.curved[k])).fold(0.0, f64::max);
            // Edges' derivatives determine the form; each adds at most a sixth of its change.
            result.slack = result.slack.max(slack + 0.5 * off);
        }
        for crease in &self.creases {
            let (other, x) = (1 - crease.axis, crease.at);
            let (below, above) = (x - low[crease.axis], high[crease.axis] - x);
            if below > 0.0 && above > 0.0 && crease.from < high[other] && crease.to > low[other] {
                let reach = below * above / (below + above);
                let kink = crease.jump * reach * result.least_weight;
                result.slack += kink;
                result.kink += kink;
                result.feedback += crease.weight_jump * reach;
            }
        }
        result
    }
}

#[derive(Default)]
struct Ranges {
    /// Second derivative along each edge, in the middle of its range.
    curved: [DVec3; 3],
    slack: f64,
    least_weight: f64,
    /// Part of the error itself that weights' jumps add.
    feedback: f64,
    /// The part of `slack` that creases add.
    kink: f64,
    slopes: DVec2,
}

fn finish(error: f64, ranges: &Ranges) -> f64 {
    let feedback = ranges.feedback / ranges.least_weight;
    if feedback < 1.0 { error / ranges.least_weight / (1.0 - feedback) } else { f64::INFINITY }
}

/// The largest `sum_(i<j) l_i l_j a_ij` over barycentric coordinates: the squared radius of the smallest circle around a
/// triangle whose squared sides are `a`.
fn largest(a: [f64; 3]) -> f64 {
    let sum = a[0] + a[1] + a[2];
    let most = a[0].max(a[1]).max(a[2]);
    let area = 2.0 * (a[0] * a[1] + a[1] * a[2] + a[2] * a[0]) - (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    if most >= sum - most || area <= 0.0 { 0.25 * most } else { a[0] * a[1] * a[2] / area }
}

impl Part {
    /// Second derivatives of N along `edges` and how much the rest may add to the bound.
    fn along(
        &self,
        edges: &[(DVec2, DVec3)],
        extent: DVec2,
        (middle, spread, longest): (DVec3, f64, f64),
        rational: bool,
    ) -> ([DVec3; 3], f64) {
        let offset = if rational { middle - self.origin } else { DVec3::ZERO };
        let shift = |h: DVec4| h.truncate() - offset * h.w;
        let (uu, uv, vv) = (shift(self.uu.middle), shift(self.uv.middle), shift(self.vv.middle));
        let mut curved = [DVec3::ZERO; 3];
        for (result, (d, p)) in curved.iter_mut().zip(edges) {
            *result = uu * (d.x * d.x) + uv * (2.0 * d.x * d.y) + vv * (d.y * d.y);
            if rational {
                *result -= *p * (2.0 * (self.weight_u.0 * d.x + self.weight_v.0 * d.y));
            }
        }
        let far = offset.length();
        let vary = |r: &Range| {
            if rational {
                r.radius + far * r.weight_radius + (r.middle.w.abs() + r.weight_radius) * spread
            } else {
                r.radius
            }
        };
        let (x, y) = (extent.x, extent.y);
        let mut slack =
            (vary(&self.uu) * x * x + 2.0 * vary(&self.uv) * x * y + vary(&self.vv) * y * y) / 8.0;
        if rational {
            // Half of twice the product of two deviations, each at most half its extent (3D: 1 / sqrt 3).
            slack += 0.29 * (self.weight_u.1 * x + self.weight_v.1 * y) * longest;
        }
        (curved, slack)
    }
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
