//! A proven bound of the distance between the surface over a triangle of parameters and the plane of its corners.
//!
//! For a patch `A / w`, a plane through `p` with the normal `n`: `F = n . (A - w p)` is a polynomial whose Bernstein
//! coefficients on the triangle's box are at hand, so that nothing is lost to how the surface runs within the plane. With
//! constant second derivatives `F = linear - 1/2 sum_ij l_i l_j F''[e_ij, e_ij]` in barycentric coordinates l and edges
//! e_ij, whose largest value is known exactly; what they vary over the box adds an eighth of it per squared extent (Filip, Magedson & Markot 1986). Where that
//! does not decide, the triangle is divided into four and bounded again against the same plane. Lines between
//! patches that are not smooth add the jump of the derivative. So the bound holds for rational surfaces and tends to the
//! true distance.

use glam::{DVec2, DVec3};

use super::creases::{Crease, creases};
use super::nets::{Height, Nets};
use super::outline::Ground;
use crate::kernel::bezier::BezierPatch;

/// A plane: a point of it and the unit normal.
pub type Supporting = (DVec3, DVec3);

/// Ranges of the second derivatives of a scalar over a box, native parameters: uu, uv, vv.
struct Curvature {
    low: DVec3,
    high: DVec3,
    /// Largest value of a coefficient over its weight.
    hull: f64,
}

