//! Identities and properties of the geometry kernel.

mod areas;
mod bounds;
mod closest;
mod editing;
mod edits;
mod gaps;
mod loops;
mod operations;
mod parity;
mod raycast;
mod runaway;
mod splines;
mod zoo;
