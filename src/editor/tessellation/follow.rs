//! Keeping the tessellation true to the scene while it is shown.
//!
//! One thread works at a time. Other options or another scene call it off; an edit lets it finish, and what the edit
//! touched is made again afterwards, so that a drag shows triangles that follow instead of none.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use bevy::prelude::*;
use glam::DVec3;

use super::job::{Order, Said, Worker};
use super::made::{Faces, Made, Task};
use super::{TessellationRequest, TessellationView};
use crate::editor::camera::{CameraRequest, ViewCamera};
use crate::editor::object::{DerivedFace, FaceChange, Model, Scene};
use crate::editor::redraw::Waker;
use crate::editor::settings::Settings;
use crate::kernel::tessellate::TessellateError;
use crate::kernel::view::Bounds;

/// Triangles that are made unasked.
const LIMIT: usize = 1_000_000;
/// Height of what is seen when flying to the largest deviation: this many times it, and a part of the model at least
/// and at most.
const CLOSE_UP: f64 = 60.0;
const CLOSEST: f64 = 1e-3;
const FARTHEST: f64 = 0.3;

/// Why nothing is made.
#[derive(Debug, Clone, PartialEq)]
pub enum Stop {
    /// The user said so.
    Cancelled,
    /// It would take more triangles than this.
    TooMany(usize),
    /// Something else.
    Failed(String),
}

/// How far it is.
#[derive(Debug, Clone, PartialEq)]
pub enum Progress {
    /// Nothing is asked for.
    Off,
    /// Triangles are made; the part done.
    Meshing(f32),
    /// They are measured; the part done.
    Measuring(f32),
    /// All is there.
    Ready,
    /// There is nothing of what was asked for.
    Stopped(Stop),
}

/// The tessellation of everything open.
#[derive(Resource)]
pub struct Tessellation {
    made: Option<Arc<Made>>,
    worker: Option<Worker>,
    stopped: Option<(Option<Task>, Stop)>,
    /// Counts changes of faces.
    edits: u64,
    /// Revision of the scene, diagonal of its faces and millimetres of its unit.
    size: Option<(u64, f64, f64)>,
    limit: usize,
    wanted: Option<Task>,
    /// Counts changes of what is made.
    pub revision: u64,
}

impl Default for Tessellation {
    fn default() -> Self {
        Self {
            made: None,
            worker: None,
            stopped: None,
            edits: 0,
            size: None,
            limit: LIMIT,
            wanted: None,
            revision: 0,
        }
    }
}

impl Tessellation {
    /// What there is, perhaps of faces as they were a moment ago.
    pub fn made(&self) -> Option<&Arc<Made>> {
        self.made.as_ref()
    }

    /// What there is, if nothing has changed since.
    pub fn current(&self) -> Option<&Arc<Made>> {
        self.made.as_ref().filter(|made| self.wanted.as_ref() == Some(&made.task))
    }

    /// Diagonal of the faces, millimetres.
    pub fn size_mm(&self) -> f64 {
        self.size.map_or(0.0, |(_, size, unit)| size * unit)
    }

    /// Triangles that are allowed.
    pub fn limit(&self) -> usize {
        self.limit
    }

    /// How far it is.
    pub fn progress(&self) -> Progress {
        if let Some(worker) = &self.worker {
            let part = worker.shared.progress.load(Ordering::Relaxed) as f32 / 1000.0;
            return match worker.shared.measuring.load(Ordering::Acquire) {
                true => Progress::Measuring(part),
                false => Progress::Meshing(part),
            };
        }
        match (&self.stopped, &self.wanted) {
            (Some((_, stop)), _) => Progress::Stopped(stop.clone()),
            (None, None) => Progress::Off,
            (None, Some(_)) => Progress::Ready,
        }
    }

    /// Takes what the thread says.
    fn collect(&mut self) {
        let Some(worker) = &self.worker else { return };
        let said: Vec<Said> = worker.said.lock().unwrap_or_else(|e| e.into_inner()).try_iter().collect();
        for said in said {
            let stop = match said {
                Said::Made(made) => {
                    self.made = Some(made);
                    self.revision += 1;
                    continue;
                }
                Said::Done => {
                    self.worker = None;
                    continue;
                }
                Said::Failed(TessellateError::TooManyTriangles { limit }) => Stop::TooMany(limit),
                Said::Failed(TessellateError::Cancelled) => Stop::Cancelled,
                Said::Failed(error) => Stop::Failed(error.to_string()),
                Said::Broken => Stop::Failed("internal error while meshing".into()),
            };
            self.stop(stop);
        }
    }

    fn stop(&mut self, stop: Stop) {
        let task = self.worker.take().map(|w| w.task.clone()).or_else(|| self.wanted.clone());
        self.stopped = Some((task, stop));
    }

    fn drop_made(&mut self) {
        if self.made.take().is_some() {
            self.revision += 1;
        }
    }
}

