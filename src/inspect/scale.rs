//! How close counts as what. Being a neighbour and having a gap are different questions: these distances
//! decide who is compared with whom, never whether a gap is reported.

use super::lifted::LiftedCurve;

/// Distances for pairing, model units unless relative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Two naked stretches further apart than this are never the sides of one edge.
    pub reach: f64,
    /// Size of the model.
    pub size: f64,
}

/// Whole curves are compared as such when their points differ by less than this part of their length.
const WHOLE: f64 = 1e-4;
/// More than two sides meet in one edge when they are closer than this part of the smaller face.
const JOIN: f64 = 1e-5;
/// A gap wider than this part of the stretch is no gap but two edges.
pub(super) const SLENDER: f64 = 0.25;

impl Scale {
    /// The usual distances for a model of `size` whose unit is `millimetres` long: neighbours are sought up
    /// to 2 mm, but not beyond a twentieth of the model, nor less than a ten-thousandth of it.
    pub fn new(size: f64, millimetres: f64) -> Self {
        let two_mm = 2.0 / if millimetres > 0.0 && millimetres.is_finite() { millimetres } else { 1.0 };
        Self { reach: two_mm.min(0.05 * size).max(1e-4 * size), size }
    }

    /// Points of two curves are taken as one when closer than this.
    pub fn join(a: &LiftedCurve, b: &LiftedCurve) -> f64 {
        let rounding = 16.0 * (a.ground().rounding() + b.ground().rounding());
        (JOIN * a.ground().size().min(b.ground().size())).max(rounding)
    }

    /// Tolerance for comparing a whole curve with another.
    pub fn whole(curve: &LiftedCurve) -> f64 {
        (WHOLE * curve.length()).max(16.0 * curve.ground().rounding())
    }

    /// How far from `curve` neighbours are sought.
    pub fn reach(&self, curve: &LiftedCurve) -> f64 {
        self.reach.min(SLENDER * curve.length()).max(16.0 * curve.ground().rounding())
    }
}
