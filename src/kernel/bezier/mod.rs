//! Rational Bezier curves and patches: the pieces that everything downstream works on.

pub mod curve;
pub mod patch;

pub use curve::{BezierCurve, BezierCurve2, BezierCurve3};
pub use patch::BezierPatch;
