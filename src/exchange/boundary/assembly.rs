//! Chaining the pcurves of one loop head to tail, with the right branch on periodic surfaces and the
//! right way round at poles.
//!
//! At a pole all u are one point, so the file need not say how u goes on. The material lies to the
//! left of a loop, so u falls along the upper pole and rises along the lower one; of all ways that
//! close the loop, the one that keeps this rule most often is taken, then the one of largest area.

use glam::DVec2;

use super::Piece;
use crate::kernel::query::Carrier;

/// Pole passages of one loop for which all ways are tried.
const MOST_POLES: usize = 5;

/// Puts `pieces` end to start: reverses and shifts pieces by periods where that closes gaps. Gaps
/// that stay are bridged by straight lines, except the last one (see [`super::winding`]).
pub fn chain(carrier: &Carrier, pieces: Vec<Piece>) -> Vec<Piece> {
    let pieces = match reordered(&pieces) {
        Some(order) => return order.into_iter().map(|k| pieces[k].clone()).collect(),
        None => pieces,
    };
    let gap = |a: DVec2, b: DVec2| (carrier.point(a) - carrier.point(b)).length();
    let mut result: Vec<Piece> = Vec::with_capacity(pieces.len());
    let count = pieces.len();
    for (index, piece) in pieces.iter().enumerate() {
        let oriented = match result.last() {
            Some(last) => {
                let at = last.end();
                let (ahead, back) = (gap(at, piece.start()), gap(at, piece.end()));
                if back < 0.1 * ahead { piece.reversed() } else { piece.clone() }
            }
            // The first piece is turned when that lets the second one follow.
            None if count > 1 => {
                let next = &pieces[index + 1];
                let reach = |p: DVec2| gap(p, next.start()).min(gap(p, next.end()));
                let (ahead, back) = (reach(piece.end()), reach(piece.start()));
                // A loop of two pieces meets at both ends: leave it as it is.
                if back < 0.1 * ahead && count > 2 { piece.reversed() } else { piece.clone() }
            }
            None => piece.clone(),
        };
        let moved = match result.last() {
            Some(last) => oriented.shifted(-nearest_period(carrier, oriented.start() - last.end())),
            None => oriented,
        };
        result.push(moved);
    }
    turn_at_poles(carrier, &mut result);
    bridge(carrier, result)
}

/// The order in which pieces that close in uv as they are follow each other. Files list them as they
/// meet in space, which on a seam need not be as they meet in uv. `None` when they do not close.
fn reordered(pieces: &[Piece]) -> Option<Vec<usize>> {
    /// Far above rounding in files, far below any piece that matters.
    const MET: f64 = 1e-7;
    let (min, max) = super::bounds_of_ends(pieces)?;
    let size = (max - min).max(DVec2::splat(f64::MIN_POSITIVE));
    let gap = |a: usize, b: usize| ((pieces[b].start() - pieces[a].end()).abs() / size).max_element();
    let mut order = vec![0];
    let mut left: Vec<usize> = (1..pieces.len()).collect();
    while !left.is_empty() {
        let last = order[order.len() - 1];
        // The next piece of the file wins when it follows; otherwise the nearest.
        let follows = left.iter().position(|k| *k == last + 1).filter(|k| gap(last, left[*k]) <= MET);
        let nearest = || (0..left.len()).min_by(|a, b| gap(last, left[*a]).total_cmp(&gap(last, left[*b])));
        let next = follows.or_else(nearest)?;
        if !(gap(last, left[next]) <= MET) {
            return None;
        }
        order.push(left.remove(next));
    }
    (gap(order[order.len() - 1], 0) <= MET && pieces.len() > 1).then_some(order)
}

/// The multiple of the periods nearest to `difference`.
pub fn nearest_period(carrier: &Carrier, difference: DVec2) -> DVec2 {
    let periods = carrier.periods();
    let one = |k: usize| periods[k].map_or(0.0, |t| (difference[k] / t).round() * t);
    DVec2::new(one(0), one(1))
}

/// Straight lines across the inner gaps.
fn bridge(carrier: &Carrier, pieces: Vec<Piece>) -> Vec<Piece> {
    let closing = nearest_period(carrier, pieces.last().map_or(DVec2::ZERO, |l| l.end() - pieces[0].start()));
    let mut result: Vec<Piece> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        if let Some(last) = result.last() {
            let (a, b) = (last.end(), piece.start());
            if is_gap(a, b) {
                result.push(Piece::line(a, b));
            }
        }
        result.push(piece);
    }
    if let (Some(first), Some(last)) = (result.first(), result.last()) {
        let (a, b) = (last.end(), first.start());
        if closing == DVec2::ZERO && is_gap(a, b) {
            result.push(Piece::line(a, b));
        }
    }
    result
}

