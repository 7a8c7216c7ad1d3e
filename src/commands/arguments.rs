//! The command line as data: every sub-command, flag, default and help text.
//!
//! Parsing is clap's; the small value types (`Size`, `View`, ...) check their own syntax so that a
//! wrong value is refused before any file is opened.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::exchange::iges::unit::Unit;
use crate::inspect::Length;
use crate::kernel::view::StandardView;

const EXAMPLES: &str = "\
Examples:
  hairline                              open the editor on the built-in demo scene
  hairline part.igs bracket.iges        open the editor on two files
  hairline render part.igs -o part.png --view top --samples 16
  hairline info part.igs --json | jq '.faces[0]'
  hairline check part.igs --tolerance 10um --html gaps.html
  printf '1 0.5 0.5\\n' | hairline classify part.igs
  hairline edit part.igs --script edits.json -o part.hairline
  hairline convert part.igs part-in-inches.igs --unit in
  hairline tessellate part.igs --error 0.1mm -o part.glb
  hairline bench classify

FILE may be the word `demo` for the built-in scene (`./demo` for a file of that name), or `demo:N` for a
quilt of N panels to measure with (demo:50000).

Exit codes:
  0  done (a reader that closes the pipe early, `| head`, is no error)
  1  the result could not be written or worked out; `check`: a gap exceeds the tolerance
  2  wrong usage or bad input: unknown flag, missing or broken file, bad line
  3  the machine or the build lacks something: no display, no graphics driver, no editor";

/// What the user typed.
#[derive(Debug, Parser)]
#[command(
    name = "hairline",
    version,
    about = "Exact viewer and inspector for trimmed NURBS: every pixel is a ray cast, no triangles",
    long_about = "Hairline opens CAD exchange files (IGES) and draws their trimmed NURBS surfaces exactly: every \
                  pixel is a ray cast against the rational surface and classified against the rational trim \
                  curves. Without a sub-command it opens the editor.",
    after_help = EXAMPLES,
    args_conflicts_with_subcommands = true
)]
pub struct Arguments {
    /// What to do instead of opening the editor.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Files to open in the editor; none: the built-in demo scene.
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Open the built-in demo scene.
    #[arg(long)]
    pub demo: bool,
}

/// The headless sub-commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw a model into a PNG file.
    Render(RenderArguments),
    /// Tell what is in a model: counts, degrees, areas, memory, import report.
    Info(InfoArguments),
    /// Classify points `face u v` from standard input against the trims: in, out or on.
    Classify(ClassifyArguments),
    /// Write a model in another format, with its trims, names, colours, levels and parts.
    Convert(ConvertArguments),
    /// Apply a script of edits to a model or scene.
    Edit(EditArguments),
    /// Look for gaps between faces; the exit code tells whether any exceeds the tolerance.
    Check(CheckArguments),
    /// Close the gaps that moving trim curves can close, and write the model.
    Mend(MendArguments),
    /// Turn a model into triangles within an error, measured and told: glTF, STL, OBJ or PLY.
    Tessellate(TessellateArguments),
    /// Measure speed and print tables.
    Bench(BenchArguments),
}

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
    #[arg(long, value_name = "LENGTH")]
    pub error: Length,
    /// Largest angle between the normals of a triangle's corners, and between chords of an edge: 15deg.
    #[arg(long, value_name = "ANGLE")]
    pub angle: Option<Angle>,
    /// Longest edge of a triangle.
    #[arg(long, value_name = "LENGTH")]
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

/// `hairline info`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  hairline info part.igs
  hairline info part.igs --json | jq '[.faces[].area] | add'

Lengths and areas are in the units of the file, which are named. Faces are numbered from 1 in file
order. JSON fields of each of faces[]: index, source, degree_u, degree_v, loops, curves, area,
bbox [xmin ymin zmin xmax ymax zmax], uv_box [umin vmin umax vmax].")]
pub struct InfoArguments {
    /// Model to describe, or `demo`.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Print everything as one JSON object.
    #[arg(long)]
    pub json: bool,
}

