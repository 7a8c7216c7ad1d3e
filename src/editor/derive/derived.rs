//! What the editor keeps of a face beside its record.

use glam::DVec3;

use crate::kernel::view::Bounds;
use crate::scene::records::FaceRecord;

/// Derived data of one face.
#[derive(Debug, Clone)]
pub struct Derived {
    /// Box around the trimmed face.
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
        let bounds = Bounds::of(record.surface.points().iter().copied().filter(|p: &DVec3| p.is_finite()));
        let curves = record.loops.iter().map(|l| l.curves.len()).sum();
        Self { bounds, area: None, curves, failure: None }
    }
}
