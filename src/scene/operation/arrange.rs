//! Whole loops: adding, deleting, turning round, and moving them about.

use glam::{DAffine2, DMat2, DVec2};
use serde::{Deserialize, Serialize};

use super::address::Subject;
use super::error::{OperationError, Place, Problem};
use super::limits::{self, Fence};
use super::shape::Shape;
use crate::kernel::nurbs::NurbsCurve2;
use crate::kernel::trim::UvRect;
use crate::scene::edit::{Change, Edit};
use crate::scene::records::{LoopRecord, LoopRole};

/// An affine map of the uv plane. Without `about`, things turn, grow and flip about the middle of their
/// common box.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields are explained at each case")]
pub enum Transform {
    /// Shift by a vector.
    Move { by: DVec2 },
    /// Turn counter-clockwise, in the uv plane.
    Rotate {
        degrees: f64,
        #[serde(default)]
        about: Option<DVec2>,
    },
    /// Scale along u and v; both factors positive.
    Scale {
        by: DVec2,
        #[serde(default)]
        about: Option<DVec2>,
    },
    /// Flip across the line through `about` in the direction `along`.
    Mirror {
        along: DVec2,
        #[serde(default)]
        about: Option<DVec2>,
    },
}

impl Transform {
    /// What to call it.
    fn label(&self) -> &'static str {
        match self {
            Self::Move { .. } => "Move loop",
            Self::Rotate { .. } => "Rotate loop",
            Self::Scale { .. } => "Scale loop",
            Self::Mirror { .. } => "Mirror loop",
        }
    }

    /// The map for things in `hull`.
    fn map(&self, place: Place, hull: UvRect) -> Result<DAffine2, OperationError> {
        let middle = 0.5 * (hull.min + hull.max);
        let about = |about: &Option<DVec2>, linear: DMat2| -> Result<DAffine2, OperationError> {
            let centre = limits::finite2(place, ["about u", "about v"], about.unwrap_or(middle))?;
            Ok(DAffine2::from_mat2_translation(linear, centre - linear * centre))
        };
        match self {
            Self::Move { by } => {
                Ok(DAffine2::from_translation(limits::finite2(place, ["by u", "by v"], *by)?))
            }
            Self::Rotate { degrees, about: centre } => {
                let angle = limits::finite(place, "degrees", *degrees)? % 360.0;
                about(centre, turn(angle))
            }
            Self::Scale { by, about: centre } => {
                limits::positive(place, "by u", by.x)?;
                limits::positive(place, "by v", by.y)?;
                about(centre, DMat2::from_diagonal(*by))
            }
            Self::Mirror { along, about: centre } => {
                limits::finite2(place, ["along u", "along v"], *along)?;
                let Some(d) = along.try_normalize() else {
                    return Err(place.error(Problem::Number {
                        what: "the length of along",
                        value: 0.0,
                        expected: "positive",
                    }));
                };
                // Twice the projection on the line, less the point itself.
                let twice = DMat2::from_cols(2.0 * d.x * d, 2.0 * d.y * d);
                about(centre, twice - DMat2::IDENTITY)
            }
        }
    }
}

/// The rotation by `degrees`, exact for quarter turns.
fn turn(degrees: f64) -> DMat2 {
    let quarter = degrees / 90.0;
    if quarter.fract() == 0.0 {
        let (x, y) = match quarter.rem_euclid(4.0) as u8 {
            0 => (1.0, 0.0),
            1 => (0.0, 1.0),
            2 => (-1.0, 0.0),
            _ => (0.0, -1.0),
        };
        return DMat2::from_cols(DVec2::new(x, y), DVec2::new(-y, x));
    }
    DMat2::from_angle(degrees.to_radians())
}

