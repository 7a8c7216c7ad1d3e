//! Undo and redo: the steps that led to the present state, and those taken back.
//!
//! Every state has a number of its own; the saved mark is the number of the state that was saved, so it is
//! right after any undoing, redoing and branching off, and stays right when its step was dropped. Steps
//! are dropped, oldest first, when together they hold more bytes than the cap; the latest step always
//! stays.

use std::collections::VecDeque;

use super::edit::Edit;

/// Memory a history may hold when nothing else is said: 256 MiB.
pub const DEFAULT_CAP_BYTES: usize = 256 << 20;

#[derive(Debug, Clone)]
struct Step {
    edit: Edit,
    bytes: usize,
    /// State before and after.
    from: u64,
    to: u64,
}

/// Steps done and undone.
#[derive(Debug, Clone)]
pub struct History {
    done: VecDeque<Step>,
    /// Steps taken back, latest last.
    undone: Vec<Step>,
    bytes: usize,
    cap_bytes: usize,
    state: u64,
    /// Highest state number given so far.
    states: u64,
    saved: Option<u64>,
    dropped: usize,
}

/// One line of a history panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry<'a> {
    /// What the step did.
    pub label: &'a str,
    /// Whether it is in effect; otherwise it was undone and can be redone.
    pub done: bool,
    /// Whether the state after it is the saved one.
    pub saved: bool,
}

impl Default for History {
    fn default() -> Self {
        Self::new(DEFAULT_CAP_BYTES)
    }
}

impl History {
    /// An empty history of a saved state, holding at most `cap_bytes` of edits.
    pub fn new(cap_bytes: usize) -> Self {
        Self {
            done: VecDeque::new(),
            undone: Vec::new(),
            bytes: 0,
            cap_bytes,
            state: 0,
            states: 0,
            saved: Some(0),
            dropped: 0,
        }
    }

    /// Enters an edit that has just been applied; what was undone can no longer be redone. An edit that
    /// changes nothing is not entered.
    pub fn push(&mut self, edit: Edit) {
        if edit.is_empty() {
            return;
        }
        for step in self.undone.drain(..) {
            self.bytes -= step.bytes;
        }
        let bytes = edit.bytes();
        self.states += 1;
        self.done.push_back(Step { edit, bytes, from: self.state, to: self.states });
        self.state = self.states;
        self.bytes += bytes;
        self.trim();
    }

    /// Takes the latest step back: `apply` gets the inverse edit. Returns the label of the step, `None` when
    /// there is nothing to undo.
    ///
    /// # Errors
    /// Those of `apply`; nothing is taken back then.
    pub fn undo<E>(&mut self, apply: impl FnOnce(&Edit) -> Result<(), E>) -> Result<Option<&str>, E> {
        let Some(step) = self.done.back() else { return Ok(None) };
        apply(&step.edit.inverse())?;
        self.undone.extend(self.done.pop_back());
        let step = self.undone.last().expect("invariant: a step was just put there");
        self.state = step.from;
        Ok(Some(&step.edit.label))
    }

    /// Does the step undone last again: `apply` gets its edit. Returns the label, `None` when there is
    /// nothing to redo.
    ///
    /// # Errors
    /// Those of `apply`; nothing is redone then.
    pub fn redo<E>(&mut self, apply: impl FnOnce(&Edit) -> Result<(), E>) -> Result<Option<&str>, E> {
        let Some(step) = self.undone.last() else { return Ok(None) };
        apply(&step.edit)?;
        self.done.extend(self.undone.pop());
        let step = self.done.back().expect("invariant: a step was just put there");
        self.state = step.to;
        Ok(Some(&step.edit.label))
    }

    /// Notes that the present state has been saved.
    pub fn mark_saved(&mut self) {
        self.saved = Some(self.state);
    }

    /// Notes that the state of this number has been saved, the present one or not: saving takes a while.
    pub fn mark_saved_at(&mut self, state: u64) {
        self.saved = Some(state);
    }

    /// Notes that no state of this history is on disk (a recovered or imported document).
    pub fn mark_unsaved(&mut self) {
        self.saved = None;
    }

    /// Whether the present state is the saved one.
    pub fn is_saved(&self) -> bool {
        self.saved == Some(self.state)
    }

    /// Number of the present state: equal exactly when nothing was done or undone in between, or all of it
    /// was taken back.
    pub fn state(&self) -> u64 {
        self.state
    }

    /// Whether the state before the oldest step is the saved one.
    pub fn start_is_saved(&self) -> bool {
        let start = self.done.front().or(self.undone.last()).map_or(self.state, |step| step.from);
        self.saved == Some(start)
    }

    /// Label of the step that undo would take back.
    pub fn undo_label(&self) -> Option<&str> {
        self.done.back().map(|s| s.edit.label.as_str())
    }

    /// Label of the step that redo would do again.
    pub fn redo_label(&self) -> Option<&str> {
        self.undone.last().map(|s| s.edit.label.as_str())
    }

    /// Number of steps that can be undone.
    pub fn undo_count(&self) -> usize {
        self.done.len()
    }

