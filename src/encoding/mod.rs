//! The `f32` layout of what the GPU sees: cells, control points, trims, faces, cameras. No GPU in here.

pub mod arena;
pub mod bisection;
pub mod cell;
pub mod coverage;
pub mod extras;
pub mod face;
pub mod level;
pub mod lone_curve;
pub mod look;
pub mod mesh;
mod mesh_choice;
pub mod options;
pub mod order;
pub mod piece;
pub mod piece_mesh;
pub mod ribbon;
pub mod scene;
pub mod seam;
pub mod subdivision;
pub mod tessellation;
pub mod tiling;
pub mod view;

pub use extras::{Extras, MeshChoice, RibbonChoice};
pub use face::FaceHeader;
pub use level::LevelView;
pub use look::Look;
pub use mesh::{MeshOrigin, MeshScene, MeshVertex};
pub use options::{Conceal, DisplayMode, EdgeStyle, Image, RenderOptions, Theme};
pub use ribbon::{RibbonPiece, RibbonScene, RibbonShape, RibbonSpan};
pub use scene::{FaceShape, FaceSlot, PackedScene};
pub use tessellation::{PackedMesh, TessellationPart, TessellationScene};
pub use view::{DepthRange, View};
