//! Loops as monotone pieces in native parameters, beside each other where the surface is closed.

use glam::DVec2;

use super::{At, GAP, LoopProblem, ProblemKind};
use crate::kernel::bezier::{BezierCurve2, MonotoneSplitter};
use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::trim::domain::{Periods, UvRect};
use crate::kernel::trim::loop_record::LoopRecord;

/// A monotone piece of a loop: its box is the box of its ends.
#[derive(Debug, Clone)]
pub(super) struct MonotonePiece {
    /// Position of its curve in the loop.
    pub curve: usize,
    pub bezier: BezierCurve2,
}

impl MonotonePiece {
    pub fn start(&self) -> DVec2 {
        self.bezier.start()
    }

    pub fn end(&self) -> DVec2 {
        self.bezier.end()
    }

    pub fn bounds(&self) -> UvRect {
        let (a, b) = (self.start(), self.end());
        UvRect { min: a.min(b), max: a.max(b) }
    }
}

/// A loop cut to pieces.
#[derive(Debug, Clone)]
pub(super) struct CutLoop {
    /// Position of the loop in its face.
    pub index: usize,
    pub pieces: Vec<MonotonePiece>,
    pub bounds: UvRect,
}

/// All loops with an extent.
#[derive(Debug, Clone)]
pub(super) struct Cut {
    /// By rising position in the face.
    pub loops: Vec<CutLoop>,
    /// Period in u and v, 0 where not closed; none while nobody had to know.
    pub periods: Option<DVec2>,
    /// Whether a loop goes round the surface.
    pub rings: bool,
}

impl Cut {
    /// Period in u and v, 0 where not closed or never asked.
    pub fn period(&self) -> DVec2 {
        self.periods.unwrap_or_default()
    }
}

/// Cuts loops, reports gaps and empty loops, and shifts loops by periods to the largest one.
pub(super) fn cut(
    surface: &NurbsSurface,
    domain: &UvRect,
    loops: &[&LoopRecord],
    problems: &mut Vec<LoopProblem>,
) -> Cut {
    let mut known: Option<DVec2> = None;
    let mut splitter = MonotoneSplitter::default();
    let mut cut = Cut { loops: Vec::new(), periods: None, rings: false };
    for (index, record) in loops.iter().enumerate() {
        let (one, turns) = cut_loop(surface, domain, (index, record), &mut known, &mut splitter, problems);
        cut.rings |= turns;
        cut.loops.extend(one);
    }
    if leaves(domain, &cut.loops) {
        known.get_or_insert_with(|| Periods::of_surface(surface).period);
    }
    cut.periods = known;
    beside(&mut cut);
    cut
}

/// Cuts the loops `changed` again and puts them in their places. `None` when that may change where other loops are
/// compared, so that all have to be cut.
pub(super) fn cut_again(
    surface: &NurbsSurface,
    domain: &UvRect,
    loops: &[&LoopRecord],
    changed: &[usize],
    cut: &mut Cut,
    problems: &mut Vec<LoopProblem>,
) -> Option<()> {
    if cut.rings || cut.period() != DVec2::ZERO {
        return None;
    }
    let mut splitter = MonotoneSplitter::default();
    for index in changed {
        let (one, turns) =
            cut_loop(surface, domain, (*index, loops[*index]), &mut cut.periods, &mut splitter, problems);
        if turns {
            return None;
        }
        match (cut.loops.binary_search_by_key(index, |l| l.index), one) {
            (Ok(at), Some(one)) => cut.loops[at] = one,
            (Ok(at), None) => drop(cut.loops.remove(at)),
            (Err(at), Some(one)) => cut.loops.insert(at, one),
            (Err(_), None) => {}
        }
    }
    if leaves(domain, &cut.loops) {
        cut.periods.get_or_insert_with(|| Periods::of_surface(surface).period);
    }
    (cut.period() == DVec2::ZERO).then_some(())
}

/// Whether a loop leaves the domain, so that one must know whether the surface is closed.
fn leaves(domain: &UvRect, loops: &[CutLoop]) -> bool {
    let all = loops.iter().fold(UvRect::EMPTY, |all, l| all.union(l.bounds));
    let out = (domain.min - all.min).max(all.max - domain.max).max_element();
    !loops.is_empty() && out > GAP * domain.size().max_element()
}

