//! `hairline bench walk`: a long random walk of edits, undos and redos, with everything derived and packed
//! after each step from what the step before left.
//!
//! Now and then, and at the end, all of it is compared bit for bit with the same made from scratch: derived
//! faces, packed ranges, and the numbers of elements in use; used and unused ranges must add up to the arrays.
//! At the end all steps are taken back, which must lead to where the walk began.

use std::io::{self, Write};
use std::time::Instant;

use glam::{DVec2, DVec3};

use super::edit::face;
use super::shapes::Random;
use super::sheet::{Sheet, number};
use crate::encoding::{FaceShape, FaceSlot, PackedScene};
use crate::kernel::face::Face;
use crate::scene::document::SceneRecord;
use crate::scene::edit::{Edit, FaceId};
use crate::scene::history::History;
use crate::scene::operation::{CurveId, NetId, Operation, PointId, Shape, Transform};
use crate::scene::records::{FaceRecord, LoopRole, ModelRecord};

/// Steps of the table.
const STEPS: usize = 100_000;
/// Faces with more loops than this lose some.
const MOST_LOOPS: usize = 40;

/// What a walk came to.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Walk {
    /// Edits made, undos and redos.
    pub steps: [usize; 3],
    /// Operations that were refused.
    pub refused: usize,
    /// Comparisons with the same made from scratch, and how many of them failed.
    pub compared: [usize; 2],
    /// Whether taking all steps back led to the beginning.
    pub came_back: bool,
    /// Elements in the packed arrays after a tenth of the walk, half way and at the end, and those of them that
    /// no face used.
    pub room: [(usize, usize); 3],
    /// Resident memory in MiB at the same times, where the system tells.
    pub memory: [Option<f64>; 3],
    /// Steps that the history held at the same times, to take back or to do again, and MiB of them.
    pub history: [(usize, f64); 3],
}

/// Prints what a walk of 100,000 steps came to.
///
/// # Errors
/// `out` cannot be written.
pub fn run(out: &mut impl Write) -> io::Result<()> {
    let start = Instant::now();
    let progress = |step: usize| {
        let (memory, s) = (number(resident_mib()), start.elapsed().as_secs_f64());
        eprintln!("  {step} of {STEPS} steps, {s:.1} s, {memory} MiB");
    };
    let walk = walk(STEPS, STEPS / 200, 1, &progress);
    let us = 1e6 * start.elapsed().as_secs_f64() / STEPS as f64;
    let mut sheet = Sheet::new("Random edits, undos and redos, all derived and packed each time", &["", ""]);
    let mut row = |name: &str, text: String| sheet.row([name.to_owned(), text]);
    row("edits, undos, redos", format!("{:?}, refused {}", walk.steps, walk.refused));
    row("us per step", number(Some(us)));
    row(
        "compared with made from scratch",
        format!(
            "{} times, {} differ (faces, packed ranges, elements in use)",
            walk.compared[0], walk.compared[1]
        ),
    );
    row("all taken back", if walk.came_back { "equal to the beginning" } else { "DIFFERS" }.into());
    for (when, k) in [("after a tenth", 0), ("half way", 1), ("at the end", 2)] {
        let ((size, free), (steps, mib)) = (walk.room[k], walk.history[k]);
        let unused = number(Some(100.0 * free as f64 / size.max(1) as f64));
        row(&format!("{when}: array elements, unused %"), format!("{size}, {unused}"));
        row(
            "steps in the history, their MiB, MiB of the process",
            format!("{steps}, {}, {}", number(Some(mib)), number(walk.memory[k])),
        );
    }
    writeln!(out, "{sheet}")
}

/// A face as the editor holds it.
struct Held {
    derived: Option<Face>,
    slot: Option<FaceSlot>,
}

struct Walker {
    scene: SceneRecord,
    history: History,
    held: Vec<Held>,
    packed: PackedScene,
    random: Random,
}

/// Walks for `steps` steps, comparing every `every` steps and telling `progress` every tenth of the way.
pub fn walk(steps: usize, every: usize, seed: u64, progress: &dyn Fn(usize)) -> Walk {
    let model = ModelRecord {
        faces: vec![face(6, 2), face(12, 1), face(1, 3), face(24, 2)],
        ..ModelRecord::default()
    };
    let first = SceneRecord::of_model(model);
    let mut walker = Walker {
        scene: first.clone(),
        history: History::default(),
        held: first.models[0].faces.iter().map(|_| Held { derived: None, slot: None }).collect(),
        packed: PackedScene::default(),
        random: Random(seed),
    };
    (0..walker.held.len()).for_each(|k| walker.update(k));
    let mut walk = Walk::default();
    for step in 0..steps {
        walker.step(&mut walk);
        if step % every == every - 1 {
            walker.compare(&mut walk);
        }
        let done = step + 1;
        if let Some(k) = [steps.div_ceil(10), steps.div_ceil(2), steps].iter().position(|s| *s == done) {
            walk.room[k] = walker.packed.room().unwrap_or_default();
            walk.memory[k] = resident_mib();
            let history = &walker.history;
            let mib = history.bytes() as f64 / f64::from(1 << 20);
            walk.history[k] = (history.undo_count() + history.redo_count(), mib);
        }
        if done % steps.div_ceil(10) == 0 {
            progress(done);
        }
    }
    while walker.take_back() {}
    walker.compare(&mut walk);
    walk.came_back = walker.scene == first;
    walk
}

impl Walker {
    fn face(&self, k: usize) -> &FaceRecord {
        &self.scene.models[0].faces[k]
    }

    fn below(&mut self, count: usize) -> usize {
        (self.random.bits() % count.max(1) as u64) as usize
    }

