//! One face: a trimmed surface (144) with its boundaries (142), or the plain surface when nothing trims it.
//!
//! A boundary is written in the surface's parameters, which is what counts, and as curves in space for
//! those who want them: exact where they can be, else fitted. Loops of more than one curve are
//! composites (102). A face that falls into parts becomes one trimmed surface for each, on one surface.

use glam::DVec3;

use super::appearance::{self, Palette};
use super::deck::{Batch, Entity, Status};
use super::list::{Field, Link};
use super::regions::{Region, regions};
use super::seam::{is_border_of_closed, moved_seam};
use super::{ExportRemark, WriteOptions, number, spline};
use crate::exchange::boundary::{bounds, end, start};
use crate::exchange::report::Severity;
use crate::kernel::nurbs::NurbsCurve3;
use crate::kernel::query::{SplineCarrier, lift};
use crate::scene::records::{FaceRecord, LoopRecord};

/// How far curves in space may be off, in parts of the face's size and at most in millimetres: as far as
/// makes no difference to any system that reads them, since the pcurves count.
const FIT: (f64, f64) = (1e-6, 1e-4);

/// Gaps in a loop above this part of its extent are told.
const OPEN: f64 = 1e-6;

/// A face as entities.
pub(crate) struct FaceBatch {
    pub batch: Batch,
    /// The face itself, or the parts that it falls into.
    pub faces: Vec<Link>,
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
    let mut made = FaceBatch { batch: Batch::default(), faces: Vec::new(), remarks: Vec::new() };
    let mut remarks = Remarks { face: number, list: Vec::new() };
    let unit = options.unit.millimetres;
    let status = if member { Status::Member } else { Status::Independent };
    let loops: Vec<&LoopRecord> = face.loops.iter().filter(|l| !l.curves.is_empty()).collect();
    if loops.len() < face.loops.len() {
        remarks.add(Severity::Warning, "loops without curves are left out");
    }
    for (k, _) in face.loops.iter().enumerate().filter(|(_, l)| is_open(l)) {
        let message = format!("loop {} is open; readers will close it each in their own way", k + 1);
        remarks.add(Severity::Warning, message);
    }
    let look = appearance::look(&mut made.batch, face, palette, &mut remarks);
    let mut add = |batch: &mut Batch, mut entity: Entity| {
        look.dress(&mut entity);
        made.faces.push(batch.push(entity));
    };
    if loops.is_empty() {
        add(&mut made.batch, Entity::new(128, status, spline::surface128(&face.surface, unit)));
    } else {
        let mut carrier = SplineCarrier::new(face.surface.clone());
        if let Some(surface) = moved_seam(&carrier, &loops) {
            remarks.add(Severity::Note, "the seam of its surface was moved to where its loops begin");
            carrier = SplineCarrier::new(surface);
        }
        let fields = spline::surface128(carrier.surface(), unit);
        let surface = made.batch.push(Entity::new(128, Status::Part, fields));
        let parts = regions(&carrier, &loops);
        if parts.len() > 1 {
            let message = format!("it has {} parts, each of which is a face of its own in IGES", parts.len());
            remarks.add(Severity::Note, message);
        }
        for part in parts {
            let fields = trimmed144(&mut made.batch, surface, &carrier, &part, options);
            add(&mut made.batch, Entity::new(144, status, fields));
        }
    }
    if face.reversed {
        remarks.add(Severity::Note, "its outside is the back of its surface, which a 144 cannot say");
    }
    made.remarks = remarks.list;
    made
}

/// Whether a curve of a loop ends where no curve begins, by more than rounding.
fn is_open(trim: &LoopRecord) -> bool {
    let Some((min, max)) = bounds(&trim.curves) else { return false };
    let count = trim.curves.len();
    (0..count).any(|k| {
        let gap = start(&trim.curves[(k + 1) % count]) - end(&trim.curves[k]);
        gap.abs().max_element() > OPEN * (max - min).max_element()
    })
}

/// Parameters of a trimmed surface.
fn trimmed144(
    batch: &mut Batch,
    surface: Link,
    carrier: &SplineCarrier,
    part: &Region<'_>,
    options: &WriteOptions,
) -> Vec<Field> {
    let outer = part.outer.filter(|l| !is_border_of_closed(carrier, l));
    let outer = outer.map(|l| boundary142(batch, surface, carrier, l, options));
    let inner: Vec<Link> =
        part.inner.iter().map(|l| boundary142(batch, surface, carrier, l, options)).collect();
    let mut fields = vec![
        Field::Pointer(surface),
        Field::Integer(i64::from(outer.is_some())),
        Field::Integer(inner.len() as i64),
        outer.map_or(Field::Integer(0), Field::Pointer),
    ];
    fields.extend(inner.into_iter().map(Field::Pointer));
    fields
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
        for lifted in trim.curves.iter().filter_map(|c| lift(carrier, c, tolerance)) {
            let curve = if lifted.deviation == 0.0 { lifted.curve } else { coarse(&lifted.curve, tolerance) };
            // What shrinks to a point (at a pole) is no curve in space.
            if curve.points().iter().any(|p| *p != curve.points()[0]) {
                space.push(spline::space_curve(batch, &curve, options.unit.millimetres));
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

/// A fitted curve without the digits that say nothing.
fn coarse(curve: &NurbsCurve3, tolerance: f64) -> NurbsCurve3 {
    let step = 10f64.powf((1e-3 * tolerance).log10().floor().min(-1.0));
    curve.map_points(|p: DVec3| DVec3::from_array(p.to_array().map(|x| number::rounded(x, step))))
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
