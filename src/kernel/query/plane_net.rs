//! Polynomial maps of the unit square to the plane, as Bezier nets: evaluation, zeros, smallest values.

use glam::{DMat2, DVec2};

use crate::kernel::bezier::bernstein;

/// Newton's method on the net from `start` (box parameters); `None` when it does not settle near the box.
pub fn newton(net: &[DVec2], degree: (usize, usize), start: DVec2) -> Option<DVec2> {
    let mut x = start.clamp(DVec2::ZERO, DVec2::ONE);
    let mut last = f64::INFINITY;
    for _ in 0..20 {
        let (value, jacobian) = evaluate(net, degree, x);
        let step = jacobian.inverse() * value;
        if !step.is_finite() {
            return None;
        }
        x = (x - step).clamp(DVec2::splat(-0.1), DVec2::splat(1.1));
        let size = step.abs().max_element();
        if size < 1e-15 || (size < 1e-9 && size >= 0.5 * last) {
            return Some(x);
        }
        last = size;
    }
    None
}

/// The parameters near the box (within half its size) at which the net comes closest to 0, and how close, from
/// the middle downhill (Levenberg & Marquardt); stops below `enough`.
pub fn smallest(net: &[DVec2], degree: (usize, usize), enough: f64) -> (DVec2, f64) {
    let mut x = DVec2::splat(0.5);
    let (mut value, mut jacobian) = evaluate(net, degree, x);
    let mut damping = 1e-3 * (jacobian.x_axis.length_squared() + jacobian.y_axis.length_squared());
    for _ in 0..60 {
        if value.length() <= enough || damping == 0.0 {
            break;
        }
        let transposed = jacobian.transpose();
        let step = (transposed * jacobian + DMat2::from_diagonal(DVec2::splat(damping))).inverse()
            * (transposed * value);
        let next = (x - step).clamp(DVec2::splat(-0.5), DVec2::splat(1.5));
        let (next_value, next_jacobian) = evaluate(net, degree, next);
        if next_value.length() < value.length() {
            (x, value, jacobian) = (next, next_value, next_jacobian);
            damping *= 0.2;
        } else {
            damping *= 5.0;
        }
    }
    (x, value.length())
}

/// Value and Jacobian of the net at `x` in box parameters.
pub fn evaluate(net: &[DVec2], degree: (usize, usize), x: DVec2) -> (DVec2, DMat2) {
    match degree.0.max(degree.1) {
        0..4 => evaluate_sized::<4>(net, degree, x),
        4..8 => evaluate_sized::<8>(net, degree, x),
        8..16 => evaluate_sized::<16>(net, degree, x),
        _ => evaluate_sized::<{ bernstein::MAX_COUNT }>(net, degree, x),
    }
}

fn evaluate_sized<const N: usize>(net: &[DVec2], (m, n): (usize, usize), x: DVec2) -> (DVec2, DMat2) {
    let (bu, bv) = (bernstein::tangent::<N>(m, x.x), bernstein::tangent::<N>(n, x.y));
    let (mut value, mut du, mut dv) = (DVec2::ZERO, DVec2::ZERO, DVec2::ZERO);
    for (i, row) in net.chunks_exact(n + 1).enumerate() {
        let (mut a, mut b) = (DVec2::ZERO, DVec2::ZERO);
        for (j, p) in row.iter().enumerate() {
            a += *p * bv[0][j];
            b += *p * bv[1][j];
        }
        value += a * bu[0][i];
        du += a * bu[1][i];
        dv += b * bu[0][i];
    }
    (value, DMat2::from_cols(du, dv))
}
