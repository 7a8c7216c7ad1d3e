//! The point of a curve or surface that is closest to a given one.
//!
//! The squared distance times the squared weight is a polynomial whose Bernstein coefficients bound it from
//! below, to second order in the size of a part. Parts are bisected and dropped when their bound
//! does not beat the best point found; each part looked at starts a Newton search (projected on its
//! borders) for a better one. A part of a surface on which that polynomial is convex holds no other minimum than the
//! one found, and is done with. What is returned is closest up to [`ACCURACY`] of the size of the shape.

use std::collections::VecDeque;

use glam::{DMat2, DVec2, DVec3};

use crate::kernel::bezier::bernstein::binomial_row;
use crate::kernel::bezier::products::{distance_coefficients, distance_coefficients_of_curve};
use crate::kernel::bezier::{BezierCurve, BezierPatch};
use crate::kernel::vector::Vector;

/// Accuracy of the distance relative to the size of the shape and the distance.
pub const ACCURACY: f64 = 1e-12;
/// Parts looked at; reached only when many points are equally close (a sphere's centre).
const BUDGET: usize = 4_000;
/// Parts of one patch that are looked at before the next patch is.
const AT_ONCE: usize = 64;

/// The closest point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestOnCurve<V> {
    /// Native parameter.
    pub t: f64,
    /// The point.
    pub point: V,
    /// Its distance.
    pub distance: f64,
}

/// The closest point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestOnSurface {
    /// Native parameters.
    pub uv: DVec2,
    /// Position of the patch in the list.
    pub patch: usize,
    /// The point.
    pub point: DVec3,
    /// Its distance.
    pub distance: f64,
}

/// The point of `pieces` (as made by [`crate::kernel::nurbs::NurbsCurve::to_bezier`]) closest to
/// `target`; `None` when there are none.
pub fn closest_on_curve<V: Vector>(
    pieces: &[(BezierCurve<V>, (f64, f64))],
    target: V,
) -> Option<ClosestOnCurve<V>> {
    let mut best: Option<ClosestOnCurve<V>> = None;
    let mut parts = VecDeque::new();
    for (curve, interval) in pieces {
        offer(&mut best, interval.0, curve.start(), target);
        offer(&mut best, interval.1, curve.end(), target);
        parts.push_back((curve.clone(), *interval));
    }
    let size = pieces.iter().map(|(c, _)| extent(c, target)).fold(0.0, f64::max);
    for _ in 0..BUDGET {
        let Some((curve, (a, b))) = parts.pop_front() else { break };
        let limit = best.map_or(f64::INFINITY, |b| b.distance) - ACCURACY * size;
        if limit <= 0.0 || cannot_beat(&distance_coefficients_of_curve(&curve, target), limit) {
            continue;
        }
        let (t, point) = descend_curve(&curve, target);
        offer(&mut best, a + (b - a) * t, point, target);
        let middle = 0.5 * (a + b);
        if middle > a && middle < b {
            let (left, right) = curve.split(0.5);
            parts.push_back((left, (a, middle)));
            parts.push_back((right, (middle, b)));
        }
    }
    best
}

/// The point of `patches` closest to `target`; `None` when there are none.
pub fn closest_on_surface(patches: &[BezierPatch], target: DVec3) -> Option<ClosestOnSurface> {
    closer_on_surface(patches, target, f64::INFINITY)
}

/// The same where it is nearer than `known`; `None` when no point is.
pub fn closer_on_surface(patches: &[BezierPatch], target: DVec3, known: f64) -> Option<ClosestOnSurface> {
    let from_box = |patch: &BezierPatch| {
        let bounds = patch.bounds();
        ((target.clamp(bounds.min, bounds.max) - target).length(), bounds)
    };
    let mut size = 0.0f64;
    let mut order: Vec<(f64, usize)> = Vec::with_capacity(patches.len());
    for (number, patch) in patches.iter().enumerate() {
        let (away, bounds) = from_box(patch);
        size = size.max((bounds.centre() - target).length() + bounds.diagonal());
        order.push((away, number));
    }
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut search = Search { target, size, limit: known, best: None, rest: VecDeque::new() };
    for (away, number) in order {
        if away > search.worth() {
            break;
        }
        search.patch(number, &patches[number]);
    }
    // What took long is left for last, so that no patch keeps others from being looked at.
    for _ in 0..BUDGET {
        let Some((number, part)) = search.rest.pop_front() else { break };
        let quarters = search.part(number, &part);
        search.rest.extend(quarters.into_iter().flatten().map(|quarter| (number, quarter)));
    }
    search.best
}

