//! The numbers of `hairline info`: counts along P1's pipeline, degrees, memory, and every face.
//!
//! Source: A. Schollmeyer, B. Froehlich, "Direct Trimming of NURBS Surfaces on the GPU", 2009 (P1),
//! tables 1, 3 and 4.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;

use crate::exchange::report::{ImportReport, Remark, Severity};
use crate::kernel::face::Face;
use crate::kernel::query::{Area, face_area, face_bounds};
use crate::kernel::trim::TrimStructure;
use crate::kernel::view::Bounds;
use crate::scene::records::{FaceRecord, LengthUnit, ModelRecord, SourceRecord};

/// What is in a model.
#[derive(Debug, Clone, Serialize)]
pub struct Info {
    /// Name of the model.
    pub name: String,
    /// Unit of all lengths; areas are in its square.
    pub unit: LengthUnit,
    /// Box around the trimmed faces: xmin ymin zmin xmax ymax zmax; `None` without faces.
    pub bbox: Option<[f64; 6]>,
    /// Sum of the faces' areas.
    pub area: f64,
    /// How many of what.
    pub counts: Counts,
    /// Bezier trim curves by degree (P1, table 3).
    pub curve_degrees: BTreeMap<usize, usize>,
    /// Bezier patches by the larger of their two degrees (P1, table 4).
    pub patch_degrees: BTreeMap<usize, usize>,
    /// Bezier patches by both degrees, `"5x6"`.
    pub patch_degree_pairs: BTreeMap<String, usize>,
    /// Bytes of what is derived from the model.
    pub memory: Memory,
    /// Every face in file order.
    pub faces: Vec<FaceInfo>,
    /// What became of the file's entities.
    pub report: ImportReport,
}

/// Numbers along the pipeline (P1, table 1), summed over the faces.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Parts.
    pub parts: usize,
    /// Faces.
    pub faces: usize,
    /// Faces with trim loops.
    pub trimmed_faces: usize,
    /// Trim loops.
    pub loops: usize,
    /// Bezier patches; those that are trimmed away are left out.
    pub patches: usize,
    /// Trim curves as the file has them.
    pub nurbs_curves: usize,
    /// Rational Bezier curves they decompose to.
    pub bezier_curves: usize,
    /// Bi-monotone segments.
    pub monotone_segments: usize,
    /// Segments left when those are dropped that no ray can cross.
    pub kept_segments: usize,
    /// Segments in P1's structure, after clipping to its v-intervals.
    pub interval_segments: usize,
    /// Entries in the lists of the parity grid, the default structure.
    pub grid_entries: usize,
}

/// Bytes of what is derived from the model.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Memory {
    /// Control points and weights of the Bezier patches.
    pub patch_bytes: usize,
    /// Trimming structures with their segments.
    pub trim_bytes: usize,
}

/// One face.
#[derive(Debug, Clone, Serialize)]
pub struct FaceInfo {
    /// Position in the file, from 1.
    pub index: usize,
    /// The entity it was made from.
    pub source: Option<SourceRecord>,
    /// Name, if the file has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Degree in u.
    pub degree_u: usize,
    /// Degree in v.
    pub degree_v: usize,
    /// Whether the surface's weights differ.
    pub rational: bool,
    /// Trim loops.
    pub loops: usize,
    /// Trim curves.
    pub curves: usize,
    /// Trimmed area in model units squared; `None` when it could not be worked out.
    pub area: Option<f64>,
    /// Box around the trimmed face: xmin ymin zmin xmax ymax zmax.
    pub bbox: Option<[f64; 6]>,
    /// Parameters that the face occupies: umin vmin umax vmax.
    pub uv_box: [f64; 4],
}

/// Works out everything about `model`. A face that cannot be derived stays in the list without area
/// and box, and gets a remark. `progress` is told the part done, 0 to 1.
pub fn summarise(model: &ModelRecord, report: &ImportReport, progress: &(dyn Fn(f64) + Sync)) -> Info {
    let done = AtomicUsize::new(0);
    let derived: Vec<_> = model
        .faces
        .par_iter()
        .map(|record| {
            let result = Derived::new(record);
            let so_far = 1 + done.fetch_add(1, Ordering::Relaxed);
            progress(so_far as f64 / model.faces.len() as f64);
            result
        })
        .collect();
    let mut info = Info {
        name: model.name.clone(),
        unit: model.unit.clone(),
        bbox: None,
        area: 0.0,
        counts: Counts { parts: model.parts.len(), faces: model.faces.len(), ..Counts::default() },
        curve_degrees: BTreeMap::new(),
        patch_degrees: BTreeMap::new(),
        patch_degree_pairs: BTreeMap::new(),
        memory: Memory::default(),
        faces: Vec::new(),
        report: report.clone(),
    };
    let mut bounds = Bounds::EMPTY;
    for (index, (record, derived)) in model.faces.iter().zip(derived).enumerate() {
        info.add_curves(record);
        let mut face_info = FaceInfo::of_record(index, record);
        match derived {
            Ok(derived) => {
                info.add_face(&derived.face);
                info.area += derived.area.unwrap_or(0.0);
                bounds = bounds.union(derived.bounds);
                face_info.area = derived.area;
                face_info.bbox = flat(&derived.bounds);
                face_info.uv_box = uv_box(&derived.face);
                let (error, area) = (derived.area_error, derived.area.unwrap_or(0.0));
                if error > AREA_DOUBT * area {
                    let message =
                        format!("its area is only known to {error:.1e}: the surface folds or breaks");
                    info.report.remarks.push(remark(record, index, Severity::Warning, &message));
                }
            }
            Err(reason) => info.report.remarks.push(remark(record, index, Severity::Error, &reason)),
        }
        info.faces.push(face_info);
    }
    info.bbox = flat(&bounds);
    info
}

