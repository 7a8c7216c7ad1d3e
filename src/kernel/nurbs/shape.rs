//! What a curve or surface looks like as a whole: closed, degenerate edges (poles), bounds.

use super::{Direction, NurbsCurve, NurbsCurve3, NurbsSurface};
use crate::kernel::vector::Vector;
use crate::kernel::view::Bounds;

/// Which of the four edges of a surface's domain shrink to one point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct DegenerateEdges {
    /// The edge of smallest u.
    pub u_min: bool,
    /// The edge of largest u.
    pub u_max: bool,
    /// The edge of smallest v.
    pub v_min: bool,
    /// The edge of largest v.
    pub v_max: bool,
}

impl<V: Vector> NurbsCurve<V> {
    /// Whether the curve ends within `tolerance` of where it starts.
    pub fn is_closed(&self, tolerance: f64) -> bool {
        let (a, b) = self.domain();
        (self.point(b) - self.point(a)).length() <= tolerance
    }
}

impl NurbsSurface {
    /// Whether the edges of smallest and largest u coincide, point by point, within `tolerance` (model
    /// units).
    pub fn is_closed_u(&self, tolerance: f64) -> bool {
        self.is_closed(Direction::U, tolerance)
    }

    /// Whether the edges of smallest and largest v coincide, point by point, within `tolerance`.
    pub fn is_closed_v(&self, tolerance: f64) -> bool {
        self.is_closed(Direction::V, tolerance)
    }

    /// Edges that stay within `tolerance` (model units) of one point.
    pub fn degenerate_edges(&self, tolerance: f64) -> DegenerateEdges {
        let ((u0, u1), (v0, v1)) = (self.knots_u().domain(), self.knots_v().domain());
        let shrinks = |direction, value| {
            let curve = self.iso_curve(direction, value).clamped();
            Bounds::of(curve.points().iter().copied()).diagonal() <= tolerance
        };
        DegenerateEdges {
            u_min: shrinks(Direction::U, u0),
            u_max: shrinks(Direction::U, u1),
            v_min: shrinks(Direction::V, v0),
            v_max: shrinks(Direction::V, v1),
        }
    }

    /// The box around the control points, which holds the surface.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.points().iter().copied())
    }

    fn is_closed(&self, direction: Direction, tolerance: f64) -> bool {
        let (start, end) = self.knots(direction).domain();
        let (first, last) = (self.iso_curve(direction, start), self.iso_curve(direction, end));
        agree(&first, &last, tolerance)
    }
}

/// Whether two curves over the same knots agree within `tolerance`. Two rational curves of degree `p`
/// that meet at `2 p + 1` parameters of a span are equal on it.
fn agree(a: &NurbsCurve3, b: &NurbsCurve3, tolerance: f64) -> bool {
    let samples = 2 * a.degree() + 1;
    a.knots().spans().all(|(_, start, end)| {
        (0..samples).all(|k| {
            let t = start + (end - start) * k as f64 / (samples - 1) as f64;
            (a.point(t) - b.point(t)).length() <= tolerance
        })
    })
}