/// What panels ask for.
pub(super) fn serve(
    mut requests: MessageReader<TessellationRequest>,
    mut state: ResMut<Tessellation>,
    mut settings: ResMut<Settings>,
    mut flights: MessageWriter<CameraRequest>,
    camera: Res<ViewCamera>,
) {
    for request in requests.read() {
        match request {
            TessellationRequest::Choose(choices) => settings.tessellation = choices.clone(),
            TessellationRequest::Cancel => {
                if state.worker.is_some() {
                    state.stop(Stop::Cancelled);
                }
            }
            TessellationRequest::Again => state.stopped = None,
            TessellationRequest::Allow(limit) => (state.limit, state.stopped) = (*limit, None),
            TessellationRequest::ShowLargest => {
                flights.write_batch(state.made.as_ref().and_then(|made| close_up(made, &state, &camera)));
            }
            TessellationRequest::Export(_) => {}
        }
    }
}

/// Straight at the largest deviation, from the side that is seen now.
fn close_up(made: &Made, state: &Tessellation, camera: &ViewCamera) -> Option<CameraRequest> {
    let largest = made.figures.largest?;
    let model = state.size.map(|(_, size, _)| size).filter(|s| *s > 0.0)?;
    let away = camera.now.eye - camera.now.target;
    let normal = if largest.normal.dot(away) < 0.0 { -largest.normal } else { largest.normal };
    // A little from the side, so that the distance between triangle and surface shows.
    let up = if normal.z.abs() < 0.9 { DVec3::Z } else { DVec3::Y };
    let across = normal.cross(up).normalize_or(DVec3::X);
    let back = (normal + 0.8 * across).normalize_or(normal);
    let size = (CLOSE_UP * largest.mm / made.unit_mm).clamp(CLOSEST * model, FARTHEST * model);
    Some(CameraRequest::Approach { point: largest.place, direction: -back, up, size })
}

/// Starts, restarts and calls off the work.
pub(super) fn follow(
    settings: Res<Settings>,
    scene: Res<Scene>,
    faces: Query<&DerivedFace>,
    models: Query<&Model>,
    waker: Res<Waker>,
    mut changes: MessageReader<FaceChange>,
    mut state: ResMut<Tessellation>,
) {
    let state = &mut *state;
    if changes.read().any(|change| matches!(change, FaceChange::Derived(_) | FaceChange::Removed(_))) {
        state.edits += 1;
    }
    let on = settings.tessellation.view != TessellationView::Off && !scene.is_empty();
    if state.made.as_ref().is_some_and(|made| made.task.scene != scene.revision) {
        state.drop_made();
    }
    if !on {
        (state.worker, state.stopped, state.wanted) = (None, None, None);
        return;
    }
    state.collect();
    let (size, unit) = match state.size {
        Some((revision, size, unit)) if revision == scene.revision => (size, unit),
        _ => {
            let bounds = scene.models.iter().flat_map(|m| &m.order).filter_map(|f| faces.get(*f).ok());
            let bounds = bounds.fold(Bounds::EMPTY, |all, f| all.union(f.0.bounds));
            let size = if bounds.is_empty() { 0.0 } else { bounds.diagonal() };
            let unit = scene.models.first().and_then(|m| models.get(m.entity).ok());
            let unit = unit.map_or(1.0, |m| m.unit.millimetres);
            state.size = Some((scene.revision, size, unit));
            state.limit = LIMIT;
            (size, unit)
        }
    };
    let options = match settings.tessellation.options(size * unit, unit, state.limit) {
        Ok(options) => options,
        Err(error) => {
            (state.worker, state.wanted) = (None, None);
            state.stopped = Some((None, Stop::Failed(error.to_string())));
            return;
        }
    };
    let task = Task { scene: scene.revision, edits: state.edits, options };
    // What is only measured any more is there already: the next run takes it over.
    let obsolete = |worker: &Worker| {
        let measuring = worker.shared.measuring.load(Ordering::Acquire);
        !worker.task.differs_by_edits(&task) || measuring && worker.task != task
    };
    if state.worker.as_ref().is_some_and(obsolete) {
        state.collect();
        state.worker = None;
    }
    if state.stopped.as_ref().is_some_and(|(of, _)| of.as_ref() != Some(&task)) {
        state.stopped = None;
    }
    let is_made = state.made.as_ref().is_some_and(|made| {
        made.task == task && (made.figures.measure_time.is_some() || state.worker.is_some())
    });
    state.wanted = Some(task.clone());
    if state.worker.is_some() || state.stopped.is_some() || is_made {
        return;
    }
    let entities: Vec<Entity> = scene.models.iter().flat_map(|m| &m.order).copied().collect();
    let derived = entities.iter().map(|f| faces.get(*f).ok().map(|d| Arc::clone(&d.0))).collect();
    let previous = state.made.clone().filter(|made| made.task.differs_by_edits(&task));
    let order = Order { task, faces: Faces { entities, derived }, unit_mm: unit, previous };
    match Worker::start(order, waker.clone()) {
        Ok(worker) => state.worker = Some(worker),
        Err(error) => state.stop(Stop::Failed(format!("cannot start a thread: {error}"))),
    }
}
