//! Surfaces as wholes: knots, degree, and other parametrisations of the same shape.
//!
//! Turning a parameter round or exchanging the two maps the trims along and turns loops round too, since what
//! is to the left of a loop would else be to its right; the face's normal stays where it was.

use glam::DVec2;

use super::address::Subject;
use super::arrange::reversed;
use super::curves::{inside, letter, repeats};
use super::error::{OperationError, Place};
use crate::kernel::nurbs::{Direction, KnotVector, NurbsSurface};
use crate::scene::edit::{Change, Edit};
use crate::scene::records::LoopRecord;

fn replace(subject: &Subject, label: &str, after: NurbsSurface) -> Edit {
    let before = Box::new(subject.view.surface.clone());
    Edit::new(label, vec![Change::Surface { face: subject.id, before, after: Box::new(after) }])
}

pub(super) fn insert_knot(
    subject: &Subject,
    direction: Direction,
    at: f64,
    times: usize,
) -> Result<Edit, OperationError> {
    let place = Place::face(subject.id);
    let knots = subject.view.surface.knots(direction);
    inside(place, knots, letter(direction), at)?;
    let knots = repeats(place, knots, at, times)?;
    let surface = subject.view.surface.inserted(direction, &knots).map_err(|e| place.error(e))?;
    Ok(replace(subject, "Insert surface knot", surface))
}

pub(super) fn elevate(subject: &Subject, direction: Direction, by: usize) -> Result<Edit, OperationError> {
    let times = by.clamp(1, crate::kernel::nurbs::knots::MAX_DEGREE);
    let surface = subject.view.surface.elevated(direction, times);
    Ok(replace(subject, "Elevate surface degree", surface.map_err(|e| Place::face(subject.id).error(e))?))
}

/// The edit to `surface` with all trims mapped and turned round, and the normal flag toggled.
fn reparametrised(
    subject: &Subject,
    label: &str,
    surface: NurbsSurface,
    map: impl Fn(DVec2) -> DVec2,
) -> Edit {
    let mut edit = replace(subject, label, surface);
    let before: Vec<LoopRecord> = subject.view.loops.iter().map(|l| (*l).clone()).collect();
    if !before.is_empty() {
        let after = before.iter().map(|trim| {
            let mut turned = reversed(trim);
            turned.curves.iter_mut().for_each(|c| *c = c.map_points(&map));
            turned
        });
        let after = after.collect();
        edit.changes.push(Change::Loops { face: subject.id, at: 0, before, after });
    }
    edit.changes.push(normal_flipped(subject));
    edit
}

fn normal_flipped(subject: &Subject) -> Change {
    let before = Box::new(subject.view.attributes.clone());
    let mut after = before.clone();
    after.reversed = !after.reversed;
    Change::Attributes { face: subject.id, before, after }
}

pub(super) fn reverse(subject: &Subject, direction: Direction) -> Result<Edit, OperationError> {
    let surface = subject.view.surface;
    let (nu, nv) = surface.counts();
    let knots = surface.knots(direction);
    let (start, end) = knots.domain();
    let mirrored = knots.as_slice().iter().rev().map(|k| start + end - k).collect();
    let place = Place::face(subject.id);
    let invalid =
        |direction, source| place.error(crate::kernel::nurbs::NurbsError::Knots { direction, source });
    let mirrored = KnotVector::new(knots.degree(), mirrored).map_err(|e| invalid("u or v", e))?;
    let order = (0..nu * nv).map(|k| match direction {
        Direction::U => (nu - 1 - k / nv) * nv + k % nv,
        Direction::V => (k / nv) * nv + nv - 1 - k % nv,
    });
    let (points, weights) = order.map(|k| (surface.points()[k], surface.weights()[k])).unzip();
    let (knots_u, knots_v, axis) = match direction {
        Direction::U => (mirrored, surface.knots_v().clone(), 0),
        Direction::V => (surface.knots_u().clone(), mirrored, 1),
    };
    let turned = NurbsSurface::new(knots_u, knots_v, points, weights).map_err(|e| place.error(e))?;
    let map = |mut p: DVec2| {
        p[axis] = start + end - p[axis];
        p
    };
    Ok(reparametrised(subject, "Reverse surface", turned, map))
}

pub(super) fn swap(subject: &Subject) -> Edit {
    reparametrised(subject, "Swap u and v", subject.view.surface.transposed(), |p| DVec2::new(p.y, p.x))
}

pub(super) fn flip_normal(subject: &Subject) -> Edit {
    Edit::new("Flip normal", vec![normal_flipped(subject)])
}
