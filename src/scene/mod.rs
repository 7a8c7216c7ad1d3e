//! What a model is, as plain serde records: the one form that load, save, undo, copy and import share.

pub mod demo;
pub mod records;
