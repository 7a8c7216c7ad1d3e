//! CPU twins of the shaders in `f32`, on the same packed arrays with the same names, and a renderer made
//! of them: the same picture on a machine without any graphics driver.

pub mod bins;
pub mod cast;
pub mod holes;
pub mod mesh;
pub mod pack;
pub mod patch_jet;
pub mod raster;
pub mod ray;
pub mod render;
pub mod resolve;
pub mod ribbon;
pub mod seeds;
pub mod shade;
pub mod solve;
pub mod visibility;

pub use render::{render_image, render_image_with};
