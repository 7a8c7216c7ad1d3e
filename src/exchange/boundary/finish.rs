//! The last step: the spline that a face keeps, and its loops in the spline's parameters.

use std::f64::consts::TAU;

use glam::DVec2;

use super::parameter_map::map_curve;
use super::{RawLoop, bounds};
use crate::kernel::nurbs::{NurbsCurve2, NurbsError, NurbsSurface};
use crate::kernel::primitives::{AnalyticSurface, Shape, Sweep, arc_angle, arc_parameter};
use crate::kernel::query::Carrier;
use crate::scene::records::LoopRecord;

/// Why no spline could be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FinishError {
    /// An endless surface without a boundary.
    #[error("the surface has no end and no boundary")]
    Unbounded,
    /// A boundary without area.
    #[error("the boundary encloses nothing")]
    Empty,
    /// Numbers out of range.
    #[error(transparent)]
    Nurbs(#[from] NurbsError),
}

/// The surface over the extent of its loops (splines as they are), and the loops to `tolerance` (model units).
///
/// # Errors
/// See [`FinishError`].
pub fn finish(
    carrier: Carrier,
    sweep: Option<&Sweep>,
    loops: Vec<RawLoop>,
    tolerance: f64,
) -> Result<(NurbsSurface, Vec<LoopRecord>), FinishError> {
    match carrier {
        Carrier::Spline(spline) => {
            if let Some(cut) = sweep.and_then(|s| cut_sweep(s, &loops, tolerance).transpose()) {
                return cut;
            }
            Ok((spline.into_surface(), loops.iter().map(|l| record(l, NurbsCurve2::clone)).collect()))
        }
        Carrier::Analytic(surface) => {
            let (min, max) = extent(&surface, &loops)?;
            let spline = surface.spline(min, max)?;
            let bent = match surface.shape {
                Shape::Plane => [false, false],
                Shape::Cylinder { .. } | Shape::Cone { .. } => [true, false],
                Shape::Sphere { .. } | Shape::Torus { .. } => [true, true],
            };
            let map = |uv: DVec2| surface.spline_parameters(min, max, uv);
            let mut distance =
                |a: DVec2, b: DVec2| (spline.point(a.x, a.y) - spline.point(b.x, b.y)).length();
            let mut convert = |c: &NurbsCurve2| {
                if bent == [false, false] {
                    return c.clone();
                }
                map_curve(c, bent, false, &map, tolerance, &mut distance).unwrap_or_else(|| c.map_points(map))
            };
            let loops = loops.iter().map(|l| record(l, &mut convert)).collect();
            Ok((spline, loops))
        }
    }
}

/// A loop with its curves converted, and their edges if any is known.
fn record(raw: &RawLoop, convert: impl FnMut(&NurbsCurve2) -> NurbsCurve2) -> LoopRecord {
    let mut record = LoopRecord::new(raw.role, raw.curves().map(convert).collect());
    if raw.pieces.iter().any(|p| p.edge.is_some()) {
        record.edges = raw.pieces.iter().map(|p| p.edge).collect();
    }
    record
}

/// A swept surface whose arcs are cut to the extent of the loops; `None` when they need no cut.
fn cut_sweep(
    sweep: &Sweep,
    loops: &[RawLoop],
    tolerance: f64,
) -> Result<Option<(NurbsSurface, Vec<LoopRecord>)>, FinishError> {
    let arcs = sweep.arcs();
    let Some((min, max)) = bounds(loops.iter().flat_map(RawLoop::curves)) else { return Ok(None) };
    let mut ranges = arcs;
    for axis in 0..2 {
        let Some((start, end)) = arcs[axis] else { continue };
        let closed = (end - start - TAU).abs() < 1e-9;
        let (mut a, mut b) = (arc_angle(start, end, min[axis]), arc_angle(start, end, max[axis]));
        // Nothing lies beyond the ends of an open arc, and ends met within rounding are met.
        let near = 1e-7 * (end - start);
        if (a - start).abs() < near || (a < start && !closed) {
            a = start;
        }
        if (b - end).abs() < near || (b > end && !closed) {
            b = end;
        }
        if !(b > a) {
            return Err(FinishError::Empty);
        }
        ranges[axis] = Some((a, b.min(a + TAU)));
    }
    if ranges == arcs {
        return Ok(None);
    }
    let spline = sweep.over(ranges)?;
    let moved = |axis: usize, x: f64| match (arcs[axis], ranges[axis]) {
        (Some((start, end)), Some((a, b))) => arc_parameter(a, b, arc_angle(start, end, x)),
        _ => x,
    };
    let map = |uv: DVec2| DVec2::new(moved(0, uv.x), moved(1, uv.y));
    let bent = [0, 1].map(|axis| arcs[axis] != ranges[axis]);
    let mut distance = |a: DVec2, b: DVec2| (spline.point(a.x, a.y) - spline.point(b.x, b.y)).length();
    let mut convert = |c: &NurbsCurve2| {
        map_curve(c, bent, false, &map, tolerance, &mut distance).unwrap_or_else(|| c.map_points(map))
    };
    let loops = loops.iter().map(|l| record(l, &mut convert)).collect();
    Ok(Some((spline, loops)))
}

/// The box of natural parameters that the spline is made over.
fn extent(surface: &AnalyticSurface, loops: &[RawLoop]) -> Result<(DVec2, DVec2), FinishError> {
    let periods = surface.periods();
    let limits = surface.limits_v();
    let Some((mut min, mut max)) = bounds(loops.iter().flat_map(RawLoop::curves)) else {
        return match (periods, limits) {
            ([Some(u), Some(v)], _) => Ok((DVec2::ZERO, DVec2::new(u, v))),
            ([Some(u), None], (low, high)) if low.is_finite() && high.is_finite() => {
                Ok((DVec2::new(0.0, low), DVec2::new(u, high)))
            }
            _ => Err(FinishError::Unbounded),
        };
    };
    min.y = min.y.max(limits.0);
    max.y = max.y.min(limits.1);
    for axis in 0..2 {
        let Some(period) = periods[axis] else { continue };
        // Rounded ends of a full turn become exact.
        let snap = |x: f64| {
            let turn = (x / (0.5 * period)).round() * 0.5 * period;
            if (x - turn).abs() < 1e-8 * period { turn } else { x }
        };
        (min[axis], max[axis]) = (snap(min[axis]), snap(max[axis]));
        max[axis] = max[axis].min(min[axis] + period);
    }
    if surface.limits_v().1.is_finite() {
        let snap = |x: f64, to: f64| if (x - to).abs() < 1e-9 { to } else { x };
        (min.y, max.y) = (snap(min.y, limits.0), snap(max.y, limits.1));
    }
    let size = max - min;
    if !(size.x > 0.0 && size.y > 0.0) {
        return Err(FinishError::Empty);
    }
    Ok((min, max))
}
