//! The worker thread that reads files while the window stays alive.
//!
//! One worker at a time; later requests wait in a queue. The worker reports through an atomic fraction and
//! a channel, wakes the window when there is something to show, and stops soon after it is cancelled.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, mpsc};

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::{LoadError, LoadedScene, OpenFiles, SceneFile, Source, read_source};
use crate::editor::camera::CameraRequest;
use crate::editor::document::{Discarding, DocumentFile, Proceed, Recovery, restore};
use crate::editor::editing::Editing;
use crate::editor::object::{Scene, despawn_model, spawn_model};
use crate::editor::panels::Notices;
use crate::editor::redraw::Waker;
use crate::editor::settings::Settings;
use crate::editor::tools::{Action, CommandRequest};
use crate::scene::file::Fingerprint;
use crate::scene::{Change, Edit};

/// What is being read.
#[derive(Resource, Default)]
pub struct Loading {
    /// What to read, and the revision of the document that it replaces.
    queue: VecDeque<(Source, Option<u64>)>,
    active: Option<Worker>,
}

struct Worker {
    name: String,
    replaces: Option<u64>,
    shared: Arc<Shared>,
    result: Mutex<mpsc::Receiver<Result<LoadedScene, LoadError>>>,
}

#[derive(Default)]
struct Shared {
    permille: AtomicU32,
    stage: Mutex<&'static str>,
    cancelled: AtomicBool,
}

/// How far the worker is.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadProgress {
    /// File name.
    pub name: String,
    /// What is being done.
    pub stage: &'static str,
    /// Fraction done.
    pub fraction: f32,
}

impl Loading {
    /// Whether a file is being read.
    pub fn is_active(&self) -> bool {
        self.active.is_some() || !self.queue.is_empty()
    }

    /// How far the worker is.
    pub fn progress(&self) -> Option<LoadProgress> {
        let worker = self.active.as_ref()?;
        Some(LoadProgress {
            name: worker.name.clone(),
            stage: *worker.shared.stage.lock().unwrap_or_else(|e| e.into_inner()),
            fraction: worker.shared.permille.load(Ordering::Relaxed) as f32 / 1000.0,
        })
    }

    fn cancel(&mut self) {
        self.queue.clear();
        if let Some(worker) = &self.active {
            worker.shared.cancelled.store(true, Ordering::Relaxed);
        }
    }
}

/// Cancel from the command table.
pub(super) fn command_requests(mut requests: MessageReader<CommandRequest>, mut loading: ResMut<Loading>) {
    if requests.read().any(|r| r.0 == Action::Cancel) {
        loading.cancel();
    }
}

/// Despawns everything open.
pub fn close_all(commands: &mut Commands, scene: &mut Scene) {
    let open: Vec<Entity> = scene.models.iter().map(|m| m.entity).collect();
    for model in open {
        despawn_model(commands, scene, model);
    }
}

/// Queues requests and starts the worker when it is free. What replaces the document comes by way of
/// `document`, which knows whether anything would be lost.
pub(super) fn start(
    mut requests: MessageReader<OpenFiles>,
    mut allowed: MessageReader<Proceed>,
    mut loading: ResMut<Loading>,
    editing: Res<Editing>,
    waker: Res<Waker>,
) {
    let replacing = allowed.read().filter_map(|Proceed(what)| match what {
        Discarding::Open(files) => Some(files),
        _ => None,
    });
    for request in requests.read().filter(|r| !r.replace).chain(replacing) {
        let sources = request.sources.iter().cloned();
        // Only the first file of a request replaces; the others join it.
        let replaced = Some(editing.revision()).filter(|_| request.replace);
        loading.queue.extend(sources.enumerate().map(|(i, s)| (s, replaced.filter(|_| i == 0))));
    }
    if loading.active.is_none()
        && let Some((source, replaces)) = loading.queue.pop_front()
    {
        loading.active = Some(spawn_worker(source, replaces, waker.clone()));
    }
}

