//! The `f32` layout of what the GPU sees: cells, control points, trims, faces, cameras. No GPU in here.

pub mod arena;
pub mod cell;
pub mod coverage;
pub mod face;
pub mod level;
pub mod look;
pub mod mesh;
pub mod options;
pub mod order;
pub mod scene;
pub mod subdivision;
pub mod tiling;
pub mod view;

pub use face::FaceHeader;
pub use look::Look;
pub use mesh::{MeshOrigin, MeshScene, MeshShape, MeshVertex};
pub use options::{DisplayMode, EdgeStyle, Image, RenderOptions, Theme};
pub use scene::{FaceShape, FaceSlot, PackedScene};
pub use view::{DepthRange, View};