/// One loop as pieces, unless it has no extent, and whether it goes round the surface.
fn cut_loop(
    surface: &NurbsSurface,
    domain: &UvRect,
    (index, record): (usize, &LoopRecord),
    known: &mut Option<DVec2>,
    splitter: &mut MonotoneSplitter,
    problems: &mut Vec<LoopProblem>,
) -> (Option<CutLoop>, bool) {
    let mut periods = || *known.get_or_insert_with(|| Periods::of_surface(surface).period);
    let mut pieces: Vec<MonotonePiece> = Vec::new();
    let mut turns = DVec2::ZERO;
    let mut first = None;
    let mut last: Option<(usize, DVec2)> = None;
    for (curve, nurbs) in record.curves.iter().enumerate() {
        let beziers = nurbs.to_bezier();
        let (Some((head, _)), Some((tail, _))) = (beziers.first(), beziers.last()) else { continue };
        first.get_or_insert(head.start());
        if let Some((before, end)) = last.replace((curve, tail.end())) {
            turns += joint(domain, (index, before), end, head.start(), &mut periods, problems);
        }
        for (bezier, _) in &beziers {
            splitter.split(&bezier.points, &bezier.weights, 0.0, |points, weights| {
                let points = points.iter().map(|p| *p - turns).collect();
                let bezier = BezierCurve2 { points, weights: weights.to_vec() };
                pieces.push(MonotonePiece { curve, bezier });
            });
        }
    }
    if let (Some(first), Some((curve, end))) = (first, last) {
        turns += joint(domain, (index, curve), end, first, &mut periods, problems);
    }
    let turns = turns != DVec2::ZERO;
    pieces.retain(|p| p.start() != p.end());
    if pieces.len() < 2 {
        let uv = record.curves.first().map_or(0.5 * (domain.min + domain.max), |c| c.points()[0]);
        let at = At { trim_loop: index, curve: 0 };
        problems.push(LoopProblem { at, uv, kind: ProblemKind::Empty });
        return (None, turns);
    }
    let bounds = pieces.iter().fold(UvRect::EMPTY, |all, p| all.union(p.bounds()));
    (Some(CutLoop { index, pieces, bounds }), turns)
}

/// Whole periods from an end to the next start; anything else is reported as a gap.
fn joint(
    domain: &UvRect,
    (trim_loop, curve): (usize, usize),
    end: DVec2,
    start: DVec2,
    periods: &mut impl FnMut() -> DVec2,
    problems: &mut Vec<LoopProblem>,
) -> DVec2 {
    let gap = start - end;
    let relative = |gap: DVec2| (gap / domain.size()).abs().max_element();
    if relative(gap) <= GAP {
        return DVec2::ZERO;
    }
    let periods = periods();
    let whole = |gap: f64, period: f64| if period > 0.0 { (gap / period).round() * period } else { 0.0 };
    let turns = DVec2::new(whole(gap.x, periods.x), whole(gap.y, periods.y));
    if relative(gap - turns) > GAP {
        let kind = ProblemKind::Open { gap: (gap - turns).length() };
        problems.push(LoopProblem { at: At { trim_loop, curve }, uv: end, kind });
    }
    turns
}

/// Shifts loops by whole periods so that their middles are nearest to that of the largest loop.
fn beside(cut: &mut Cut) {
    let periods = cut.period();
    if periods == DVec2::ZERO {
        return;
    }
    let area = |l: &CutLoop| l.bounds.size().x * l.bounds.size().y;
    let Some(largest) = cut.loops.iter().max_by(|a, b| area(a).total_cmp(&area(b))) else { return };
    let middle = 0.5 * (largest.bounds.min + largest.bounds.max);
    for cut_loop in &mut cut.loops {
        let own = 0.5 * (cut_loop.bounds.min + cut_loop.bounds.max);
        let whole = |gap: f64, period: f64| if period > 0.0 { (gap / period).round() * period } else { 0.0 };
        let by = DVec2::new(whole(middle.x - own.x, periods.x), whole(middle.y - own.y, periods.y));
        if by != DVec2::ZERO {
            for piece in &mut cut_loop.pieces {
                piece.bezier.points.iter_mut().for_each(|p| *p += by);
            }
            cut_loop.bounds = UvRect { min: cut_loop.bounds.min + by, max: cut_loop.bounds.max + by };
        }
    }
}
