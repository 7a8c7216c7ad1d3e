//! Closed surfaces whose loops run past their ends: the seam is moved to where the loops begin.
//!
//! Here parameters of a closed surface go on for ever, but a pcurve in a file should lie in the domain
//! of its surface. The surface is cut at the loops' smallest parameter and its first part is put behind the
//! last, a period later: the same points at the same parameters, and the pcurves stay as they are.

use glam::DVec2;

use crate::exchange::boundary::bounds;
use crate::kernel::nurbs::{Direction, KnotVector, NurbsSurface};
use crate::kernel::query::SplineCarrier;
use crate::scene::records::LoopRecord;

/// Relative slack within which parameters count as equal.
const SLACK: f64 = 1e-9;

/// The surface with its seams where no loop crosses them; `None` when they are there already, or nowhere.
pub(crate) fn moved_seam(carrier: &SplineCarrier, loops: &[&LoopRecord]) -> Option<NurbsSurface> {
    let (min, max) = bounds(loops.iter().flat_map(|l| &l.curves))?;
    let mut surface = carrier.surface().clone();
    let mut changed = false;
    for (axis, direction) in [Direction::U, Direction::V].into_iter().enumerate() {
        let Some(period) = carrier.periods()[axis] else { continue };
        let (start, end) = surface.knots(direction).domain();
        let (low, high) = (min[axis], max[axis]);
        let slack = SLACK * period;
        if (low >= start - slack && high <= end + slack) || high - low > period + slack {
            continue;
        }
        surface = match direction {
            Direction::U => rotated(&surface, low, period)?,
            Direction::V => rotated(&surface.transposed(), low, period)?.transposed(),
        };
        changed = true;
    }
    changed.then_some(surface)
}

/// The surface over `[seam, seam + period]` in u.
fn rotated(surface: &NurbsSurface, seam: f64, period: f64) -> Option<NurbsSurface> {
    let ((start, end), (v0, v1)) = (surface.knots_u().domain(), surface.knots_v().domain());
    let turns = ((seam - start) / period).floor();
    let cut = seam - turns * period;
    let (a, b) = if cut - start <= SLACK * period || end - cut <= SLACK * period {
        // The seam only moves by whole turns.
        let turns = ((seam - start) / period).round();
        return with_knots_u(surface, surface.knots_u().as_slice().iter().map(|k| k + turns * period));
    } else {
        let part = |from, to| surface.restricted(DVec2::new(from, v0), DVec2::new(to, v1)).ok();
        (part(cut, end)?, part(start, cut)?)
    };
    // Both parts are clamped; they meet where the surface closes.
    let (_, count_v) = a.counts();
    let last = a.weights().len() - count_v;
    let factor = a.weights()[last] / b.weights()[0];
    let agree =
        (0..count_v).all(|j| (a.weights()[last + j] / b.weights()[j] - factor).abs() <= SLACK * factor);
    if !agree {
        return None;
    }
    let degree = a.degrees().0;
    let (before, after) = (a.knots_u().as_slice(), b.knots_u().as_slice());
    let knots = before[..before.len() - 1]
        .iter()
        .map(|k| k + turns * period)
        .chain(after[degree + 1..].iter().map(|k| k + (turns + 1.0) * period));
    let points = a.points().iter().chain(&b.points()[count_v..]).copied().collect();
    let weights = a.weights().iter().copied().chain(b.weights()[count_v..].iter().map(|w| w * factor));
    let knots = KnotVector::new(degree, knots.collect()).ok()?;
    NurbsSurface::new(knots, a.knots_v().clone(), points, weights.collect()).ok()
}

fn with_knots_u(surface: &NurbsSurface, knots: impl Iterator<Item = f64>) -> Option<NurbsSurface> {
    let knots = KnotVector::new(surface.degrees().0, knots.collect()).ok()?;
    let (points, weights) = (surface.points().to_vec(), surface.weights().to_vec());
    NurbsSurface::new(knots, surface.knots_v().clone(), points, weights).ok()
}

/// Whether a loop is the border of a surface that is closed both ways, and so bounds nothing. Systems that
/// tell such a border from its copies by where it lies in space cannot read it.
pub(crate) fn is_border_of_closed(carrier: &SplineCarrier, trim: &LoopRecord) -> bool {
    if carrier.periods().contains(&None) {
        return false;
    }
    let surface = carrier.surface();
    let ((u0, u1), (v0, v1)) = (surface.knots_u().domain(), surface.knots_v().domain());
    let size = DVec2::new(u1 - u0, v1 - v0);
    let on = |p: DVec2, axis: usize, level: f64| (p[axis] - level).abs() <= SLACK * size[axis];
    let along_a_side = trim.curves.iter().all(|c| {
        [(0, u0), (0, u1), (1, v0), (1, v1)]
            .into_iter()
            .any(|(axis, level)| c.points().iter().all(|p| on(*p, axis, level)))
    });
    let ends: Vec<DVec2> = trim.curves.iter().map(|c| c.point(c.domain().0)).collect();
    let area: f64 = (0..ends.len()).map(|k| 0.5 * ends[k].perp_dot(ends[(k + 1) % ends.len()])).sum();
    along_a_side && (area.abs() - size.element_product()).abs() <= 4.0 * SLACK * size.element_product()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::demo;

    #[test]
    fn the_ring_keeps_its_points_and_its_loops_come_to_lie_inside() {
        let model = demo::model();
        let ring = model.faces.iter().find(|f| f.name.as_deref() == Some("Ring")).unwrap();
        let carrier = SplineCarrier::new(ring.surface.clone());
        let loops: Vec<&LoopRecord> = ring.loops.iter().collect();
        let moved = moved_seam(&carrier, &loops).unwrap();
        let ((u0, u1), (v0, v1)) = (moved.knots_u().domain(), moved.knots_v().domain());
        assert_eq!(v0, -2.0, "cut where no loop is");
        for i in 0..=40 {
            for j in 0..=40 {
                let uv =
                    DVec2::new(u0 + (u1 - u0) * f64::from(i) / 40.0, v0 + (v1 - v0) * f64::from(j) / 40.0);
                assert!(moved.point(uv.x, uv.y).distance(carrier.point(uv)) < 1e-12);
            }
        }
        let moved = SplineCarrier::new(moved);
        assert!(moved_seam(&moved, &loops).is_none());
        assert!(is_border_of_closed(&moved, loops[0]) && !is_border_of_closed(&moved, loops[1]));
    }
}
