//! What the editor keeps of a face beside its record.

use std::sync::Arc;

use crate::kernel::face::Face;
use crate::kernel::view::Bounds;
use crate::scene::records::FaceRecord;

/// Derived data of one face.
#[derive(Debug, Clone)]
pub struct Derived {
    /// Patches and trimming structure; `None` when the face cannot be drawn.
    pub face: Option<Arc<Face>>,
    /// Box around the face.
    pub bounds: Bounds,
    /// Trimmed area, model units squared.
    pub area: Option<f64>,
    /// Number of trim curves.
    pub curves: usize,
    /// Why the face cannot be drawn, if it cannot.
    pub failure: Option<String>,
}

impl Derived {
    /// Derives everything from the record. Never fails: what went wrong is in [`Self::failure`].
    pub fn of(record: &FaceRecord) -> Self {
        let curves = record.loops.iter().map(|l| l.curves.len()).sum();
        match Face::derive(record) {
            Ok(face) => {
                let bounds = face.bounds;
                Self { face: Some(Arc::new(face)), bounds, area: None, curves, failure: None }
            }
            Err(error) => {
                let bounds = Bounds::of(record.surface.points().iter().copied());
                Self { face: None, bounds, area: None, curves, failure: Some(error.to_string()) }
            }
        }
    }
}
