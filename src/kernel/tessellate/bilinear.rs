//! How far a rectangle of a surface is from the bilinear patch of its corners: P2's surface errors (section 5.2).
//!
//! The conservative error takes control points, the approximate one points of the surface at their parameters; both
//! add a quarter of the twist, which two triangles cannot follow. For rational patches P2's formula is no bound: the
//! difference is taken in homogeneous space, where numerator `A - w B` and denominator `w` of degree one higher have a
//! hull again. A rectangle may cover several patches.

use glam::{DVec2, DVec3};

use super::outline::Ground;
use crate::kernel::bezier::BezierPatch;
use crate::kernel::bezier::bernstein::binomial_row;
use crate::kernel::trim::UvRect;

/// Deviation of a rectangle from its bilinear patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Bound or estimate of the distance to two triangles.
    pub error: f64,
    /// Native parameters of the largest deviation from the bilinear patch.
    pub at: DVec2,
    /// The largest deviation from the bilinear patch.
    pub bilinear: f64,
}

/// Corners of a rectangle on the surface, `[u][v]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corners(pub [[DVec3; 2]; 2]);

impl Corners {
    /// Evaluates the four corners.
    pub fn new(ground: &Ground, rect: &UvRect) -> Self {
        let at = |x: f64, y: f64| ground.point(DVec2::new(x, y));
        let (a, b) = (rect.min, rect.max);
        Self([[at(a.x, a.y), at(a.x, b.y)], [at(b.x, a.y), at(b.x, b.y)]])
    }

    /// The bilinear patch at `x` (0 to 1).
    pub fn at(&self, x: DVec2) -> DVec3 {
        let [low, high] = self.0;
        low[0].lerp(low[1], x.y).lerp(high[0].lerp(high[1], x.y), x.x)
    }

    /// A quarter of the distance between the middles of the diagonals, doubled: P2's term for two triangles.
    pub fn twist(&self) -> f64 {
        let [low, high] = self.0;
        0.25 * (low[0] - low[1] - high[0] + high[1]).length()
    }
}

/// The deviation of `rect`: by control points when `conservative`, else by points of the surface.
pub fn deviation(ground: &Ground, rect: &UvRect, conservative: bool) -> Deviation {
    let corners = Corners::new(ground, rect);
    let mut worst = Deviation { error: 0.0, at: 0.5 * (rect.min + rect.max), bilinear: 0.0 };
    for patch in ground.patches() {
        let (low, high) = (patch.uv_min.max(rect.min), patch.uv_max.min(rect.max));
        if !(high - low).cmpgt(DVec2::ZERO).all() {
            continue;
        }
        let mut offer = |off: f64, uv: DVec2| {
            if off > worst.bilinear {
                worst.bilinear = off;
                worst.at = uv;
            }
        };
        if conservative {
            let part = restricted(patch, low, high);
            let place = |uv: DVec2| corners.at((uv - rect.min) / rect.size());
            if part.is_rational() {
                rational(&part, place, &mut offer)
            } else {
                polynomial(&part, place, &mut offer)
            }
        } else {
            for (x, y) in abscissae(patch) {
                let uv = low + (high - low) * DVec2::new(x, y);
                let local = patch.local(uv);
                offer(
                    (patch.point(local.x, local.y) - corners.at((uv - rect.min) / rect.size())).length(),
                    uv,
                );
            }
        }
    }
    worst.error = worst.bilinear + corners.twist();
    worst
}

/// The part of a patch over native `low..high`.
pub fn restricted(patch: &BezierPatch, low: DVec2, high: DVec2) -> BezierPatch {
    if low == patch.uv_min && high == patch.uv_max {
        return patch.clone();
    }
    let mut part = patch.restrict(patch.local(low), patch.local(high));
    (part.uv_min, part.uv_max) = (low, high);
    part
}

