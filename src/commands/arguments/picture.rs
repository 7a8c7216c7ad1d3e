//! What `hairline render` takes: the kinds of picture, who draws them, their size and viewpoint.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum};

use crate::kernel::view::StandardView;

/// `hairline render`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  hairline render part.igs -o part.png
  hairline render part.igs -o top.png --size 1920x1080 --view top --mode faces --samples 16
  hairline render part.igs -o hole.png --view fit:17 --mode uv --backend cpu
  hairline render demo -o demo.png
  hairline render big.igs -o quick.png --renderer mesh
  hairline render part.igs -o holes.png --view fit:17 --conceal difference

The picture is written whole or not at all. Without --backend the graphics driver (Vulkan) draws
if there is one, else the processor does; both give the same picture.")]
pub struct RenderArguments {
    /// Model to draw, or `demo`.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// PNG file to write.
    #[arg(short, long, value_name = "PNG")]
    pub output: PathBuf,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x768")]
    pub size: Size,
    /// Where to look from: iso, front, back, left, right, top, bottom, or fit:FACE to face one face
    /// (numbered from 1).
    #[arg(long, value_name = "VIEW", default_value = "iso")]
    pub view: View,
    /// What the colours show.
    #[arg(long, value_enum, default_value_t = Mode::Shaded)]
    pub mode: Mode,
    /// Samples per pixel.
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=256))]
    pub samples: u32,
    /// Who draws; without it the graphics driver if there is one, else the processor.
    #[arg(long, value_enum)]
    pub backend: Option<Backend>,
    /// How surfaces are drawn: rays at the exact surfaces, or triangles wrong by at most half a pixel.
    #[arg(long, value_enum, default_value_t = Surfaces::Cast)]
    pub renderer: Surfaces,
    /// Pin holes between faces that share an edge: left as they are, filled by fat lines along the edges,
    /// or shown by what fat lines would fill.
    #[arg(long, value_enum, default_value_t = Holes::Raw)]
    pub conceal: Holes,
}

/// What the colours of a picture show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Mode {
    /// Lit surfaces in their own colours.
    Shaded,
    /// A colour for each face.
    Faces,
    /// The surface parameters.
    Uv,
    /// Number of curve evaluations per sample.
    Heat,
    /// Lit surfaces with their trims ignored.
    Untrimmed,
}

/// What is done about pin holes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Holes {
    /// The picture is what the model is.
    Raw,
    /// Fat lines fill them.
    Concealed,
    /// What fat lines fill, in red on grey.
    Difference,
}

/// How surfaces become pixels; trims are exact either way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Surfaces {
    /// A ray per pixel, cast at the exact surface.
    Cast,
    /// Triangles of the untrimmed surface, trimmed per pixel: quick on weak machines.
    Mesh,
}

/// Who draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// The graphics driver, by Vulkan.
    Gpu,
    /// The processor.
    Cpu,
}

/// Where to look from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// The whole model from a standard direction.
    Standard(StandardView),
    /// One face, seen along its normal; numbered from 1.
    Fit(usize),
}

impl FromStr for View {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(face) = text.strip_prefix("fit:") {
            return match face.parse() {
                Ok(number) if number > 0 => Ok(Self::Fit(number)),
                _ => Err(format!("`{face}` is not a face number (1, 2, ...)")),
            };
        }
        Ok(Self::Standard(match text {
            "iso" => StandardView::Iso,
            "front" => StandardView::Front,
            "back" => StandardView::Back,
            "left" => StandardView::Left,
            "right" => StandardView::Right,
            "top" => StandardView::Top,
            "bottom" => StandardView::Bottom,
            _ => return Err("expected iso, front, back, left, right, top, bottom or fit:FACE".into()),
        }))
    }
}

/// Size of a picture in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Size {
    /// Longest side: the limit of common graphics drivers.
    pub const LIMIT: u32 = 16_384;
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |s: &str| s.parse::<u32>().ok().filter(|n| (1..=Self::LIMIT).contains(n));
        text.split_once(['x', 'X'])
            .and_then(|(w, h)| Some(Self { width: side(w)?, height: side(h)? }))
            .ok_or_else(|| format!("expected WIDTHxHEIGHT, both from 1 to {}, such as 1024x768", Self::LIMIT))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_views_refuse_nonsense() {
        assert_eq!("640x480".parse(), Ok(Size { width: 640, height: 480 }));
        for bad in ["", "640", "0x5", "5x0", "-1x5", "99999x1", "axb", "1x2x3"] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
        assert_eq!("fit:12".parse(), Ok(View::Fit(12)));
        for bad in ["fit:", "fit:0", "fit:-1", "fit:x", "Top", ""] {
            assert!(bad.parse::<View>().is_err(), "{bad}");
        }
    }
}
