//! Copies kept while there is unsaved work, and offering those of a run that crashed.
//!
//! Some seconds after a change a snapshot is written on a thread into the user's data folder; saving or
//! closing in order removes it. A copy whose process is gone is offered at the next start.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, mpsc};
use std::time::{Duration, Instant};

use bevy::prelude::*;

use super::{DocumentFile, Question, Questions, Snapshot};
use crate::editor::editing::Editing;
use crate::editor::object::Scene;
use crate::editor::panels::Notices;
use crate::editor::redraw::Waker;
use crate::editor::settings::Settings;
use crate::scene::file::recovery::{Recoverable, RecoveryFolder};

/// Where copies are kept; nowhere unless a folder is set (tests).
#[derive(Resource, Debug, Default)]
pub struct Recovery {
    /// The folder.
    pub folder: Option<RecoveryFolder>,
    /// The copy that is being opened.
    pub(super) recovering: Option<Recoverable>,
    /// How often copies were forgotten. Held while one is written, so that none comes after it was forgotten.
    forgotten: Arc<Mutex<u64>>,
}

impl Recovery {
    /// Copies in the user's data folder.
    pub fn of_user() -> Self {
        Self { folder: RecoveryFolder::of_user(), ..default() }
    }

    /// Copies in a folder.
    pub fn at(folder: RecoveryFolder) -> Self {
        Self { folder: Some(folder), ..default() }
    }

    /// Removes the copies of a document that was saved or closed in order. What cannot be removed is offered at the
    /// next start, which loses nothing.
    ///
    /// Waits for a copy that is being written: the program may end next.
    pub fn forget(&self, file: &DocumentFile) {
        *count(&self.forgotten) += 1;
        if let Some(folder) = &self.folder {
            let _ = folder.forget(file.path.as_deref(), file.number);
            if let Some(copy) = &file.recovered {
                let _ = folder.remove(copy);
            }
        }
    }

    pub(super) fn remove(&self, copy: &Path) {
        if let Some(folder) = &self.folder {
            let _ = folder.remove(copy);
        }
    }

    /// What is known of a copy that has just been opened from `path`.
    pub fn take_recovering(&mut self, path: &Path) -> Option<Recoverable> {
        self.recovering.take_if(|r| r.file == path)
    }
}

fn count(forgotten: &Mutex<u64>) -> MutexGuard<'_, u64> {
    // A number is whole even if its holder panicked.
    forgotten.lock().unwrap_or_else(|e| e.into_inner())
}

/// The copy that was written, none if it had been forgotten by then, or why there is none.
type Kept = Result<Option<PathBuf>, String>;

/// When the next copy is due, and the one being written.
#[derive(Resource, Debug, Default)]
pub(super) struct Autosave {
    /// Revision of the document that the latest copy holds, and how often copies were forgotten before it.
    kept: (u64, u64),
    /// Revision seen last, and since when it waits.
    waiting: Option<(u64, Instant)>,
    worker: Option<Mutex<mpsc::Receiver<Kept>>>,
    failed: bool,
}

/// Offers the copies of earlier runs at start.
pub(super) fn offer(recovery: Res<Recovery>, mut questions: ResMut<Questions>) {
    let copies = recovery.folder.as_ref().map(RecoveryFolder::recoverable).unwrap_or_default();
    if !copies.is_empty() {
        questions.ask(Question::Recover(copies));
    }
}

/// Starts a copy when one is due.
pub(super) fn keep(
    mut autosave: ResMut<Autosave>,
    recovery: Res<Recovery>,
    settings: Res<Settings>,
    editing: Res<Editing>,
    scene: Res<Scene>,
    file: Res<DocumentFile>,
    snapshot: Snapshot,
    waker: Res<Waker>,
) {
    let Some(folder) = recovery.folder.clone().filter(|_| settings.autosave_s > 0) else { return };
    let revision = editing.revision();
    if autosave.worker.is_some() {
        return;
    }
    let before = *count(&recovery.forgotten);
    if !editing.is_unsaved() || scene.is_empty() || autosave.kept == (revision, before) {
        autosave.waiting = None;
        return;
    }
    let wait = Duration::from_secs(settings.autosave_s.into());
    let now = Instant::now();
    let (_, since) = *autosave.waiting.get_or_insert((revision, now));
    // A document that was just recovered has only the copy of another process: keep one at once.
    let due = if file.recovered.is_some() { Duration::ZERO } else { wait };
    if now.duration_since(since) < due {
        waker.wake_after(wait - now.duration_since(since));
        return;
    }
    if editing.is_dragging() {
        return;
    }
    let (record, path, number) = (snapshot.record(), file.path.clone(), file.number);
    let (sender, receiver) = mpsc::channel();
    let for_thread = waker.clone();
    let forgotten = Arc::clone(&recovery.forgotten);
    let spawned = std::thread::Builder::new().name("hairline-autosave".into()).spawn(move || {
        let now = count(&forgotten);
        let wanted = *now == before;
        let kept = wanted.then(|| folder.keep(path.as_deref(), number, &record).map_err(|e| e.to_string()));
        drop(now);
        let result = kept.transpose();
        // The receiver is gone only when the program ends.
        let _ = sender.send(result);
        for_thread.wake();
    });
    autosave.kept = (revision, before);
    autosave.waiting = None;
    autosave.worker = spawned.is_ok().then(|| Mutex::new(receiver));
}

/// Takes the result. A failure is said once: the work itself is not in danger.
pub(super) fn finish(
    mut autosave: ResMut<Autosave>,
    mut file: ResMut<DocumentFile>,
    recovery: Res<Recovery>,
    mut notices: ResMut<Notices>,
) {
    let Some(worker) = &autosave.worker else { return };
    let received = worker.lock().unwrap_or_else(|e| e.into_inner()).try_recv();
    let result = match received {
        Err(mpsc::TryRecvError::Empty) => return,
        Err(mpsc::TryRecvError::Disconnected) => Err("the writer ended".into()),
        Ok(result) => result,
    };
    autosave.worker = None;
    match result {
        // Saved or closed meanwhile.
        Ok(None) => {}
        Ok(Some(copy)) => {
            autosave.failed = false;
            // Otherwise another document may be open by now.
            if autosave.kept.1 == *count(&recovery.forgotten)
                && let Some(old) = file.recovered.take().filter(|old| *old != copy)
            {
                recovery.remove(&old);
            }
        }
        Err(error) if !autosave.failed => {
            autosave.failed = true;
            notices.error(format!("No copy is kept to recover from: {error}"));
        }
        Err(_) => {}
    }
}
