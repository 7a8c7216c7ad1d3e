//! Moving control points and whole curves of trim loops, and their weights.

use std::collections::BTreeMap;

use glam::DVec2;

use super::address::{CurveId, PointId, Subject};
use super::error::{OperationError, Place, Problem};
use super::joints::LoopChange;
use super::limits::{self, Fence};
use crate::kernel::nurbs::NurbsCurve2;
use crate::kernel::trim::UvRect;
use crate::scene::edit::{Change, Edit};

/// The curves that have one of `points`, each with the positions of those points, sorted.
fn by_curve(subject: &Subject, points: &[PointId]) -> Result<BTreeMap<CurveId, Vec<usize>>, OperationError> {
    if points.is_empty() {
        return Err(Place::face(subject.id).error(Problem::Nothing { what: "points" }));
    }
    let mut curves: BTreeMap<CurveId, Vec<usize>> = BTreeMap::new();
    for id in points {
        subject.curve_of_point(*id)?;
        curves.entry(id.curve_id()).or_default().push(id.point);
    }
    for positions in curves.values_mut() {
        positions.sort_unstable();
        positions.dedup();
    }
    Ok(curves)
}

/// Replaces curves one by one, lets their neighbours follow, and collects the changes of all loops.
fn replace<T>(
    subject: &Subject,
    curves: &BTreeMap<CurveId, T>,
    new: impl Fn(CurveId, &NurbsCurve2, &T) -> Result<NurbsCurve2, OperationError>,
) -> Result<Vec<Change>, OperationError> {
    let mut changes = Vec::new();
    let mut open: Option<(usize, LoopChange)> = None;
    for (id, what) in curves {
        if let Some((trim_loop, _)) = &open
            && *trim_loop != id.trim_loop
            && let Some((_, change)) = open.take()
        {
            changes.extend(change.finish()?);
        }
        let (_, change) = match &mut open {
            Some(open) => open,
            None => open.insert((id.trim_loop, LoopChange::of(subject, id.trim_loop)?)),
        };
        change.put(id.curve, new(*id, subject.curve(*id)?, what)?);
    }
    if let Some((_, change)) = open {
        changes.extend(change.finish()?);
    }
    Ok(changes)
}

/// `curve` with other control points.
fn with_points(place: Place, curve: &NurbsCurve2, points: Vec<DVec2>) -> Result<NurbsCurve2, OperationError> {
    NurbsCurve2::new(curve.knots().clone(), points, curve.weights().to_vec()).map_err(|e| place.error(e))
}

pub(super) fn move_points(
    subject: &Subject,
    points: &[PointId],
    by: DVec2,
    beyond: bool,
) -> Result<Edit, OperationError> {
    limits::finite2(Place::face(subject.id), ["by u", "by v"], by)?;
    let fence = Fence::around(subject);
    let changes = replace(subject, &by_curve(subject, points)?, |id, curve, positions| {
        let mut moved = curve.points().to_vec();
        for &k in positions {
            let to = if beyond { moved[k] + by } else { fence.moved(subject, moved[k], by) };
            let place = Place::point(subject.id, id.trim_loop, id.curve, k);
            moved[k] = limits::trim_point(subject, place, to)?;
        }
        with_points(subject.place(id), curve, moved)
    })?;
    let label = match points {
        [_] => "Move control point".to_owned(),
        _ => format!("Move {} control points", points.len()),
    };
    Ok(Edit::new(label, changes))
}

pub(super) fn set_point(
    subject: &Subject,
    point: PointId,
    to: DVec2,
    beyond: bool,
) -> Result<Edit, OperationError> {
    let place = Place::point(subject.id, point.trim_loop, point.curve, point.point);
    limits::trim_point(subject, place, to)?;
    let domain = subject.view.domain();
    if !beyond && !domain.contains(to) {
        let (periods, near) = (subject.view.periods(), to.clamp(domain.min, domain.max));
        if (0..2).any(|axis| near[axis] != to[axis] && periods[axis] == 0.0) {
            let domain = [domain.min.x, domain.max.x, domain.min.y, domain.max.y];
            return Err(place.error(Problem::OutsideDomain { u: to.x, v: to.y, domain }));
        }
    }
    let changes = replace(subject, &by_curve(subject, &[point])?, |id, curve, _| {
        let mut points = curve.points().to_vec();
        points[point.point] = to;
        with_points(subject.place(id), curve, points)
    })?;
    Ok(Edit::new("Set control point", changes))
}

pub(super) fn set_weight(subject: &Subject, points: &[PointId], weight: f64) -> Result<Edit, OperationError> {
    let changes = replace(subject, &by_curve(subject, points)?, |id, curve, positions| {
        let mut weights = curve.weights().to_vec();
        for &k in positions {
            let place = Place::point(subject.id, id.trim_loop, id.curve, k);
            weights[k] = limits::weight(place, weight)?;
        }
        NurbsCurve2::new(curve.knots().clone(), curve.points().to_vec(), weights)
            .map_err(|e| subject.place(id).error(e))
    })?;
    Ok(Edit::new("Set weight", changes))
}

pub(super) fn move_curves(
    subject: &Subject,
    curves: &[CurveId],
    by: DVec2,
    beyond: bool,
) -> Result<Edit, OperationError> {
    limits::finite2(Place::face(subject.id), ["by u", "by v"], by)?;
    if curves.is_empty() {
        return Err(Place::face(subject.id).error(Problem::Nothing { what: "curves" }));
    }
    let mut hull = UvRect::EMPTY;
    for id in curves {
        subject.curve(*id)?.points().iter().for_each(|p| hull.include(*p));
    }
    let by = if beyond { by } else { Fence::around(subject).shift(subject, hull, by) };
    let all: BTreeMap<CurveId, ()> = curves.iter().map(|id| (*id, ())).collect();
    let changes = replace(subject, &all, |id, curve, ()| {
        let moved = curve.points().iter().enumerate().map(|(k, p)| {
            let place = Place::point(subject.id, id.trim_loop, id.curve, k);
            limits::trim_point(subject, place, *p + by)
        });
        with_points(subject.place(id), curve, moved.collect::<Result<_, _>>()?)
    })?;
    let label = match curves {
        [_] => "Move curve".to_owned(),
        _ => format!("Move {} curves", curves.len()),
    };
    Ok(Edit::new(label, changes))
}
