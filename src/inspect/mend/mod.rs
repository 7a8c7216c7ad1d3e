//! Closing a gap by its trims: one side's pcurve is fitted anew, so that its image meets the other side's curve.
//!
//! Each point of the moving curve gets a goal: the nearest point of the other side's exact curve, projected onto
//! the moving face's surface. Control points are fitted to the goals by least squares over the curve's own knots
//! and weights, and knots are added only where that does not reach the tolerance. The curve's ends move only where
//! they must, and take the ends of their neighbours in the loop along. Surfaces that do not meet cannot be
//! brought together by trims: that is refused, and the distance left is told.

pub mod batch;
mod goals;
pub mod harm;
mod refit;

use super::edge::{Edge, EdgeUse};
use super::face_curves::{lift, sides};
use super::lifted::LiftedCurve;
use super::measure::{Stretch, gap};
use super::quantity::Length;
use crate::kernel::nurbs::NurbsCurve2;
use crate::scene::edit::{Change, Edit, FaceId};
use crate::scene::records::{FaceRecord, LoopRecord, LoopRole};
use goals::Goals;
use harm::Harm;

/// What to close, and how well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MendOptions {
    /// Largest gap that may be left (model units).
    pub tolerance: f64,
    /// Position of the use whose pcurve moves; without one the first that lies on the edge with all of its curve.
    pub side: Option<usize>,
    /// Position of the model in the scene, for the edit.
    pub model: usize,
}

/// A closed gap.
#[derive(Debug, Clone, PartialEq)]
pub struct Mended {
    /// The change, to be applied and undone as one.
    pub edit: Edit,
    /// Position of its model in the scene.
    pub model: usize,
    /// The face whose pcurve moves.
    pub face: usize,
    /// Position of the use that moves.
    pub side: usize,
    /// Largest gap before (model units).
    pub before: f64,
    /// Largest gap afterwards.
    pub after: f64,
    /// How far the surface stays from the other side's curve.
    pub left: f64,
}

/// Why a gap is not closed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MendError {
    /// Not an edge of two sides.
    #[error("only edges of two sides can be closed; this one has {sides}")]
    Sides {
        /// How many it has.
        sides: usize,
    },
    /// A tolerance that is not positive.
    #[error("the tolerance {tolerance} is not positive")]
    Tolerance {
        /// The tolerance.
        tolerance: f64,
    },
    /// The faces do not have the curves that the edge names.
    #[error("face {face} has no such curve; the model has changed since the edge was found")]
    Stale {
        /// Number of the face, from 1.
        face: usize,
    },
    /// The side lies on the edge with a part of its curve only.
    #[error("only a part of the curve lies on this edge: split it there first, or move the other side")]
    Partial,
    /// The gap is within the tolerance already.
    #[error("the gap of {gap} is within the tolerance already")]
    Closed {
        /// The gap.
        gap: f64,
    },
    /// The surfaces do not meet.
    #[error("the surfaces do not meet: moving trims leaves {left} of the gap of {gap}")]
    SurfacesApart {
        /// Distance between the surface and the other side's curve.
        left: f64,
        /// The gap.
        gap: f64,
    },
    /// Other edges would be worse for it.
    #[error("closing it {}", harm.told(&|x| x.to_string()))]
    Harms {
        /// What would happen.
        harm: Harm,
    },
    /// No curve of reasonable size comes close enough.
    #[error("the best curve found leaves a gap of {reached} (before: {gap})")]
    NotReached {
        /// The smallest gap reached.
        reached: f64,
        /// The gap before.
        gap: f64,
    },
}

impl MendError {
    /// The message with lengths as people write them, for models in a unit that is `millimetres` long.
    pub fn told(&self, millimetres: f64) -> String {
        let length = |x: f64| Length { mm: x * millimetres };
        match self {
            Self::Tolerance { tolerance } => format!("the tolerance {} is not positive", length(*tolerance)),
            Self::Closed { gap } => format!("the gap of {} is within the tolerance already", length(*gap)),
            Self::SurfacesApart { left, gap } => {
                let (left, gap) = (length(*left), length(*gap));
                format!("the surfaces do not meet: moving trims leaves {left} of the gap of {gap}")
            }
            Self::NotReached { reached, gap } if reached < gap => {
                format!("the best curve found leaves {} of the gap of {}", length(*reached), length(*gap))
            }
            Self::NotReached { gap, .. } => {
                format!("moving the curve does not make the gap of {} smaller", length(*gap))
            }
            Self::Harms { harm } => format!("closing it {}", harm.told(&|x| length(x).to_string())),
            Self::Sides { .. } | Self::Stale { .. } | Self::Partial => self.to_string(),
        }
    }
}

/// Rounds of adding knots.
const ROUNDS: u32 = 9;

/// Closes the gap of `edge` of `faces`.
///
/// # Errors
/// See [`MendError`]; nothing is changed then.
pub fn close(faces: &[FaceRecord], edge: &Edge, options: &MendOptions) -> Result<Mended, MendError> {
    let [_, _] = edge.uses[..] else { return Err(MendError::Sides { sides: edge.uses.len() }) };
    if !(options.tolerance > 0.0 && options.tolerance.is_finite()) {
        return Err(MendError::Tolerance { tolerance: options.tolerance });
    }
    let tries: Vec<usize> = options.side.map_or(vec![0, 1], |side| vec![side.min(1)]);
    let mut first_error = None;
    for side in tries {
        match move_side(faces, edge, side, options) {
            Ok(mended) => return Ok(mended),
            Err(error) => first_error = first_error.or(Some(error)),
        }
    }
    Err(first_error.unwrap_or(MendError::Partial))
}

