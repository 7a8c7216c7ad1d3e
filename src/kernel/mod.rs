//! Pure geometry in `f64`: curves, surfaces, trimming, queries. Knows nothing of files or GPUs.

pub mod bezier;
pub mod face;
pub mod nurbs;
pub mod primitives;
pub mod query;
pub mod tessellate;
pub mod trim;
pub mod vector;
pub mod view;
