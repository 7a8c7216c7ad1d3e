//! Rational Bezier curves and patches: the pieces that everything downstream works on.

pub mod bernstein;
pub mod curve;
pub mod monotone;
pub mod normal_cone;
pub mod patch;
pub mod products;
pub mod roots;
pub mod subdivision;

pub use curve::{BezierCurve, BezierCurve2, BezierCurve3};
pub use monotone::MonotoneSplitter;
pub use normal_cone::NormalCone;
pub use patch::{BezierPatch, Tangents};
