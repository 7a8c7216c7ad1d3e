//! Components of models, parts, faces and loops. Each is authored, derived or interaction.

use std::path::PathBuf;
use std::sync::Arc;

use bevy::prelude::*;

use crate::editor::derive::Derived;
use crate::exchange::report::ImportReport;
use crate::scene::records::{FaceRecord, LengthUnit};

/// Authored: one opened file or built-in scene; parent of its parts.
#[derive(Component, Debug, Clone)]
pub struct Model {
    /// Name to show.
    pub name: String,
    /// Where it was read from; none for built-in scenes.
    pub path: Option<PathBuf>,
    /// Unit of its lengths.
    pub unit: LengthUnit,
    /// What the import did.
    pub report: Arc<ImportReport>,
}

/// Authored: a named group of faces; parent of its faces.
#[derive(Component, Debug, Clone)]
pub struct Part {
    /// Name to show.
    pub name: String,
}

/// Authored: the record of one trimmed surface.
#[derive(Component, Debug, Clone)]
pub struct AuthoredFace {
    /// The truth about the face.
    pub record: Arc<FaceRecord>,
    /// Number in file order, from 1.
    pub number: usize,
    /// The model that holds it.
    pub model: Entity,
}

/// Authored: one trim loop of the face that is its parent.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrimLoop {
    /// Position in the loops of the record.
    pub index: usize,
}

/// Derived from [`AuthoredFace`]: patches, trimming structure, area and bounds.
#[derive(Component, Debug, Clone)]
pub struct DerivedFace(pub Arc<Derived>);

/// Interaction: whether the face is drawn.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shown(pub bool);
