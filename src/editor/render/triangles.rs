//! The second renderer in the editor: triangles of the faces in sight, made in the background at the level that the view
//! asks for, and drawn while rays would be too slow.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, mpsc};

use bevy::prelude::*;

use super::faces::RenderFaces;
use crate::editor::derive::Derived;
use crate::editor::redraw::Waker;
use crate::encoding::bisection::SortedMesh;
use crate::encoding::mesh::{build, wanted};
use crate::encoding::{FaceSlot, LevelView, MeshScene};

/// Error on the screen, pixels.
const ERROR_PX: f64 = 0.5;
/// Faces worked on at a time: what is asked for later, by a view that has moved on, waits no longer than these take.
const MOST_UNDER_WAY: usize = 32;
/// Vertices kept, of the levels of past views too.
const MOST_VERTICES: usize = 4_000_000;

struct Built {
    slot: FaceSlot,
    level: i32,
    of: Arc<Derived>,
    mesh: Option<SortedMesh>,
}

/// Triangles in the render world.
#[derive(Resource)]
pub(super) struct RenderTriangles {
    pub scene: MeshScene,
    under_way: BTreeSet<(FaceSlot, i32)>,
    sender: mpsc::Sender<Built>,
    results: Mutex<mpsc::Receiver<Built>>,
}

impl Default for RenderTriangles {
    fn default() -> Self {
        let (sender, receiver) = mpsc::channel();
        Self {
            scene: MeshScene::default(),
            under_way: BTreeSet::new(),
            sender,
            results: Mutex::new(receiver),
        }
    }
}

impl RenderTriangles {
    /// Drops what was made of faces that changed.
    pub fn forget(&mut self, slots: impl IntoIterator<Item = FaceSlot>) {
        slots.into_iter().for_each(|slot| self.scene.forget(slot));
    }

    /// Selects what `view` needs and asks for what is lacking. Gives the faces to be cast beside the triangles, or
    /// nothing while other faces in sight have no triangles yet.
    pub fn prepare(&mut self, faces: &RenderFaces, view: &LevelView, waker: &Waker) -> Option<Vec<FaceSlot>> {
        self.collect(faces);
        let list: Vec<_> = wanted(&faces.packed, view, ERROR_PX).collect();
        for (slot, level) in &list {
            if !self.scene.knows(*slot, *level) {
                self.ask(faces, *slot, *level, waker);
            }
        }
        let lacking = self.scene.select(list.iter().copied());
        self.scene.trim_to(MOST_VERTICES);
        let level_of = |slot: &FaceSlot| list.iter().find(|(s, _)| s == slot).map(|(_, level)| *level);
        let known = |slot: &FaceSlot| level_of(slot).is_some_and(|level| self.scene.knows(*slot, level));
        lacking.iter().all(known).then_some(lacking)
    }

    fn collect(&mut self, faces: &RenderFaces) {
        let results = self.results.lock().unwrap_or_else(|e| e.into_inner());
        for built in results.try_iter() {
            self.under_way.remove(&(built.slot, built.level));
            let current = faces.derived(built.slot).is_some_and(|now| Arc::ptr_eq(now, &built.of));
            if let Some(face) = built.of.face.as_deref().filter(|_| current) {
                self.scene.take(built.slot, built.level, face, built.mesh.as_ref());
            }
        }
    }

    fn ask(&mut self, faces: &RenderFaces, slot: FaceSlot, level: i32, waker: &Waker) {
        let Some(of) = faces.derived(slot).cloned() else { return };
        if self.under_way.len() >= MOST_UNDER_WAY || !self.under_way.insert((slot, level)) {
            return;
        }
        let (sender, waker) = (self.sender.clone(), waker.clone());
        rayon::spawn(move || {
            let mesh = of.face.as_deref().and_then(|face| build(face, level));
            // Fails only when the program ends.
            let _ = sender.send(Built { slot, level, of, mesh });
            waker.wake();
        });
    }
}
