//! What was measured, and the thread that measures a whole scene.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, mpsc};

use bevy::ecs::entity::EntityHashMap;
use bevy::prelude::*;

use crate::editor::object::FaceParts;
use crate::editor::redraw::Waker;
use crate::inspect::{Edge, EdgeKey, Inspection, Statistics};

/// The edges of everything open, once they are measured.
#[derive(Resource, Default)]
pub struct Findings {
    inspection: Option<Arc<Inspection>>,
    /// Faces by their number in the inspection.
    faces: Vec<Entity>,
    numbers: EntityHashMap<usize>,
    /// Revision of the scene that the faces are of.
    pub(super) scene: Option<u64>,
    worker: Option<Worker>,
    /// Faces measured again since the lines were made; none: all of them.
    dirty: Option<BTreeSet<usize>>,
    statistics: Statistics,
    /// Millimetres of a model unit; 0 before the first measurement.
    unit_mm: f64,
    /// Counts changes of the edges.
    pub revision: u64,
    failure: Option<String>,
}

/// How far the inspection is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Progress {
    /// Nothing was asked for.
    Off,
    /// The scene is being measured.
    Measuring,
    /// The edges are there.
    Ready,
    /// It cannot be done.
    Failed(String),
}

struct Worker {
    faces: Vec<Entity>,
    scene: u64,
    result: Mutex<mpsc::Receiver<Inspection>>,
    /// Faces that changed meanwhile.
    changed: Vec<Entity>,
}

impl Findings {
    /// How far it is.
    pub fn progress(&self) -> Progress {
        match (&self.failure, &self.worker, &self.inspection) {
            (Some(text), ..) => Progress::Failed(text.clone()),
            (_, Some(_), _) => Progress::Measuring,
            (_, _, Some(_)) => Progress::Ready,
            _ => Progress::Off,
        }
    }

    /// The edges; none before the first measurement.
    pub fn inspection(&self) -> Option<&Inspection> {
        self.inspection.as_deref()
    }

    /// The edges, to be looked at on a thread. What is measured meanwhile does not change them.
    pub fn shared_inspection(&self) -> Option<Arc<Inspection>> {
        self.inspection.clone()
    }

    /// An edge.
    pub fn edge(&self, key: &EdgeKey) -> Option<&Edge> {
        self.inspection.as_ref()?.edge(key)
    }

    /// Millimetres of a model unit.
    pub fn unit(&self) -> f64 {
        if self.unit_mm > 0.0 { self.unit_mm } else { 1.0 }
    }

    /// Counts and gaps of all edges, in millimetres.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// The face with a number of the inspection.
    pub fn face(&self, number: usize) -> Option<Entity> {
        self.faces.get(number).copied()
    }

    /// The number of a face in the inspection.
    pub fn number(&self, face: Entity) -> Option<usize> {
        self.numbers.get(&face).copied()
    }

    /// Forgets everything: the scene changed, or the inspection was switched off.
    pub(super) fn clear(&mut self) {
        let revision = self.revision + 1;
        *self = Self { revision, ..Self::default() };
    }

    /// Starts measuring `faces`; what was measured before stays until the new result is there.
    pub(super) fn start(&mut self, scene: u64, faces: Vec<(Entity, FaceParts)>, unit: f64, waker: &Waker) {
        self.scene = Some(scene);
        self.failure = None;
        self.unit_mm = unit;
        let (entities, parts): (Vec<Entity>, Vec<FaceParts>) = faces.into_iter().unzip();
        let (send, result) = mpsc::channel();
        let waker = waker.clone();
        let parts = Arc::new(parts);
        let spawned = std::thread::Builder::new().name("hairline-inspect".into()).spawn(move || {
            let records: Vec<_> = parts.iter().map(FaceParts::to_record).collect();
            drop(parts);
            // A defect in measuring costs the figures, not the program.
            let inspected = std::panic::catch_unwind(|| Inspection::in_unit(&records, unit));
            if let Ok(inspection) = inspected {
                // Fails only when nobody waits any more.
                let _ = send.send(inspection);
            }
            drop(send);
            waker.wake();
        });
        match spawned {
            Ok(_) => {
                self.worker =
                    Some(Worker { faces: entities, scene, result: Mutex::new(result), changed: Vec::new() });
            }
            Err(error) => self.failure = Some(format!("cannot start a thread: {error}")),
        }
    }

    /// Notes that a face changed while a measurement runs.
    pub(super) fn note(&mut self, face: Entity) {
        if let Some(worker) = &mut self.worker {
            worker.changed.push(face);
        }
    }

    /// Takes a finished measurement; gives the faces that changed since it began.
    pub(super) fn collect(&mut self) -> Option<Vec<Entity>> {
        let worker = self.worker.as_ref()?;
        let result = worker.result.lock().unwrap_or_else(|e| e.into_inner()).try_recv();
        match result {
            Ok(inspection) => {
                let worker = self.worker.take()?;
                self.numbers = worker.faces.iter().enumerate().map(|(k, f)| (*f, k)).collect();
                self.faces = worker.faces;
                self.scene = Some(worker.scene);
                self.inspection = Some(Arc::new(inspection));
                self.dirty = None;
                self.settle();
                Some(worker.changed)
            }
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => {
                self.worker = None;
                self.inspection = None;
                self.failure = Some("measuring failed on this model".into());
                self.settle();
                None
            }
        }
    }

    /// Measures the edges of one face again.
    pub(super) fn update(&mut self, face: Entity, parts: &FaceParts) {
        let Some(number) = self.number(face) else { return };
        if let Some(inspection) = &mut self.inspection {
            Arc::make_mut(inspection).update(number, &parts.to_record());
            if let Some(dirty) = &mut self.dirty {
                dirty.insert(number);
            }
        }
    }

    /// Whether a face was measured again since [`Self::clean`].
    pub(super) fn is_dirty(&self, number: usize) -> bool {
        self.dirty.as_ref().is_none_or(|dirty| dirty.contains(&number))
    }

    /// What was made from the faces is up to date.
    pub(super) fn clean(&mut self) {
        self.dirty = Some(BTreeSet::new());
    }

    /// Counts again after edges changed.
    pub(super) fn settle(&mut self) {
        self.statistics = self.inspection.as_deref().map(Statistics::of).unwrap_or_default();
        self.statistics.scale(self.unit());
        self.revision += 1;
    }
}
