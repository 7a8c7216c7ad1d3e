//! Questions that the user must answer before something goes on, and the answers.

use std::path::PathBuf;

use bevy::prelude::*;

use super::autosave::Recovery;
use super::save::{SaveRequest, Target};
use super::{Discarding, Proceed};
use crate::editor::files::{OpenFiles, Source};
use crate::scene::file::recovery::Recoverable;

/// What is asked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Question {
    /// There is unsaved work that this would lose.
    Unsaved(Discarding),
    /// Somebody else has written the file since it was opened.
    Changed {
        /// The file.
        path: PathBuf,
        /// What was to be done after saving.
        then: Option<Discarding>,
    },
    /// Copies of documents that an earlier run did not close in order.
    Recover(Vec<Recoverable>),
}

/// The open question, and what waits for a save that is under way.
#[derive(Resource, Debug, Default)]
pub struct Questions {
    open: Option<Question>,
    after_saving: Option<Discarding>,
}

/// The answer.
#[derive(Message, Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// Save, then go on.
    Save,
    /// Go on without saving.
    Discard,
    /// Do nothing.
    Cancel,
    /// Replace what somebody else has written.
    Overwrite,
    /// Save under another name.
    SaveAs,
    /// Open this copy.
    Recover(PathBuf),
    /// Remove this copy.
    Remove(PathBuf),
}

impl Questions {
    /// The open question.
    pub fn open(&self) -> Option<&Question> {
        self.open.as_ref()
    }

    /// Asks, instead of what was asked before.
    pub fn ask(&mut self, question: Question) {
        self.open = Some(question);
    }

    /// Comes back to this when saving has ended.
    pub fn ask_after_saving(&mut self, what: Discarding) {
        self.after_saving = Some(what);
    }

    /// What waited for the end of saving.
    pub fn take_after_saving(&mut self) -> Option<Discarding> {
        self.after_saving.take()
    }
}

/// Does what the answers say.
pub(super) fn answer(
    mut answers: MessageReader<Answer>,
    mut questions: ResMut<Questions>,
    mut recovery: ResMut<Recovery>,
    mut proceed: MessageWriter<Proceed>,
    mut save: MessageWriter<SaveRequest>,
    mut open: MessageWriter<OpenFiles>,
) {
    for answer in answers.read() {
        let Some(question) = questions.open.take() else { continue };
        match (question, answer) {
            (Question::Unsaved(what), Answer::Discard) => {
                proceed.write(Proceed(what));
            }
            (Question::Unsaved(what), Answer::Save) => {
                save.write(SaveRequest { target: Target::Own, then: Some(what) });
            }
            (Question::Changed { then, .. }, Answer::Overwrite) => {
                save.write(SaveRequest { target: Target::Overwrite, then });
            }
            (Question::Changed { then, .. }, Answer::SaveAs) => {
                save.write(SaveRequest { target: Target::Ask, then });
            }
            (Question::Recover(mut list), Answer::Remove(file)) => {
                recovery.remove(file);
                list.retain(|r| r.file != *file);
                questions.open = (!list.is_empty()).then_some(Question::Recover(list));
            }
            (Question::Recover(list), Answer::Recover(file)) => {
                recovery.recovering = list.into_iter().find(|r| r.file == *file);
                let sources = vec![Source::File(file.clone())];
                open.write(OpenFiles { sources, replace: true });
            }
            _ => {}
        }
    }
}