/// The loops of a face as they can be edited: a face without any gets the sides of its surface.
fn editable(record: &FaceRecord) -> FaceRecord {
    let mut record = record.clone();
    if record.loops.is_empty() {
        record.loops.push(LoopRecord::new(LoopRole::Outer, sides(&record.surface)));
    }
    record
}

fn curve_of(face: usize, record: &FaceRecord, one: &EdgeUse) -> Result<LiftedCurve, MendError> {
    let found = lift(face, record).into_iter().find(|c| c.address == one.curve);
    found.ok_or(MendError::Stale { face: face + 1 })
}

fn move_side(
    faces: &[FaceRecord],
    edge: &Edge,
    side: usize,
    options: &MendOptions,
) -> Result<Mended, MendError> {
    let (moving, still) = (&edge.uses[side], &edge.uses[1 - side]);
    let record =
        |one: &EdgeUse| faces.get(one.curve.face).ok_or(MendError::Stale { face: one.curve.face + 1 });
    let (own, other) = (editable(record(moving)?), record(still)?);
    let curve = curve_of(moving.curve.face, &own, moving)?;
    let fixed = curve_of(still.curve.face, other, still)?;
    if moving.interval != curve.domain() {
        return Err(MendError::Partial);
    }
    let target = Stretch { curve: &fixed, range: still.interval };
    let forward = moving.forward == still.forward;
    let measure =
        |c: &LiftedCurve| gap(Stretch { curve: c, range: c.domain() }, target, forward, [0, 1]).maximum;
    let before = measure(&curve);
    if before <= options.tolerance {
        return Err(MendError::Closed { gap: before });
    }
    let stale = MendError::Stale { face: moving.curve.face + 1 };
    let trim_loop = own.loops.get(moving.curve.trim_loop).ok_or(stale.clone())?;
    let pcurve = trim_loop.curves.get(moving.curve.curve).ok_or(stale)?.clamped();
    let mut goals = Goals::new(&own.surface, curve, target, forward, options.tolerance);
    let (mut best, mut reached) = (None, before);
    let mut candidate = pcurve.clone();
    for round in 0..ROUNDS {
        let Some(fitted) = goals.fit(&candidate) else { break };
        if goals.left() > options.tolerance {
            return Err(MendError::SurfacesApart { left: goals.left(), gap: before });
        }
        let loops = with_curve(trim_loop, moving.curve.curve, &fitted);
        let mut changed = own.clone();
        changed.loops[moving.curve.trim_loop].curves = loops;
        let moved = curve_of(moving.curve.face, &changed, moving)?;
        let after = measure(&moved);
        if after < reached {
            reached = after;
            best = Some(changed);
        }
        if reached <= options.tolerance {
            break;
        }
        let Some(finer) = refit::refined(&fitted, round) else { break };
        candidate = finer;
        goals.start_from(moved);
    }
    let changed = best.filter(|_| reached <= options.tolerance);
    let changed = changed.ok_or(MendError::NotReached { reached, gap: before })?;
    Ok(Mended {
        edit: edit(record(moving)?, &changed, moving, options.model),
        model: options.model,
        face: moving.curve.face,
        side,
        before,
        after: reached,
        left: goals.left(),
    })
}

/// The curves of a loop with number `at` replaced, and its neighbours' ends moved to its own.
fn with_curve(trim_loop: &LoopRecord, at: usize, new: &NurbsCurve2) -> Vec<NurbsCurve2> {
    let mut curves = trim_loop.curves.clone();
    let count = curves.len();
    let old_ends = ends(&curves[at]);
    let new_ends = ends(new);
    curves[at] = new.clone();
    if count > 1 {
        for (neighbour, own) in [((at + count - 1) % count, 0), ((at + 1) % count, 1)] {
            if old_ends[own] != new_ends[own] {
                curves[neighbour] =
                    refit::with_end(&curves[neighbour], 1 - own, old_ends[own], new_ends[own]);
            }
        }
    }
    curves
}

fn ends(curve: &NurbsCurve2) -> [glam::DVec2; 2] {
    let (a, b) = curve.domain();
    [curve.point(a), curve.point(b)]
}

/// What differs between two records of a face, in one loop.
fn edit(before: &FaceRecord, after: &FaceRecord, moving: &EdgeUse, model: usize) -> Edit {
    let face = FaceId { model, face: moving.curve.face };
    let label = "Close gap";
    if before.loops.len() != after.loops.len() {
        let change = Change::Loops { face, at: 0, before: before.loops.clone(), after: after.loops.clone() };
        return Edit::new(label, vec![change]);
    }
    let trim_loop = moving.curve.trim_loop;
    let pairs = before.loops[trim_loop].curves.iter().zip(&after.loops[trim_loop].curves);
    let changes = pairs.enumerate().filter(|(_, (old, new))| old != new).map(|(at, (old, new))| {
        Change::Curves { face, trim_loop, at, before: vec![old.clone()], after: vec![new.clone()] }
    });
    Edit::new(label, changes.collect())
}
