//! Checking again after a drag moved a loop or two: only these are cut, and compared with what is near them.
//!
//! Invariant: what a [`Memory`] gives equals what a check from scratch gives. Loops are told apart by identity, so
//! whoever edits must replace the record of a loop that changes and keep those that do not.

use std::sync::Arc;

use super::crossing::{self, Crossings};
use super::loops::{self, Cut};
use super::nesting::{self, Around};
use super::{LoopProblem, MOST, ProblemKind, curves};
use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::trim::domain::UvRect;
use crate::kernel::trim::loop_record::LoopRecord;

/// With more loops than this changed, everything is checked.
const FEW: usize = 16;

/// The loops of a face as they were checked last.
#[derive(Debug, Clone, Default)]
pub struct Memory {
    kept: Option<Kept>,
}

#[derive(Debug, Clone)]
struct Kept {
    surface: Arc<NurbsSurface>,
    loops: Vec<Arc<LoopRecord>>,
    state: State,
}

impl Memory {
    /// The problems of a face's loops, as [`super::check`] gives them.
    pub fn check(&mut self, surface: &Arc<NurbsSurface>, loops: &[Arc<LoopRecord>]) -> Vec<LoopProblem> {
        let records: Vec<&LoopRecord> = loops.iter().map(|l| &**l).collect();
        let state = self
            .kept
            .take()
            .and_then(|kept| kept.changed(surface, loops).map(|changed| (kept.state, changed)))
            .and_then(|(state, changed)| state.again(surface, &records, &changed))
            .unwrap_or_else(|| State::of(surface, &records));
        let problems = state.problems(&records);
        self.kept = Some(Kept { surface: Arc::clone(surface), loops: loops.to_vec(), state });
        problems
    }

    /// Number of curves that the next check has to look at.
    pub fn curves_to_check(&self, surface: &Arc<NurbsSurface>, loops: &[Arc<LoopRecord>]) -> usize {
        let changed = self.kept.as_ref().and_then(|k| k.changed(surface, loops));
        match changed {
            Some(changed) => changed.iter().map(|k| loops[*k].curves.len()).sum(),
            None => loops.iter().map(|l| l.curves.len()).sum(),
        }
    }
}

impl Kept {
    /// The loops that are others now; `None` when all have to be checked.
    fn changed(&self, surface: &Arc<NurbsSurface>, loops: &[Arc<LoopRecord>]) -> Option<Vec<usize>> {
        if !Arc::ptr_eq(&self.surface, surface) || self.loops.len() != loops.len() {
            return None;
        }
        let pairs = self.loops.iter().zip(loops).enumerate();
        let changed: Vec<usize> = pairs.filter(|(_, (a, b))| !Arc::ptr_eq(a, b)).map(|(k, _)| k).collect();
        (changed.len() <= FEW).then_some(changed)
    }
}

/// What is known of all loops.
#[derive(Debug, Clone)]
pub(super) struct State {
    domain: UvRect,
    cut: Cut,
    /// What is wrong with single loops.
    own: Vec<LoopProblem>,
    crossings: Crossings,
    around: Around,
}

impl State {
    /// Checks everything.
    pub fn of(surface: &NurbsSurface, loops: &[&LoopRecord]) -> Self {
        let domain = UvRect::of_surface(surface);
        let mut own = Vec::new();
        let cut = loops::cut(surface, &domain, loops, &mut own);
        curves::ends(&domain, loops, |_| true, &mut own);
        curves::leaving(&domain, &cut, |_| true, &mut own);
        let crossings = crossing::find(&cut.loops, domain.size().max_element(), None);
        let around = if cut.rings { Vec::new() } else { nesting::around(&cut.loops) };
        Self { domain, cut, own, crossings, around }
    }

    /// Checks what `changed`; `None` when all have to be checked.
    fn again(mut self, surface: &NurbsSurface, loops: &[&LoopRecord], changed: &[usize]) -> Option<Self> {
        if self.crossings.too_many {
            return None;
        }
        let is_changed = |index: usize| changed.contains(&index);
        let count = self.cut.loops.len();
        self.own.retain(|p| !is_changed(p.at.trim_loop));
        loops::cut_again(surface, &self.domain, loops, changed, &mut self.cut, &mut self.own)?;
        if self.cut.loops.len() != count {
            return None;
        }
        curves::ends(&self.domain, loops, is_changed, &mut self.own);
        curves::leaving(&self.domain, &self.cut, is_changed, &mut self.own);
        let new = crossing::find(&self.cut.loops, self.domain.size().max_element(), Some(changed));
        if new.too_many {
            return None;
        }
        let touches = |p: &LoopProblem| is_changed(p.at.trim_loop) || other_loop(p).is_some_and(is_changed);
        self.crossings.found.retain(|p| !touches(p));
        self.crossings.found.extend(new.found);
        self.crossings.found.sort_by(LoopProblem::order);
        nesting::around_again(&self.cut.loops, changed, &mut self.around);
        Some(self)
    }

    /// All problems, by loop and curve.
    pub fn problems(&self, loops: &[&LoopRecord]) -> Vec<LoopProblem> {
        let mut problems = self.own.clone();
        if !self.cut.rings {
            let mut crossed = vec![false; loops.len()];
            for problem in &self.crossings.found {
                crossed[problem.at.trim_loop] = true;
                if let Some(other) = other_loop(problem) {
                    crossed[other] = true;
                }
            }
            nesting::check(&self.cut.loops, &self.around, loops, &crossed, &mut problems);
        }
        problems.extend(self.crossings.found.iter().take(MOST).copied());
        problems.sort_by(LoopProblem::order);
        problems
    }
}

fn other_loop(problem: &LoopProblem) -> Option<usize> {
    match problem.kind {
        ProblemKind::Crosses { other } => Some(other.trim_loop),
        _ => None,
    }
}
