//! Reads the faces that [`super::structure`] found: shape, loops, names, colours, layers.

use std::ops::ControlFlow;

use rayon::prelude::*;

use super::error::{EntityError, ReadError};
use super::store::{Reader, Store};
use super::structure::{self, Root};
use super::trimmed144::{Trimmed, own_boundary, plane_holes, read143, read144};
use super::{Progress, appearance, brep, surface};
use crate::exchange::boundary::RawLoop;
use crate::exchange::boundary::finish::finish;
use crate::exchange::boundary::winding;
use crate::exchange::report::{ImportReport, Remark, Severity};
use crate::kernel::query::Carrier;
use crate::kernel::view::Bounds;
use crate::scene::records::{FaceRecord, LengthUnit, ModelRecord, SourceRecord};

/// Faces between two calls of the progress function.
const CHUNK: usize = 256;
/// Parts of a face's size that its loops may deviate by in conversion.
const FIT: f64 = 1e-7;
/// Largest size of a surface in millimetres: squares of it must fit single precision.
const LARGEST: f64 = 1e18;

/// Reads all faces in file order.
pub(crate) fn read(
    store: &Store<'_>,
    report: &mut ImportReport,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<ModelRecord, ReadError> {
    let structure = structure::read(store);
    report.remarks.extend(structure.remarks);
    let total = structure.roots.len();
    let mut model = ModelRecord {
        name: store.global.product.clone(),
        unit: LengthUnit::default(),
        parts: structure.parts,
        faces: Vec::with_capacity(total),
    };
    for (k, chunk) in structure.roots.chunks(CHUNK).enumerate() {
        if progress(Progress { done: k * CHUNK, total }).is_break() {
            return Err(ReadError::Cancelled);
        }
        let read: Vec<(Option<FaceRecord>, Vec<Remark>)> =
            chunk.par_iter().map(|root| one(store, root)).collect();
        for (face, mut remarks) in read {
            model.faces.extend(face);
            report.remarks.append(&mut remarks);
        }
    }
    match progress(Progress { done: total, total }) {
        ControlFlow::Continue(()) => Ok(model),
        ControlFlow::Break(()) => Err(ReadError::Cancelled),
    }
}

fn one(store: &Store<'_>, root: &Root) -> (Option<FaceRecord>, Vec<Remark>) {
    let mut reader = Reader::new(store);
    reader.instance = root.instance;
    let face = match face(&mut reader, root) {
        Ok(face) => Some(face),
        Err(error) => {
            reader.remark(root.index, Severity::Error, format!("skipped: {error}"));
            None
        }
    };
    (face, reader.remarks)
}

fn face(reader: &mut Reader<'_, '_>, root: &Root) -> Result<FaceRecord, EntityError> {
    let entry = &reader.store.entries[root.index];
    let pointer = Store::number(root.index) as i64;
    let mut name = None;
    let (surface, mut loops): Trimmed = reader
        .open(pointer, "face", |reader, mut opened| {
            let trimmed = match opened.entry.kind {
                144 => read144(reader, &mut opened, root.place)?,
                143 => read143(reader, &mut opened, root.place)?,
                510 => brep::read510(reader, &mut opened, root.place)?,
                _ => {
                    let surface = surface::read_opened(reader, &mut opened, root.place)?;
                    let mut loops: Vec<RawLoop> = own_boundary(reader, &surface).into_iter().collect();
                    loops.extend(plane_holes(reader, &surface, &root.holes, root.place));
                    (surface, loops)
                }
            };
            name = appearance::name_property(reader, &mut opened.args);
            Ok(trimmed)
        })
        .map_err(|e| match e {
            // The remark already names this entity.
            EntityError::Part { target, source, .. } if target == Store::number(root.index) => *source,
            other => other,
        })?;
    for problem in winding::close(&surface.carrier, &mut loops) {
        reader.remark(root.index, Severity::Warning, problem);
    }
    let size = size(&surface.carrier, &loops);
    if !(size <= LARGEST) {
        return Err(EntityError::Degenerate(format!("its size of {size:.3e} mm is beyond {LARGEST:e} mm")));
    }
    let tolerance = FIT * size;
    let (nurbs, loops) = finish(surface.carrier, surface.sweep.as_ref(), loops, tolerance)
        .map_err(|e| EntityError::Degenerate(e.to_string()))?;
    let own_colour = appearance::colour(reader, entry.colour);
    let surface_colour = reader.store.entries[surface.index].colour;
    let colour = own_colour.or_else(|| appearance::colour(reader, surface_colour));
    if entry.blanked {
        reader.remark(root.index, Severity::Note, "blanked in the file; loaded all the same".into());
    }
    Ok(FaceRecord {
        name: name.or_else(|| Some(entry.label.clone()).filter(|l| !l.is_empty())),
        source: Some(SourceRecord { entity: entry.kind.to_string(), id: Store::number(root.index) }),
        colour,
        layer: i32::try_from(entry.level).ok().filter(|l| *l > 0),
        part: root.part,
        surface: nurbs,
        loops,
        reversed: root.reversed,
    })
}

fn size(carrier: &Carrier, loops: &[RawLoop]) -> f64 {
    match carrier {
        Carrier::Spline(spline) => spline.surface().bounds().diagonal(),
        Carrier::Analytic(surface) => {
            let ends = loops.iter().flat_map(RawLoop::curves).map(|c| surface.jet(c.point(c.domain().0))[0]);
            Bounds::of(ends).diagonal()
        }
    }
}
