//! Where the points of a moving curve are to go, in the parameters of its surface.

use glam::DVec2;

use super::refit::least_squares;
use crate::inspect::lifted::LiftedCurve;
use crate::inspect::measure::Stretch;
use crate::inspect::nearest::{nearest, nearest_from};
use crate::kernel::nurbs::{NurbsCurve2, NurbsSurface};
use crate::kernel::query::Carrier;

/// Points for each control point.
const DENSITY: usize = 4;
/// An end that is this part of the tolerance off already stays, so that its neighbours may stay too.
const STAYS: f64 = 0.25;

/// The goals of a curve.
pub struct Goals<'a> {
    carrier: Carrier,
    curve: LiftedCurve,
    target: Stretch<'a>,
    forward: bool,
    tolerance: f64,
    left: f64,
}

impl<'a> Goals<'a> {
    /// Goals for `curve` on `surface`: the part of the other side at `target`.
    pub fn new(
        surface: &NurbsSurface,
        curve: LiftedCurve,
        target: Stretch<'a>,
        forward: bool,
        tolerance: f64,
    ) -> Self {
        let carrier = Carrier::spline(surface.clone());
        Self { carrier, curve, target, forward, tolerance, left: 0.0 }
    }

    /// Takes the feet from `curve` from now on: those of a curve that is close already hardly slip along.
    pub fn start_from(&mut self, curve: LiftedCurve) {
        self.curve = curve;
    }

    /// The largest distance between the surface and the other side's curve seen so far.
    pub fn left(&self) -> f64 {
        self.left
    }

    /// The curve over the knots and weights of `candidate` that comes closest to the goals.
    pub fn fit(&mut self, candidate: &NurbsCurve2) -> Option<NurbsCurve2> {
        let (a, b) = candidate.domain();
        let count = (DENSITY * candidate.points().len()).max(24);
        let at = |k: usize| if k == count { b } else { a + (b - a) * k as f64 / count as f64 };
        let goals: Vec<(f64, DVec2)> = (0..=count).map(|k| (at(k), self.goal(at(k)))).collect();
        least_squares(candidate, &goals)
    }

    /// Where the point at `t` is to go.
    fn goal(&mut self, t: f64) -> DVec2 {
        let here = self.curve.at(t);
        let (start, end) = self.curve.domain();
        let range = self.target.range;
        let ends = if self.forward { [range.0, range.1] } else { [range.1, range.0] };
        let there = if t <= start {
            self.target.curve.at(ends[0])
        } else if t >= end {
            self.target.curve.at(ends[1])
        } else {
            // Along the other curve in proportion to arc length would slip; the nearest point does not.
            nearest_from(
                self.target.curve,
                here.point,
                range,
                nearest(self.target.curve, here.point, range).at.t,
            )
            .at
        };
        let is_end = t <= start || t >= end;
        if is_end && (there.point - here.point).length() <= STAYS * self.tolerance {
            return here.uv;
        }
        let uv = self.carrier.locate(there.point, Some(here.uv));
        self.left = self.left.max((self.carrier.point(uv) - there.point).length());
        uv
    }
}