/// A face with the figures that take work.
struct Derived {
    face: Face,
    area: Option<f64>,
    area_error: f64,
    bounds: Bounds,
}

/// An area that may be off by more than this part of it gets a remark.
const AREA_DOUBT: f64 = 1e-4;

impl Derived {
    fn new(record: &FaceRecord) -> Result<Self, String> {
        let face = record.derive().map_err(|e| e.to_string())?;
        let Area { value: area, error: area_error } = face_area(&face);
        Ok(Self { area: area.is_finite().then_some(area), area_error, bounds: face_bounds(&face), face })
    }
}

impl Info {
    fn add_curves(&mut self, record: &FaceRecord) {
        self.counts.trimmed_faces += usize::from(!record.loops.is_empty());
        self.counts.loops += record.loops.len();
        for curve in record.loops.iter().flat_map(|l| &l.curves) {
            let pieces = curve.knots().breaks().len().saturating_sub(1);
            *self.curve_degrees.entry(curve.degree()).or_insert(0) += pieces;
        }
    }

    fn add_face(&mut self, face: &Face) {
        let (counts, from) = (&mut self.counts, &face.counts);
        counts.patches += face.patches.len();
        counts.nurbs_curves += from.nurbs;
        counts.bezier_curves += from.bezier;
        counts.monotone_segments += from.monotone;
        counts.kept_segments += from.kept;
        counts.interval_segments += face.clipped_count();
        counts.grid_entries += from.entries;
        for patch in &face.patches {
            let (u, v) = (patch.degree_u, patch.degree_v);
            *self.patch_degrees.entry(u.max(v)).or_insert(0) += 1;
            *self.patch_degree_pairs.entry(format!("{u}x{v}")).or_insert(0) += 1;
            self.memory.patch_bytes += patch.points.len() * 4 * size_of::<f32>();
        }
        self.memory.trim_bytes += face.grid.memory_bytes();
    }
}

fn remark(record: &FaceRecord, index: usize, severity: Severity, reason: &str) -> Remark {
    let (entity, id) = record.source.as_ref().map_or((String::new(), 0), |s| (s.entity.clone(), s.id));
    Remark { severity, entity, id, line: 0, message: format!("face {}: {reason}", index + 1) }
}

impl FaceInfo {
    /// What the record alone tells.
    fn of_record(index: usize, record: &FaceRecord) -> Self {
        let (degree_u, degree_v) = record.surface.degrees();
        let ((u0, u1), (v0, v1)) = (record.surface.knots_u().domain(), record.surface.knots_v().domain());
        Self {
            index: index + 1,
            source: record.source.clone(),
            name: record.name.clone(),
            degree_u,
            degree_v,
            rational: record.surface.is_rational(),
            loops: record.loops.len(),
            curves: record.loops.iter().map(|l| l.curves.len()).sum(),
            area: None,
            bbox: None,
            uv_box: [u0, v0, u1, v1],
        }
    }
}

/// The bounding box of the trim loops in native parameters, or the surface's domain when there are
/// none. Exact: the ends of bi-monotone pieces are the extrema of the loops.
fn uv_box(face: &Face) -> [f64; 4] {
    let ends = face.pieces.pieces().iter().flat_map(|p| [face.pieces.start(p), face.pieces.end(p)]);
    let ends = ends.map(|p| face.domain.native(p));
    let empty = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let (min, max) = ends.fold(empty, |(min, max), p| (min.min(p), max.max(p)));
    let (min, max) = if min.x <= max.x { (min, max) } else { (face.domain.min, face.domain.max) };
    [min.x, min.y, max.x, max.y]
}

fn flat(bounds: &Bounds) -> Option<[f64; 6]> {
    let (a, b) = (bounds.min, bounds.max);
    (!bounds.is_empty()).then_some([a.x, a.y, a.z, b.x, b.y, b.z])
}
