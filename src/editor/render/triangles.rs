//! The second renderer in the editor: triangles of the faces in sight, made in the background at the level that the view
//! asks for, and drawn while rays would be too slow.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, mpsc};

use bevy::prelude::*;

use super::faces::RenderFaces;
use crate::editor::derive::Derived;
use crate::editor::redraw::Waker;
use crate::encoding::mesh::{Selection, Want};
use crate::encoding::piece_mesh::{Built, build};
use crate::encoding::{FaceSlot, LevelView, MeshScene};

/// Error on the screen, pixels.
const ERROR_PX: f64 = 0.5;
/// Pieces of faces worked on at a time: what is asked for later, by a view that has moved on, waits no longer than these take.
const MOST_UNDER_WAY: usize = 32;
/// Vertices kept, of the levels of past views too.
const MOST_VERTICES: usize = 4_000_000;

struct Done {
    want: Want,
    of: Arc<Derived>,
    built: Built,
}

/// Triangles in the render world.
#[derive(Resource)]
pub(super) struct RenderTriangles {
    pub scene: MeshScene,
    under_way: BTreeSet<(FaceSlot, u32, i32)>,
    sender: mpsc::Sender<Done>,
    results: Mutex<mpsc::Receiver<Done>>,
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
        let Selection { cast, complete, wanted } = self.scene.select(&faces.packed, view, ERROR_PX);
        wanted.iter().for_each(|want| self.ask(faces, want, waker));
        self.scene.trim_to(MOST_VERTICES);
        complete.then_some(cast)
    }

    fn collect(&mut self, faces: &RenderFaces) {
        let results = self.results.lock().unwrap_or_else(|e| e.into_inner());
        for Done { want, of, built } in results.try_iter() {
            self.under_way.remove(&want.key());
            if faces.derived(want.slot).is_some_and(|now| Arc::ptr_eq(now, &of)) {
                self.scene.take(&want, built);
            }
        }
    }

    fn ask(&mut self, faces: &RenderFaces, want: &Want, waker: &Waker) {
        let Some(of) = faces.derived(want.slot).cloned() else { return };
        if self.under_way.len() >= MOST_UNDER_WAY || !self.under_way.insert(want.key()) {
            return;
        }
        let (sender, waker, want) = (self.sender.clone(), waker.clone(), *want);
        rayon::spawn(move || {
            let built = of.face.as_deref().map_or(Built::Nothing, |face| build(face, &want));
            // Fails only when the program ends.
            let _ = sender.send(Done { want, of, built });
            waker.wake();
        });
    }
}