/// `hairline classify`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  printf '1 0.5 0.5\\n2 10 -3.25\\n' | hairline classify part.igs
  hairline classify part.igs < points.txt > answers.txt

Each input line is `face u v`: the number of a face (from 1) and native surface parameters, parted
by blanks, tabs or commas. Each gives one line in the same order: `in`, `out`, or `on` for a point
on a trim curve (within 1e-7 of the size of the face's parameter box, the precision of trimming). Empty lines and lines that
start with # are passed over without an answer. The first bad line (not three numbers, no such
face) stops the run with its line number and exit code 2; answers before it have been printed.")]
pub struct ClassifyArguments {
    /// Model to classify against, or `demo`.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
}

/// `hairline convert`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  hairline convert part.igs mended.igs
  hairline convert part.igs inches.iges --unit in
  hairline convert demo demo.igs

The extension of OUT says what to write: .igs and .iges are IGES 5.3 (faces as 128 and 144, boundaries
as 142 with curves in parameters and in space, names, colours, levels, parts as groups). In
millimetres every number of surfaces and trim curves reads back bit for bit. OUT is written whole or not
at all, and must not be IN. Entities of IN that cannot be read are left out, which standard error says.")]
pub struct ConvertArguments {
    /// Model to read, or `demo`.
    #[arg(value_name = "IN")]
    pub input: PathBuf,
    /// File to write.
    #[arg(value_name = "OUT")]
    pub output: PathBuf,
    /// Unit of lengths in an IGES file: mm, cm, m, km, um, in, ft, mi, mil or uin.
    #[arg(long, value_name = "UNIT", default_value = "mm")]
    pub unit: Unit,
}

/// `hairline edit`.
#[derive(Debug, Clone, Args)]
#[command(after_help = r#"Examples:
  hairline edit part.igs --script edits.json -o part.hairline
  hairline edit part.hairline --script edits.json -o part.igs
  echo '[{"op": "untrim", "face": 1}]' | hairline edit part.igs --script - --dry-run

A script is a JSON array of steps, done in order: objects with the field `op` and the fields of that
operation. Faces, loops, curves and control points are numbered from 1, faces as in `hairline info`
(or [model, face] in scenes of several models). A few of the operations:
  {"op": "move_points", "face": 1, "points": [{"loop": 1, "curve": 2, "point": 1}], "by": [0.1, 0]}
  {"op": "set_weight", "face": 1, "points": [{"loop": 1, "curve": 2, "point": 2}], "weight": 0.5}
  {"op": "split_curve", "face": 1, "curve": {"loop": 1, "curve": 2}, "at": 0.5}
  {"op": "add_loop", "face": 1, "role": "inner", "shape": {"circle": {"centre": [0, 0], "radius": 2}}}
  {"op": "delete_loops", "face": 1, "loops": [2, 3]}
All of them, each with an example: docs/edit-script.md. They are the ones of the editor.

Prints a line for each step, then what is wrong with the loops of the faces touched; with --json, JSON
lines. A step that cannot be done stops the run with its number and exit code 2; nothing is written
then."#)]
pub struct EditArguments {
    /// Model or scene to change, or `demo`.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// File with the steps; `-` for standard input.
    #[arg(long, value_name = "JSON")]
    pub script: PathBuf,
    /// File to write; the extension says what: .hairline (scene), .igs or .iges (IGES). May be FILE itself.
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Write nothing; only tell what would change.
    #[arg(long)]
    pub dry_run: bool,
    /// Tell what changed as JSON lines.
    #[arg(long)]
    pub json: bool,
}

/// `hairline check`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  hairline check part.igs
  hairline check part.igs --tolerance 1um --html part.html
  hairline check *.igs --tolerance 0.01mm --json gaps.jsonl
  hairline check part.igs --json - | jq '.findings[] | select(.exceeds)'

