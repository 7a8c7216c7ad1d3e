//! A surface moved along its normal, as a spline.
//!
//! The offset of a spline is not a spline. It is approximated by bicubic Hermite patches, whose corner
//! positions, derivatives and twists come from the offset itself; the grid is halved until the
//! error found between the corners is within the tolerance.

use glam::{DVec2, DVec3};

use crate::kernel::nurbs::{KnotVector, NurbsSurface};

/// Spans per direction at most.
const MOST_SPANS: usize = 128;
/// Halving must bring the error down to this part of it, or the surface is too wild for the grid.
const GAIN: f64 = 0.7;
/// Halvings without gain that are forgiven.
const STALLS: u32 = 3;

/// `surface` moved by `distance` along `du x dv`, to `tolerance` (model units): the surface, over the
/// same parameters, and the largest error found. `None` where the normal vanishes.
pub fn offset(surface: &NurbsSurface, distance: f64, tolerance: f64) -> Option<(NurbsSurface, f64)> {
    let mut us = surface.knots_u().breaks();
    let mut vs = surface.knots_v().breaks();
    let (mut before, mut stalls) = (f64::INFINITY, 0);
    loop {
        let result = hermite(surface, distance, &us, &vs)?;
        let (error_u, error_v) = errors(surface, &result, distance, &us, &vs);
        let error = error_u.max(error_v);
        let full = us.len().max(vs.len()) > MOST_SPANS / 2;
        stalls += u32::from(error > GAIN * before);
        if error <= tolerance || full || stalls > STALLS {
            return Some((result, error));
        }
        before = error;
        if error_u > 0.25 * error {
            us = halved(&us);
        }
        if error_v > 0.25 * error {
            vs = halved(&vs);
        }
    }
}

fn halved(breaks: &[f64]) -> Vec<f64> {
    let mut result: Vec<f64> = breaks.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]).collect();
    result.extend(breaks.last());
    result
}

fn point(surface: &NurbsSurface, distance: f64, u: f64, v: f64) -> Option<DVec3> {
    let jet = surface.jet(u, v);
    Some(jet.point + jet.du.cross(jet.dv).try_normalize()? * distance)
}

/// Largest errors at the middles of the sides (along u, along v) and of the patches.
fn errors(
    surface: &NurbsSurface,
    result: &NurbsSurface,
    distance: f64,
    us: &[f64],
    vs: &[f64],
) -> (f64, f64) {
    let error =
        |u: f64, v: f64| point(surface, distance, u, v).map_or(0.0, |p| (p - result.point(u, v)).length());
    let (mut along_u, mut along_v) = (0.0_f64, 0.0_f64);
    for a in us.windows(2) {
        for b in vs.windows(2) {
            let (mu, mv) = (0.5 * (a[0] + a[1]), 0.5 * (b[0] + b[1]));
            along_u = along_u.max(error(mu, b[0])).max(error(0.75 * a[0] + 0.25 * a[1], mv));
            along_v = along_v.max(error(a[0], mv)).max(error(mu, 0.75 * b[0] + 0.25 * b[1]));
            let both = error(mu, mv);
            if both > along_u.max(along_v) {
                (along_u, along_v) = (both, both);
            }
        }
    }
    (along_u, along_v)
}

/// The C1 (C0 at break points) bicubic surface through the offset at the grid.
fn hermite(surface: &NurbsSurface, distance: f64, us: &[f64], vs: &[f64]) -> Option<NurbsSurface> {
    let (m, n) = (us.len() - 1, vs.len() - 1);
    let nv = 3 * n + 1;
    let mut points = vec![DVec3::ZERO; (3 * m + 1) * nv];
    for i in 0..m {
        for j in 0..n {
            let (h, k) = (us[i + 1] - us[i], vs[j + 1] - vs[j]);
            for a in 0..2 {
                for b in 0..2 {
                    let corner = DVec2::new(us[i + a], vs[j + b]);
                    let inward = DVec2::new(if a == 0 { h } else { -h }, if b == 0 { k } else { -k });
                    let [p, pu, pv, puv] = corner_data(surface, distance, corner, inward)?;
                    let (ia, jb) = (3 * (i + a), 3 * (j + b));
                    let step = |base: usize, forward: bool| if forward { base + 1 } else { base - 1 };
                    let (iu, jv) = (step(ia, a == 0), step(jb, b == 0));
                    points[ia * nv + jb] = p;
                    points[iu * nv + jb] = p + pu / 3.0;
                    points[ia * nv + jv] = p + pv / 3.0;
                    points[iu * nv + jv] = p + pu / 3.0 + pv / 3.0 + puv / 9.0;
                }
            }
        }
    }
    let knots = |breaks: &[f64]| {
        let mut knots: Vec<f64> = breaks.iter().flat_map(|b| [*b; 3]).collect();
        knots.insert(0, breaks[0]);
        knots.push(breaks[breaks.len() - 1]);
        KnotVector::new(3, knots).ok()
    };
    let weights = vec![1.0; points.len()];
    NurbsSurface::new(knots(us)?, knots(vs)?, points, weights).ok()
}

/// Position, derivatives along the two inward vectors and the mixed one, by differences into the patch.
fn corner_data(surface: &NurbsSurface, distance: f64, corner: DVec2, inward: DVec2) -> Option<[DVec3; 4]> {
    const H: f64 = 1e-3;
    let at =
        |a: f64, b: f64| point(surface, distance, corner.x + a * H * inward.x, corner.y + b * H * inward.y);
    // One-sided differences of fourth order.
    const C: [f64; 5] = [-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -0.25];
    let (mut pu, mut pv, mut puv) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    for (a, ca) in C.iter().enumerate() {
        pu += at(a as f64, 0.0)? * (ca / H);
        pv += at(0.0, a as f64)? * (ca / H);
        for (b, cb) in C.iter().enumerate() {
            puv += at(a as f64, b as f64)? * (ca * cb / (H * H));
        }
    }
    Some([at(0.0, 0.0)?, pu, pv, puv])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::primitives::{arc, revolution};

    #[test]
    fn the_offset_of_a_ball_is_a_ball() {
        let arc = arc(DVec3::ZERO, DVec3::X, DVec3::Z, -1.0, 1.0).unwrap();
        let ball = revolution(&arc, DVec3::ZERO, DVec3::Z, 0.0, 3.0).unwrap();
        let (shell, error) = offset(&ball, 0.5, 1e-6).unwrap();
        assert!(error <= 1e-6);
        for k in 0..=200 {
            let p = shell.point(3.0 * f64::from(k) / 200.0, -1.0 + 2.0 * f64::from((7 * k) % 201) / 200.0);
            assert!((p.length() - 1.5).abs() < 2e-6);
        }
    }
}
