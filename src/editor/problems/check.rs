//! Checking the faces that changed: at once, or on a thread with the latest version winning.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use bevy::prelude::*;

use super::{FaceProblems, Found, ProblemList};
use crate::editor::object::{DerivedFace, FaceChange, FaceParts, Records};
use crate::editor::redraw::Waker;
use crate::kernel::trim::validity::{LoopProblem, Memory};

/// With at most this many curves to be checked, faces are checked in the frame in which they change.
const SMALL: usize = 1000;
/// Of more faces than this that change in one frame all go to the thread.
const FEW: usize = 4;
/// What the thread found is shown this often while it goes on.
const TELL: Duration = Duration::from_millis(500);

/// Faces on their way to the thread and back.
#[derive(Resource, Debug, Clone, Default)]
pub(super) struct Checker(Arc<Mutex<Queue>>);

#[derive(Debug, Default)]
struct Queue {
    waiting: VecDeque<(Entity, FaceParts)>,
    done: Vec<(Entity, FaceParts, Vec<LoopProblem>)>,
    /// The face checked last, as it was then: of it only what changed since is checked.
    memory: Option<(Entity, Memory)>,
    running: bool,
}

impl Checker {
    fn lock(&self) -> std::sync::MutexGuard<'_, Queue> {
        self.0.lock().unwrap_or_else(|e| e.into_inner())
    }

    fn next(&self) -> Option<(Entity, FaceParts)> {
        let mut queue = self.lock();
        let next = queue.waiting.pop_front();
        queue.running = next.is_some();
        next
    }
}

fn check(parts: &FaceParts, memory: &mut Memory) -> Vec<LoopProblem> {
    // A defect in checking costs the marks, not the program.
    let checked = std::panic::AssertUnwindSafe(|| memory.check(&parts.surface, &parts.loops));
    let result = std::panic::catch_unwind(checked);
    if result.is_err() {
        *memory = Memory::default();
    }
    result.unwrap_or_default()
}

impl Checker {
    /// What is remembered of a face; it is put back when it was checked.
    fn take_memory(&self, face: Entity) -> Memory {
        let kept = self.lock().memory.take_if(|(of, _)| *of == face);
        kept.map_or_else(Memory::default, |(_, memory)| memory)
    }

    fn keep_memory(&self, face: Entity, memory: Memory) {
        self.lock().memory = Some((face, memory));
    }
}

/// Checks what changed, or queues it.
pub(super) fn start(
    mut changes: MessageReader<FaceChange>,
    checker: Res<Checker>,
    records: Records,
    mut publish: Publish,
    waker: Res<Waker>,
) {
    if changes.is_empty() {
        return;
    }
    let mut changed = Vec::new();
    for change in changes.read() {
        match *change {
            FaceChange::Derived(face) => changed.push(face),
            FaceChange::Removed(face) => publish.list.set(face, None),
            FaceChange::Shown(_) => {}
        }
    }
    changed.sort_unstable();
    changed.dedup();
    let few = changed.len() <= FEW;
    let mut queue = Vec::new();
    for face in changed {
        let Some(parts) = records.parts(face) else { continue };
        // Many at once are not being dragged: nothing is worth remembering of them.
        let mut memory = if few { checker.take_memory(face) } else { Memory::default() };
        let at_once = few && memory.curves_to_check(&parts.surface, &parts.loops) <= SMALL;
        if at_once {
            publish.face(face, check(&parts, &mut memory));
        }
        if few {
            checker.keep_memory(face, memory);
        }
        if !at_once {
            queue.push((face, parts));
        }
    }
    if queue.is_empty() {
        return;
    }
    let start = {
        let mut shared = checker.lock();
        // A version that still waits is replaced by the new one.
        if few {
            shared.waiting.retain(|(face, _)| !queue.iter().any(|(other, _)| other == face));
        }
        shared.waiting.extend(queue);
        !std::mem::replace(&mut shared.running, true)
    };
    if start {
        let (checker, waker) = (checker.clone(), waker.clone());
        let run = move || check_all(&checker, &waker);
        if let Err(error) = std::thread::Builder::new().name("hairline-check".into()).spawn(run) {
            warn!("loops are not checked: cannot start a thread: {error}");
        }
    }
}

fn check_all(checker: &Checker, waker: &Waker) {
    let mut told = Instant::now();
    while let Some((face, parts)) = checker.next() {
        let mut memory = checker.take_memory(face);
        let found = check(&parts, &mut memory);
        checker.keep_memory(face, memory);
        checker.lock().done.push((face, parts, found));
        if told.elapsed() > TELL {
            waker.wake();
            told = Instant::now();
        }
    }
    waker.wake();
}

/// Where findings go.
#[derive(bevy::ecs::system::SystemParam)]
pub(super) struct Publish<'w, 's> {
    commands: Commands<'w, 's>,
    list: ResMut<'w, ProblemList>,
    faces: Query<'w, 's, (Option<&'static FaceProblems>, Option<&'static DerivedFace>)>,
}

impl Publish<'_, '_> {
    fn face(&mut self, face: Entity, problems: Vec<LoopProblem>) {
        let Ok((before, derived)) = self.faces.get(face) else { return };
        let failure = derived.and_then(|d| d.0.failure.clone());
        let before = before.map_or(&[][..], |b| &b.0);
        if problems.is_empty() && before.is_empty() && failure.is_none() && self.list.faces.is_empty() {
            return;
        }
        let loops: Arc<[LoopProblem]> = problems.into();
        if loops.is_empty() && !before.is_empty() {
            self.commands.entity(face).remove::<FaceProblems>();
        } else if *loops != *before {
            self.commands.entity(face).insert(FaceProblems(Arc::clone(&loops)));
        }
        let any = !loops.is_empty() || failure.is_some();
        self.list.set(face, any.then_some(Found { loops, failure }));
    }
}

/// Takes what the thread found, unless the face has changed since.
pub(super) fn finish(checker: Res<Checker>, records: Records, mut publish: Publish) {
    let done = std::mem::take(&mut checker.lock().done);
    for (face, parts, found) in done {
        if records.parts(face).is_some_and(|now| now.is_same(&parts)) {
            publish.face(face, found);
        }
    }
}
