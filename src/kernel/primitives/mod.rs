//! Classic shapes as exact NURBS, in OpenCASCADE's parametrisation, so that (u, v) mean the same to both.

pub mod analytic;
pub mod conic;
pub mod lettering;
pub mod outline;
pub mod sweep;

pub use analytic::{AnalyticSurface, Shape};
pub use conic::{arc, arc_angle, arc_parameter, hyperbola, parabola};
pub use sweep::{Motion, Profile, Sweep, extrusion, revolution, ruled};
