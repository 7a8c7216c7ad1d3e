//! Where pieces of loops meet: a sweep over their boxes, then halving with fat lines.
//!
//! Two monotone pieces are apart when the boxes of their ends are, or when all control points of one lie on
//! one side of the band around the other's chord that holds the other (Sederberg & Nishita 1990). What is
//! left is halved until both are straight, and then their chords decide. Neighbours may meet in their common
//! end; pieces that stay together over a length are reported once.

use glam::DVec2;

use super::loops::{CutLoop, MonotonePiece};
use super::{At, LoopProblem, MOST, ProblemKind};
use crate::kernel::bezier::BezierCurve2;
use crate::kernel::trim::domain::UvRect;

/// Pieces flatter than this fraction of the domain are their chords.
const FLAT: f64 = 1e-9;
/// Meetings this near to a common end, as a fraction of the domain, are that end.
const AT_END: f64 = 1e-6;
/// Halvings looked at for one pair; pieces that need more lie on each other.
const EFFORT: usize = 400;
/// The search ends after this many times as many places as are reported.
const GIVE_UP: usize = 4;

struct Item<'c> {
    piece: &'c MonotonePiece,
    at: At,
    /// Position in its loop and number of pieces there.
    position: (usize, usize),
    bounds: UvRect,
    /// Whether its loop is one of those that changed.
    new: bool,
}

/// Places where loops meet themselves or each other, in order.
#[derive(Debug, Clone, Default)]
pub(super) struct Crossings {
    pub found: Vec<LoopProblem>,
    /// Whether the search was given up.
    pub too_many: bool,
}

/// All places where loops meet themselves or each other. With `changed` only those at one of these loops, by
/// position in the face.
pub(super) fn find(loops: &[CutLoop], size: f64, changed: Option<&[usize]>) -> Crossings {
    let is_changed = |index: usize| changed.is_none_or(|c| c.contains(&index));
    let regions: Vec<UvRect> = loops.iter().filter(|l| is_changed(l.index)).map(|l| l.bounds).collect();
    // Everything is near when everything changed.
    let near = |bounds: &UvRect| changed.is_none() || regions.iter().any(|r| overlap(r, bounds));
    let mut items: Vec<Item> = Vec::new();
    for one in loops.iter().filter(|l| near(&l.bounds)) {
        let new = is_changed(one.index);
        let count = one.pieces.len();
        items.extend(one.pieces.iter().enumerate().filter_map(|(k, piece)| {
            let (at, bounds) = (At { trim_loop: one.index, curve: piece.curve }, piece.bounds());
            (new || near(&bounds)).then_some(Item { piece, at, position: (k, count), bounds, new })
        }));
    }
    items.sort_by(|a, b| {
        a.bounds.min.x.total_cmp(&b.bounds.min.x).then(a.at.cmp(&b.at)).then(a.position.cmp(&b.position))
    });
    let mut raw: Vec<LoopProblem> = Vec::new();
    let mut active: Vec<usize> = Vec::new();
    for (number, item) in items.iter().enumerate() {
        active.retain(|k| items[*k].bounds.max.x >= item.bounds.min.x);
        for other in active.iter().map(|k| &items[*k]) {
            let (a, b) = (&item.bounds, &other.bounds);
            if a.min.y > b.max.y || b.min.y > a.max.y || !(item.new || other.new) {
                continue;
            }
            // In the order of the loops, so that the place does not depend on what else is looked at.
            let swaps = (other.at, other.position) < (item.at, item.position);
            let (first, second) = if swaps { (other, item) } else { (item, other) };
            if let Some(uv) = meeting(first, second, size) {
                let kind = if first.at.trim_loop == second.at.trim_loop {
                    ProblemKind::CrossesItself { curve: second.at.curve }
                } else {
                    ProblemKind::Crosses { other: second.at }
                };
                raw.push(LoopProblem { at: first.at, uv, kind });
                if raw.len() >= GIVE_UP * MOST {
                    return Crossings { found: once(raw, size), too_many: true };
                }
            }
        }
        active.push(number);
    }
    Crossings { found: once(raw, size), too_many: false }
}

fn overlap(a: &UvRect, b: &UvRect) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}

/// In order, each place of two curves once.
fn once(mut raw: Vec<LoopProblem>, size: f64) -> Vec<LoopProblem> {
    raw.sort_by(LoopProblem::order);
    let mut found: Vec<LoopProblem> = Vec::with_capacity(raw.len());
    for one in raw {
        let same_curves = found.iter().rev().take_while(|p| p.at == one.at && p.kind == one.kind);
        if !same_curves.take(64).any(|p| p.uv.distance(one.uv) < AT_END * size) {
            found.push(one);
        }
    }
    found
}

/// A place where two pieces meet, other than an end that they share as neighbours.
fn meeting(a: &Item, b: &Item, size: f64) -> Option<DVec2> {
    let mut shared = Vec::new();
    if a.at.trim_loop == b.at.trim_loop {
        let ((i, count), (j, _)) = (a.position, b.position);
        if (i + 1) % count == j {
            shared.push(a.piece.end());
        }
        if (j + 1) % count == i {
            shared.push(b.piece.end());
        }
    }
    if !shared.is_empty() && touch_in_a_point(&a.bounds, &b.bounds) {
        return None;
    }
    let mut effort = EFFORT;
    let pair = (&a.piece.bezier, &b.piece.bezier);
    halve(pair.0, pair.1, &Search { shared: &shared, size }, &mut effort)
}

