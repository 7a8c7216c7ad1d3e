//! What the sub-commands take that read a model and ask, convert or edit it.

use std::path::PathBuf;

use clap::Args;

use crate::exchange::iges::unit::Unit;

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
