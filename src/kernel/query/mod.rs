//! Questions asked of exact geometry: where a ray hits, how large a face is, what is closest, how a
//! curve lies on a surface.

pub mod area;
pub mod boundary;
pub mod bounds;
pub mod bounds_tree;
pub mod carrier;
pub mod closest;
pub mod fit;
pub mod lift;
pub mod line_roots;
pub mod locate;
pub mod offset;
mod plane_net;
pub mod project;
pub mod quadrature;
pub mod raycast;
mod row;
pub mod sheet;

pub use area::{Area, face_area, trimmed_area};
pub use boundary::Boundary;
pub use bounds::{face_bounds, trimmed_bounds};
pub use bounds_tree::BoundsTree;
pub use carrier::{Carrier, SplineCarrier};
pub use closest::{closer_on_surface, closest_on_curve, closest_on_surface};
pub use lift::{Lift, lift};
pub use locate::Locator;
pub use project::{Projection, project};
pub use raycast::{RayHit, RayHits, Raycaster};
pub use sheet::Sheet;
