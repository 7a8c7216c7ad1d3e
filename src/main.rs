//! The `hairline` program: parses the command line and dispatches.

/// Meshing and import make many small short-lived vectors: with the system's allocator a tenth of
/// the time of meshing goes into it.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> std::process::ExitCode {
    hairline::commands::run()
}
