//! Division of the parameter rectangle until every cell is flat enough (P2, section 5.2).
//!
//! The kd-tree divides at the control point that deviates most, across the direction whose dividing line stays closer
//! to the surface there; the quadtree, P2's yardstick, divides into equal quarters. The rectangle is that of the loops.
//! Leaves come in a fixed order and share bit-identical coordinates along common sides.

use glam::DVec2;

use super::bilinear::{Corners, deviation};
use super::line_error::distance_to_segment;
use super::options::{SurfaceDivision, TessellateError};
use super::outline::Ground;
use crate::kernel::trim::UvRect;

/// What cells must keep to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellLimits {
    /// Largest error.
    pub tolerance: f64,
    /// Whether errors are bounds or estimates.
    pub conservative: bool,
    /// How cells are divided.
    pub division: SurfaceDivision,
    /// Cells at most.
    pub most: usize,
}

/// Cells thinner than this part of the rectangle are not divided further.
const THINNEST: f64 = 1e-7;
/// Dividing lines keep this share of a cell on either side.
const SHARE: f64 = 0.1;

/// The leaves of the tree over `domain`.
///
/// # Errors
/// More leaves than allowed, or points that are not finite.
pub fn leaves(ground: &Ground, domain: &UvRect, limits: &CellLimits) -> Result<Vec<UvRect>, TessellateError> {
    let mut leaves = Vec::new();
    let mut open = vec![*domain];
    while let Some(rect) = open.pop() {
        let found = deviation(ground, &rect, limits.conservative);
        if !found.error.is_finite() {
            return Err(TessellateError::NotFinite { u: found.at.x, v: found.at.y });
        }
        let part = rect.size() / domain.size();
        let wide = [part.x > THINNEST, part.y > THINNEST];
        if found.error <= limits.tolerance || !(wide[0] || wide[1]) {
            leaves.push(rect);
            continue;
        }
        if leaves.len() + open.len() >= limits.most {
            return Err(TessellateError::TooManyTriangles { limit: 2 * limits.most });
        }
        let middle = 0.5 * (rect.min + rect.max);
        match limits.division {
            SurfaceDivision::QuadTree => {
                let (low, high) = halves(&rect, 0, middle.x);
                for half in [high, low] {
                    let (below, above) = halves(&half, 1, middle.y);
                    open.extend([above, below]);
                }
            }
            SurfaceDivision::KdTree => {
                let corners = Corners::new(ground, &rect);
                let twisted = found.bilinear < 0.5 * found.error;
                let mut axis =
                    if twisted { longer_side(&corners) } else { direction(ground, &rect, found.at) };
                if !wide[axis] {
                    axis = 1 - axis;
                }
                let share = (found.at[axis] - rect.min[axis]) / rect.size()[axis];
                let at = if twisted || !(SHARE..=1.0 - SHARE).contains(&share) {
                    middle[axis]
                } else {
                    found.at[axis]
                };
                let (low, high) = halves(&rect, axis, at);
                open.extend([high, low]);
            }
        }
    }
    Ok(leaves)
}

fn halves(rect: &UvRect, axis: usize, at: f64) -> (UvRect, UvRect) {
    let (mut low, mut high) = (*rect, *rect);
    low.max[axis] = at;
    high.min[axis] = at;
    (low, high)
}

fn longer_side(corners: &Corners) -> usize {
    let [low, high] = corners.0;
    let along_u = low[0].distance(high[0]) + low[1].distance(high[1]);
    let along_v = low[0].distance(low[1]) + high[0].distance(high[1]);
    usize::from(along_v > along_u)
}

/// The direction to divide across: 0 where the line of constant u through `at` is closer to its chord.
fn direction(ground: &Ground, rect: &UvRect, at: DVec2) -> usize {
    let point = |u: f64, v: f64| ground.point(DVec2::new(u, v));
    let here = point(at.x, at.y);
    let along_v = distance_to_segment(here, point(at.x, rect.min.y), point(at.x, rect.max.y));
    let along_u = distance_to_segment(here, point(rect.min.x, at.y), point(rect.max.x, at.y));
    usize::from(along_u < along_v)
}
