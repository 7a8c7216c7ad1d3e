//! Where a model is broken: edges by pairing trim curves of faces, and the exact gap along each.
//!
//! A trim curve is inspected as the exact curve in space that its surface makes of it; no triangles anywhere.
//! [`Inspection::of`] finds for every part of every trim curve the others that run beside it (by the model's
//! own edges where its file tells them, else by geometry), and measures how far apart they are.

mod arrange;
mod curve_index;
mod edge;
mod face_curves;
pub mod gap;
pub mod ground;
mod inspection;
pub mod lifted;
pub mod measure;
pub mod mend;
pub mod nearest;
mod overlap;
pub mod pinholes;
pub mod quantity;
pub mod report;
pub mod ribbons;
mod scale;
pub mod statistics;
mod whole;

pub use edge::{CurveAddress, Edge, EdgeKey, EdgeKind, EdgeUse, edge_name};
pub use face_curves::lift;
pub use gap::{Gap, GapEnd, GapSense};
pub use inspection::Inspection;
pub use lifted::LiftedCurve;
pub use pinholes::{EdgePairs, FINEST_PIXEL, HoleClass, HoleScene, PinHole, pin_holes};
pub use quantity::Length;
pub use ribbons::ribbons;
pub use scale::Scale;
pub use statistics::Statistics;
