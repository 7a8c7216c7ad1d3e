//! The WGSL renderer on plain `wgpu`: used by the command line on a device of its own and by the editor
//! inside Bevy's render world. Knows nothing of Bevy.
//!
//! A picture takes three steps. **Cast** draws the boxes of the cells and casts a ray per pixel into a
//! visibility buffer (face, u, v, normal) with depth. **Shade** turns that into colours and adds them to
//! a sum, once per sample. **Present** divides the sum and puts it, with depth, into any target.
//! Hovering, selection, modes and edges change only the last two.

mod attachments;
pub mod buffers;
mod casting;
pub mod context;
mod mesh;
pub mod picture;
pub mod pipelines;
pub mod renderer;
mod ribbons;
pub mod shaders;
pub mod targets;
mod tessellation;
mod wipe;

pub use buffers::Uploaded;
pub use context::Context;
pub use picture::{render_image, render_image_with};
pub use renderer::{Renderer, Sample};

/// Why the GPU cannot draw.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GpuError {
    /// No usable driver.
    #[error(
        "no Vulkan driver could be opened ({reason}); install one (on Debian: mesa-vulkan-drivers) or use the CPU renderer"
    )]
    NoDriver {
        /// What the loader says.
        reason: String,
    },
    /// An array does not fit.
    #[error("the scene's {what} take {} MB at once; this device takes {}", bytes.div_ceil(1_000_000), limit / 1_000_000)]
    TooLarge {
        /// Which array.
        what: &'static str,
        /// Bytes needed.
        bytes: u64,
        /// Bytes the device can bind.
        limit: u64,
    },
    /// A picture does not fit.
    #[error("a picture of {width} x {height} is larger than this device draws ({limit} pixels each way)")]
    PictureTooLarge {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
        /// Largest width or height.
        limit: u32,
    },
    /// The device stopped working.
    #[error("the graphics device was lost: {reason}")]
    Lost {
        /// What the driver says.
        reason: String,
    },
}