/// The loops named, each once, in order; all of them exist.
pub(super) fn named(subject: &Subject, loops: &[usize]) -> Result<Vec<usize>, OperationError> {
    if loops.is_empty() {
        return Err(Place::face(subject.id).error(Problem::Nothing { what: "loops" }));
    }
    let mut named = loops.to_vec();
    named.sort_unstable();
    named.dedup();
    for index in &named {
        subject.trim_loop(*index)?;
    }
    Ok(named)
}

/// Loops with their control points mapped.
pub(super) fn mapped(
    subject: &Subject,
    trim_loop: usize,
    curves: &[NurbsCurve2],
    map: DAffine2,
) -> Result<Vec<NurbsCurve2>, OperationError> {
    let map_curve = |(number, curve): (usize, &NurbsCurve2)| {
        let moved = curve.map_points(|p: DVec2| map.transform_point2(p));
        for (k, p) in moved.points().iter().enumerate() {
            limits::trim_point(subject, Place::point(subject.id, trim_loop, number, k), *p)?;
        }
        Ok(moved)
    };
    curves.iter().enumerate().map(map_curve).collect()
}

/// The box around the control points of loops.
pub(super) fn hull<'c>(loops: impl IntoIterator<Item = &'c LoopRecord>) -> UvRect {
    let mut hull = UvRect::EMPTY;
    let points = loops.into_iter().flat_map(|l| &l.curves).flat_map(|c| c.points());
    points.for_each(|p| hull.include(*p));
    hull
}

pub(super) fn transform(
    subject: &Subject,
    loops: &[usize],
    transform: &Transform,
    beyond: bool,
) -> Result<Edit, OperationError> {
    let loops = named(subject, loops)?;
    let hull = hull(loops.iter().map(|l| subject.view.loops[*l]));
    let mut map = transform.map(Place::face(subject.id), hull)?;
    if let (Transform::Move { by }, false) = (transform, beyond) {
        map = DAffine2::from_translation(Fence::around(subject).shift(subject, hull, *by));
    }
    let change = |trim_loop: usize| {
        let before = &subject.view.loops[trim_loop].curves;
        let after = mapped(subject, trim_loop, before, map)?;
        Ok(Change::Curves { face: subject.id, trim_loop, at: 0, before: before.clone(), after })
    };
    Ok(Edit::new(transform.label(), loops.into_iter().map(change).collect::<Result<_, OperationError>>()?))
}

pub(super) fn add(subject: &Subject, shape: &Shape, role: LoopRole) -> Result<Edit, OperationError> {
    let after: Vec<LoopRecord> =
        shape.loops(subject)?.into_iter().map(|curves| LoopRecord::new(role, curves)).collect();
    let change = Change::Loops { face: subject.id, at: subject.view.loops.len(), before: Vec::new(), after };
    Ok(Edit::new(format!("Add {}", shape.name()), vec![change]))
}

pub(super) fn delete(subject: &Subject, loops: &[usize]) -> Result<Edit, OperationError> {
    // From the last to the first, so that positions stay right while they go.
    let loops = named(subject, loops)?;
    let changes = loops.iter().rev().map(|at| Change::Loops {
        face: subject.id,
        at: *at,
        before: vec![subject.view.loops[*at].clone()],
        after: Vec::new(),
    });
    let label = if loops.len() == 1 { "Delete loop" } else { "Delete loops" };
    Ok(Edit::new(label, changes.collect()))
}

/// `trim` run through the other way round.
pub(super) fn reversed(trim: &LoopRecord) -> LoopRecord {
    LoopRecord {
        role: trim.role,
        curves: trim.curves.iter().rev().map(NurbsCurve2::reversed).collect(),
        edges: trim.edges.iter().rev().copied().collect(),
    }
}

pub(super) fn reverse(subject: &Subject, loops: &[usize]) -> Result<Edit, OperationError> {
    let changes = named(subject, loops)?.into_iter().map(|at| {
        let before = subject.view.loops[at];
        Change::Loops { face: subject.id, at, before: vec![before.clone()], after: vec![reversed(before)] }
    });
    Ok(Edit::new("Reverse loop", changes.collect()))
}
