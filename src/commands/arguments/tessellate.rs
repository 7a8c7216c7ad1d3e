//! What `hairline tessellate` takes.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use crate::inspect::Length;

/// `hairline tessellate`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  hairline tessellate part.igs --error 0.1mm -o part.glb
  hairline tessellate part.igs --error 10um --angle 15deg --max-edge 5mm -o part.stl
  hairline tessellate part.igs --error 0.1mm -o part.ply --json | jq .triangles

The error is the largest distance between mesh and surface, both ways, kept by bounds; with --approximate
it is estimated at points, for less time and a few triangles fewer. Vertices may lie off the surface within the
error, so that triangles pass through it and are fewer; --on-surface keeps them on it. The true error is measured at samples and
told, with the rest of the figures. Faces with triangles that the bounds cannot prove are named with the error
measured; so is a face that comes out without triangles. Faces that share edges share their vertices. OBJ
files come with a .mtl file.")]
pub struct TessellateArguments {
    /// Model to tessellate, or `demo`.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Largest distance between mesh and surface, with a unit: 0.1mm, 10um (a number alone is in millimetres).
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub error: Length,
    /// Largest angle between the normals of a triangle's corners, and between chords of an edge: 15deg.
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true)]
    pub angle: Option<Angle>,
    /// Longest edge of a triangle.
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub max_edge: Option<Length>,
    /// Estimate the error instead of guaranteeing it.
    #[arg(long)]
    pub approximate: bool,
    /// Keep all vertices on the surfaces: takes more triangles.
    #[arg(long)]
    pub on_surface: bool,
    /// Ask before making more triangles than this; stop where there is no terminal to ask at.
    #[arg(long, value_name = "N", default_value_t = 1_000_000)]
    pub limit: usize,
    /// Go on beyond the limit without asking.
    #[arg(short, long)]
    pub yes: bool,
    /// File to write: .glb, .stl, .obj or .ply.
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Print the figures as one JSON object.
    #[arg(long)]
    pub json: bool,
}

/// An angle in radians, written in degrees or with a unit (`15deg`, `0.2rad`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Angle(pub f64);

impl FromStr for Angle {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (number, factor) = match (text.strip_suffix("rad"), text.strip_suffix("deg")) {
            (Some(number), _) => (number, 1.0),
            (None, Some(number)) => (number, 1f64.to_radians()),
            (None, None) => (text, 1f64.to_radians()),
        };
        let radians = number.trim().parse::<f64>().map(|x| x * factor);
        match radians {
            Ok(x) if (1e-4..=std::f64::consts::PI).contains(&x) => Ok(Self(x)),
            _ => Err("expected an angle above 0 and up to 180 degrees, such as 15deg".into()),
        }
    }
}
