//! Closing loops that run once round a periodic surface.
//!
//! Such a loop ends one period away from its start. It is cut where the surface's own seam is
//! (angle 0, or the start of the domain); two of them are joined by two lines along the seam, and
//! one alone is joined with the pole or the end of the surface on its left.

use glam::DVec2;

use super::{Piece, RawLoop, bounds};
use crate::kernel::primitives::Shape;
use crate::kernel::query::Carrier;
use crate::scene::records::LoopRole;

/// Closes winding loops among `loops` and moves all loops next to each other by whole periods.
/// Returns what could not be closed, in words.
pub fn close(carrier: &Carrier, loops: &mut Vec<RawLoop>) -> Vec<String> {
    let mut problems = Vec::new();
    for axis in 0..2 {
        if let Some(period) = carrier.periods()[axis] {
            close_axis(carrier, loops, axis, period, &mut problems);
        }
    }
    gather(carrier, loops);
    problems
}

/// Periods by which a loop's end lies beyond its start.
fn turns(pieces: &[Piece], axis: usize, period: f64) -> f64 {
    match (pieces.first(), pieces.last()) {
        (Some(first), Some(last)) => ((last.end() - first.start())[axis] / period).round(),
        _ => 0.0,
    }
}

fn close_axis(
    carrier: &Carrier,
    loops: &mut Vec<RawLoop>,
    axis: usize,
    period: f64,
    problems: &mut Vec<String>,
) {
    let (mut winding, plain): (Vec<RawLoop>, Vec<RawLoop>) =
        std::mem::take(loops).into_iter().partition(|l| turns(&l.pieces, axis, period) != 0.0);
    *loops = plain;
    if winding.is_empty() {
        return;
    }
    if winding.iter().any(|l| turns(&l.pieces, axis, period).abs() > 1.5) {
        problems.push("a boundary runs round the surface more than once".into());
    }
    let seam = seam(carrier, axis);
    for l in &mut winding {
        l.pieces = cut_at(std::mem::take(&mut l.pieces), axis, period, seam);
    }
    let height = |l: &RawLoop| l.pieces[0].start()[1 - axis];
    winding.retain(|l| !l.pieces.is_empty());
    winding.sort_by(|a, b| height(a).total_cmp(&height(b)));
    let mut merged = Vec::new();
    let mut rest = winding.into_iter();
    while let Some(first) = rest.next() {
        match rest.next() {
            Some(second) => merged.push(join_two(carrier, first, second, axis, period, seam)),
            None => match join_edge(carrier, &first, axis, period, seam) {
                Some(l) => merged.push(l),
                None => problems.push("a boundary runs round the surface and nothing closes it".into()),
            },
        }
    }
    loops.splice(0..0, merged);
}

fn seam(carrier: &Carrier, axis: usize) -> f64 {
    match carrier {
        Carrier::Analytic(_) => 0.0,
        Carrier::Spline(spline) => {
            let surface = spline.surface();
            if axis == 0 { surface.knots_u().domain().0 } else { surface.knots_v().domain().0 }
        }
    }
}

/// Rotates and shifts a winding loop so that it starts on the seam.
fn cut_at(pieces: Vec<Piece>, axis: usize, period: f64, seam: f64) -> Vec<Piece> {
    let sign = turns(&pieces, axis, period).signum();
    let from = pieces[0].start()[axis];
    // The first seam position on the way.
    let ahead = ((from - seam) * sign / period).ceil().mul_add(period, seam * sign) * sign;
    let level = if (ahead - from).abs() < 1e-9 * period { from } else { ahead };
    let unit = |x: f64| if axis == 0 { DVec2::new(x, 0.0) } else { DVec2::new(0.0, x) };
    let mut before = Vec::new();
    let mut after = Vec::new();
    let crossed = |p: DVec2| (p[axis] - level) * sign >= 0.0;
    if level == from {
        after = pieces;
    } else {
        for piece in pieces {
            if !after.is_empty() {
                after.push(piece);
            } else if crossed(piece.end()) && !crossed(piece.start()) {
                let curve = &piece.curve;
                let (a, b) = curve.domain();
                let (mut low, mut high) = (a, b);
                for _ in 0..100 {
                    let middle = 0.5 * (low + high);
                    if crossed(curve.point(middle)) { high = middle } else { low = middle }
                }
                let close = 1e-9 * (b - a);
                match (curve.restricted(a, low), curve.restricted(low, b)) {
                    (Ok(head), Ok(tail)) if low - a > close && b - low > close => {
                        before.push(Piece { curve: head, edge: piece.edge });
                        after.push(Piece { curve: tail, edge: piece.edge });
                    }
                    _ if low - a <= close => after.push(piece),
                    _ => before.push(piece),
                }
            } else if crossed(piece.start()) {
                after.push(piece);
            } else {
                before.push(piece);
            }
        }
        after.extend(before.iter().map(|p| p.shifted(unit(sign * period))));
    }
    let target = if sign > 0.0 { seam } else { seam + period };
    let shift = ((target - level) / period).round() * period;
    after.iter().map(|p| p.shifted(unit(shift))).collect()
}

