//! The point of a curve or surface that is closest to a given one.
//!
//! The squared distance times the squared weight is a polynomial whose Bernstein coefficients bound it from
//! below, to second order in the size of a part. Parts are bisected and dropped when their bound
//! does not beat the best point found; each part looked at starts a Newton search (projected on its
//! borders) for a better one. What is returned is closest up to [`ACCURACY`] of the size of the shape.

use glam::{DMat2, DVec2, DVec3};

use crate::kernel::bezier::products::{distance_coefficients, distance_coefficients_of_curve};
use crate::kernel::bezier::{BezierCurve, BezierPatch};
use crate::kernel::vector::Vector;

/// Accuracy of the distance relative to the size of the shape and the distance.
pub const ACCURACY: f64 = 1e-12;
/// Parts looked at; reached only when many points are equally close (a sphere's centre).
const BUDGET: usize = 4_000;

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
    let mut parts = std::collections::VecDeque::new();
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
    let mut best: Option<ClosestOnSurface> = None;
    let mut offer = |patch: usize, uv: DVec2, point: DVec3| {
        let distance = (point - target).length();
        if best.is_none_or(|b| distance < b.distance) {
            best = Some(ClosestOnSurface { uv, patch, point, distance });
        }
        best.map_or(f64::INFINITY, |b| b.distance)
    };
    let mut limit = f64::INFINITY;
    let mut parts = std::collections::VecDeque::new();
    let mut size = 0.0f64;
    for (number, patch) in patches.iter().enumerate() {
        for local in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE, DVec2::splat(0.5)] {
            limit = offer(number, patch.native(local), patch.point(local.x, local.y));
        }
        let bounds = patch.bounds();
        size = size.max((bounds.centre() - target).length() + bounds.diagonal());
        parts.push_back((number, patch.clone()));
    }
    for _ in 0..BUDGET {
        let Some((number, part)) = parts.pop_front() else { break };
        let worth = limit - ACCURACY * size;
        let bounds = part.bounds();
        let from_box = (target.clamp(bounds.min, bounds.max) - target).length();
        if worth <= 0.0 || from_box > worth || cannot_beat(&distance_coefficients(&part, target), worth) {
            continue;
        }
        let (local, point) = descend(&part, target);
        limit = offer(number, part.native(local), point);
        let middle = part.native(DVec2::splat(0.5));
        if (middle.cmpgt(part.uv_min) & middle.cmplt(part.uv_max)).all() {
            parts.extend(part.quarters().map(|quarter| (number, quarter)));
        }
    }
    best
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

/// The same for a patch.
fn descend(patch: &BezierPatch, target: DVec3) -> (DVec2, DVec3) {
    let mut uv = DVec2::splat(0.5);
    let mut jet = patch.jet(uv.x, uv.y);
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
    (uv, jet.point)
}
