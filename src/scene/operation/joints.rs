//! Neighbouring curves of a loop that end where the next one begins stay together when one of them changes.
//!
//! Two ends are joined when they coincide, miss each other by no more than trimming closes silently, or
//! lie whole periods of a closed surface apart. After a change the unchanged neighbour's end is put
//! exactly on the changed curve's end (plus those periods), so joints never open, and sloppy ones close.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use glam::DVec2;

use super::address::Subject;
use super::error::{OperationError, Place};
use crate::kernel::nurbs::{NurbsCurve2, NurbsError};
use crate::scene::edit::Change;

/// Ends nearer than this fraction of the domain's size are joined; larger gaps are remarked on by trimming.
pub const JOINED: f64 = 1e-6;

/// One of the two ends of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    Start,
    Finish,
}

/// A loop some of whose curves are being replaced.
#[derive(Debug)]
pub(super) struct LoopChange<'a> {
    subject: &'a Subject<'a>,
    trim_loop: usize,
    curves: &'a [NurbsCurve2],
    changed: BTreeMap<usize, NurbsCurve2>,
    size: DVec2,
    periods: OnceCell<DVec2>,
}

/// The point where a curve starts or ends.
pub(super) fn end_point(curve: &NurbsCurve2, end: End) -> DVec2 {
    let (knots, p) = (curve.knots().as_slice(), curve.degree());
    let (first, last) = (knots[0] == knots[p], knots[knots.len() - 1] == knots[knots.len() - p - 1]);
    let points = curve.points();
    match end {
        End::Start if first => points[0],
        End::Finish if last => points[points.len() - 1],
        End::Start => curve.point(curve.domain().0),
        End::Finish => curve.point(curve.domain().1),
    }
}

/// The curve with one end put at `to`; the rest of its control points stay.
pub(super) fn with_end(curve: &NurbsCurve2, end: End, to: DVec2) -> Result<NurbsCurve2, NurbsError> {
    let clamped;
    let curve = if curve.knots().is_clamped() {
        curve
    } else {
        clamped = curve.clamped();
        &clamped
    };
    let mut points = curve.points().to_vec();
    let at = match end {
        End::Start => 0,
        End::Finish => points.len() - 1,
    };
    points[at] = to;
    NurbsCurve2::new(curve.knots().clone(), points, curve.weights().to_vec())
}

impl<'a> LoopChange<'a> {
    /// No change yet of loop `trim_loop`.
    pub fn of(subject: &'a Subject<'a>, trim_loop: usize) -> Result<Self, OperationError> {
        let curves = &subject.trim_loop(trim_loop)?.curves;
        let size = subject.view.domain().size();
        Ok(Self { subject, trim_loop, curves, changed: BTreeMap::new(), size, periods: OnceCell::new() })
    }

    /// The curve as it is now.
    pub fn curve(&self, index: usize) -> &NurbsCurve2 {
        self.changed.get(&index).unwrap_or(&self.curves[index])
    }

    /// Replaces a curve.
    pub fn put(&mut self, index: usize, curve: NurbsCurve2) {
        self.changed.insert(index, curve);
    }

    fn periods(&self) -> DVec2 {
        *self.periods.get_or_init(|| self.subject.view.periods())
    }

    /// How far the start of the curve after `index` lies from the end of `index` before any change: whole
    /// periods, or `None` when the two are not joined.
    pub fn joint(&self, index: usize) -> Option<DVec2> {
        let next = (index + 1) % self.curves.len();
        let gap = end_point(&self.curves[next], End::Start) - end_point(&self.curves[index], End::Finish);
        let is_small = |gap: DVec2| (gap / self.size).abs().max_element() <= JOINED;
        if is_small(gap) {
            return Some(DVec2::ZERO);
        }
        let periods = self.periods();
        let turns = |gap: f64, period: f64| if period > 0.0 { (gap / period).round() * period } else { 0.0 };
        let shift = DVec2::new(turns(gap.x, periods.x), turns(gap.y, periods.y));
        is_small(gap - shift).then_some(shift)
    }

