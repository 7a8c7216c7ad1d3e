//! Areas and exact boxes, worked out on a thread of their own after the faces are on the screen.
//!
//! One thread at a time takes faces from a queue. While a face is being dragged it is put off until it rests:
//! a version that is already replaced is gone when its turn comes.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

use bevy::prelude::*;

use super::Derived;
use crate::editor::object::{DerivedFace, FaceChange};
use crate::editor::redraw::Waker;

/// The panels are told of new measures this often.
const TELL: Duration = Duration::from_millis(700);

/// Faces that wait, and whether a thread works on them.
#[derive(Resource, Debug, Clone, Default)]
pub(super) struct Measurer(Arc<Mutex<Queue>>);

#[derive(Debug, Default)]
struct Queue {
    waiting: VecDeque<Weak<Derived>>,
    running: bool,
}

impl Measurer {
    fn next(&self) -> Option<Weak<Derived>> {
        let mut queue = self.0.lock().unwrap_or_else(|e| e.into_inner());
        let next = queue.waiting.pop_front();
        queue.running = next.is_some();
        next
    }
}

/// Queues the faces derived since the last frame and starts a thread if there is none.
pub(super) fn start(
    mut changes: MessageReader<FaceChange>,
    faces: Query<&DerivedFace>,
    measurer: Res<Measurer>,
    waker: Res<Waker>,
) {
    if changes.is_empty() {
        return;
    }
    let derived = changes.read().filter_map(|change| match change {
        FaceChange::Derived(face) => faces.get(*face).ok().map(|f| Arc::downgrade(&f.0)),
        _ => None,
    });
    let start = {
        let mut queue = measurer.0.lock().unwrap_or_else(|e| e.into_inner());
        queue.waiting.extend(derived);
        let start = !queue.running && !queue.waiting.is_empty();
        queue.running |= start;
        start
    };
    if start {
        let (measurer, waker) = (measurer.clone(), waker.clone());
        let run = move || measure_all(&measurer, &waker);
        if let Err(error) = std::thread::Builder::new().name("hairline-measure".into()).spawn(run) {
            warn!("areas are not worked out: cannot start a thread: {error}");
        }
    }
}

fn measure_all(measurer: &Measurer, waker: &Waker) {
    let mut told = Instant::now();
    while let Some(waiting) = measurer.next() {
        let Some(derived) = waiting.upgrade() else { continue };
        // A defect in measuring costs the figure, not the program.
        let measured = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| derived.measure()));
        if measured.is_ok() && told.elapsed() > TELL {
            waker.wake();
            told = Instant::now();
        }
    }
    waker.wake();
}
