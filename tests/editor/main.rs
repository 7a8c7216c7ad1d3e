//! The editor: camera mathematics, the command table, a headless world, and the program in a real window.

mod camera;
mod commands;
mod document;
mod edit_commands;
mod editing;
mod input;
mod inspection;
mod mending;
#[cfg(target_os = "linux")]
mod recovery;
#[cfg(target_os = "linux")]
mod screen;
mod settings;
mod tessellation;
mod uv;
#[cfg(target_os = "linux")]
mod uv_window;
#[cfg(target_os = "linux")]
mod window;
mod world;
