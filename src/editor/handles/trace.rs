//! Trim curves in space, as polylines that no eye can tell from them at the present zoom.
//!
//! The interval of a Bezier piece is halved until the middle of its image is close to the chord; what is off the
//! screen is not refined. Every vertex lies on the surface.

use glam::{DVec2, DVec3};

use super::surface_map::SurfaceMap;
use crate::kernel::nurbs::NurbsCurve2;

/// Halvings that are always made: a closed curve's chord says nothing.
const LEAST_HALVINGS: u32 = 2;
/// Most halvings of one Bezier piece.
const MOST_HALVINGS: u32 = 12;

/// How fine polylines are made.
pub struct Fineness<'a> {
    /// Farthest a polyline may be from its curve, model units.
    pub tolerance: f64,
    /// Whether something between these points of space may be seen.
    pub visible: &'a dyn Fn(DVec3, DVec3, DVec3) -> bool,
}

/// The image of `curve` on the surface.
pub fn trace(curve: &NurbsCurve2, map: &SurfaceMap, fineness: &Fineness) -> Vec<DVec3> {
    let mut points = Vec::new();
    for (piece, _) in curve.to_bezier() {
        let at = |t: f64| map.point(piece.point(t));
        let (start, end) = (at(0.0), at(1.0));
        if points.is_empty() {
            points.push(start);
        }
        halve(&at, ((0.0, start), (1.0, end)), fineness, 0, &mut points);
    }
    points
}

/// The image of the straight line of the parameter plane from `a` to `b`.
pub fn trace_line(a: DVec2, b: DVec2, map: &SurfaceMap, fineness: &Fineness) -> Vec<DVec3> {
    let at = |t: f64| map.point(a.lerp(b, t));
    let (start, end) = (at(0.0), at(1.0));
    let mut points = vec![start];
    halve(&at, ((0.0, start), (1.0, end)), fineness, 0, &mut points);
    points
}

fn halve(
    at: &impl Fn(f64) -> DVec3,
    ((t0, p0), (t1, p1)): ((f64, DVec3), (f64, DVec3)),
    fineness: &Fineness,
    depth: u32,
    points: &mut Vec<DVec3>,
) {
    let t = 0.5 * (t0 + t1);
    let middle = at(t);
    let enough = || {
        let chord = p1 - p0;
        let offset = middle - p0;
        let along = (offset.dot(chord) / chord.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (offset - chord * along).length() <= fineness.tolerance || !(fineness.visible)(p0, middle, p1)
    };
    if depth >= MOST_HALVINGS || depth >= LEAST_HALVINGS && enough() {
        points.push(p1);
        return;
    }
    halve(at, ((t0, p0), (t, middle)), fineness, depth + 1, points);
    halve(at, ((t, middle), (t1, p1)), fineness, depth + 1, points);
}