    /// Number of steps that can be redone.
    pub fn redo_count(&self) -> usize {
        self.undone.len()
    }

    /// Number of steps dropped for the cap since the history began.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// All steps in the order of doing: first those in effect, then those undone.
    pub fn entries(&self) -> impl DoubleEndedIterator<Item = Entry<'_>> + ExactSizeIterator {
        let count = self.done.len() + self.undone.len();
        (0..count).map(move |i| {
            let (step, done) = match self.done.get(i) {
                Some(step) => (step, true),
                None => (&self.undone[count - 1 - i], false),
            };
            Entry { label: &step.edit.label, done, saved: self.saved == Some(step.to) }
        })
    }

    /// The edits in effect, oldest first; those dropped for the cap are not among them.
    pub fn edits(&self) -> impl Iterator<Item = &Edit> {
        self.done.iter().map(|s| &s.edit)
    }

    /// Bytes that the steps hold.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Bytes that the steps may hold.
    pub fn cap_bytes(&self) -> usize {
        self.cap_bytes
    }

    /// Changes the cap and drops what is too much.
    pub fn set_cap_bytes(&mut self, cap_bytes: usize) {
        self.cap_bytes = cap_bytes;
        self.trim();
    }

    fn trim(&mut self) {
        while self.bytes > self.cap_bytes && self.done.len() > 1 {
            if let Some(step) = self.done.pop_front() {
                self.bytes -= step.bytes;
                self.dropped += 1;
            }
        }
        // Only a lowered cap gets here: what would be redone last goes first.
        while self.bytes > self.cap_bytes && self.undone.len() > 1 {
            self.bytes -= self.undone.remove(0).bytes;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::document::SceneRecord;
    use crate::scene::edit::FaceId;
    use crate::scene::operation::{CurveId, Operation};
    use glam::DVec2;

    fn scene() -> SceneRecord {
        let mut scene = SceneRecord::of_model(Default::default());
        scene.models[0].faces.push(crate::scene::demo::holes(4));
        scene
    }

    fn step(scene: &mut SceneRecord, history: &mut History, by: f64) {
        let curves = vec![CurveId { trim_loop: 1, curve: 0 }];
        let by = DVec2::new(by, 0.0);
        let operation = Operation::MoveCurves { face: FaceId::default(), curves, by, beyond: false };
        let edit = operation.perform(scene).expect("possible");
        edit.apply(scene).expect("fits");
        history.push(edit);
    }

    #[test]
    fn undo_and_redo_give_the_same_states_bit_for_bit() {
        let mut scene = scene();
        let mut history = History::default();
        let mut states = vec![scene.clone()];
        for k in 1..=5 {
            step(&mut scene, &mut history, 1e-3 * f64::from(k));
            states.push(scene.clone());
        }
        for k in (0..5).rev() {
            assert!(history.undo(|e| e.apply(&mut scene)).expect("fits").is_some());
            assert_eq!(scene, states[k]);
        }
        assert_eq!(history.undo(|e| e.apply(&mut scene)), Ok(None));
        for k in 1..=5 {
            history.redo(|e| e.apply(&mut scene)).expect("fits");
            assert_eq!(scene, states[k]);
        }
    }

    #[test]
    fn the_saved_mark_is_right_after_branching_and_dropping() {
        let mut scene = scene();
        let mut history = History::default();
        assert!(history.is_saved());
        step(&mut scene, &mut history, 1e-3);
        step(&mut scene, &mut history, 1e-3);
        history.mark_saved();
        history.undo(|e| e.apply(&mut scene)).expect("fits");
        assert!(!history.is_saved());
        history.redo(|e| e.apply(&mut scene)).expect("fits");
        assert!(history.is_saved());
        history.undo(|e| e.apply(&mut scene)).expect("fits");
        step(&mut scene, &mut history, 2e-3);
        assert!(!history.is_saved(), "the saved state can no longer be reached");
        history.undo(|e| e.apply(&mut scene)).expect("fits");
        assert!(!history.is_saved());
        history.mark_saved();
        step(&mut scene, &mut history, 1e-3);
        let one = history.bytes() / history.undo_count();
        history.set_cap_bytes(one);
        for _ in 0..20 {
            step(&mut scene, &mut history, 1e-4);
            assert!(history.bytes() <= 2 * one);
        }
        assert!(history.dropped() > 10 && history.undo_count() >= 1);
        while history.undo(|e| e.apply(&mut scene)).expect("fits").is_some() {
            assert!(!history.is_saved(), "the step to the saved state was dropped");
        }
    }

    #[test]
    fn edits_that_do_not_fit_change_nothing() {
        let mut scene = scene();
        let mut history = History::default();
        step(&mut scene, &mut history, 1e-3);
        let mut other = scene.clone();
        step(&mut other, &mut History::default(), 1e-3);
        let kept = other.clone();
        assert!(history.undo(|e| e.apply(&mut other)).is_err());
        assert_eq!((other, history.undo_count()), (kept, 1));
        let empty = Edit::new("nothing", Vec::new());
        history.push(empty);
        assert_eq!(history.entries().len(), 1);
    }
}