fn reversed(pieces: &[Piece]) -> Vec<Piece> {
    pieces.iter().rev().map(Piece::reversed).collect()
}

/// Joins two winding loops by lines along the seam.
fn join_two(
    carrier: &Carrier,
    first: RawLoop,
    second: RawLoop,
    axis: usize,
    period: f64,
    seam: f64,
) -> RawLoop {
    let forward =
        |l: RawLoop| if turns(&l.pieces, axis, period) > 0.0 { l.pieces } else { reversed(&l.pieces) };
    // On a torus the material may lie on the other side: left of the loop that runs forward.
    let swap = carrier.periods()[1 - axis].is_some()
        && turns(&first.pieces, axis, period) < 0.0
        && turns(&second.pieces, axis, period) > 0.0
        && axis == 0;
    let (low, mut high) =
        if swap { (forward(second), forward(first)) } else { (forward(first), forward(second)) };
    if swap && let Some(t) = carrier.periods()[1 - axis] {
        let by = if axis == 0 { DVec2::new(0.0, t) } else { DVec2::new(t, 0.0) };
        high = high.iter().map(|p| p.shifted(by)).collect();
    }
    let _ = seam;
    let mut pieces = low;
    let back = reversed(&high);
    let (a, b) = (pieces[pieces.len() - 1].end(), back[0].start());
    pieces.push(Piece::line(a, b));
    pieces.extend(back);
    let (a, b) = (pieces[pieces.len() - 1].end(), pieces[0].start());
    pieces.push(Piece::line(a, b));
    RawLoop { role: LoopRole::Outer, pieces }
}

/// Joins one winding loop with the edge of the surface on its left, or the only one there is.
fn join_edge(carrier: &Carrier, l: &RawLoop, axis: usize, period: f64, _seam: f64) -> Option<RawLoop> {
    let (low, high) = edges(carrier, axis);
    let forward = turns(&l.pieces, axis, period) > 0.0;
    // Left of +u is +v; left of +v is -u.
    let upper = forward == (axis == 0);
    let edge = match (low, high, upper) {
        (_, Some(high), true) | (None, Some(high), false) => high,
        (Some(low), _, _) => low,
        (None, None, _) => return None,
    };
    let (a, b) = (l.pieces[0].start(), l.pieces[l.pieces.len() - 1].end());
    let at = |p: DVec2| if axis == 0 { DVec2::new(p.x, edge) } else { DVec2::new(edge, p.y) };
    let mut pieces = l.pieces.clone();
    pieces.push(Piece::line(b, at(b)));
    pieces.push(Piece::line(at(b), at(a)));
    pieces.push(Piece::line(at(a), a));
    Some(RawLoop { role: LoopRole::Outer, pieces })
}

/// Where the surface ends across `axis`: poles, or the ends of a spline.
fn edges(carrier: &Carrier, axis: usize) -> (Option<f64>, Option<f64>) {
    match carrier {
        Carrier::Analytic(surface) => match surface.shape {
            Shape::Sphere { .. } | Shape::Cone { .. } => {
                let (low, high) = surface.limits_v();
                (Some(low), Some(high).filter(|h| h.is_finite()))
            }
            _ => (None, None),
        },
        Carrier::Spline(spline) => {
            let surface = spline.surface();
            let (a, b) = if axis == 0 { surface.knots_v().domain() } else { surface.knots_u().domain() };
            (Some(a), Some(b))
        }
    }
}

/// Moves the first loop into the first period, the others next to it.
fn gather(carrier: &Carrier, loops: &mut [RawLoop]) {
    let periods = carrier.periods();
    let mut home: Option<(DVec2, DVec2)> = None;
    for l in loops.iter_mut() {
        let Some((min, max)) = bounds(l.curves()) else { continue };
        let mut shift = DVec2::ZERO;
        for axis in 0..2 {
            let Some(period) = periods[axis] else { continue };
            let seam = seam(carrier, axis);
            shift[axis] = match home {
                // A hair below the seam is rounding, not another turn.
                None => -((min[axis] - seam) / period + 1e-7).floor() * period,
                Some((a, b)) => {
                    let middle = 0.5 * (a[axis] + b[axis] - min[axis] - max[axis]);
                    (middle / period).round() * period
                }
            };
        }
        if shift != DVec2::ZERO {
            l.pieces = l.pieces.iter().map(|p| p.shifted(shift)).collect();
        }
        home.get_or_insert((min + shift, max + shift));
    }
}
