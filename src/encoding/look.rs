//! How a picture shall look, as the shading passes see it.

use bytemuck::{Pod, Zeroable};

use super::options::{DisplayMode, EdgeStyle, Theme};
use super::view::View;

/// Mirror of `Look` in `shaders/layout/look.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[expect(missing_docs, reason = "described in the shader's layout")]
pub struct Look {
    pub background_top: [f32; 4],
    pub background_bottom: [f32; 4],
    pub edge: [f32; 4],
    pub selected: [f32; 4],
    pub hovered: [f32; 4],
    pub slope_scale: [f32; 2],
    pub offset_scale: [f32; 2],
    pub jitter: [f32; 2],
    pub size: [f32; 2],
    pub depth: [f32; 4],
    pub mode: u32,
    pub edges: u32,
    pub samples: f32,
    pub edge_width: f32,
    pub pixel: [f32; 2],
    pub difference: u32,
    pub pad1: u32,
}

impl Look {
    /// `mode` of surfaces in their own colours.
    pub const SHADED: u32 = 0;

    /// The look of one sample seen by `view`.
    pub fn new(view: &View, mode: DisplayMode, edges: EdgeStyle, theme: Theme) -> Self {
        let (background_top, background_bottom, edge) = match theme {
            Theme::Light => ([0.72, 0.78, 0.86, 1.0], [0.93, 0.94, 0.96, 1.0], [0.015, 0.018, 0.025, 0.85]),
            Theme::Dark => ([0.020, 0.024, 0.032, 1.0], [0.060, 0.068, 0.082, 1.0], [0.0, 0.0, 0.0, 0.9]),
            Theme::Transparent => ([0.0; 4], [0.0; 4], [0.015, 0.018, 0.025, 0.85]),
        };
        Self {
            background_top,
            background_bottom,
            edge,
            selected: [0.95, 0.38, 0.03, 0.75],
            hovered: [0.25, 0.62, 0.98, 0.45],
            slope_scale: view.slope_scale,
            offset_scale: view.offset_scale,
            jitter: view.jitter,
            size: view.size,
            depth: view.depth,
            mode: match mode {
                DisplayMode::Shaded | DisplayMode::Untrimmed => Self::SHADED,
                DisplayMode::Faces => 1,
                DisplayMode::Uv => 2,
                DisplayMode::Heat => 3,
                DisplayMode::Deviation => 4,
            },
            edges: u32::from(edges.visible),
            samples: 1.0,
            edge_width: edges.width_px,
            pixel: view.pixel,
            difference: 0,
            pad1: 0,
        }
    }
}