/// A search for the closest point under way.
struct Search {
    target: DVec3,
    /// Of all patches as seen from the target.
    size: f64,
    /// Distance of the best point known.
    limit: f64,
    best: Option<ClosestOnSurface>,
    /// Parts of patches that were not done with at once.
    rest: VecDeque<(usize, BezierPatch)>,
}

impl Search {
    /// What a point must be nearer than to count.
    fn worth(&self) -> f64 {
        self.limit - ACCURACY * self.size
    }

    fn offer(&mut self, patch: usize, uv: DVec2, point: DVec3) {
        let distance = (point - self.target).length();
        if distance < self.limit {
            self.limit = distance;
            self.best = Some(ClosestOnSurface { uv, patch, point, distance });
        }
    }

    fn patch(&mut self, number: usize, patch: &BezierPatch) {
        for local in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE, DVec2::splat(0.5)] {
            self.offer(number, patch.native(local), patch.point(local.x, local.y));
        }
        let mut parts = VecDeque::from([patch.clone()]);
        for _ in 0..AT_ONCE {
            let Some(part) = parts.pop_front() else { return };
            parts.extend(self.part(number, &part).into_iter().flatten());
        }
        self.rest.extend(parts.into_iter().map(|part| (number, part)));
    }

    /// Looks at a part of a patch; gives its quarters where they may hold a nearer point.
    fn part(&mut self, number: usize, part: &BezierPatch) -> Option<[BezierPatch; 4]> {
        let bounds = part.bounds();
        let from_box = (self.target.clamp(bounds.min, bounds.max) - self.target).length();
        if self.worth() <= 0.0 || from_box > self.worth() {
            return None;
        }
        let coefficients = distance_coefficients(part, self.target);
        if cannot_beat(&coefficients, self.worth()) {
            return None;
        }
        let foot = descend(part, self.target);
        self.offer(number, part.native(foot.local), foot.point);
        let middle = part.native(DVec2::splat(0.5));
        let divisible = (middle.cmpgt(part.uv_min) & middle.cmplt(part.uv_max)).all();
        (divisible && !self.is_settled(part, &coefficients, &foot)).then(|| part.quarters())
    }

    /// Whether no point of `part` is nearer than the one that Newton's method found, up to the accuracy: the polynomial that
    /// bounds the distance is convex there and all but stationary at the foot.
    fn is_settled(&self, part: &BezierPatch, coefficients: &[(f64, f64)], foot: &Foot) -> bool {
        let (m, n) = (part.degree_u, part.degree_v);
        let range = part.weights.iter().fold((f64::INFINITY, 0.0f64), |r, w| (r.0.min(*w), r.1.max(*w)));
        // What the weights add to the slope at the foot comes to less than half of what the foot is off by.
        if (m + n) as f64 * (range.1 - range.0) >= 0.5 * range.0 {
            return false;
        }
        let squared = self.limit * self.limit;
        let (bu, bv) = (binomial_row(2 * m), binomial_row(2 * n));
        let f = |i: usize, j: usize| {
            let (distance, weight) = coefficients[i * (2 * n + 1) + j];
            (distance - squared * weight) / (bu[i] * bv[j])
        };
        let (mut uu, mut vv, mut uv) = (f64::INFINITY, f64::INFINITY, 0.0f64);
        for i in 0..=2 * m {
            for j in 0..=2 * n {
                if i < 2 * m - 1 {
                    uu = uu.min(f(i + 2, j) - 2.0 * f(i + 1, j) + f(i, j));
                }
                if j < 2 * n - 1 {
                    vv = vv.min(f(i, j + 2) - 2.0 * f(i, j + 1) + f(i, j));
                }
                if i < 2 * m && j < 2 * n {
                    uv = uv.max((f(i + 1, j + 1) - f(i + 1, j) - f(i, j + 1) + f(i, j)).abs());
                }
            }
        }
        let (m, n) = (2.0 * m as f64, 2.0 * n as f64);
        let (uu, vv, uv) = (m * (m - 1.0) * uu, n * (n - 1.0) * vv, m * n * uv);
        let apart = 1.0 - uv / (uu * vv).sqrt();
        if !(uu > 0.0 && vv > 0.0 && apart > 0.05) {
            return false;
        }
        // A quadratic below the polynomial is lower by no more than this.
        let slope = 2.0 * range.1 * range.1 * foot.slope;
        let gain = (slope.x * slope.x / uu + slope.y * slope.y / vv) / (2.0 * apart);
        gain <= range.0 * range.0 * ACCURACY * self.size * self.limit
    }
}

