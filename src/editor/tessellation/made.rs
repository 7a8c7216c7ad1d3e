//! A tessellation that is there: meshes, what is drawn of them, figures.

use std::sync::Arc;
use std::time::Duration;

use bevy::prelude::Entity;
use glam::DVec3;

use crate::editor::derive::Derived;
use crate::encoding::PackedMesh;
use crate::kernel::tessellate::TessellationOptions;
use crate::meshing::{Distance, MeshEdge, ModelMesh};

/// What a tessellation is made of.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Task {
    /// Revision of the scene: which faces there are.
    pub scene: u64,
    /// Counts changes of faces.
    pub edits: u64,
    /// Lengths in units of the first model.
    pub options: TessellationOptions,
}

impl Task {
    /// Whether only faces changed between the two.
    pub fn differs_by_edits(&self, other: &Self) -> bool {
        self.scene == other.scene && self.options == other.options
    }
}

/// The faces of a scene, in the order of the scene.
#[derive(Debug, Clone, Default)]
pub(super) struct Faces {
    pub entities: Vec<Entity>,
    /// What each was meshed from.
    pub derived: Vec<Option<Arc<Derived>>>,
}

/// How far each triangle of a face is off, and the face as a whole.
#[derive(Debug, Clone)]
pub(super) struct Measured {
    pub deviations: Vec<f64>,
    pub distance: Distance,
}

/// A tessellation.
#[derive(Debug, Clone)]
pub struct Made {
    pub(super) task: Task,
    pub(super) faces: Arc<Faces>,
    /// Millimetres of a unit.
    pub unit_mm: f64,
    /// Meshes in the order of the scene's faces.
    pub mesh: Arc<ModelMesh>,
    /// The same packed to be drawn, with levels of deviation once they are measured.
    pub(in crate::editor) packed: Vec<Option<Arc<PackedMesh>>>,
    /// Its edges.
    pub edges: Arc<Vec<MeshEdge>>,
    pub(super) measured: Vec<Option<Arc<Measured>>>,
    /// Its figures.
    pub figures: Figures,
}

/// Figures of a tessellation. Lengths in millimetres.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Figures {
    /// The tolerance.
    pub tolerance_mm: f64,
    /// Whether it is guaranteed.
    pub conservative: bool,
    /// Triangles.
    pub triangles: usize,
    /// Edges, shared ones once.
    pub edges: usize,
    /// Edges with a triangle on one side only.
    pub open_edges: usize,
    /// Triangles that could not be proved to keep the tolerance.
    pub over_tolerance: usize,
    /// Faces with a mesh.
    pub faces: usize,
    /// Faces without one, by position in the scene, and why.
    pub left_out: Vec<(usize, String)>,
    /// Faces whose triangles were made by the last run, not taken over.
    pub remade: usize,
    /// Time of meshing.
    pub mesh_time: Duration,
    /// Time of measuring, once that is done.
    pub measure_time: Option<Duration>,
    /// Where the measured distance is largest.
    pub largest: Option<Largest>,
}

/// The largest distance that was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest {
    /// Distance, millimetres.
    pub mm: f64,
    /// Where, model units.
    pub place: DVec3,
    /// Normal of the mesh near there.
    pub normal: DVec3,
    /// Position of the face in the scene.
    pub face: usize,
}

impl Made {
    /// The face at a position.
    pub fn face(&self, position: usize) -> Option<Entity> {
        self.faces.entities.get(position).copied()
    }

    /// All faces in order.
    pub fn faces(&self) -> &[Entity] {
        &self.faces.entities
    }

    /// How far lines on it may be from the exact surfaces, model units: what was measured, or the tolerance.
    pub fn reach(&self) -> f64 {
        self.figures.largest.map_or(self.task.options.tolerance, |l| l.mm / self.unit_mm)
    }
}
