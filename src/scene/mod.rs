//! What a model is, as plain serde records: the one form that load, save, undo, copy and import share;
//! and what can be done to it: [`operation`] says what a user asks for, [`edit`] what that changes,
//! [`history`] takes it back.

pub mod demo;
pub mod document;
pub mod edit;
pub mod file;
pub mod history;
pub mod number;
pub mod operation;
pub mod records;
pub mod settings;

pub use document::{Document, FaceAttributes, FaceView, SceneRecord};
pub use edit::{Change, Edit, EditError, FaceId};
pub use history::History;
