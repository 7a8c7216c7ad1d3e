//! The worker thread that reads files while the window stays alive.
//!
//! One worker at a time; later requests wait in a queue. The worker reports through an atomic fraction and
//! a channel, wakes the window when there is something to show, and stops soon after it is cancelled.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, mpsc};

use bevy::prelude::*;

use super::{LoadError, OpenFiles, Source, read_model};
use crate::editor::camera::CameraRequest;
use crate::editor::editing::Editing;
use crate::editor::object::{LoadedModel, Scene, despawn_model, spawn_model};
use crate::editor::panels::Notices;
use crate::editor::redraw::Waker;
use crate::editor::settings::Settings;
use crate::editor::tools::{Action, CommandRequest};

/// What is being read.
#[derive(Resource, Default)]
pub struct Loading {
    queue: VecDeque<(Source, bool)>,
    active: Option<Worker>,
}

struct Worker {
    name: String,
    replace: bool,
    shared: Arc<Shared>,
    result: Mutex<mpsc::Receiver<Result<LoadedModel, LoadError>>>,
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

/// Demo, cancel and close from the command table.
pub(super) fn command_requests(
    mut requests: MessageReader<CommandRequest>,
    mut open: MessageWriter<OpenFiles>,
    mut loading: ResMut<Loading>,
    mut scene: ResMut<Scene>,
    mut editing: ResMut<Editing>,
    mut commands: Commands,
) {
    for CommandRequest(action) in requests.read() {
        match action {
            Action::OpenDemo => {
                open.write(OpenFiles { sources: vec![Source::Demo], replace: true });
            }
            Action::Cancel => loading.cancel(),
            Action::CloseAll => {
                close_all(&mut commands, &mut scene);
                editing.start_over();
            }
            _ => {}
        }
    }
}

fn close_all(commands: &mut Commands, scene: &mut Scene) {
    let open: Vec<Entity> = scene.models.iter().map(|m| m.entity).collect();
    for model in open {
        despawn_model(commands, scene, model);
    }
}

/// Queues requests and starts the worker when it is free.
pub(super) fn start(mut requests: MessageReader<OpenFiles>, mut loading: ResMut<Loading>, waker: Res<Waker>) {
    for request in requests.read() {
        let sources = request.sources.iter().cloned();
        // Only the first file of a request replaces; the others join it.
        loading.queue.extend(sources.enumerate().map(|(i, s)| (s, request.replace && i == 0)));
    }
    if loading.active.is_none()
        && let Some((source, replace)) = loading.queue.pop_front()
    {
        loading.active = Some(spawn_worker(source, replace, waker.clone()));
    }
}

fn spawn_worker(source: Source, replace: bool, waker: Waker) -> Worker {
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
        let read = std::panic::AssertUnwindSafe(|| read_model(&source, &progress));
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
    Worker { name, replace, shared, result: Mutex::new(receiver) }
}

/// Takes what the worker delivered: spawns the model or says what went wrong.
pub(super) fn finish(
    mut loading: ResMut<Loading>,
    mut scene: ResMut<Scene>,
    mut commands: Commands,
    mut settings: ResMut<Settings>,
    mut editing: ResMut<Editing>,
    mut notices: ResMut<Notices>,
    mut camera: MessageWriter<CameraRequest>,
    waker: Res<Waker>,
) {
    let Some(worker) = &loading.active else { return };
    let received = worker.result.lock().unwrap_or_else(|e| e.into_inner()).try_recv();
    let result = match received {
        Ok(result) => result,
        Err(mpsc::TryRecvError::Empty) => return,
        Err(mpsc::TryRecvError::Disconnected) => Err(LoadError::Cancelled),
    };
    let replace = worker.replace;
    let name = worker.name.clone();
    loading.active = None;
    waker.wake();
    match result {
        Ok(model) => {
            if replace {
                close_all(&mut commands, &mut scene);
                editing.start_over();
            } else {
                editing.touch();
            }
            if let Some(path) = &model.path {
                super::remember(&mut settings, path);
            }
            notices.imported(&name, &model.report);
            spawn_model(&mut commands, &mut scene, model);
            camera.write(CameraRequest::FitNew);
        }
        Err(LoadError::Cancelled) => notices.info(format!("{name}: loading cancelled")),
        Err(error) => notices.error(error.to_string()),
    }
}
