//! The program: parses the command line, runs one command, turns a failure into a message and an
//! exit code. Each command is one file, and each is a thin shell around a documented function of
//! the library.

pub mod arguments;
pub mod bench;
pub mod check;
pub mod classify;
pub mod convert;
pub mod edit;
pub mod failure;
pub mod info;
pub mod mend;
pub mod output;
pub mod progress;
pub mod render;
pub mod source;
pub mod tessellate;
pub mod window;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use failure::Failure;

/// Runs the program with the process's arguments; the exit code is that of `hairline --help`.
pub fn run() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version go to standard output, where a closed pipe is no failure.
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    quieten_drivers(&arguments);
    quieten_caught_panics();
    match dispatch(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if !matches!(failure, Failure::Closed | Failure::Found { .. }) {
                eprintln!("hairline: error: {failure}");
            }
            ExitCode::from(failure.exit_code())
        }
    }
}

/// Panics of the triangulation's crate are caught where it is called and become errors of the face, which are told.
fn quieten_caught_panics() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !info.location().is_some_and(|place| place.file().contains("/spade-")) {
            print(info);
        }
    }));
}

fn dispatch(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.command {
        None => window::run(&arguments.files, arguments.demo),
        Some(Command::Render(arguments)) => render::run(arguments),
        Some(Command::Info(arguments)) => info::run(arguments),
        Some(Command::Classify(arguments)) => classify::run(arguments),
        Some(Command::Convert(arguments)) => convert::run(arguments),
        Some(Command::Edit(arguments)) => edit::run(arguments),
        Some(Command::Check(arguments)) => check::run(arguments),
        Some(Command::Mend(arguments)) => mend::run(arguments),
        Some(Command::Tessellate(arguments)) => tessellate::run(arguments),
        Some(Command::Bench(arguments)) => bench::run(arguments),
    }
}

/// Mesa's device-selection layer looks for a Wayland display and complains on standard error where
/// there is no session (containers, root shells), although nothing is wrong. Starts the program
/// again in place with that layer off; going on as before is fine too.
#[cfg(all(feature = "gpu", target_os = "linux"))]
fn quieten_drivers(arguments: &Arguments) {
    use std::os::unix::process::CommandExt;

    const LAYER_OFF: &str = "NODEVICE_SELECT";
    let draws =
        !matches!(arguments.command, Some(Command::Info(_) | Command::Classify(_) | Command::Convert(_)));
    let complains = std::env::var_os("XDG_RUNTIME_DIR").is_none() && std::env::var_os(LAYER_OFF).is_none();
    if draws
        && complains
        && let Ok(program) = std::env::current_exe()
    {
        // Returns only when it fails, and then the complaint is harmless.
        let _ =
            std::process::Command::new(program).args(std::env::args_os().skip(1)).env(LAYER_OFF, "1").exec();
    }
}

#[cfg(not(all(feature = "gpu", target_os = "linux")))]
fn quieten_drivers(_arguments: &Arguments) {}
