//! The selected faces, in the order they were picked.

use std::collections::HashSet;

use bevy::prelude::*;

use crate::editor::object::{AuthoredFace, Scene, Shown};
use crate::editor::tools::{Action, CommandRequest};

/// The selection and the face under the pointer.
#[derive(Resource, Debug, Default)]
pub struct Selection {
    order: Vec<Entity>,
    set: HashSet<Entity>,
    /// The face under the pointer, in the viewport or in the tree.
    pub hovered: Option<Entity>,
    /// Counts changes of the selected set.
    pub revision: u64,
}

/// How a request changes the selection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SelectMode {
    /// Select these and nothing else.
    Replace,
    /// Select these too.
    Add,
    /// Select those of these that are not selected, drop those that are.
    Toggle,
}

/// Asks for a change of the selection.
#[derive(Message, Debug, Clone, PartialEq, Eq)]
pub struct SelectRequest {
    /// Faces meant; none with [`SelectMode::Replace`] clears.
    pub faces: Vec<Entity>,
    /// What to do with them.
    pub mode: SelectMode,
}

impl Selection {
    /// Whether `face` is selected.
    pub fn contains(&self, face: Entity) -> bool {
        self.set.contains(&face)
    }

    /// The selected faces in the order they were picked.
    pub fn faces(&self) -> &[Entity] {
        &self.order
    }

    /// Whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Applies one request; counts it only if something changed.
    pub fn apply(&mut self, request: &SelectRequest) {
        let before = self.order.clone();
        match request.mode {
            SelectMode::Replace => {
                self.order.clear();
                self.set.clear();
                self.extend(&request.faces);
            }
            SelectMode::Add => self.extend(&request.faces),
            SelectMode::Toggle => {
                let (old, new): (Vec<_>, Vec<_>) = request.faces.iter().partition(|f| self.set.contains(f));
                let drop: HashSet<Entity> = old.into_iter().collect();
                self.order.retain(|f| !drop.contains(f));
                self.set.retain(|f| !drop.contains(f));
                self.extend(&new);
            }
        }
        if self.order != before {
            self.revision += 1;
        }
    }

    fn extend(&mut self, faces: &[Entity]) {
        for face in faces {
            if self.set.insert(*face) {
                self.order.push(*face);
            }
        }
    }
}

/// Select all, invert and clear from the command table.
pub(super) fn command_requests(
    mut commands: MessageReader<CommandRequest>,
    scene: Res<Scene>,
    selection: Res<Selection>,
    shown: Query<&Shown>,
    mut requests: MessageWriter<SelectRequest>,
) {
    for CommandRequest(action) in commands.read() {
        let visible = || scene.faces().filter(|f| shown.get(*f).is_ok_and(|s| s.0));
        let faces: Vec<Entity> = match action {
            Action::SelectAll => visible().collect(),
            Action::InvertSelection => visible().filter(|f| !selection.contains(*f)).collect(),
            Action::ClearSelection => Vec::new(),
            _ => continue,
        };
        requests.write(SelectRequest { faces, mode: SelectMode::Replace });
    }
}

/// Faces that are gone are not selected.
pub(super) fn drop_despawned(mut removed: RemovedComponents<AuthoredFace>, mut selection: ResMut<Selection>) {
    let gone: HashSet<Entity> = removed.read().collect();
    if gone.is_empty() {
        return;
    }
    if selection.hovered.is_some_and(|h| gone.contains(&h)) {
        selection.hovered = None;
    }
    if selection.order.iter().any(|f| gone.contains(f)) {
        selection.order.retain(|f| !gone.contains(f));
        selection.set.retain(|f| !gone.contains(f));
        selection.revision += 1;
    }
}

/// Applies requests in order. Entities that are no faces (any more) are ignored.
pub(super) fn apply(
    mut requests: MessageReader<SelectRequest>,
    mut selection: ResMut<Selection>,
    faces: Query<(), With<AuthoredFace>>,
) {
    for request in requests.read() {
        let alive = request.faces.iter().copied().filter(|f| faces.contains(*f)).collect();
        selection.apply(&SelectRequest { faces: alive, mode: request.mode });
    }
}
