//! What is wrong with curves by themselves: no length, no direction at an end, beyond the surface.

use glam::DVec2;

use super::loops::{Cut, CutLoop};
use super::{At, LoopProblem, ProblemKind};
use crate::kernel::trim::domain::UvRect;
use crate::kernel::trim::loop_record::LoopRecord;

/// Reaching out by less than this fraction of the domain is rounding.
const BEYOND: f64 = 1e-6;

/// Curves without length or without direction at an end.
pub(super) fn ends(
    domain: &UvRect,
    loops: &[&LoopRecord],
    which: impl Fn(usize) -> bool,
    problems: &mut Vec<LoopProblem>,
) {
    const SAME: f64 = 1e-12;
    let size = domain.size();
    let same = |a: DVec2, b: DVec2| ((a - b) / size).abs().max_element() <= SAME;
    for (trim_loop, record) in loops.iter().enumerate().filter(|(k, _)| which(*k)) {
        for (curve, nurbs) in record.curves.iter().enumerate() {
            let (points, at) = (nurbs.points(), At { trim_loop, curve });
            let uv = points[0];
            if points.iter().all(|p| same(*p, uv)) {
                problems.push(LoopProblem { at, uv, kind: ProblemKind::ZeroLength });
                continue;
            }
            let last = points.len() - 2;
            let firsts = if last == 0 { vec![] } else { vec![0, last] };
            for point in firsts {
                if same(points[point], points[point + 1]) {
                    let kind = ProblemKind::NoDirection { point };
                    problems.push(LoopProblem { at, uv: points[point], kind });
                }
            }
        }
    }
}

/// One problem for each curve that leaves the domain in a direction in which the surface is not closed.
pub(super) fn leaving(
    domain: &UvRect,
    cut: &Cut,
    which: impl Fn(usize) -> bool,
    problems: &mut Vec<LoopProblem>,
) {
    let (size, periods) = (domain.size(), cut.period());
    for CutLoop { index, pieces, .. } in cut.loops.iter().filter(|l| which(l.index)) {
        let mut worst: Option<LoopProblem> = None;
        for piece in pieces {
            for uv in [piece.start(), piece.end()] {
                let mut out = (domain.min - uv).max(uv - domain.max).max(DVec2::ZERO);
                for axis in 0..2 {
                    if periods[axis] > 0.0 || out[axis] <= BEYOND * size[axis] {
                        out[axis] = 0.0;
                    }
                }
                let by = out.max_element();
                if by == 0.0 {
                    continue;
                }
                let at = At { trim_loop: *index, curve: piece.curve };
                let found = LoopProblem { at, uv, kind: ProblemKind::LeavesDomain { by } };
                match &mut worst {
                    Some(worst) if worst.at == at => {
                        if matches!(worst.kind, ProblemKind::LeavesDomain { by: most } if by > most) {
                            *worst = found;
                        }
                    }
                    _ => problems.extend(worst.replace(found)),
                }
            }
        }
        problems.extend(worst);
    }
}