    /// Lets the neighbours' ends follow the curves put so far, and makes the changes.
    pub fn finish(mut self) -> Result<Vec<Change>, OperationError> {
        let put: Vec<usize> = self.changed.keys().copied().collect();
        let count = self.curves.len();
        for index in put {
            let before = (index + count - 1) % count;
            if let Some(shift) = self.joint(index) {
                self.follow((index, End::Finish), ((index + 1) % count, End::Start), shift)?;
            }
            if let Some(shift) = self.joint(before) {
                self.follow((index, End::Start), (before, End::Finish), -shift)?;
            }
        }
        Ok(self.changes())
    }

    /// Puts end `to` where end `from` went, unless it moved by itself.
    fn follow(&mut self, from: (usize, End), to: (usize, End), shift: DVec2) -> Result<(), OperationError> {
        let moved = |curves: &Self, (index, end): (usize, End)| {
            let (old, new) = (end_point(&curves.curves[index], end), end_point(curves.curve(index), end));
            (old != new).then_some(new)
        };
        let Some(target) = moved(self, from) else { return Ok(()) };
        if moved(self, to).is_some() {
            return Ok(());
        }
        let place = Place::curve(self.subject.id, self.trim_loop, to.0);
        let curve = with_end(self.curve(to.0), to.1, target + shift).map_err(|e| place.error(e))?;
        self.changed.insert(to.0, curve);
        Ok(())
    }

    /// One change for each run of neighbouring curves.
    fn changes(self) -> Vec<Change> {
        let mut changes: Vec<Change> = Vec::new();
        for (index, curve) in self.changed {
            let old = self.curves[index].clone();
            if let Some(Change::Curves { at, before, after, .. }) = changes.last_mut()
                && *at + before.len() == index
            {
                before.push(old);
                after.push(curve);
                continue;
            }
            let (face, trim_loop) = (self.subject.id, self.trim_loop);
            changes.push(Change::Curves {
                face,
                trim_loop,
                at: index,
                before: vec![old],
                after: vec![curve],
            });
        }
        changes
    }
}

#[cfg(test)]
mod tests {
    use crate::kernel::nurbs::NurbsCurve2;
    use crate::scene::document::SceneRecord;
    use crate::scene::edit::FaceId;
    use crate::scene::operation::{Operation, PointId};
    use glam::DVec2;

    fn joined(curves: &[NurbsCurve2]) -> bool {
        (0..curves.len())
            .all(|i| curves[i].points().last() == curves[(i + 1) % curves.len()].points().first())
    }

    #[test]
    fn neighbours_follow_round_the_loop_and_in_a_single_closed_curve() {
        let mut scene = SceneRecord::of_model(Default::default());
        scene.models[0].faces.push(crate::scene::demo::holes(4));
        for (trim_loop, curve, point) in [(0, 0, 0), (0, 3, 1), (1, 0, 0), (1, 0, 8)] {
            let points = vec![PointId { trim_loop, curve, point }];
            let operation = Operation::MovePoints {
                face: FaceId::default(),
                points,
                by: DVec2::new(0.01, 0.02),
                beyond: true,
            };
            let before = scene.models[0].faces[0].loops[trim_loop].clone();
            operation.perform(&scene).expect("possible").apply(&mut scene).expect("fits");
            let after = &scene.models[0].faces[0].loops[trim_loop];
            assert!(joined(&after.curves) && *after != before);
        }
    }

    #[test]
    fn a_ring_stays_closed_over_the_seam() {
        let mut scene = SceneRecord::of_model(Default::default());
        let mut face = crate::scene::demo::model()
            .faces
            .iter()
            .find(|f| f.name.as_deref() == Some("Ring"))
            .expect("the torus")
            .clone();
        let (u0, u1) = face.surface.knots_u().domain();
        face.loops.truncate(1);
        face.loops[0].curves = vec![NurbsCurve2::line(DVec2::new(u0, 1.0), DVec2::new(u1, 1.0))];
        scene.models[0].faces.push(face);
        let points = vec![PointId { trim_loop: 0, curve: 0, point: 1 }];
        let by = DVec2::new(0.25, -0.5);
        let operation = Operation::MovePoints { face: FaceId::default(), points, by, beyond: false };
        operation.perform(&scene).expect("possible").apply(&mut scene).expect("fits");
        let points = scene.models[0].faces[0].loops[0].curves[0].points();
        assert_eq!(points[1], DVec2::new(u1 + 0.25, 0.5));
        assert_eq!(points[0], DVec2::new(u0 + 0.25, 0.5));
    }
}
