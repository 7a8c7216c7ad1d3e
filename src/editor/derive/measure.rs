//! Areas and exact boxes, worked out on a thread of their own after the faces are on the screen.

use std::sync::{Arc, Weak};
use std::time::{Duration, Instant};

use bevy::prelude::*;

use super::Derived;
use crate::editor::object::DerivedFace;
use crate::editor::redraw::Waker;

/// The panels are told of new measures this often.
const TELL: Duration = Duration::from_millis(700);

/// Starts a thread for the faces derived since the last frame. Faces closed in the meantime are skipped.
pub(super) fn start(faces: Query<&DerivedFace, Changed<DerivedFace>>, waker: Res<Waker>) {
    if faces.is_empty() {
        return;
    }
    let waiting: Vec<Weak<Derived>> = faces.iter().map(|f| Arc::downgrade(&f.0)).collect();
    let waker = waker.clone();
    let spawned = std::thread::Builder::new().name("hairline-measure".into()).spawn(move || {
        let mut told = Instant::now();
        for derived in waiting.iter().filter_map(Weak::upgrade) {
            // A defect in measuring costs the figure, not the program.
            let measured = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| derived.measure()));
            if measured.is_err() {
                continue;
            }
            if told.elapsed() > TELL {
                waker.wake();
                told = Instant::now();
            }
        }
        waker.wake();
    });
    if let Err(error) = spawned {
        warn!("areas are not worked out: cannot start a thread: {error}");
    }
}