/// Parameters of control points.
fn abscissae(patch: &BezierPatch) -> impl Iterator<Item = (f64, f64)> + use<> {
    let (m, n) = (patch.degree_u, patch.degree_v);
    (0..=m).flat_map(move |i| (0..=n).map(move |j| (i as f64 / m as f64, j as f64 / n as f64)))
}

fn polynomial(part: &BezierPatch, bilinear: impl Fn(DVec2) -> DVec3, offer: &mut impl FnMut(f64, DVec2)) {
    for (p, (x, y)) in part.points.iter().zip(abscissae(part)) {
        let uv = part.native(DVec2::new(x, y));
        offer((*p - bilinear(uv)).length(), uv);
    }
}

fn rational(part: &BezierPatch, bilinear: impl Fn(DVec2) -> DVec3, offer: &mut impl FnMut(f64, DVec2)) {
    let (m, n) = (part.degree_u, part.degree_v);
    let (bu, bv) = (binomial_row(m), binomial_row(n));
    let corner = |k: usize, l: usize| bilinear(part.native(DVec2::new(k as f64, l as f64)));
    let corners = [[corner(0, 0), corner(0, 1)], [corner(1, 0), corner(1, 1)]];
    let mut sums = vec![(DVec3::ZERO, 0.0); (m + 2) * (n + 2)];
    for (index, (p, w)) in part.points.iter().zip(&part.weights).enumerate() {
        let (i, j) = (index / (n + 1), index % (n + 1));
        let factor = w * bu[i] * bv[j];
        for (k, l) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let sum = &mut sums[(i + k) * (n + 2) + j + l];
            sum.0 += (*p - corners[k][l]) * factor;
            sum.1 += factor;
        }
    }
    for (index, (off, weight)) in sums.into_iter().enumerate() {
        let (i, j) = (index / (n + 2), index % (n + 2));
        let uv = part.native(DVec2::new(i as f64 / (m + 1) as f64, j as f64 / (n + 1) as f64));
        offer(off.length() / weight, uv);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::face::Face;
    use crate::kernel::nurbs::{KnotVector, NurbsSurface};

    fn face(rational: bool) -> Face {
        let knots = |degree: usize| {
            let mut knots = vec![0.0; degree + 1];
            knots.push(1.0);
            knots.extend(vec![2.0; degree + 1]);
            KnotVector::new(degree, knots).unwrap()
        };
        let (u, v) = (knots(3), knots(2));
        let count = u.control_count() * v.control_count();
        let point = |k: usize| DVec3::new((k / 4) as f64, (k % 4) as f64, ((k * 7) % 5) as f64 * 0.3);
        let weight = |k: usize| if rational { 0.3 + ((k * 5) % 7) as f64 } else { 1.0 };
        let surface =
            NurbsSurface::new(u, v, (0..count).map(point).collect(), (0..count).map(weight).collect())
                .unwrap();
        Face::derive(&surface, &[]).unwrap()
    }

    #[test]
    fn the_conservative_error_bounds_the_distance_to_the_bilinear_patch() {
        for rational in [false, true] {
            let face = face(rational);
            let ground = Ground::new(&face);
            let rects = [(0.0, 0.0, 2.0, 2.0), (0.3, 0.1, 0.5, 1.9), (0.9, 0.9, 1.2, 1.3)];
            for (a, b, c, d) in rects {
                let rect = UvRect { min: DVec2::new(a, b), max: DVec2::new(c, d) };
                let (bound, estimate) = (deviation(&ground, &rect, true), deviation(&ground, &rect, false));
                assert!(estimate.error <= bound.error);
                let corners = Corners::new(&ground, &rect);
                for k in 0..=900 {
                    let x = DVec2::new(f64::from(k % 31) / 30.0, f64::from(k / 31) / 29.0).min(DVec2::ONE);
                    let off = (ground.point(rect.native(x)) - corners.at(x)).length();
                    assert!(off <= bound.bilinear + 1e-12, "{off} {bound:?}");
                }
            }
        }
    }
}