fn spawn_worker(source: Source, replaces: Option<u64>, waker: Waker) -> Worker {
    let shared = Arc::new(Shared::default());
    let (sender, receiver) = mpsc::channel();
    let name = match &source {
        Source::Demo => "Demo scene".to_owned(),
        Source::File(path) => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
    };
    let (for_worker, for_failure) = (Arc::clone(&shared), sender.clone());
    let path = match &source {
        Source::File(path) => path.clone(),
        Source::Demo => std::path::PathBuf::from(&name),
    };
    let spawned = std::thread::Builder::new().name("hairline-load".into()).spawn(move || {
        let shared = for_worker;
        let progress = |fraction: f32, stage: &'static str| {
            let permille = (1000.0 * fraction.clamp(0.0, 1.0)) as u32;
            let before = shared.permille.swap(permille, Ordering::Relaxed);
            // Redraw the bar in steps of 2 %: a worker must not keep the window busy.
            if permille / 20 != before / 20 {
                *shared.stage.lock().unwrap_or_else(|e| e.into_inner()) = stage;
                waker.wake();
            }
            !shared.cancelled.load(Ordering::Relaxed)
        };
        let read = std::panic::AssertUnwindSafe(|| read_source(&source, &progress));
        // A defect in a reader must not take the window, and what is open in it, down.
        let result = std::panic::catch_unwind(read).unwrap_or_else(|_| {
            Err(LoadError::Read {
                path,
                message: "internal error while reading; please report this file".into(),
            })
        });
        // The receiver is gone only when the program ends.
        let _ = sender.send(result);
        waker.wake();
    });
    if let Err(error) = spawned {
        let message = format!("cannot start a thread: {error}");
        let _ = for_failure.send(Err(LoadError::Read { path: name.clone().into(), message }));
    }
    Worker { name, replaces, shared, result: Mutex::new(receiver) }
}

/// Takes what the worker delivered: spawns the models or says what went wrong.
pub(super) fn finish(
    mut loading: ResMut<Loading>,
    mut commands: Commands,
    mut spawn: Spawn,
    mut notices: ResMut<Notices>,
    waker: Res<Waker>,
) {
    let Some(worker) = &loading.active else { return };
    let received = worker.result.lock().unwrap_or_else(|e| e.into_inner()).try_recv();
    let result = match received {
        Ok(result) => result,
        Err(mpsc::TryRecvError::Empty) => return,
        Err(mpsc::TryRecvError::Disconnected) => Err(LoadError::Cancelled),
    };
    let replaces = worker.replaces;
    let name = worker.name.clone();
    loading.active = None;
    waker.wake();
    match result {
        Ok(_) if replaces.is_some_and(|revision| revision != spawn.editing.revision()) => {
            notices.error(format!("{name} was not opened: the scene was edited while it was being read"));
        }
        Ok(loaded) => {
            for model in &loaded.models {
                notices.imported(&name, &model.report);
            }
            spawn.enter(&mut commands, loaded, &name, replaces.is_some(), &mut notices);
        }
        Err(LoadError::Cancelled) => notices.info(format!("{name}: loading cancelled")),
        Err(error) => notices.error(error.to_string()),
    }
}

/// What changes when a file is opened.
#[derive(SystemParam)]
pub(super) struct Spawn<'w> {
    scene: ResMut<'w, Scene>,
    settings: ResMut<'w, Settings>,
    editing: ResMut<'w, Editing>,
    file: ResMut<'w, DocumentFile>,
    recovery: ResMut<'w, Recovery>,
    camera: MessageWriter<'w, CameraRequest>,
}

impl Spawn<'_> {
    fn enter(
        &mut self,
        commands: &mut Commands,
        loaded: LoadedScene,
        name: &str,
        replace: bool,
        notices: &mut Notices,
    ) {
        let path = loaded.models.iter().find_map(|m| m.path.clone());
        let path = path.or(loaded.file.as_ref().map(|f| f.path.clone()));
        if replace {
            self.recovery.forget(&self.file);
            close_all(commands, &mut self.scene);
            self.editing.start_over();
            self.file.start_over();
        } else {
            let records = loaded.models.iter().map(|m| m.record.clone()).collect();
            let change = Change::Models { at: self.scene.models.len(), before: Vec::new(), after: records };
            self.editing.enter(Edit::new(format!("Import {name}"), vec![change]));
        }
        for model in loaded.models {
            spawn_model(commands, &mut self.scene, model);
        }
        let recovered = path.as_ref().and_then(|path| self.recovery.take_recovering(path));
        match loaded.file.filter(|_| replace) {
            Some(file) => {
                let SceneFile { path, scene, fingerprint } = file;
                let (settings, document) = (&mut self.settings, &mut self.file);
                restore(&scene, &self.scene, commands, settings, document, &mut self.camera);
                (self.file.path, self.file.fingerprint) = (Some(path), Some(fingerprint));
            }
            None => {
                self.camera.write(CameraRequest::FitNew);
            }
        }
        if let Some(copy) = recovered {
            // It belongs to the file that it is a copy of, as that is now, and is not saved there.
            let original = copy.note.path;
            self.file.fingerprint = original.as_deref().and_then(|path| Fingerprint::of_file(path).ok());
            self.file.path = original;
            self.file.recovered = Some(copy.file);
            self.editing.touch();
            notices.info(format!("Recovered {}; it is not saved yet", copy.note.name));
        } else if let Some(path) = path {
            super::remember(&mut self.settings, &path);
        }
    }
}
