//! Identities and properties of the geometry kernel.

mod areas;
mod raycast;
mod splines;
mod zoo;
