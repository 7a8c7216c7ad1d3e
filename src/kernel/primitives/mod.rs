//! Classic shapes as exact NURBS, in OpenCASCADE's parametrisation, so that (u, v) mean the same to both.

pub mod conic;

pub use conic::{arc, arc_angle, arc_parameter, hyperbola, parabola};
