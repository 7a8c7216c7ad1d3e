//! Control points and weights of surfaces. Trims do not change: they live in the parameter plane.

use glam::DVec3;

use super::address::{NetId, Subject};
use super::error::{OperationError, Place, Problem};
use super::limits;
use crate::scene::edit::{Change, Edit, NetPoint};

/// The edit that sends each of `points` through `map`.
fn mapped(
    subject: &Subject,
    label: impl Into<String>,
    points: &[NetId],
    map: impl Fn(Place, NetPoint) -> Result<NetPoint, OperationError>,
) -> Result<Edit, OperationError> {
    if points.is_empty() {
        return Err(Place::face(subject.id).error(Problem::Nothing { what: "points" }));
    }
    let mut points = points.to_vec();
    points.sort_unstable();
    points.dedup();
    let surface = subject.view.surface;
    let (mut before, mut after) = (Vec::with_capacity(points.len()), Vec::with_capacity(points.len()));
    for id in points {
        let index = subject.net_index(id)?;
        let old = NetPoint { index, point: surface.points()[index], weight: surface.weights()[index] };
        before.push(old);
        after.push(map(Place::net(subject.id, id.i, id.j), old)?);
    }
    Ok(Edit::new(label, vec![Change::Net { face: subject.id, before, after }]))
}

pub(super) fn shift(subject: &Subject, points: &[NetId], by: DVec3) -> Result<Edit, OperationError> {
    let label = match points {
        [_] => "Move surface point".to_owned(),
        _ => format!("Move {} surface points", points.len()),
    };
    mapped(subject, label, points, |place, old| {
        Ok(NetPoint { point: limits::model_point(place, old.point + by)?, ..old })
    })
}

pub(super) fn put(subject: &Subject, point: NetId, to: DVec3) -> Result<Edit, OperationError> {
    mapped(subject, "Set surface point", &[point], |place, old| {
        Ok(NetPoint { point: limits::model_point(place, to)?, ..old })
    })
}

pub(super) fn weigh(subject: &Subject, points: &[NetId], weight: f64) -> Result<Edit, OperationError> {
    mapped(subject, "Set surface weight", points, |place, old| {
        Ok(NetPoint { weight: limits::weight(place, weight)?, ..old })
    })
}
