//! The `hairline` program: parses the command line and dispatches.

fn main() -> std::process::ExitCode {
    hairline::commands::run()
}
