//! What the sub-commands take that look for gaps and close them.

use std::path::PathBuf;

use clap::Args;

use crate::inspect::Length;

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
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, default_value = "10um")]
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
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, default_value = "1um")]
    pub tolerance: Length,
    /// File to write.
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
}
