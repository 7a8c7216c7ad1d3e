//! One curve at a time: knots, degree, splitting, joining. All keep the shape, exactly or within a tolerance.

use super::address::{CurveId, Subject};
use super::error::{OperationError, Problem};
use super::joints::{End, LoopChange, end_point, with_end};
use super::limits;
use crate::kernel::nurbs::{Coarse, Direction, KnotVector, NurbsCurve2, NurbsError};
use crate::scene::edit::{Change, Edit};
use crate::scene::records::LoopRecord;
use glam::DVec2;

/// Changes below this fraction of the domain's size are rounding, not a change of shape.
const EXACT: f64 = 1e-12;

/// Largest change of shape allowed: the one asked for, else what counts as exact for the face.
fn tolerance(subject: &Subject, id: CurveId, asked: Option<f64>) -> Result<f64, OperationError> {
    match asked {
        Some(0.0) => Ok(0.0),
        Some(value) => limits::positive(subject.place(id), "tolerance", value),
        None => Ok(EXACT * subject.view.domain().size().max_element()),
    }
}

/// The edit that replaces `count` curves from `id` on by `after`; edges follow the first of them.
fn replace(subject: &Subject, id: CurveId, label: &str, count: usize, after: Vec<NurbsCurve2>) -> Edit {
    let face = subject.id;
    let before = subject.view.loops[id.trim_loop];
    if count == after.len() && count == 1 {
        let before = vec![before.curves[id.curve].clone()];
        let change = Change::Curves { face, trim_loop: id.trim_loop, at: id.curve, before, after };
        return Edit::new(label, vec![change]);
    }
    let mut changed: LoopRecord = before.clone();
    if changed.edges.len() == changed.curves.len() {
        let edge = changed.edges[id.curve];
        changed.edges.splice(id.curve..id.curve + count, std::iter::repeat_n(edge, after.len()));
    }
    changed.curves.splice(id.curve..id.curve + count, after);
    let change = Change::Loops { face, at: id.trim_loop, before: vec![before.clone()], after: vec![changed] };
    Edit::new(label, vec![change])
}

/// Refuses a parameter that is not inside the domain of knots.
pub(super) fn inside(
    place: super::Place,
    knots: &KnotVector,
    what: &'static str,
    at: f64,
) -> Result<f64, OperationError> {
    limits::finite(place, what, at)?;
    let (start, end) = knots.domain();
    if at > start && at < end {
        return Ok(at);
    }
    Err(place.refused(format!("{what} {at} is not inside the domain from {start} to {end}")))
}

/// Refuses more repeats of a knot than keep a spline in one piece.
pub(super) fn repeats(
    place: super::Place,
    knots: &KnotVector,
    at: f64,
    times: usize,
) -> Result<Vec<f64>, OperationError> {
    let (there, most) = (knots.multiplicity(at), knots.degree());
    if times == 0 || there + times > most {
        let reason =
            format!("knot {at} is there {there} times and can be at most {most} times, not {times} more");
        return Err(place.refused(reason));
    }
    Ok(vec![at; times])
}

pub(super) fn insert_knot(
    subject: &Subject,
    id: CurveId,
    at: f64,
    times: usize,
) -> Result<Edit, OperationError> {
    let (curve, place) = (subject.curve(id)?, subject.place(id));
    inside(place, curve.knots(), "knot", at)?;
    let knots = repeats(place, curve.knots(), at, times)?;
    let curve = curve.inserted(&knots).map_err(|e| place.error(e))?;
    Ok(replace(subject, id, "Insert knot", 1, vec![curve]))
}

/// `coarse` if it stays within the tolerance.
fn accepted(
    subject: &Subject,
    id: CurveId,
    what: &'static str,
    coarse: Result<Option<Coarse<DVec2>>, NurbsError>,
    tolerance: f64,
) -> Result<NurbsCurve2, OperationError> {
    let place = subject.place(id);
    match coarse.map_err(|e| place.error(e))? {
        Some(Coarse { curve, deviation }) if deviation <= tolerance => Ok(curve),
        Some(Coarse { deviation, .. }) => Err(place.error(Problem::Deviation { what, deviation, tolerance })),
        None => Err(place.refused(format!("{what} is not possible here"))),
    }
}

pub(super) fn remove_knot(
    subject: &Subject,
    id: CurveId,
    at: f64,
    asked: Option<f64>,
) -> Result<Edit, OperationError> {
    let (curve, place) = (subject.curve(id)?, subject.place(id));
    let tolerance = tolerance(subject, id, asked)?;
    limits::finite(place, "knot", at)?;
    let (start, end) = curve.domain();
    let inner: Vec<f64> = curve.knots().breaks().into_iter().filter(|k| *k > start && *k < end).collect();
    let Some(nearest) = inner.into_iter().min_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs())) else {
        return Err(place.refused("the curve has no inner knots"));
    };
    // Typed numbers are rounded; anything further away is another knot.
    if (nearest - at).abs() > 1e-6 * (end - start) {
        return Err(place.refused(format!("{at} is no inner knot; the nearest is {nearest}")));
    }
    let curve = accepted(subject, id, "removing the knot", curve.knot_removed(nearest), tolerance)?;
    Ok(replace(subject, id, "Remove knot", 1, vec![curve]))
}

