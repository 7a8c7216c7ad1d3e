//! Saving and exporting: a snapshot is taken at once and written on a thread.
//!
//! What is edited meanwhile is not in the file, and stays unsaved. A save that fails leaves the old file, the
//! document and its history as they are.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, mpsc};

use bevy::prelude::*;

use super::autosave::Recovery;
use super::naming::Naming;
use super::{Discarding, DocumentFile, Proceed, Question, Questions, Snapshot, merge};
use crate::editor::editing::{Editing, SavePoint};
use crate::editor::files::{FileDialogs, Purpose, remember};
use crate::editor::panels::Notices;
use crate::editor::redraw::Waker;
use crate::editor::settings::Settings;
use crate::editor::tools::{Action, CommandRequest};
use crate::exchange::iges::write::{self, WriteOptions};
use crate::scene::SceneRecord;
use crate::scene::file::replace::replace;
use crate::scene::file::{self, Fingerprint, SaveError, SaveOptions};

/// Where to save.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// Its own file; when it has none the user is asked.
    Own,
    /// Its own file, whatever somebody else has written there.
    Overwrite,
    /// Where the user says.
    Ask,
    /// This file, which becomes its own.
    File(PathBuf),
    /// This IGES file, which does not become its own.
    Export(PathBuf),
}

/// Asks for the document to be saved.
#[derive(Message, Debug, Clone, PartialEq, Eq)]
pub struct SaveRequest {
    /// Where.
    pub target: Target,
    /// What to do once it is saved.
    pub then: Option<Discarding>,
}

/// The save under way.
#[derive(Resource, Default)]
pub struct Saving {
    worker: Option<Worker>,
}

struct Worker {
    path: PathBuf,
    point: SavePoint,
    then: Option<Discarding>,
    result: Mutex<mpsc::Receiver<Result<Written, SaveFailure>>>,
}

/// What was written.
enum Written {
    Scene(Fingerprint),
    /// With remarks on what the format could not hold.
    Export(Vec<String>),
}

#[derive(Debug, thiserror::Error)]
enum SaveFailure {
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error("{0}")]
    Export(String),
}

impl Saving {
    /// Whether something is being written.
    pub fn is_active(&self) -> bool {
        self.worker.is_some()
    }

    /// The file being written.
    pub fn path(&self) -> Option<&Path> {
        self.worker.as_ref().map(|w| w.path.as_path())
    }
}

/// Save, Save as and Export from the command table.
pub(super) fn command_requests(
    mut commands: MessageReader<CommandRequest>,
    mut dialogs: ResMut<FileDialogs>,
    naming: Naming,
    mut requests: MessageWriter<SaveRequest>,
) {
    for CommandRequest(action) in commands.read() {
        let target = match action {
            Action::Save => Target::Own,
            Action::SaveAs => Target::Ask,
            Action::Export => {
                dialogs.open(Purpose::Export, naming.suggestion().as_deref());
                continue;
            }
            _ => continue,
        };
        requests.write(SaveRequest { target, then: None });
    }
}

