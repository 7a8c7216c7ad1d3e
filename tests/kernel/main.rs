//! Identities and properties of the geometry kernel.

mod raycast;
mod splines;
mod zoo;
