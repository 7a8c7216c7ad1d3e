//! WGSL against the CPU twins and the f64 kernel. Needs a Vulkan driver (a software one will do): without
//! one these tests fail, they do not pass quietly.

mod bands;
mod edits;
mod exact_edges;
#[path = "../models/folder.rs"]
mod folder;
mod holes;
mod modules;
mod oracle;
mod pictures;
mod tessellation;
mod triangles;
