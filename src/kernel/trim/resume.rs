//! Preparing the loops of a face again after an edit of a few of them.
//!
//! Loops that an edit left alone keep their pieces, which are copied. That is right as long as the loops are
//! independent: not on closed surfaces where they were shifted or joined, and only while the rectangle
//! they are normalised to stays the same bit for bit. Otherwise there is no short way and the answer is
//! `None`. Invariant: what is given equals [`super::loops::prepare`] bit for bit.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec2;

use super::chain::ChainLayer;
use super::domain::{Periods, UvRect};
use super::loop_record::LoopRecord;
use super::loops::{LaidLoop, SLACK, Splitter, TrimLoops, bounds, hull_of_loops};
use super::pieces::PieceList;
use super::remark::TrimRemark;
use crate::kernel::nurbs::NurbsSurface;

/// What the loops were made from.
#[derive(Debug, Clone)]
pub struct LoopMemory {
    records: Vec<Arc<LoopRecord>>,
    laid: Vec<LaidLoop>,
    hull: UvRect,
    rect: UvRect,
    domain: UvRect,
}

/// Pieces (or segments) that an edit replaced; what lies between two of them is the same as before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Splice {
    /// Positions before the edit.
    pub before: Range<usize>,
    /// Positions after it.
    pub after: Range<usize>,
}

/// Loops prepared again.
#[derive(Debug)]
pub struct Resumed {
    /// As from [`super::loops::prepare`].
    pub loops: TrimLoops,
    /// Replaced pieces, in order; whole chains.
    pub chains: Vec<Splice>,
    /// For the next time.
    pub memory: LoopMemory,
}

impl LoopMemory {
    /// Notes what `trim` was prepared from; `None` when no edit could make use of it.
    pub fn new(surface: &NurbsSurface, loops: &[LoopRecord], trim: &TrimLoops) -> Option<Self> {
        (!trim.laid.is_empty()).then(|| Self {
            records: loops.iter().cloned().map(Arc::new).collect(),
            laid: trim.laid.clone(),
            hull: hull_of_loops(loops),
            rect: UvRect::of_surface(surface),
            domain: trim.domain,
        })
    }

    /// Prepares `loops` from the pieces `before` of the loops remembered.
    pub fn resume(
        &self,
        before: &PieceList,
        surface: &NurbsSurface,
        loops: &[LoopRecord],
    ) -> Option<Resumed> {
        let rect = UvRect::of_surface(surface);
        let same = |(record, old): (&LoopRecord, &Arc<LoopRecord>)| record.role == old.role;
        if loops.len() != self.records.len()
            || !loops.iter().zip(&self.records).all(same)
            || rect != self.rect
            || hull_of_loops(loops) != self.hull
        {
            return None;
        }
        let mut memory = self.clone();
        let mut chains = vec![None; loops.len()];
        let mut changed = vec![false; loops.len()];
        let scale = if self.hull.has_area() { self.hull.size() } else { rect.size() };
        for (i, record) in loops.iter().enumerate() {
            if *record == *self.records[i] {
                continue;
            }
            changed[i] = true;
            memory.records[i] = Arc::new(record.clone());
            let (mut asked, mut remarks) = (false, Vec::new());
            let mut periods = || {
                asked = true;
                Periods::default()
            };
            let mut layer = ChainLayer { surface: rect, scale, periods: &mut periods, remarks: &mut remarks };
            let chain = layer.lay(i, &record.curves);
            if asked || chain.is_some() != self.laid[i].is_chain {
                return None;
            }
            memory.laid[i] = LaidLoop::of(chain.as_ref(), remarks);
            memory.laid[i].rect = chain.as_ref().map_or(UvRect::EMPTY, bounds);
            chains[i] = chain;
        }
        let all = memory.laid.iter().filter(|l| l.is_chain).fold(UvRect::EMPTY, |a, l| a.union(l.rect));
        let domain = UvRect { min: all.min.max(rect.min), max: all.max.min(rect.max) };
        if domain != self.domain {
            return None;
        }
        let mut pieces = PieceList::default();
        let mut splitter = Splitter::new(domain);
        let mut splices = Vec::new();
        // Chains of `before` up to `done` are copied; those up to `next` are to be.
        let (mut done, mut next) = (0, 0);
        for i in 0..self.laid.len() {
            let was_kept = self.laid[i].is_kept;
            if changed.get(i) != Some(&true) {
                next += usize::from(was_kept);
                continue;
            }
            pieces.append_chains(before, done..next);
            let place =
                if next < before.chain_count() { before.chain(next).start } else { before.pieces().len() };
            let old = if was_kept { before.chain(next) } else { place..place };
            next += usize::from(was_kept);
            done = next;
            let first = pieces.pieces().len();
            if let Some(chain) = &chains[i] {
                let (overshoot, is_kept) = splitter.append(chain, &mut pieces);
                (memory.laid[i].overshoot, memory.laid[i].is_kept) = (overshoot, is_kept);
            }
            splices.push(Splice { before: old, after: first..pieces.pieces().len() });
        }
        pieces.append_chains(before, done..next);
        let loops = memory.trim_loops(pieces);
        Some(Resumed { loops, chains: splices, memory })
    }

    fn trim_loops(&self, pieces: PieceList) -> TrimLoops {
        let mut remarks: Vec<TrimRemark> = self.laid.iter().flat_map(|l| l.remarks.iter().copied()).collect();
        if self.laid.len() > self.records.len() && !self.records.is_empty() {
            remarks.push(TrimRemark::NoOuterLoop);
        }
        let relative = self.laid.iter().fold(0.0f64, |a, l| a.max(l.overshoot));
        if relative > SLACK {
            remarks.push(TrimRemark::BeyondSurface { relative });
        }
        let bezier = self.laid.iter().map(|l| l.bezier).sum();
        let laid = self.laid.clone();
        TrimLoops { domain: self.domain, pieces, bezier, period: DVec2::ZERO, remarks, laid }
    }
}

/// The parts of replaced chains that differ: equal pieces at both ends are left out.
pub fn narrowed(chains: &[Splice], before: &PieceList, after: &PieceList) -> Vec<Splice> {
    let same = |a: usize, b: usize| {
        let (p, q) = (&before.pieces()[a], &after.pieces()[b]);
        before.points(p) == after.points(q) && before.weights(p) == after.weights(q)
    };
    let narrow = |splice: &Splice| {
        let (mut a, mut b) = (splice.before.clone(), splice.after.clone());
        while !a.is_empty() && !b.is_empty() && same(a.start, b.start) {
            (a.start, b.start) = (a.start + 1, b.start + 1);
        }
        while !a.is_empty() && !b.is_empty() && same(a.end - 1, b.end - 1) {
            (a.end, b.end) = (a.end - 1, b.end - 1);
        }
        Splice { before: a, after: b }
    };
    chains.iter().map(narrow).collect()
}