    fn step(&mut self, walk: &mut Walk) {
        match self.below(10) {
            0..4 => walk.steps[1] += usize::from(self.take_back()),
            4 | 5 => {
                let mut faces = Vec::new();
                let scene = &mut self.scene;
                let done = self.history.redo(|edit| {
                    faces = edit.faces();
                    edit.apply(scene)
                });
                walk.steps[2] += usize::from(matches!(done, Ok(Some(_))));
                self.update_all(&faces);
            }
            _ => match self.operation().and_then(|o| o.perform(&self.scene).ok()) {
                Some(edit) if !edit.is_empty() => {
                    walk.steps[0] += 1;
                    if edit.apply(&mut self.scene).is_ok() {
                        self.update_all(&edit.faces());
                        self.history.push(edit);
                    }
                }
                _ => walk.refused += 1,
            },
        }
    }

    fn take_back(&mut self) -> bool {
        let mut faces = Vec::new();
        let scene = &mut self.scene;
        let undone = self.history.undo(|edit: &Edit| {
            faces = edit.faces();
            edit.apply(scene)
        });
        let any = matches!(undone, Ok(Some(_)));
        self.update_all(&faces);
        any
    }

    fn operation(&mut self) -> Option<Operation> {
        let k = self.below(self.held.len());
        let id = FaceId { model: 0, face: k };
        let count = self.face(k).loops.len();
        let at = self.below(count);
        let kind = self.below(12);
        if count > MOST_LOOPS {
            return Some(Operation::DeleteLoops { face: id, loops: vec![at.max(1)] });
        }
        let centre = self.random.point();
        let by = 0.05 * (self.random.point() - 0.5) * self.random.unit();
        if kind == 0 || count == 0 {
            let radius = 0.05 * self.random.unit();
            let shape = if self.below(2) == 0 {
                Shape::Circle { centre, radius }
            } else {
                Shape::Rectangle { from: centre, to: centre + by }
            };
            return Some(Operation::AddLoop { face: id, shape, role: LoopRole::Inner });
        }
        let curves = self.face(k).loops[at].curves.len();
        let curve = self.below(curves);
        let points = self.face(k).loops[at].curves.get(curve)?.points().len();
        let point = PointId { trim_loop: at, curve, point: self.below(points) };
        let name = CurveId { trim_loop: at, curve };
        let amount = self.random.unit();
        Some(match kind {
            1 if at > 0 => Operation::DeleteLoops { face: id, loops: vec![at] },
            2 => Operation::SetWeight { face: id, points: vec![point], weight: 0.2 + 3.0 * amount },
            3 => Operation::SplitCurve { face: id, curve: name, at: amount },
            4 => Operation::JoinCurves { face: id, curve: name, tolerance: Some(1e-3) },
            5 => Operation::ReverseLoops { face: id, loops: vec![at] },
            6 if amount < 0.3 => {
                let (u, v) = self.face(k).surface.counts();
                let net = NetId { i: self.below(u), j: self.below(v) };
                Operation::MoveSurfacePoints { face: id, points: vec![net], by: DVec3::Z * (amount - 0.1) }
            }
            7 if at > 0 => {
                let transform = Transform::Move { by };
                Operation::TransformLoops { face: id, loops: vec![at], transform, beyond: false }
            }
            8 => Operation::InsertKnot { face: id, curve: name, at: amount, times: 1 },
            9 => Operation::DuplicateLoops { face: id, loops: vec![at.max(1)], by: DVec2::splat(0.01) },
            _ => Operation::MovePoints { face: id, points: vec![point], by, beyond: false },
        })
    }

    fn update_all(&mut self, faces: &[FaceId]) {
        faces.iter().for_each(|id| self.update(id.face));
    }

    /// Derives and packs a face after it changed.
    fn update(&mut self, k: usize) {
        let record = &self.scene.models[0].faces[k];
        let held = &mut self.held[k];
        let derived = match &held.derived {
            Some(previous) => record.derive_after(previous),
            None => record.derive(),
        };
        held.derived = derived.ok();
        match (&held.derived, held.slot) {
            (Some(face), Some(slot)) => self.packed.replace(slot, &FaceShape::of(face, None, false)),
            (Some(face), None) => held.slot = Some(self.packed.add(&FaceShape::of(face, None, false))),
            (None, Some(slot)) => {
                self.packed.remove(slot);
                held.slot = None;
            }
            (None, None) => {}
        }
        self.packed.take_changed_bytes();
    }

    /// Compares everything with the same made from scratch.
    fn compare(&self, walk: &mut Walk) {
        walk.compared[0] += 1;
        let mut in_use = 0;
        let same = self.held.iter().enumerate().all(|(k, held)| {
            let fresh = self.face(k).derive().ok();
            let alike = match (&fresh, held.slot) {
                (Some(face), Some(slot)) => {
                    let anew = PackedScene::from_faces([FaceShape::of(face, None, false)]);
                    in_use += anew.room().map_or(0, |(size, free)| size - free);
                    self.packed.is_packed_like(slot, &anew, FaceSlot(0))
                }
                (None, None) => true,
                _ => false,
            };
            alike && held.derived == fresh
        });
        let no_leak = self.packed.room().is_some_and(|(size, free)| size - free == in_use);
        walk.compared[1] += usize::from(!same || !no_leak);
    }
}

/// Resident memory of this process, from Linux's process table (4 KiB pages).
fn resident_mib() -> Option<f64> {
    let statm = std::fs::read_to_string("/proc/self/statm").ok()?;
    let pages: f64 = statm.split_whitespace().nth(1)?.parse().ok()?;
    Some(pages * 4096.0 / f64::from(1 << 20))
}
