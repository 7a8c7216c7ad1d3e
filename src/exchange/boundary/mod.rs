//! From boundary curves as files give them to trim loops: head to tail, closed across seams and poles,
//! in the parameters of the final NURBS surface.
//!
//! [`assembly`] chains the pcurves of one loop; [`winding`] closes loops that run round a periodic
//! surface; [`finish`] fixes the extent of analytic surfaces and converts loops to the spline's
//! parameters.

pub mod assembly;
pub mod finish;
pub mod parameter_map;
pub mod winding;

use glam::DVec2;

use crate::kernel::nurbs::NurbsCurve2;
use crate::scene::records::{EdgeId, LoopRole};

/// A loop in the natural parameters of its carrier.
#[derive(Debug, Clone, PartialEq)]
pub struct RawLoop {
    /// What the file says it is.
    pub role: LoopRole,
    /// Pcurves in order.
    pub pieces: Vec<Piece>,
}

/// A pcurve on its way into a loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The curve.
    pub curve: NurbsCurve2,
    /// The edge of the model it lies on, where the file says so.
    pub edge: Option<EdgeId>,
}

impl Piece {
    /// A straight line that no edge is known of.
    pub fn line(from: DVec2, to: DVec2) -> Self {
        Self { curve: NurbsCurve2::line(from, to), edge: None }
    }

    /// First point.
    pub fn start(&self) -> DVec2 {
        start(&self.curve)
    }

    /// Last point.
    pub fn end(&self) -> DVec2 {
        end(&self.curve)
    }

    /// The piece run through backwards.
    pub fn reversed(&self) -> Self {
        Self { curve: self.curve.reversed(), edge: self.edge }
    }

    /// The piece moved by `by`.
    pub fn shifted(&self, by: DVec2) -> Self {
        Self { curve: shifted(&self.curve, by), edge: self.edge }
    }
}

impl RawLoop {
    /// Its curves.
    pub fn curves(&self) -> impl Iterator<Item = &NurbsCurve2> + Clone {
        self.pieces.iter().map(|p| &p.curve)
    }
}

/// First point of a curve.
pub fn start(curve: &NurbsCurve2) -> DVec2 {
    curve.point(curve.domain().0)
}

/// Last point of a curve.
pub fn end(curve: &NurbsCurve2) -> DVec2 {
    curve.point(curve.domain().1)
}

/// The curve moved by `by`.
pub fn shifted(curve: &NurbsCurve2, by: DVec2) -> NurbsCurve2 {
    if by == DVec2::ZERO { curve.clone() } else { curve.map_points(|p| p + by) }
}

/// Box (min, max) of the ends of `pieces`.
pub fn bounds_of_ends(pieces: &[Piece]) -> Option<(DVec2, DVec2)> {
    pieces.iter().flat_map(|p| [p.start(), p.end()]).fold(None, |b: Option<(DVec2, DVec2)>, p| {
        Some(b.map_or((p, p), |(min, max)| (min.min(p), max.max(p))))
    })
}

/// Tight box (min, max) of `curves`: control points for straight pieces, extrema otherwise. Curves whose
/// control points lie in the box of all ends add nothing and are not searched.
pub fn bounds<'a>(curves: impl IntoIterator<Item = &'a NurbsCurve2>) -> Option<(DVec2, DVec2)> {
    let mut curved = Vec::new();
    let mut result: Option<(DVec2, DVec2)> = None;
    let grow = |result: &mut Option<(DVec2, DVec2)>, p: DVec2| {
        *result = Some(result.map_or((p, p), |(a, b)| (a.min(p), b.max(p))));
    };
    for curve in curves {
        grow(&mut result, start(curve));
        grow(&mut result, end(curve));
        if curve.degree() == 1 {
            curve.points().iter().for_each(|p| grow(&mut result, *p));
        } else {
            curved.push(curve);
        }
    }
    for curve in curved {
        let breaks = curve.knots().breaks();
        for span in breaks.windows(2) {
            let index = curve.knots().span(span[0]);
            let hull = &curve.points()[index - curve.degree()..=index];
            let within =
                |p: &DVec2| result.is_some_and(|(a, b)| p.x >= a.x && p.y >= a.y && p.x <= b.x && p.y <= b.y);
            if hull.iter().all(within) {
                continue;
            }
            const PARTS: usize = 12;
            let h = (span[1] - span[0]) / PARTS as f64;
            for k in 0..PARTS {
                let a = span[0] + h * k as f64;
                grow(&mut result, curve.point(a));
                for axis in 0..2 {
                    if let Some(p) = extremum(curve, axis, a, a + h) {
                        grow(&mut result, p);
                    }
                }
            }
            grow(&mut result, curve.point(span[1]));
        }
    }
    result
}

/// The point of `[a, b]` where the derivative of coordinate `axis` changes sign, if it does.
fn extremum(curve: &NurbsCurve2, axis: usize, mut a: f64, mut b: f64) -> Option<DVec2> {
    let slope = |t: f64| curve.derivatives(t, 1)[1][axis];
    let (sa, sb) = (slope(a), slope(b));
    if !(sa * sb < 0.0) {
        return None;
    }
    for _ in 0..50 {
        let m = 0.5 * (a + b);
        if slope(m) * sa > 0.0 { a = m } else { b = m }
    }
    Some(curve.point(0.5 * (a + b)))
}
