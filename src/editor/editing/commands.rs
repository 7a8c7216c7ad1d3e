//! Editing commands: from a command and the values typed to a step of the history.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::operations::{Target, operations};
use super::prompt::{self, Prompt};
use super::{EditRequest, OpenDocument};
use crate::editor::elements::{ActiveFace, ElementRequest, ElementSelection};
use crate::editor::panels::Notices;
use crate::editor::selection::{SelectMode, Selection};
use crate::editor::tools::{Action, CommandRequest, EditAction};
use crate::scene::FaceId;
use crate::scene::operation::Operation;
use crate::scene::records::LoopRecord;

/// Asks for an editing command with the values it needs.
#[derive(Message, Debug, Clone, PartialEq, Eq)]
pub struct RunEdit {
    /// What to do.
    pub action: EditAction,
    /// One for each of its fields, as typed.
    pub values: Vec<String>,
}

/// Loops that were copied.
#[derive(Resource, Debug, Clone, Default, PartialEq)]
pub struct Clipboard(pub Vec<LoopRecord>);

/// What editing commands look at.
#[derive(SystemParam)]
pub(super) struct Sight<'w, 's> {
    document: OpenDocument<'w, 's>,
    active: Res<'w, ActiveFace>,
    elements: Res<'w, ElementSelection>,
    selection: Res<'w, Selection>,
}

impl Sight<'_, '_> {
    fn faces(&self) -> Vec<FaceId> {
        self.selection.faces().iter().filter_map(|face| self.document.id(*face)).collect()
    }

    fn target<'a>(&'a self, faces: &'a [FaceId], clipboard: &'a Clipboard) -> Target<'a> {
        let face = self.active.face.as_ref().filter(|f| self.elements.face == Some(f.entity));
        let face = face.and_then(|f| Some((self.document.id(f.entity)?, &*f.record)));
        Target { face, elements: &self.elements, faces, clipboard: &clipboard.0 }
    }
}

/// Commands without values run at once, those with values open a prompt.
pub(super) fn command_requests(
    mut commands: MessageReader<CommandRequest>,
    mut prompt: ResMut<Prompt>,
    mut run: MessageWriter<RunEdit>,
    clipboard: Res<Clipboard>,
    sight: Sight,
) {
    for CommandRequest(action) in commands.read() {
        let Action::Edit(action) = *action else { continue };
        if action.fields().is_empty() {
            run.write(RunEdit { action, values: Vec::new() });
        } else {
            let faces = sight.faces();
            prompt.open(action, prompt::defaults(action, &sight.target(&faces, &clipboard)));
        }
    }
}

/// Turns requests into steps. What cannot be done is said in the prompt, or in a notice.
pub(super) fn run(
    mut requests: MessageReader<RunEdit>,
    mut edits: MessageWriter<EditRequest>,
    mut select: MessageWriter<ElementRequest>,
    mut notices: ResMut<Notices>,
    mut prompt: ResMut<Prompt>,
    mut clipboard: ResMut<Clipboard>,
    sight: Sight,
) {
    for RunEdit { action, values } in requests.read() {
        let faces = sight.faces();
        if matches!(action, EditAction::Copy | EditAction::Cut) {
            copy(&sight, &mut clipboard);
            if *action == EditAction::Copy {
                continue;
            }
        }
        match operations(*action, &sight.target(&faces, &clipboard), values) {
            Ok((label, operations)) => {
                prompt.close();
                if matches!(action, EditAction::Delete | EditAction::Cut) {
                    select.write(ElementRequest { elements: Vec::new(), mode: SelectMode::Replace });
                }
                edits.write(match <[Operation; 1]>::try_from(operations) {
                    Ok([operation]) => EditRequest::Perform(operation),
                    Err(operations) => EditRequest::PerformAll(label, operations),
                });
            }
            Err(reason) if prompt.is_open() => prompt.refuse(reason),
            Err(reason) => notices.error(reason),
        }
    }
}

/// Takes the selected loops to the clipboard; what is there stays when there are none.
fn copy(sight: &Sight, clipboard: &mut Clipboard) {
    let empty = Clipboard::default();
    let Some((_, record)) = sight.target(&[], &empty).face else { return };
    let loops = sight.elements.loops();
    let copied: Vec<_> = loops.iter().filter_map(|l| record.loops.get(*l)).cloned().collect();
    if !copied.is_empty() {
        clipboard.0 = copied;
    }
}
