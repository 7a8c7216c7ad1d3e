//! Components of models, parts, faces and loops. Each is authored, derived or interaction.
//!
//! Authored components of faces and loops are immutable: they change by being inserted anew, and their hooks
//! note the face in [`Changes`](super::Changes). So an edit costs the same whatever else is open.

use std::path::PathBuf;
use std::sync::Arc;

use bevy::prelude::*;

use super::changes;
use crate::editor::derive::Derived;
use crate::exchange::report::ImportReport;
use crate::kernel::nurbs::NurbsSurface;
use crate::scene::FaceAttributes;
use crate::scene::records::{LengthUnit, LoopRecord, PartRecord};

/// Authored: one opened file or built-in scene; parent of its parts.
#[derive(Component, Debug, Clone)]
pub struct Model {
    /// Name to show.
    pub name: String,
    /// Where it was read from; none for built-in scenes.
    pub path: Option<PathBuf>,
    /// Unit of its lengths.
    pub unit: LengthUnit,
    /// The parts of the record; faces name theirs by position.
    pub parts: Vec<PartRecord>,
    /// What the import did.
    pub report: Arc<ImportReport>,
}

/// Authored: a named group of faces; parent of its faces.
#[derive(Component, Debug, Clone)]
pub struct Part {
    /// Name to show.
    pub name: String,
}

/// Authored: surface and attributes of a face, and which trim loops it has in which order.
#[derive(Component, Debug, Clone)]
#[component(immutable, on_insert = changes::face_inserted)]
pub struct AuthoredFace {
    /// The untrimmed surface; its parameters are the face's native (u, v).
    pub surface: Arc<NurbsSurface>,
    /// Name, colour and the like.
    pub attributes: Arc<FaceAttributes>,
    /// Entities with [`TrimLoop`], its children. None at all: the whole domain of the surface.
    pub loops: Vec<Entity>,
}

/// Authored: one trim loop of the face that is its parent.
#[derive(Component, Debug, Clone)]
#[component(immutable, on_insert = changes::loop_inserted, on_remove = changes::loop_removed)]
pub struct TrimLoop {
    /// The face it trims.
    pub face: Entity,
    /// The truth about the loop: pcurves in native (u, v).
    pub record: Arc<LoopRecord>,
}

/// Where a face stands among all faces; changes when faces before it are added or deleted.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq)]
pub struct FacePlace {
    /// Number in the order of the model, from 1.
    pub number: usize,
    /// The model that holds it.
    pub model: Entity,
}

/// Derived from [`AuthoredFace`] and its [`TrimLoop`]s: patches, trimming structure, area and bounds.
#[derive(Component, Debug, Clone)]
#[component(immutable, on_insert = changes::derived_inserted, on_remove = changes::derived_removed)]
pub struct DerivedFace(pub Arc<Derived>);

/// Interaction: whether the face is drawn.
#[derive(Component, Debug, Clone, Copy, PartialEq, Eq)]
#[component(immutable, on_insert = changes::shown_inserted)]
pub struct Shown(pub bool);
