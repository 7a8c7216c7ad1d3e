//! What is wrong with trim loops, found while they are edited.
//!
//! Wiring: after `Derive`, faces that changed are checked: at once when they are few and small, so that marks
//! follow a drag, else on a thread. What is found is the component [`FaceProblems`] of the face, which the uv panel draws,
//! and a line of [`ProblemList`], which the panel shows.

mod check;

use std::collections::BTreeMap;
use std::sync::Arc;

use bevy::prelude::*;

use super::EditorSystems;
use crate::kernel::trim::validity::LoopProblem;

/// Derived: what is wrong with the loops of a face, by loop and curve. Faces without problems have none.
#[derive(Component, Debug, Clone, PartialEq)]
pub struct FaceProblems(pub Arc<[LoopProblem]>);

/// All faces with problems.
#[derive(Resource, Debug, Default)]
pub struct ProblemList {
    faces: BTreeMap<Entity, Found>,
    /// Counts changes.
    pub revision: u64,
}

/// What is wrong with one face.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Its loops.
    pub loops: Arc<[LoopProblem]>,
    /// Why it cannot be drawn at all.
    pub failure: Option<String>,
}

impl ProblemList {
    /// Faces with problems.
    pub fn faces(&self) -> impl Iterator<Item = (Entity, &Found)> {
        self.faces.iter().map(|(face, found)| (*face, found))
    }

    /// Number of problems.
    pub fn count(&self) -> usize {
        self.faces.values().map(|f| f.loops.len() + usize::from(f.failure.is_some())).sum()
    }

    /// Number of those that are drawn wrong or may be.
    pub fn serious_count(&self) -> usize {
        let of =
            |f: &Found| f.loops.iter().filter(|p| p.is_serious()).count() + usize::from(f.failure.is_some());
        self.faces.values().map(of).sum()
    }

    fn set(&mut self, face: Entity, found: Option<Found>) {
        let before = match &found {
            Some(found) => self.faces.insert(face, found.clone()),
            None => self.faces.remove(&face),
        };
        self.revision += u64::from(before != found);
    }
}

/// Adds the search for problems.
pub struct ProblemsPlugin;

impl Plugin for ProblemsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ProblemList>().init_resource::<check::Checker>().add_systems(
            Update,
            (check::start, check::finish).chain().after(EditorSystems::Derive).before(EditorSystems::Present),
        );
    }
}
