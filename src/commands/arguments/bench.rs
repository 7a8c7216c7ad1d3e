//! What `hairline bench` takes.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

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