/// Whether two ends are further apart than rounding explains.
fn is_gap(a: DVec2, b: DVec2) -> bool {
    let size = a.abs().max(b.abs()) + DVec2::ONE * f64::MIN_POSITIVE;
    ((b - a).abs() / size).max_element() > 1e-12 && (b - a).abs().max_element() > 1e-15
}

/// Decides how u (or v) goes on at poles: `pieces[i]` and all after it move by periods.
fn turn_at_poles(carrier: &Carrier, pieces: &mut [Piece]) {
    let periods = carrier.periods();
    for axis in 0..2 {
        let Some(period) = periods[axis] else { continue };
        let count = pieces.len();
        // A piece along the pole says by itself how u goes on.
        let along: Vec<bool> = pieces.iter().map(|p| runs_along_pole(carrier, p, axis, period)).collect();
        let joints: Vec<usize> = (0..count)
            .filter(|i| {
                let before = (i + count - 1) % count;
                if along[before] || along[*i] {
                    return false;
                }
                let (a, b) = (pieces[before].end(), pieces[*i].start());
                // Only where the other coordinate agrees: the pole is one line of the domain.
                carrier.is_singular(a)[axis] && carrier.is_singular(b)[axis]
            })
            .collect();
        if joints.is_empty() || joints.len() > MOST_POLES {
            continue;
        }
        if let Some(shifts) = best_turns(pieces, axis, period, &joints) {
            for (piece, shift) in pieces.iter_mut().zip(shifts) {
                let by = if axis == 0 { DVec2::new(shift, 0.0) } else { DVec2::new(0.0, shift) };
                *piece = piece.shifted(by);
            }
        }
    }
}

fn runs_along_pole(carrier: &Carrier, piece: &Piece, axis: usize, period: f64) -> bool {
    let (a, b) = (piece.start(), piece.end());
    (b - a)[axis].abs() > 1e-6 * period && carrier.is_singular(a)[axis] && carrier.is_singular(b)[axis]
}

/// Shifts of every piece that close the loop best.
fn best_turns(pieces: &[Piece], axis: usize, period: f64, joints: &[usize]) -> Option<Vec<f64>> {
    let other = 1 - axis;
    let count = pieces.len();
    let (low, high) = pieces
        .iter()
        .flat_map(|p| [p.start()[other], p.end()[other]])
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    let mut best: Option<((usize, f64), Vec<f64>)> = None;
    let choices = 3usize.pow(joints.len() as u32);
    for code in 0..choices {
        let mut shifts = vec![0.0; count];
        let mut idle = true;
        let mut rest = code;
        for joint in joints {
            let turn = (rest % 3) as f64 - 1.0;
            rest /= 3;
            // A turn before the first piece is the same as all others the other way round.
            idle &= *joint > 0 || turn == 0.0;
            shifts[*joint..].iter_mut().for_each(|s| *s += turn * period);
        }
        if !idle {
            continue;
        }
        let mut closed = true;
        let mut area = 0.0;
        let mut rule = 0;
        let mut previous: Option<DVec2> = None;
        for k in 0..=count {
            let (piece, shift) = (&pieces[k % count], shifts[k % count]);
            let at = |p: DVec2| {
                if axis == 0 { DVec2::new(p.x + shift, p.y) } else { DVec2::new(p.y + shift, p.x) }
            };
            if let Some(last) = previous {
                let next = at(piece.start());
                area += last.perp_dot(next);
                let jump = next.x - last.x;
                if joints.contains(&(k % count)) {
                    // A jump of more than one turn is nonsense.
                    closed &= jump.abs() <= period * (1.0 + 1e-9);
                    let upper = next.y > 0.5 * (low + high);
                    let falls = if axis == 0 { upper } else { !upper };
                    rule += usize::from(if falls { jump <= 1e-9 * period } else { jump >= -1e-9 * period });
                } else {
                    closed &= jump.abs() < 0.25 * period;
                }
            }
            if k < count {
                const PARTS: usize = 16;
                let (a, b) = piece.curve.domain();
                let mut p = at(piece.start());
                for s in 1..=PARTS {
                    let q = at(piece.curve.point(a + (b - a) * s as f64 / PARTS as f64));
                    area += p.perp_dot(q);
                    p = q;
                }
                previous = Some(p);
            }
        }
        if !closed || area.abs() < 1e-9 * period * (high - low) {
            continue;
        }
        let key = (rule, area.abs());
        if best.as_ref().is_none_or(|(k, _)| key.0 > k.0 || (key.0 == k.0 && key.1 > k.1 * (1.0 + 1e-9))) {
            best = Some((key, shifts));
        }
    }
    best.map(|b| b.1)
}
