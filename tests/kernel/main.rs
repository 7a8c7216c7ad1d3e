//! Identities and properties of the geometry kernel.

mod splines;
mod zoo;
