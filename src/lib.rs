//! Hairline draws trimmed NURBS surfaces exactly: every pixel is a ray cast against the rational
//! surface and classified against the rational trim curves. No triangles stand in between.
//!
//! The library is layered and dependencies point one way:
//! `kernel` <- `scene` <- `inspect`; `kernel` <- `encoding` <- `reference` <- `gpu`; `kernel` <- `scene` <- `exchange`; `commands`
//! sees all of these; `editor` sees everything and nothing sees `editor`.

pub mod commands;
#[cfg(feature = "editor")]
pub mod editor;
pub mod encoding;
pub mod exchange;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod inspect;
pub mod kernel;
pub mod meshing;
pub mod reference;
pub mod scene;