pub(super) fn elevate(subject: &Subject, id: CurveId, by: usize) -> Result<Edit, OperationError> {
    let curve = subject.curve(id)?.elevated(by.clamp(1, crate::kernel::nurbs::knots::MAX_DEGREE));
    let curve = curve.map_err(|e| subject.place(id).error(e))?;
    Ok(replace(subject, id, "Elevate degree", 1, vec![curve]))
}

pub(super) fn reduce(subject: &Subject, id: CurveId, asked: Option<f64>) -> Result<Edit, OperationError> {
    let tolerance = tolerance(subject, id, asked)?;
    let reduced = subject.curve(id)?.degree_reduced();
    let curve = accepted(subject, id, "reducing the degree", reduced, tolerance)?;
    Ok(replace(subject, id, "Reduce degree", 1, vec![curve]))
}

pub(super) fn split(subject: &Subject, id: CurveId, at: f64) -> Result<Edit, OperationError> {
    let (curve, place) = (subject.curve(id)?, subject.place(id));
    inside(place, curve.knots(), "parameter", at)?;
    let (start, end) = curve.domain();
    let parts = || -> Result<_, NurbsError> {
        let first = curve.restricted(start, at)?;
        let second = with_end(&curve.restricted(at, end)?, End::Start, end_point(&first, End::Finish))?;
        Ok(vec![first, second])
    };
    Ok(replace(subject, id, "Split curve", 1, parts().map_err(|e| place.error(e))?))
}

pub(super) fn join(subject: &Subject, id: CurveId, asked: Option<f64>) -> Result<Edit, OperationError> {
    let (curve, place) = (subject.curve(id)?, subject.place(id));
    let trim = subject.trim_loop(id.trim_loop)?;
    let count = trim.curves.len();
    if count < 2 {
        return Err(place.refused("it is the only curve of its loop, so it has no neighbour to join"));
    }
    let tolerance = tolerance(subject, id, asked)?;
    let next = (id.curve + 1) % count;
    let neighbour = &trim.curves[next];
    let joint = LoopChange::of(subject, id.trim_loop)?.joint(id.curve);
    let gap = end_point(neighbour, End::Start) - end_point(curve, End::Finish);
    let Some(shift) = joint else {
        let deviation = gap.length();
        if deviation > tolerance {
            return Err(place.error(Problem::Deviation {
                what: "closing the gap to the next curve",
                deviation,
                tolerance,
            }));
        }
        return finish_join(subject, id, curve, neighbour, tolerance);
    };
    let shifted =
        if shift == DVec2::ZERO { neighbour.clone() } else { neighbour.map_points(|p: DVec2| p - shift) };
    finish_join(subject, id, curve, &shifted, tolerance)
}

/// Joins, then removes the repeats of the knot between as long as the shape stays.
fn finish_join(
    subject: &Subject,
    id: CurveId,
    first: &NurbsCurve2,
    second: &NurbsCurve2,
    tolerance: f64,
) -> Result<Edit, OperationError> {
    let place = subject.place(id);
    let end = first.domain().1;
    let mut joined = first.joined(second).map_err(|e| place.error(e))?;
    let mut left = tolerance;
    while joined.knots().multiplicity(end) > 0 {
        match joined.knot_removed(end).map_err(|e| place.error(e))? {
            Some(Coarse { curve, deviation }) if deviation <= left => {
                joined = curve;
                left -= deviation;
            }
            _ => break,
        }
    }
    let trim = subject.view.loops[id.trim_loop];
    if id.curve + 1 < trim.curves.len() {
        return Ok(replace(subject, id, "Join curves", 2, vec![joined]));
    }
    // The last curve with the first: the loop begins with what they become.
    let mut changed = trim.clone();
    changed.curves.pop();
    changed.curves[0] = joined;
    if changed.edges.len() == trim.curves.len() {
        changed.edges.pop();
    }
    let (before, after) = (vec![trim.clone()], vec![changed]);
    let change = Change::Loops { face: subject.id, at: id.trim_loop, before, after };
    Ok(Edit::new("Join curves", vec![change]))
}

/// The direction's name in words.
pub(super) fn letter(direction: Direction) -> &'static str {
    match direction {
        Direction::U => "knot in u",
        Direction::V => "knot in v",
    }
}
