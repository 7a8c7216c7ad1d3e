//! Serving requests: the history, and the drag that is going on.

use std::time::Instant;

use bevy::ecs::system::SystemState;
use bevy::prelude::*;

use super::{EditRequest, OpenDocument, apply_edit};
use crate::editor::diagnostics::RenderFigures;
use crate::editor::elements::FreshLoops;
use crate::editor::panels::Notices;
use crate::editor::redraw::Waker;
use crate::editor::tools::{Action, CommandRequest};
use crate::scene::operation::{Operation, OperationError};
use crate::scene::{Change, Edit, EditError, FaceId, History};

/// The moment in `ApplyEdits` when requests are served.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ApplyRequests;

/// The steps of the open document, and the drag that is going on.
#[derive(Resource, Debug, Default)]
pub struct Editing {
    history: History,
    drag: Option<Drag>,
    /// Counts what happened to the document that is no step: a file was added to it, it was recovered.
    touches: u64,
    /// The count that is on disk.
    saved_touches: u64,
    /// Why the last preview was refused, while it is the latest.
    refused: Option<String>,
    /// Counts changes of the document, previews included.
    revision: u64,
}

/// A state of the document.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SavePoint {
    state: u64,
    touches: u64,
}

/// A drag: what the last preview did to the document as it was at the beginning.
#[derive(Debug, Default)]
struct Drag {
    shown: Option<Edit>,
}

impl Editing {
    /// The steps.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Whether a drag is going on.
    pub fn is_dragging(&self) -> bool {
        self.drag.is_some()
    }

    /// Why the last preview was refused; what is shown is the one before it.
    pub fn refused(&self) -> Option<&str> {
        self.refused.as_deref()
    }

    /// Whether there is something that no file holds.
    pub fn is_unsaved(&self) -> bool {
        self.touches != self.saved_touches
            || !self.history.is_saved()
            || self.drag.as_ref().is_some_and(|d| d.shown.is_some())
    }

    /// Enters a change that was made elsewhere, as a step. One too large to keep is only noted.
    pub fn enter(&mut self, edit: Edit) {
        self.revision += 1;
        if edit.bytes() > self.history.cap_bytes() / 2 {
            self.touches += 1;
        } else {
            self.history.push(edit);
        }
    }

    /// Notes a change that is no step.
    pub fn touch(&mut self) {
        self.touches += 1;
        self.revision += 1;
    }

    /// Names the present state, to say later that it was saved.
    pub fn save_point(&self) -> SavePoint {
        SavePoint { state: self.history.state(), touches: self.touches }
    }

    /// Notes that a state is on disk.
    pub fn mark_saved(&mut self, point: SavePoint) {
        self.history.mark_saved_at(point.state);
        self.saved_touches = point.touches;
    }

    /// Starts over with a document that was just opened: without steps, saved.
    pub fn start_over(&mut self) {
        *self = Self { revision: self.revision + 1, ..Self::default() };
    }

    /// Counts changes of the document, previews included.
    pub fn revision(&self) -> u64 {
        self.revision
    }
}