fn offer<V: Vector>(best: &mut Option<ClosestOnCurve<V>>, t: f64, point: V, target: V) {
    let distance = (point - target).length();
    if best.is_none_or(|b| distance < b.distance) {
        *best = Some(ClosestOnCurve { t, point, distance });
    }
}

fn extent<V: Vector>(curve: &BezierCurve<V>, target: V) -> f64 {
    curve.points.iter().map(|p| (*p - target).length()).fold(0.0, f64::max)
}

/// Whether the squared distance (times the squared weight, with which it comes) stays above `limit`.
fn cannot_beat(coefficients: &[(f64, f64)], limit: f64) -> bool {
    coefficients.iter().all(|(distance, weight)| *distance >= limit * limit * weight)
}

/// Newton's method on the derivative of the squared distance, kept within 0..1 and going downhill.
fn descend_curve<V: Vector>(curve: &BezierCurve<V>, target: V) -> (f64, V) {
    let mut t = 0.5;
    let mut jet = curve.jet(t);
    for _ in 0..20 {
        let off = jet.point - target;
        let slope = off.dot(jet.d1);
        let full = jet.d1.dot(jet.d1) + off.dot(jet.d2);
        let curvature = if full > 0.0 { full } else { jet.d1.dot(jet.d1) };
        let mut step = -slope / curvature;
        let squared = off.dot(off);
        let mut moved = None;
        for _ in 0..8 {
            let next = (t + step).clamp(0.0, 1.0);
            let there = curve.jet(next);
            let distance = (there.point - target).dot(there.point - target);
            if next != t && distance < squared {
                moved = Some((next, there));
                break;
            }
            step *= 0.25;
        }
        let Some((next, there)) = moved else { break };
        (t, jet) = (next, there);
    }
    (t, jet.point)
}

/// Where Newton's method ended on a patch.
struct Foot {
    /// Parameters, 0 to 1.
    local: DVec2,
    point: DVec3,
    /// Half the derivatives of the squared distance there, without those across a border that holds it back.
    slope: DVec2,
}

/// The same for a patch.
fn descend(patch: &BezierPatch, target: DVec3) -> Foot {
    let mut uv = DVec2::splat(0.5);
    let mut jet = patch.jet(uv.x, uv.y);
    let mut rest = DVec2::ZERO;
    for _ in 0..20 {
        let off = jet.point - target;
        let mut slope = DVec2::new(off.dot(jet.du), off.dot(jet.dv));
        let first = DMat2::from_cols(
            DVec2::new(jet.du.length_squared(), jet.du.dot(jet.dv)),
            DVec2::new(jet.du.dot(jet.dv), jet.dv.length_squared()),
        );
        let second = DMat2::from_cols(
            DVec2::new(off.dot(jet.duu), off.dot(jet.duv)),
            DVec2::new(off.dot(jet.duv), off.dot(jet.dvv)),
        );
        let full = first + second;
        let mut hessian = if full.x_axis.x > 0.0 && full.determinant() > 0.0 { full } else { first };
        // Coordinates at a border that would leave the patch stay.
        for axis in 0..2 {
            let stuck = (uv[axis] <= 0.0 && slope[axis] > 0.0) || (uv[axis] >= 1.0 && slope[axis] < 0.0);
            if stuck {
                slope[axis] = 0.0;
                hessian.x_axis[1] = 0.0;
                hessian.y_axis[0] = 0.0;
            }
        }
        rest = slope;
        let mut step = -(hessian.inverse() * slope);
        if !step.is_finite() {
            step = -slope / first.x_axis.x.max(first.y_axis.y).max(f64::MIN_POSITIVE);
        }
        let mut moved = None;
        for _ in 0..8 {
            let next = (uv + step).clamp(DVec2::ZERO, DVec2::ONE);
            let there = patch.jet(next.x, next.y);
            if next != uv && (there.point - target).length_squared() < off.length_squared() {
                moved = Some((next, there));
                break;
            }
            step *= 0.25;
        }
        let Some((next, there)) = moved else { break };
        (uv, jet) = (next, there);
    }
    Foot { local: uv, point: jet.point, slope: rest }
}
