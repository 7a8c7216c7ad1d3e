//! The curves of loops as lists: closing, copying, pasting, deleting, roles, untrimming.

use glam::{DAffine2, DVec2};

use super::address::{CurveId, Subject};
use super::arrange::{hull, mapped, named};
use super::error::{OperationError, Place, Problem};
use super::joints::{End, LoopChange, end_point, with_end};
use super::limits;
use crate::kernel::nurbs::NurbsCurve2;
use crate::scene::edit::{Change, Edit};
use crate::scene::records::{LoopRecord, LoopRole};

/// Puts ends that miss each other hardly together, and bridges wider gaps with lines.
pub(super) fn close(subject: &Subject, loops: &[usize]) -> Result<Edit, OperationError> {
    let mut changes = Vec::new();
    for at in named(subject, loops)? {
        let before = subject.view.loops[at];
        let after = closed(subject, at)?;
        if after != *before {
            changes.push(Change::Loops {
                face: subject.id,
                at,
                before: vec![before.clone()],
                after: vec![after],
            });
        }
    }
    if changes.is_empty() {
        let place = Place { trim_loop: (loops.len() == 1).then(|| loops[0]), ..Place::face(subject.id) };
        return Err(place.refused("it is closed already"));
    }
    Ok(Edit::new("Close loop", changes))
}

fn closed(subject: &Subject, at: usize) -> Result<LoopRecord, OperationError> {
    let trim = subject.trim_loop(at)?;
    let joints = LoopChange::of(subject, at)?;
    let count = trim.curves.len();
    let known = trim.edges.len() == count;
    let mut result = LoopRecord { role: trim.role, ..LoopRecord::default() };
    let mut first = None;
    for (i, curve) in trim.curves.iter().enumerate() {
        let mut curve = curve.clone();
        if let Some(start) = first.take() {
            curve =
                with_end(&curve, End::Start, start).map_err(|e| Place::curve(subject.id, at, i).error(e))?;
        }
        let (end, next) =
            (end_point(&curve, End::Finish), end_point(&trim.curves[(i + 1) % count], End::Start));
        let edge = trim.edges.get(i).copied().flatten();
        let mut push = |curve, edge| {
            result.curves.push(curve);
            result.edges.extend(known.then_some(edge));
        };
        match joints.joint(i) {
            // Joined over a seam, or exactly.
            Some(_) if end == next => push(curve, edge),
            Some(shift) if i + 1 < count => {
                first = Some(end + shift);
                push(curve, edge);
            }
            Some(shift) => {
                let to = next - shift;
                let place = Place::curve(subject.id, at, i);
                push(with_end(&curve, End::Finish, to).map_err(|e| place.error(e))?, edge);
            }
            None => {
                push(curve, edge);
                push(NurbsCurve2::line(end, next), None);
            }
        }
    }
    Ok(result)
}

pub(super) fn duplicate(subject: &Subject, loops: &[usize], by: DVec2) -> Result<Edit, OperationError> {
    let copies: Vec<LoopRecord> =
        named(subject, loops)?.into_iter().map(|at| subject.view.loops[at].clone()).collect();
    let edit = paste(subject, &copies, by)?;
    Ok(Edit { label: "Duplicate loop".into(), ..edit })
}

pub(super) fn paste(subject: &Subject, loops: &[LoopRecord], by: DVec2) -> Result<Edit, OperationError> {
    let place = Place::face(subject.id);
    let map = DAffine2::from_translation(limits::finite2(place, ["by u", "by v"], by)?);
    if loops.is_empty() || !hull(loops).min.is_finite() {
        return Err(place.error(Problem::Nothing { what: "loops" }));
    }
    let at = subject.view.loops.len();
    let copy = |(k, trim): (usize, &LoopRecord)| {
        // A copy bounds no edge of the model that the original bounds.
        Ok(LoopRecord::new(trim.role, mapped(subject, at + k, &trim.curves, map)?))
    };
    let after = loops.iter().enumerate().map(copy).collect::<Result<_, OperationError>>()?;
    Ok(Edit::new("Paste loop", vec![Change::Loops { face: subject.id, at, before: Vec::new(), after }]))
}

/// Takes curves away; a loop that loses all of them goes too. What is left may be open, which is for
/// [`close`] to mend and for the validity check to report.
pub(super) fn delete_curves(subject: &Subject, curves: &[CurveId]) -> Result<Edit, OperationError> {
    if curves.is_empty() {
        return Err(Place::face(subject.id).error(Problem::Nothing { what: "curves" }));
    }
    let mut curves = curves.to_vec();
    curves.sort_unstable();
    curves.dedup();
    curves.iter().try_for_each(|id| subject.curve(*id).map(drop))?;
    let mut loops: Vec<usize> = curves.iter().map(|id| id.trim_loop).collect();
    loops.dedup();
    let changes = loops.into_iter().rev().map(|at| {
        let before = subject.view.loops[at];
        let goes = |curve: usize| curves.binary_search(&CurveId { trim_loop: at, curve }).is_ok();
        let known = before.edges.len() == before.curves.len();
        let stays: Vec<usize> = (0..before.curves.len()).filter(|c| !goes(*c)).collect();
        let after = LoopRecord {
            role: before.role,
            curves: stays.iter().map(|c| before.curves[*c].clone()).collect(),
            edges: if known { stays.iter().map(|c| before.edges[*c]).collect() } else { Vec::new() },
        };
        let after = if after.curves.is_empty() { Vec::new() } else { vec![after] };
        Change::Loops { face: subject.id, at, before: vec![before.clone()], after }
    });
    Ok(Edit::new(if curves.len() == 1 { "Delete curve" } else { "Delete curves" }, changes.collect()))
}

pub(super) fn set_role(subject: &Subject, loops: &[usize], role: LoopRole) -> Result<Edit, OperationError> {
    let changes = named(subject, loops)?.into_iter().map(|trim_loop| {
        let before = subject.view.loops[trim_loop].role;
        Change::Role { face: subject.id, trim_loop, before, after: role }
    });
    let label = match role {
        LoopRole::Outer => "Make outer loop",
        LoopRole::Inner => "Make hole",
        LoopRole::Unknown => "Forget role",
    };
    Ok(Edit::new(label, changes.collect()))
}

pub(super) fn untrim(subject: &Subject) -> Result<Edit, OperationError> {
    let before: Vec<LoopRecord> = subject.view.loops.iter().map(|l| (*l).clone()).collect();
    if before.is_empty() {
        return Err(Place::face(subject.id).refused("it has no trim loops"));
    }
    let change = Change::Loops { face: subject.id, at: 0, before, after: Vec::new() };
    Ok(Edit::new("Untrim", vec![change]))
}