/// Why a request was refused.
#[derive(Debug, thiserror::Error)]
enum Refusal {
    #[error(transparent)]
    Operation(#[from] Box<OperationError>),
    #[error(transparent)]
    Edit(#[from] EditError),
}

/// Undo and redo from the command table.
pub(super) fn command_requests(
    mut commands: MessageReader<CommandRequest>,
    mut requests: MessageWriter<EditRequest>,
) {
    for CommandRequest(action) in commands.read() {
        requests.write(match action {
            Action::Undo => EditRequest::Undo,
            Action::Redo => EditRequest::Redo,
            _ => continue,
        });
    }
}

/// Serves the requests of this frame in order.
pub(super) fn serve(
    world: &mut World,
    reader: &mut SystemState<MessageReader<'static, 'static, EditRequest>>,
    document: &mut Reading,
) {
    let Ok(mut reader) = reader.get_mut(world) else { return };
    let requests: Vec<EditRequest> = reader.read().cloned().collect();
    if requests.is_empty() {
        return;
    }
    let started = Instant::now();
    world.resource_scope(|world, mut editing: Mut<Editing>| {
        for (index, request) in requests.iter().enumerate() {
            // Of several previews in a slow frame only the last is ever seen.
            if let (EditRequest::Preview(_), Some(EditRequest::Preview(_))) =
                (request, requests.get(index + 1))
            {
                continue;
            }
            let before = editing.revision;
            let preview = matches!(request, EditRequest::Preview(_));
            let result = editing.serve(world, document, request);
            match result {
                Ok(()) if preview => editing.refused = None,
                Ok(()) => {}
                Err(error) if preview => editing.refused = Some(error.to_string()),
                Err(error) => world.resource_mut::<Notices>().error(error.to_string()),
            }
            if editing.revision != before {
                world.resource::<RenderFigures>().lock().edit.begin(started.elapsed());
            }
        }
    });
    world.resource::<Waker>().wake();
}

/// Access to the document from a system that has the whole world.
type Reading = SystemState<OpenDocument<'static, 'static>>;

fn work_out(world: &World, document: &mut Reading, operation: &Operation) -> Result<Edit, Refusal> {
    let document = document.get(world).expect("invariant: the index of the document is always there");
    Ok(operation.perform(&document).map_err(Box::new)?)
}

/// Loops that an operation adds to a face, by position.
fn fresh_loops(operation: &Operation, edit: &Edit) -> Option<(FaceId, std::ops::Range<usize>)> {
    let adds = matches!(
        operation,
        Operation::AddLoop { .. } | Operation::PasteLoops { .. } | Operation::DuplicateLoops { .. }
    );
    edit.changes.iter().rev().filter(|_| adds).find_map(|change| match change {
        Change::Loops { face, at, before, after } if after.len() > before.len() => {
            Some((*face, at + before.len()..at + after.len()))
        }
        _ => None,
    })
}

impl Editing {
    fn serve(
        &mut self,
        world: &mut World,
        document: &mut Reading,
        request: &EditRequest,
    ) -> Result<(), Refusal> {
        match request {
            EditRequest::Perform(operation) => {
                self.cancel(world)?;
                let edit = work_out(world, document, operation)?;
                let fresh = fresh_loops(operation, &edit);
                self.step(world, edit)?;
                if fresh.is_some() {
                    world.resource_mut::<FreshLoops>().0 = fresh;
                }
                Ok(())
            }
            EditRequest::PerformAll(label, operations) => {
                self.cancel(world)?;
                self.perform_all(world, document, label, operations)
            }
            EditRequest::Apply(edit) => {
                self.cancel(world)?;
                self.step(world, edit.clone())
            }
            EditRequest::Begin => {
                self.cancel(world)?;
                self.drag = Some(Drag::default());
                Ok(())
            }
            EditRequest::Preview(operation) => self.preview(world, document, operation),
            EditRequest::Commit => {
                let drag = self.drag.take();
                if let Some(edit) = drag.and_then(|d| d.shown) {
                    self.history.push(edit);
                }
                self.refused = None;
                Ok(())
            }
            EditRequest::Cancel => self.cancel(world),
            EditRequest::Undo if self.drag.is_some() => self.cancel(world),
            EditRequest::Undo => self.undo(world),
            EditRequest::Redo if self.drag.is_some() => Ok(()),
            EditRequest::Redo => self.redo(world),
            EditRequest::GoTo(count) => {
                self.cancel(world)?;
                while self.history.undo_count() > *count {
                    self.undo(world)?;
                }
                while self.history.undo_count() < *count && self.history.redo_count() > 0 {
                    self.redo(world)?;
                }
                Ok(())
            }
        }
    }

    fn step(&mut self, world: &mut World, edit: Edit) -> Result<(), Refusal> {
        if !edit.is_empty() {
            apply_edit(world, &edit)?;
            self.revision += 1;
            self.history.push(edit);
        }
        Ok(())
    }

    fn undo(&mut self, world: &mut World) -> Result<(), Refusal> {
        if self.history.undo(|edit| apply_edit(world, edit))?.is_some() {
            self.revision += 1;
        }
        Ok(())
    }

    fn redo(&mut self, world: &mut World) -> Result<(), Refusal> {
        if self.history.redo(|edit| apply_edit(world, edit))?.is_some() {
            self.revision += 1;
        }
        Ok(())
    }

    /// Ends the drag and takes it back.
    fn cancel(&mut self, world: &mut World) -> Result<(), Refusal> {
        self.refused = None;
        if let Some(edit) = self.drag.take().and_then(|d| d.shown) {
            apply_edit(world, &edit.inverse())?;
            self.revision += 1;
        }
        Ok(())
    }

    fn preview(
        &mut self,
        world: &mut World,
        document: &mut Reading,
        operation: &Operation,
    ) -> Result<(), Refusal> {
        let Some(drag) = &mut self.drag else { return Ok(()) };
        let last = drag.shown.take();
        if let Some(edit) = &last {
            apply_edit(world, &edit.inverse())?;
        }
        let edit = work_out(world, document, operation);
        let result = edit.and_then(|edit| {
            apply_edit(world, &edit)?;
            Ok(edit)
        });
        self.revision += 1;
        match result {
            Ok(edit) => {
                drag.shown = (!edit.is_empty()).then_some(edit);
                Ok(())
            }
            Err(error) => {
                if let Some(edit) = &last {
                    apply_edit(world, edit)?;
                }
                drag.shown = last;
                Err(error)
            }
        }
    }

    fn perform_all(
        &mut self,
        world: &mut World,
        document: &mut Reading,
        label: &str,
        operations: &[Operation],
    ) -> Result<(), Refusal> {
        let mut whole = Edit::new(label, Vec::new());
        let mut fresh = None;
        for operation in operations {
            let done = work_out(world, document, operation).and_then(|edit| {
                apply_edit(world, &edit)?;
                Ok(edit)
            });
            match done {
                Ok(edit) => {
                    fresh = fresh_loops(operation, &edit).or(fresh);
                    whole.changes.extend(edit.changes);
                }
                Err(error) => {
                    apply_edit(world, &whole.inverse())?;
                    return Err(error);
                }
            }
        }
        self.revision += 1;
        self.history.push(whole);
        if fresh.is_some() {
            world.resource_mut::<FreshLoops>().0 = fresh;
        }
        Ok(())
    }
}
