//! Which entities become faces, and their names, colours and layers.

use std::ops::ControlFlow;

use glam::DAffine3;

use super::error::{EntityError, ReadError};
use super::store::{Reader, Store};
use super::{Progress, surface, transform124, trimmed144};
use crate::exchange::report::{ImportReport, Severity};
use crate::scene::records::{FaceRecord, LengthUnit, ModelRecord, SourceRecord};

/// Faces between two calls of the progress function.
const CHUNK: usize = 128;

/// Reads all faces in file order.
pub(crate) fn read(
    store: &Store<'_>,
    report: &mut ImportReport,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<ModelRecord, ReadError> {
    let mut model =
        ModelRecord { name: store.global.product.clone(), unit: LengthUnit::default(), ..Default::default() };
    let roots = roots(store);
    for (done, &index) in roots.iter().enumerate() {
        if done % CHUNK == 0 && progress(Progress { done, total: roots.len() }).is_break() {
            return Err(ReadError::Cancelled);
        }
        let mut reader = Reader::new(store);
        match face(&mut reader, index) {
            Ok(face) => model.faces.push(face),
            Err(error) => reader.remark(index, Severity::Error, format!("skipped: {error}")),
        }
        report.remarks.append(&mut reader.remarks);
    }
    let _ = progress(Progress { done: roots.len(), total: roots.len() });
    Ok(model)
}

/// Positions of the entities that become faces.
fn roots(store: &Store<'_>) -> Vec<usize> {
    let trimmed: Vec<usize> = (0..store.entries.len()).filter(|i| store.entries[*i].kind == 144).collect();
    if trimmed.is_empty() {
        return (0..store.entries.len()).filter(|i| surface::is_surface(store.entries[*i].kind)).collect();
    }
    trimmed
}

fn face(reader: &mut Reader<'_, '_>, index: usize) -> Result<FaceRecord, EntityError> {
    let pointer = Store::number(index) as i64;
    let (surface, loops) = if reader.store.entries[index].kind == 144 {
        reader.open(pointer, "face", |reader, mut opened| {
            trimmed144::read(reader, &mut opened.args, opened.entry.transform, DAffine3::IDENTITY)
        })?
    } else {
        (surface::read(reader, pointer, DAffine3::IDENTITY)?, Vec::new())
    };
    let entry = &reader.store.entries[index];
    let _ = transform124::transform;
    Ok(FaceRecord {
        name: Some(entry.label.clone()).filter(|l| !l.is_empty()),
        source: Some(SourceRecord { entity: entry.kind.to_string(), id: Store::number(index) }),
        colour: None,
        layer: i32::try_from(entry.level).ok().filter(|l| *l > 0),
        part: None,
        surface,
        loops,
        reversed: false,
    })
}
