//! Questions asked of exact geometry: where a ray hits, how large a face is, what is closest.

pub mod bounds_tree;
pub mod line_roots;
pub mod raycast;

pub use bounds_tree::BoundsTree;
pub use raycast::{RayHit, RayHits, Raycaster};
