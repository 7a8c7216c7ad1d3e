//! What a picture shall show: shared by the GPU renderer, the CPU renderer, the command line and the editor.

use super::view::{CAST_DEVIATION, CAST_HEAT, CAST_TRIM};
use crate::kernel::view::Camera;

/// What the colours of a picture mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DisplayMode {
    /// Lit surfaces in their own colours.
    #[default]
    Shaded,
    /// Each face in a colour of its own.
    Faces,
    /// Surface parameters as colours with iso-lines (Schollmeyer & Froehlich 2009, figure 10).
    Uv,
    /// Number of curve evaluations per pixel (figure 9): green kept, red trimmed away, darker is more;
    /// yellow kept and blue trimmed away without any evaluation.
    Heat,
    /// The untrimmed surfaces, lit.
    Untrimmed,
    /// The triangles of a tessellation by how far they are from the exact surface; rays show nothing of it.
    Deviation,
}

/// What is done about pin holes between faces that share an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Conceal {
    /// Nothing: the picture is what the model is.
    #[default]
    Raw,
    /// They are filled by fat lines along the edges.
    Concealed,
    /// The picture in grey, what fat lines fill in a colour.
    Difference,
}

/// Background colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Theme {
    /// Light gradient.
    #[default]
    Light,
    /// Dark gradient.
    Dark,
    /// Nothing: alpha 0 where there is no surface.
    Transparent,
}

/// How edges of faces and silhouettes are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeStyle {
    /// Whether they are drawn.
    pub visible: bool,
    /// Width in pixels.
    pub width_px: f32,
}

impl Default for EdgeStyle {
    fn default() -> Self {
        Self { visible: true, width_px: 1.2 }
    }
}

/// Everything that decides a picture of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RenderOptions {
    /// Camera.
    pub camera: Camera,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel, at least 1.
    pub samples: u32,
    /// What the colours mean.
    pub mode: DisplayMode,
    /// Edges.
    pub edges: EdgeStyle,
    /// Background.
    pub theme: Theme,
}

impl RenderOptions {
    /// A shaded picture with 8 samples per pixel.
    pub fn new(camera: Camera, size: [u32; 2]) -> Self {
        Self {
            camera,
            size,
            samples: 8,
            mode: DisplayMode::Shaded,
            edges: EdgeStyle::default(),
            theme: Theme::Light,
        }
    }
}

/// Shift of sample `index` within its pixel, in -0.5..0.5: the first is the centre, the others follow a
/// low-discrepancy sequence (R2 of Roberts 2018), so that any number of samples spreads evenly.
pub fn jitter(index: u32) -> [f32; 2] {
    if index == 0 {
        return [0.0, 0.0];
    }
    let along = |step: f64| ((0.5 + step * f64::from(index)).fract() - 0.5) as f32;
    [along(0.754_877_666_246_692_8), along(0.569_840_290_998_053_3)]
}

/// Flags of [`super::View`] that a mode casts with.
pub fn cast_flags(mode: DisplayMode) -> u32 {
    match mode {
        DisplayMode::Untrimmed => 0,
        DisplayMode::Heat => CAST_TRIM | CAST_HEAT,
        DisplayMode::Deviation => CAST_TRIM | CAST_HEAT | CAST_DEVIATION,
        DisplayMode::Shaded | DisplayMode::Faces | DisplayMode::Uv => CAST_TRIM,
    }
}

/// A picture of 8-bit sRGB with straight alpha, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// RGBA, 4 bytes per pixel.
    pub rgba: Vec<u8>,
}