impl Curvature {
    /// Of the height number `which` over the nets from number `first` on.
    fn new<V: Height>(all: &Nets<V>, first: usize, which: usize) -> Self {
        let mut result = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, hull: 0.0 };
        for net in &all.nets[first..] {
            let [m, n] = net.degrees;
            let values = &all.values[net.first..net.first + (m + 1) * (n + 1)];
            let of = |value: &V| value.heights().as_ref()[which];
            for value in values {
                let hull = of(value).abs() / value.weight();
                result.hull = if hull > result.hull { hull } else { result.hull };
            }
            let (mf, nf) = (m as f64, n as f64);
            let size = net.high - net.low;
            let unit = size * size;
            let mut ranges = [(f64::INFINITY, f64::NEG_INFINITY); 3];
            let note = |range: &mut (f64, f64), x: f64| {
                range.0 = if x < range.0 { x } else { range.0 };
                range.1 = if x > range.1 { x } else { range.1 };
            };
            let rows = values.chunks_exact(n + 1);
            for ((a, b), c) in rows.clone().zip(rows.clone().skip(1)).zip(rows.clone().skip(2)) {
                for ((a, b), c) in a.iter().zip(b).zip(c) {
                    note(&mut ranges[0], of(c) - 2.0 * of(b) + of(a));
                }
            }
            for (a, b) in rows.clone().zip(rows.clone().skip(1)) {
                for (a, b) in a.windows(2).zip(b.windows(2)) {
                    note(&mut ranges[1], of(&b[1]) - of(&b[0]) - of(&a[1]) + of(&a[0]));
                }
            }
            for row in rows {
                for w in row.windows(3) {
                    note(&mut ranges[2], of(&w[2]) - 2.0 * of(&w[1]) + of(&w[0]));
                }
            }
            // Across a box of no width nothing is gone along.
            let per = |count: f64, area: f64| if area > 0.0 { count / area } else { 0.0 };
            let factor =
                [per(mf * (mf - 1.0), unit.x), per(mf * nf, size.x * size.y), per(nf * (nf - 1.0), unit.y)];
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

/// Bounds for the triangles of one face.
pub struct Flatness<'a> {
    ground: Ground<'a>,
    creases: Vec<Crease>,
    /// Whether weights differ anywhere.
    rational: bool,
    origin: DVec3,
    domain: (DVec2, DVec2),
}

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
        let weight = all.first().map_or(1.0, |p| p.weights[0]);
        let rational = all.iter().any(|p| p.weights.iter().any(|w| *w != weight));
        Self { ground: ground.clone(), creases: creases(ground), rational, origin, domain }
    }

    /// Bound of the distance of the surface over a triangle of native `uv` from a plane. Stops as
    /// soon as it is known to be above `limit`, or when halving further would cost more than it is worth.
    pub fn triangle(&self, uv: [DVec2; 3], plane: Supporting, limit: f64) -> f64 {
        let (low, high) = self.boxed(&uv);
        let foot = plane.0 - self.origin;
        if self.rational {
            let height = |p: DVec3, w: f64| DVec2::new(plane.1.dot(p - foot) * w, w);
            self.over(uv, self.nets(low, high, height), limit)
        } else {
            self.over(uv, self.nets(low, high, |p: DVec3, _| plane.1.dot(p - foot)), limit)
        }
    }

    /// The bound for a triangle whose box has the `nets`.
    fn over<V: Height>(&self, uv: [DVec2; 3], mut nets: Nets<V>, limit: f64) -> f64 {
        let heights = uv.map(|uv| first_of(nets.at(0, uv)));
        self.part(uv, heights, limit, DEPTH, &mut nets, 0)
    }

    /// The bound for a part of the triangle whose nets stand from number `first` on in `nets`; `heights` of its corners are
    /// those of the numerator.
    fn part<V: Height>(
        &self,
        uv: [DVec2; 3],
        heights: [f64; 3],
        limit: f64,
        depth: u32,
        nets: &mut Nets<V>,
        first: usize,
    ) -> f64 {
        let (low, high) = self.boxed(&uv);
        let curvature = Curvature::new(nets, first, 0);
        let bent = [0, 1, 2].map(|k| curvature.along(uv[(k + 1) % 3] - uv[k]));
        let weights = nets.weights(first);
        let (kink, feedback) = self.kinks(low, high);
        let over = highest(heights, bent) + curvature.slack(high - low) + kink * weights.0;
        let bound = finish(over / weights.0, feedback / weights.0).min(curvature.hull);
        if bound <= limit || depth == 0 || bound.is_nan() {
            return bound;
        }
        let middles = [0, 1, 2].map(|k| 0.5 * (uv[k] + uv[(k + 1) % 3]));
        let at = middles.map(|m| nets.at(first, m));
        let most = at.iter().fold(0.0f64, |m, h| m.max((first_of(*h) / h.weight()).abs()));
        if !(most <= limit) {
            return most.min(bound);
        }
        let off = at.map(first_of);
        let parts = [
            ([uv[0], middles[0], middles[2]], [heights[0], off[0], off[2]]),
            ([middles[0], uv[1], middles[1]], [off[0], heights[1], off[1]]),
            ([middles[2], middles[1], uv[2]], [off[2], off[1], heights[2]]),
            ([middles[0], middles[1], middles[2]], off),
        ];
        let mut worst = 0.0f64;
        let end = nets.nets.len();
        for (uv, heights) in parts {
            let (low, high) = self.boxed(&uv);
            nets.narrow((first, end), low, high);
            worst = worst.max(self.part(uv, heights, limit, depth - 1, nets, end));
            nets.drop_to(end);
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
        let frame = [x, along.cross(x)];
        let foot = p[0] - self.origin;
        let height = |q: DVec3, w: f64| DVec3::new(frame[0].dot(q - foot) * w, frame[1].dot(q - foot) * w, w);
        let (low, high) = self.boxed(&uv);
        let mut nets = self.nets(low, high, height);
        let heights = uv.map(|uv| nets.at(0, uv));
        self.piece(uv, heights, limit, CHORD_DEPTH, &mut nets, 0)
    }

    /// The same for a part of it; `heights` of its ends are those of the numerator.
    fn piece(
        &self,
        uv: [DVec2; 2],
        heights: [DVec3; 2],
        limit: f64,
        depth: u32,
        nets: &mut Nets<DVec3>,
        first: usize,
    ) -> f64 {
        let (low, high) = self.boxed(&uv);
        let weights = nets.weights(first);
        let [x, y] = [0, 1].map(|which| {
            let found = Curvature::new(nets, first, which);
            let own = heights.map(|h| h[which]);
            let bow = highest_between(own[0], own[1], found.along(uv[1] - uv[0]));
            (own[0].abs().max(own[1].abs()).max(bow.abs()) + found.slack(high - low), found.hull)
        });
        let (kink, feedback) = self.kinks(low, high);
        let over = x.0.hypot(y.0) + kink * weights.0;
        let bound = finish(over / weights.0, feedback / weights.0).min(x.1.hypot(y.1));
        if bound <= limit || depth == 0 || bound.is_nan() {
            return bound;
        }
        let middle = 0.5 * (uv[0] + uv[1]);
        let at = nets.at(first, middle);
        let off = (at.x / at.z).hypot(at.y / at.z);
        if !(off <= limit) {
            return off.min(bound);
        }
        let end = nets.nets.len();
        let mut worst = 0.0f64;
        for (uv, heights) in [([uv[0], middle], [heights[0], at]), ([middle, uv[1]], [at, heights[1]])] {
            let (low, high) = self.boxed(&uv);
            nets.narrow((first, end), low, high);
            worst = worst.max(self.piece(uv, heights, limit, depth - 1, nets, end));
            nets.drop_to(end);
            if !(worst <= limit) {
                return worst;
            }
        }
        worst.min(bound)
    }

    fn boxed(&self, uv: &[DVec2]) -> (DVec2, DVec2) {
        let low = uv.iter().fold(DVec2::INFINITY, |a, b| a.min(*b));
        let high = uv.iter().fold(DVec2::NEG_INFINITY, |a, b| a.max(*b));
        // Rounding may put vertices a hair outside of all patches.
        (low.clamp(self.domain.0, self.domain.1), high.clamp(self.domain.0, self.domain.1))
    }

    /// The parts of patches over a box, by what `height` makes of control points about the origin and weights.
    fn nets<V: Height>(&self, low: DVec2, high: DVec2, height: impl Fn(DVec3, f64) -> V) -> Nets<V> {
        let range = |lines: &[f64], from: f64, to: f64| {
            let cells = lines.len().saturating_sub(1);
            let first = lines.partition_point(|x| *x <= from).saturating_sub(1).min(cells.saturating_sub(1));
            let end = lines.partition_point(|x| *x < to).min(cells).max(first + 1);
            first..end
        };
        let sheet = &self.ground.sheet;
        let (us, vs) = (sheet.u_lines(), sheet.v_lines());
        let mut nets = Nets { nets: Vec::with_capacity(8), values: Vec::with_capacity(96) };
        for i in range(us, low.x, high.x) {
            for j in range(vs, low.y, high.y) {
                let Some(patch) = sheet.cell(i, j) else { continue };
                let from = low.max(DVec2::new(us[i], vs[j]));
                let to = high.min(DVec2::new(us[i + 1], vs[j + 1])).max(from);
                let first = nets.values.len();
                let all = patch.points.iter().zip(&patch.weights);
                nets.values.extend(all.map(|(p, w)| height(*p - self.origin, *w)));
                nets.cut([patch.degree_u, patch.degree_v], first, (patch.uv_min, patch.uv_max), (from, to));
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

/// The first of the functions, times its weight.
fn first_of<V: Height>(value: V) -> f64 {
    value.heights().as_ref()[0]
}

/// The distance that follows from a bound of which `feedback` times the distance itself is a part.
fn finish(error: f64, feedback: f64) -> f64 {
    if feedback < 1.0 { error / (1.0 - feedback) } else { f64::INFINITY }
}

/// The extreme of a quadratic between two places where it is `a` and `b`, whose second derivative along the way is `bent`; 0
/// where the ends are its extremes.
fn highest_between(a: f64, b: f64, bent: f64) -> f64 {
    let t = 0.5 - (b - a) / bent;
    if t > 0.0 && t < 1.0 { a + (b - a) * t - 0.5 * t * (1.0 - t) * bent } else { 0.0 }
}

/// The largest absolute value of a quadratic over a triangle with the values `h` at its corners and the second derivatives
/// `bent` along its edges (from corner k to the next).
fn highest(h: [f64; 3], bent: [f64; 3]) -> f64 {
    let mut most = h.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for k in 0..3 {
        most = most.max(highest_between(h[k], h[(k + 1) % 3], bent[k]).abs());
    }
    // Inside: where the gradient in the coordinates of corners 1 and 2 is nothing.
    let (ss, tt, st) = (bent[0], bent[2], 0.5 * (bent[0] + bent[2] - bent[1]));
    let (gs, gt) = (h[1] - h[0] - 0.5 * ss, h[2] - h[0] - 0.5 * tt);
    let det = ss * tt - st * st;
    let (s, t) = ((st * gt - tt * gs) / det, (st * gs - ss * gt) / det);
    if s > 0.0 && t > 0.0 && s + t < 1.0 {
        most = most.max((h[0] + 0.5 * (gs * s + gt * t)).abs());
    }
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_point_of_a_quadratic_is_found_inside_and_on_edges() {
        for seed in 0..2000u32 {
            let number = |k: u32| {
                let x = (seed * 31 + k).wrapping_mul(2_654_435_761);
                f64::from((x ^ (x >> 15)).wrapping_mul(2_246_822_519)) / f64::from(u32::MAX) - 0.5
            };
            let (h, bent) = ([0, 1, 2].map(number), [3, 4, 5].map(|k| 6.0 * number(k)));
            let found = highest(h, bent);
            let mut sampled = 0.0f64;
            for i in 0..=60 {
                for j in 0..=60 - i {
                    let l = [60 - i - j, i, j].map(|x| f64::from(x) / 60.0);
                    let line = h[0] * l[0] + h[1] * l[1] + h[2] * l[2];
                    let bow = bent[0] * l[0] * l[1] + bent[1] * l[1] * l[2] + bent[2] * l[2] * l[0];
                    sampled = sampled.max((line - 0.5 * bow).abs());
                }
            }
            assert!(found >= sampled - 1e-12 && found <= sampled + 2e-3, "{found} {sampled}");
        }
    }
}
