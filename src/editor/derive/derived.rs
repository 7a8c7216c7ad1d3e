//! What the editor keeps of a face beside its record.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use crate::encoding::FaceShape;
use crate::encoding::tiling::PackedCells;
use crate::kernel::face::Face;
use crate::kernel::query;
use crate::kernel::view::Bounds;
use crate::scene::records::FaceRecord;

/// Derived data of one face.
#[derive(Debug, Clone)]
pub struct Derived {
    /// Patches and trimming structure; `None` when the face cannot be drawn.
    pub face: Option<Arc<Face>>,
    /// Box around the face.
    pub bounds: Bounds,
    /// What takes longer to work out; there some time after the face is shown.
    measures: OnceLock<Measures>,
    /// The face packed for drawing, from when that was done ahead until it is taken.
    packed: Arc<Mutex<Option<PackedCells>>>,
    /// Number of trim loops.
    pub loops: usize,
    /// Number of trim curves.
    pub curves: usize,
    /// Why the face cannot be drawn, if it cannot.
    pub failure: Option<String>,
}

/// Exact measures of the trimmed face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measures {
    /// Area, model units squared.
    pub area: f64,
    /// Box around what is left after trimming.
    pub bounds: Bounds,
}

impl Derived {
    /// The measures, once they are worked out.
    pub fn measures(&self) -> Option<&Measures> {
        self.measures.get()
    }

    /// The tightest box known.
    pub fn best_bounds(&self) -> Bounds {
        self.measures().map_or(self.bounds, |m| m.bounds)
    }

    /// Works out the measures, if that was not done before. May take a while.
    pub fn measure(&self) {
        if let Some(face) = &self.face {
            self.measures.get_or_init(|| Measures {
                area: query::face_area(face).value,
                bounds: query::face_bounds(face),
            });
        }
    }

    /// Packs the face for drawing ahead of time: to be done beside the window's thread, where many faces are loaded.
    pub fn pack(&self) {
        if let Some(face) = &self.face {
            let packed = FaceShape::of(face, None, false).pack();
            *self.packed.lock().unwrap_or_else(PoisonError::into_inner) = Some(packed);
        }
    }

    /// What [`Self::pack`] made, once.
    pub fn take_packed(&self) -> Option<PackedCells> {
        self.packed.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Derives everything from the record. Never fails: what went wrong is in [`Self::failure`].
    pub fn of(record: &FaceRecord) -> Self {
        Self::after(record, None)
    }

    /// The same for an edited record; quick when `previous` is of the record before the edit.
    pub fn after(record: &FaceRecord, previous: Option<&Self>) -> Self {
        let loops = record.loops.len();
        let curves = record.loops.iter().map(|l| l.curves.len()).sum();
        let derived = match previous.and_then(|p| p.face.as_deref()) {
            Some(face) => record.derive_after(face),
            None => record.derive(),
        };
        let (face, bounds, failure) = match derived {
            Ok(face) => (Some(Arc::new(face)), None, None),
            Err(error) => {
                let bounds = Bounds::of(record.surface.points().iter().copied());
                (None, Some(bounds), Some(error.to_string()))
            }
        };
        let bounds = bounds.or(face.as_ref().map(|f| f.bounds)).unwrap_or(Bounds::EMPTY);
        Self { face, bounds, measures: OnceLock::new(), packed: Arc::default(), loops, curves, failure }
    }
}