/// Takes the snapshot and starts the thread, or asks for a name first.
pub(super) fn start(
    mut requests: MessageReader<SaveRequest>,
    mut saving: ResMut<Saving>,
    mut dialogs: ResMut<FileDialogs>,
    mut notices: ResMut<Notices>,
    file: Res<DocumentFile>,
    naming: Naming,
    editing: Res<Editing>,
    snapshot: Snapshot,
    waker: Res<Waker>,
) {
    for SaveRequest { target, then } in requests.read() {
        if saving.is_active() {
            notices.info("Still saving".into());
            continue;
        }
        let own = file.path.clone();
        let (path, expected, export) = match (target, own) {
            (Target::Own, Some(path)) => (path, file.fingerprint.clone(), false),
            (Target::Overwrite, Some(path)) => (path, None, false),
            (Target::File(path), _) => (with_extension(path, file::EXTENSION), None, false),
            (Target::Export(path), _) => (with_extension(path, "igs"), None, true),
            (Target::Own | Target::Overwrite | Target::Ask, own) => {
                dialogs.open(Purpose::Save(then.clone()), own.or_else(|| naming.suggestion()).as_deref());
                continue;
            }
        };
        if editing.is_dragging() {
            notices.info("Let go first: what is being dragged is not saved".into());
            continue;
        }
        let scene = snapshot.record();
        let (sender, receiver) = mpsc::channel();
        let (to, waker) = (path.clone(), waker.clone());
        let spawned = std::thread::Builder::new().name("hairline-save".into()).spawn(move || {
            let work = std::panic::AssertUnwindSafe(|| match export {
                true => export_iges(&to, &scene),
                false => {
                    let options = SaveOptions { expected, ..SaveOptions::default() };
                    Ok(Written::Scene(file::save(&to, &scene, &options)?))
                }
            });
            // A defect in a writer must not take the window, and the unsaved work in it, down.
            let result = std::panic::catch_unwind(work)
                .unwrap_or_else(|_| Err(SaveFailure::Export("internal error while writing".into())));
            // The receiver is gone only when the program ends.
            let _ = sender.send(result);
            waker.wake();
        });
        match spawned {
            Ok(_) => {
                let (then, point) = (then.clone(), editing.save_point());
                saving.worker = Some(Worker { path, point, then, result: Mutex::new(receiver) });
            }
            Err(error) => notices.error(format!("not saved: cannot start a thread: {error}")),
        }
    }
}

/// Adds the extension to a name that has none.
fn with_extension(path: &Path, extension: &str) -> PathBuf {
    if path.extension().is_some() { path.to_owned() } else { path.with_extension(extension) }
}

fn export_iges(path: &Path, scene: &SceneRecord) -> Result<Written, SaveFailure> {
    let model = merge::to_one_model(&scene.models).map_err(SaveFailure::Export)?;
    let file_name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let options = WriteOptions { file_name, ..WriteOptions::default() };
    let (bytes, remarks) = write::write(&model, &options).map_err(|e| SaveFailure::Export(e.to_string()))?;
    replace(path, &bytes).map_err(SaveError::Io)?;
    Ok(Written::Export(remarks.iter().map(|r| format!("face {}: {}", r.face, r.message)).collect()))
}

/// Takes what the thread reports.
pub(super) fn finish(
    mut saving: ResMut<Saving>,
    mut file: ResMut<DocumentFile>,
    mut editing: ResMut<Editing>,
    mut settings: ResMut<Settings>,
    mut notices: ResMut<Notices>,
    mut questions: ResMut<Questions>,
    mut proceed: MessageWriter<Proceed>,
    recovery: Res<Recovery>,
) {
    let Some(worker) = &saving.worker else { return };
    let received = worker.result.lock().unwrap_or_else(|e| e.into_inner()).try_recv();
    let result = match received {
        Ok(result) => result,
        Err(mpsc::TryRecvError::Empty) => return,
        Err(mpsc::TryRecvError::Disconnected) => Err(SaveFailure::Export("the writer ended".into())),
    };
    let Some(worker) = saving.worker.take() else { return };
    let name = worker.path.display();
    let waiting = questions.take_after_saving();
    match result {
        Ok(Written::Scene(fingerprint)) => {
            recovery.forget(&file);
            file.recovered = None;
            file.path = Some(worker.path.clone());
            file.fingerprint = Some(fingerprint);
            editing.mark_saved(worker.point);
            remember(&mut settings, &worker.path);
            notices.info(format!("Saved {name}"));
            match worker.then.or(waiting) {
                Some(next) if !editing.is_unsaved() => {
                    proceed.write(Proceed(next));
                }
                // Edited meanwhile.
                Some(next) => questions.ask(Question::Unsaved(next)),
                None => {}
            }
        }
        Ok(Written::Export(remarks)) => match remarks.first() {
            None => notices.info(format!("Exported {name}")),
            Some(first) => {
                notices.info(format!("Exported {name}: {} remarks, the first: {first}", remarks.len()))
            }
        },
        Err(SaveFailure::Save(SaveError::ChangedOnDisk)) => {
            questions.ask(Question::Changed { path: worker.path, then: worker.then.or(waiting) });
        }
        Err(error) => notices.error(format!("{name} was not written: {error}. Nothing is lost.")),
    }
}
