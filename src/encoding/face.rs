//! What shading and trimming know of a face.

use bytemuck::{Pod, Zeroable};

use crate::kernel::trim::grid::GridHeader;

/// Mirror of `FaceHeader` in `shaders/layout/face.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FaceHeader {
    /// Linear RGB.
    pub colour: [f32; 3],
    /// Bits of [`FaceHeader::VISIBLE`] and so on.
    pub flags: u32,
    /// Position of the face in the scene, from 0.
    pub number: u32,
    /// Zero.
    pub pad: [u32; 3],
    /// Trim grid, its bases counting from the start of the scene's arrays.
    pub grid: GridHeader,
}

impl FaceHeader {
    /// Drawn at all.
    pub const VISIBLE: u32 = 1;
    /// Selected by the user.
    pub const SELECTED: u32 = 2;
    /// Under the pointer.
    pub const HOVERED: u32 = 4;
    /// The outside is opposite to `du x dv`.
    pub const REVERSED: u32 = 8;
    /// Has a trim grid that does not keep everything.
    pub const TRIMMED: u32 = 16;
}