struct Search<'s> {
    /// Ends where meeting is right.
    shared: &'s [DVec2],
    /// Size of the domain.
    size: f64,
}

impl Search<'_> {
    fn is_shared(&self, p: DVec2) -> bool {
        self.shared.iter().any(|s| s.distance(p) <= AT_END * self.size)
    }
}

fn bounds(curve: &BezierCurve2) -> UvRect {
    let (a, b) = (curve.start(), curve.end());
    UvRect { min: a.min(b), max: a.max(b) }
}

fn touch_in_a_point(a: &UvRect, b: &UvRect) -> bool {
    let low = a.min.max(b.min);
    let high = a.max.min(b.max);
    low.x >= high.x && low.y >= high.y
}

fn halve(a: &BezierCurve2, b: &BezierCurve2, search: &Search, effort: &mut usize) -> Option<DVec2> {
    let (box_a, box_b) = (bounds(a), bounds(b));
    let low = box_a.min.max(box_b.min);
    let high = box_a.max.min(box_b.max);
    if !(low.x <= high.x && low.y <= high.y) || apart(a, b) || apart(b, a) {
        return None;
    }
    let middle = 0.5 * (low + high);
    // What is left lies in the end that both share.
    if search.shared.iter().any(|s| within(s, &low, &high, AT_END * search.size)) {
        return None;
    }
    if *effort == 0 {
        return (!search.is_shared(middle)).then_some(middle);
    }
    *effort -= 1;
    let flat = FLAT * search.size;
    match (flatness(a) <= flat, flatness(b) <= flat) {
        (true, true) => chords(a, b).filter(|p| !search.is_shared(*p)),
        (flat_a, flat_b) => {
            let longer = box_a.size().length_squared() >= box_b.size().length_squared();
            if !flat_a && (flat_b || longer) {
                let (first, second) = a.split(0.5);
                halve(&first, b, search, effort).or_else(|| halve(&second, b, search, effort))
            } else {
                let (first, second) = b.split(0.5);
                halve(a, &first, search, effort).or_else(|| halve(a, &second, search, effort))
            }
        }
    }
}

/// Whether the box from `low` to `high` is within `reach` of `p` as a whole.
fn within(p: &DVec2, low: &DVec2, high: &DVec2, reach: f64) -> bool {
    (*high - *p).abs().max((*p - *low).abs()).max_element() <= reach
}

/// Whether all of `b` lies strictly on one side of the band around `a`'s chord that holds `a`.
fn apart(a: &BezierCurve2, b: &BezierCurve2) -> bool {
    let (start, chord) = (a.start(), a.end() - a.start());
    let side = |p: &DVec2| chord.perp_dot(*p - start);
    let range = |points: &[DVec2]| {
        points.iter().map(side).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s), h.max(s)))
    };
    let (band, other) = (range(&a.points), range(&b.points));
    other.0 > band.1 || other.1 < band.0
}

/// Largest distance of control points from the chord.
fn flatness(curve: &BezierCurve2) -> f64 {
    let n = curve.points.len();
    if n == 2 {
        return 0.0;
    }
    let (start, chord) = (curve.start(), curve.end() - curve.start());
    let length = chord.length();
    let inner = &curve.points[1..n - 1];
    if length == 0.0 {
        return inner.iter().map(|p| p.distance(start)).fold(0.0, f64::max);
    }
    inner.iter().map(|p| chord.perp_dot(*p - start).abs() / length).fold(0.0, f64::max)
}

/// Where two chords meet, ends included.
fn chords(a: &BezierCurve2, b: &BezierCurve2) -> Option<DVec2> {
    let (p, r) = (a.start(), a.end() - a.start());
    let (q, s) = (b.start(), b.end() - b.start());
    let (across, offset) = (r.perp_dot(s), q - p);
    if across.abs() <= 1e-12 * r.length() * s.length() {
        // Along each other: they meet when an end of one lies on the other.
        let on = |from: DVec2, along: DVec2, point: DVec2| {
            let t = (point - from).dot(along) / along.length_squared();
            let off = along.perp_dot(point - from).abs() / along.length();
            (0.0..=1.0).contains(&t) && off <= 1e-12 * along.length()
        };
        let ends = [(q, on(p, r, q)), (q + s, on(p, r, q + s)), (p, on(q, s, p)), (p + r, on(q, s, p + r))];
        let meeting: Vec<DVec2> = ends.into_iter().filter(|(_, on)| *on).map(|(p, _)| p).collect();
        let count = meeting.len() as f64;
        return (!meeting.is_empty()).then(|| meeting.iter().sum::<DVec2>() / count);
    }
    let (t, u) = (offset.perp_dot(s) / across, offset.perp_dot(r) / across);
    ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u)).then(|| p + r * t)
}
