//! One face: a trimmed surface (144) with its boundaries (142), or the plain surface when nothing trims it.
//!
//! A boundary is written in the surface's parameters, which is what counts, and as curves in space for
//! those who want them: exact where they can be, else fitted. Loops of more than one curve are
//! composites (102).

use super::appearance::{self, Palette};
use super::deck::{Batch, Entity, Status};
use super::list::{Field, Link};
use super::{ExportRemark, WriteOptions, spline};
use crate::exchange::report::Severity;
use crate::kernel::query::{SplineCarrier, lift};
use crate::scene::records::{FaceRecord, LoopRecord, LoopRole};

/// How far curves in space may be off, in parts of the face's size and at most in millimetres.
const FIT: (f64, f64) = (1e-7, 1e-5);

/// A face as entities, the last of which is the face itself.
pub(crate) struct FaceBatch {
    pub batch: Batch,
    /// The face itself.
    pub face: Link,
    pub remarks: Vec<ExportRemark>,
}

/// Makes the entities of face number `number` (from 1).
pub(crate) fn face(
    number: usize,
    face: &FaceRecord,
    palette: &Palette,
    member: bool,
    options: &WriteOptions,
) -> FaceBatch {
    let mut batch = Batch::default();
    let mut remarks = Remarks { face: number, list: Vec::new() };
    let unit = options.unit.millimetres;
    let status = if member { Status::Member } else { Status::Independent };
    let fields = spline::surface128(&face.surface, unit);
    let loops = in_order(&face.loops, &mut remarks);
    let mut entity = if loops.is_empty() {
        Entity::new(128, status, fields)
    } else {
        let surface = batch.push(Entity::new(128, Status::Part, fields));
        let carrier = SplineCarrier::new(face.surface.clone());
        let has_outer = loops[0].role != LoopRole::Inner;
        let boundaries: Vec<Link> =
            loops.iter().map(|l| boundary142(&mut batch, surface, &carrier, l, options)).collect();
        let inner = boundaries.len() - usize::from(has_outer);
        let mut fields =
            vec![Field::Pointer(surface), Field::Integer(i64::from(has_outer)), Field::Integer(inner as i64)];
        if !has_outer {
            fields.push(Field::Integer(0));
        }
        fields.extend(boundaries.into_iter().map(Field::Pointer));
        Entity::new(144, status, fields)
    };
    appearance::dress(&mut batch, &mut entity, face, palette, &mut remarks);
    if face.reversed {
        remarks.add(Severity::Note, "its outside is the back of its surface, which a 144 cannot say");
    }
    let face = batch.push(entity);
    FaceBatch { batch, face, remarks: remarks.list }
}

/// Collects what is worth telling about one face.
pub(crate) struct Remarks {
    face: usize,
    list: Vec<ExportRemark>,
}

impl Remarks {
    pub(crate) fn add(&mut self, severity: Severity, message: impl Into<String>) {
        self.list.push(ExportRemark { severity, face: self.face, message: message.into() });
    }
}

/// The loops with curves, the outer one first.
fn in_order<'a>(loops: &'a [LoopRecord], remarks: &mut Remarks) -> Vec<&'a LoopRecord> {
    let mut list: Vec<&LoopRecord> = loops.iter().filter(|l| !l.curves.is_empty()).collect();
    if list.len() < loops.len() {
        remarks.add(Severity::Warning, "loops without curves are left out");
    }
    if let Some(position) = list.iter().position(|l| l.role == LoopRole::Outer) {
        list[..=position].rotate_right(1);
    } else if list.iter().any(|l| l.role == LoopRole::Unknown)
        && let Some(position) = widest(&list)
    {
        list[..=position].rotate_right(1);
    }
    list
}

/// The loop with the largest box.
fn widest(loops: &[&LoopRecord]) -> Option<usize> {
    let extent = |l: &LoopRecord| {
        crate::exchange::boundary::bounds(&l.curves).map_or(0.0, |(min, max)| (max - min).element_product())
    };
    (0..loops.len()).rev().max_by(|a, b| extent(loops[*a]).total_cmp(&extent(loops[*b])))
}

/// A boundary: curve on a parametric surface.
fn boundary142(
    batch: &mut Batch,
    surface: Link,
    carrier: &SplineCarrier,
    trim: &LoopRecord,
    options: &WriteOptions,
) -> Link {
    let pcurves: Vec<Link> = trim.curves.iter().map(|c| spline::pcurve(batch, c)).collect();
    let uv = run(batch, pcurves, Status::ParameterPart);
    let size = carrier.surface().bounds().diagonal();
    let tolerance = (FIT.0 * size).min(FIT.1);
    let mut space = Vec::new();
    if options.space_curves {
        for curve in &trim.curves {
            // What shrinks to a point (at a pole) is no curve in space.
            match lift(carrier, curve, tolerance) {
                Some(l) if l.curve.points().iter().any(|p| *p != l.curve.points()[0]) => {
                    space.push(spline::space_curve(batch, &l.curve, options.unit.millimetres));
                }
                _ => {}
            }
        }
    }
    let space = (!space.is_empty()).then(|| run(batch, space, Status::Part));
    batch.push(Entity::new(
        142,
        Status::Part,
        vec![
            Field::Integer(0), // how it was made: not said
            Field::Pointer(surface),
            Field::Pointer(uv),
            space.map_or(Field::Integer(0), Field::Pointer),
            Field::Integer(1), // the curve in parameters counts
        ],
    ))
}

/// One curve, or a composite (102) of several.
fn run(batch: &mut Batch, curves: Vec<Link>, status: Status) -> Link {
    if let [only] = curves[..] {
        return only;
    }
    let count = Field::Integer(curves.len() as i64);
    let fields = std::iter::once(count).chain(curves.into_iter().map(Field::Pointer)).collect();
    batch.push(Entity::new(102, status, fields))
}
