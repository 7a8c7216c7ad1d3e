//! What would lose unsaved work waits for an answer.

use bevy::prelude::*;
use bevy::window::WindowCloseRequested;

use super::autosave::Recovery;
use super::{DocumentFile, Question, Questions, Saving};
use crate::editor::editing::Editing;
use crate::editor::files::{OpenFiles, Source, close_all};
use crate::editor::object::Scene;
use crate::editor::tools::{Action, CommandRequest};

/// Something that ends the open document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Discarding {
    /// Nothing comes instead.
    Close,
    /// These files come instead.
    Open(OpenFiles),
    /// The program ends.
    Quit,
}

/// It may be done: nothing is lost, or the user said so.
#[derive(Message, Debug, Clone, PartialEq, Eq)]
pub struct Proceed(pub Discarding);

/// Lets through what loses nothing, and asks about the rest.
pub(super) fn stop(
    mut commands: MessageReader<CommandRequest>,
    mut files: MessageReader<OpenFiles>,
    mut closing: MessageReader<WindowCloseRequested>,
    editing: Res<Editing>,
    saving: Res<Saving>,
    scene: Res<Scene>,
    mut questions: ResMut<Questions>,
    mut proceed: MessageWriter<Proceed>,
) {
    let mut wanted = Vec::new();
    for CommandRequest(action) in commands.read() {
        wanted.push(match action {
            Action::New | Action::CloseAll => Discarding::Close,
            Action::OpenDemo => Discarding::Open(OpenFiles { sources: vec![Source::Demo], replace: true }),
            Action::Quit => Discarding::Quit,
            _ => continue,
        });
    }
    wanted.extend(files.read().filter(|f| f.replace).cloned().map(Discarding::Open));
    if closing.read().count() > 0 {
        wanted.push(Discarding::Quit);
    }
    // Of several things at once only the last makes sense.
    let Some(last) = wanted.pop() else { return };
    if saving.is_active() {
        // The answer depends on how saving goes.
        questions.ask_after_saving(last);
    } else if editing.is_unsaved() && !scene.is_empty() {
        questions.ask(Question::Unsaved(last));
    } else {
        proceed.write(Proceed(last));
    }
}

/// Closes the document and ends the program. Files are opened by `files`, which closes when it has read them.
pub(super) fn proceed(
    mut requests: MessageReader<Proceed>,
    mut commands: Commands,
    mut scene: ResMut<Scene>,
    mut editing: ResMut<Editing>,
    mut file: ResMut<DocumentFile>,
    recovery: Res<Recovery>,
    mut exit: MessageWriter<AppExit>,
) {
    for Proceed(what) in requests.read() {
        match what {
            Discarding::Open(_) => {}
            Discarding::Close => {
                recovery.forget(&file);
                close_all(&mut commands, &mut scene);
                editing.start_over();
                file.start_over();
            }
            Discarding::Quit => {
                recovery.forget(&file);
                exit.write(AppExit::Success);
            }
        }
    }
}