Every part of every trim curve is paired with those that run beside it, whatever their parametrisation,
direction and splits; gaps are distances between the exact curves in space, with a bound on the error.
No triangles are made. One file gives a summary on standard output, several give one line of JSON each,
in the order given. The JSON is described in docs/check-schema.md.

A model fails when a gap exceeds the tolerance; naked edges (borders of one face only) are counted and
listed, but fail a model only with --naked. Lengths take a unit: nm, um, mm, cm, m, in, mil; mm without.

Exit codes:
  0  nothing exceeds the tolerance
  1  something does
  2  a file could not be read or holds no faces, wrong usage, or a report could not be written")]
pub struct CheckArguments {
    /// Models to check; `demo` for the built-in one.
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// The largest gap that passes.
    #[arg(long, value_name = "LENGTH", default_value = "10um")]
    pub tolerance: Length,
    /// Naked edges fail a model too.
    #[arg(long)]
    pub naked: bool,
    /// Write the findings as JSON, one line for each file; `-` for standard output.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write one self-contained page with pictures of the worst gaps.
    #[arg(long, value_name = "FILE")]
    pub html: Option<PathBuf>,
    /// Write the pictures as PNG files too; without a folder into MODEL-gaps.
    #[arg(long, value_name = "FOLDER", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    pub pictures: Option<PathBuf>,
}

/// `hairline mend`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  hairline mend part.igs --tolerance 1um -o mended.igs
  hairline check mended.igs --tolerance 1um

One side's trim curve is fitted anew so that its image meets the other side's curve; surfaces stay as they
are. Gaps between surfaces that do not meet stay open and are listed with the distance left; so do those
whose closing would open another. The output is written whatever is left, as IGES or scene file by its name.

Exit codes:
  0  every gap is closed to the tolerance
  1  some stay open, or the output could not be written
  2  wrong usage or bad input")]
pub struct MendArguments {
    /// Model to mend, or `demo`.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The largest gap that may stay.
    #[arg(long, value_name = "LENGTH", default_value = "1um")]
    pub tolerance: Length,
    /// File to write.
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
}

/// `hairline bench`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  hairline bench
  hairline bench classify
  hairline bench tessellate part.igs --samples 1000000
  hairline bench raycast part.igs

Times are of this machine and this moment; compare the ratios, which are taken in one run.")]
pub struct BenchArguments {
    /// Which table; none: all of them.
    #[arg(value_enum, value_name = "TABLE")]
    pub table: Option<Table>,
    /// Models to measure as well (or instead of the demo scene); `demo` for the built-in one.
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Points at which `tessellate` measures each model's mesh, about.
    #[arg(long, value_name = "N", default_value_t = 200_000)]
    pub samples: usize,
}

/// The tables of `hairline bench`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Table {
    /// Point classification: ns per point for each structure and for its rivals.
    Classify,
    /// Building the trimming structures: time and bytes per segment.
    Build,
    /// Editing: time and bytes from one moved control point to the ranges sent to a GPU.
    Edit,
    /// 100,000 random edits, undos and redos, checked against everything made from scratch.
    Walk,
    /// Ray casting: time per frame and per fragment, and what each pixel takes.
    Raycast,
    /// Ray casting against the f64 oracle: missed hits.
    Misses,
    /// Saving and loading scene files of up to 50,000 faces: time and size.
    Scene,
    /// Pairing trim curves and measuring gaps: time for a whole model and after an edit.
    Gaps,
    /// Tessellation: kd-tree against quadtree, errors of trim curves, shared evaluation, meshes measured.
    Tessellate,
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
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn files_open_the_editor_and_sub_commands_do_not_take_them() {
        let plain = Arguments::try_parse_from(["hairline", "a.igs", "b.igs"]).expect("two files");
        assert_eq!(plain.files.len(), 2);
        assert!(plain.command.is_none());
        assert!(
            Arguments::try_parse_from(["hairline", "a.igs", "render", "b.igs"])
                .is_ok_and(|a| a.command.is_none())
        );
        assert!(Arguments::try_parse_from(["hairline", "render", "b.igs"]).is_err(), "-o is needed");
    }

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
