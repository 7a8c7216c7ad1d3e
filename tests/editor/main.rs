//! The editor without a window: camera mathematics, the command table, and a headless world.

mod camera;
mod commands;
mod settings;
mod world;
