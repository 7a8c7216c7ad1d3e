//! The command line as data: every sub-command, flag, default and help text.
//!
//! Parsing is clap's; the small value types (`Size`, `View`, ...) check their own syntax so that a
//! wrong value is refused before any file is opened.

mod bench;
mod gaps;
mod model;
mod picture;
mod tessellate;

use std::path::PathBuf;

use clap::{Parser, Subcommand};

pub use bench::{BenchArguments, Table};
pub use gaps::{CheckArguments, MendArguments};
pub use model::{ClassifyArguments, ConvertArguments, EditArguments, InfoArguments};
pub use picture::{Backend, Holes, Mode, RenderArguments, Size, Surfaces, View};
pub use tessellate::{Angle, TessellateArguments};

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

    /// Not "unexpected argument '-1'", which does not tell what is wrong with the length.
    #[test]
    fn a_negative_length_is_refused_as_a_length() {
        for (flag, value) in [("--error", "-1mm"), ("--max-edge", "-0.5in"), ("--angle", "-3deg")] {
            let mut line = vec!["hairline", "tessellate", "a.igs", "-o", "a.glb", flag, value];
            if flag != "--error" {
                line.extend(["--error", "1mm"]);
            }
            let refusal = Arguments::try_parse_from(line).expect_err(value).to_string();
            assert!(refusal.contains(&format!("invalid value '{value}'")), "{refusal}");
        }
    }
}
