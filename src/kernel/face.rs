//! A face ready to draw: its surface as Bezier patches over a parameter rectangle, and the trim loops as a
//! parity grid over the same rectangle normalised to the unit square. Derived from a
//! [`FaceRecord`], never stored.

use glam::{DVec2, Vec2};

use super::bezier::BezierPatch;
use super::trim::grid::GridOptions;
use super::trim::pack::{PackedSegments, TooManySegments};
use super::trim::{ParityGrid, PieceList, SegmentSet, TrimStructure};
use super::view::Bounds;
use crate::scene::records::FaceRecord;

/// A rectangle of native parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvRect {
    /// Smallest u and v.
    pub min: DVec2,
    /// Largest u and v.
    pub max: DVec2,
}

impl UvRect {
    /// Native to normalised parameters.
    pub fn normalise(&self, native: DVec2) -> DVec2 {
        (native - self.min) / (self.max - self.min)
    }

    /// Normalised to native parameters.
    pub fn native(&self, uv: DVec2) -> DVec2 {
        self.min + uv * (self.max - self.min)
    }
}

/// Where a point lies with respect to a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Inside.
    In,
    /// Outside.
    Out,
    /// On a trim curve, within the tolerance asked for.
    On,
}

/// Numbers of curves along the pipeline (P1, table 1).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct PipelineCounts {
    /// Trim curves of the record.
    pub nurbs: usize,
    /// Rational Bezier curves they decompose to.
    pub bezier: usize,
    /// Bi-monotone pieces.
    pub monotone: usize,
    /// Pieces left when those are dropped that no ray can cross: horizontal or of no length.
    pub kept: usize,
    /// Curves in P1's structure, after clipping to the v-intervals.
    pub clipped: usize,
    /// Entries in the lists of the parity grid.
    pub entries: usize,
}

/// Why a face cannot be derived.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FaceError {
    /// Too many trim segments for one face.
    #[error(transparent)]
    TooManySegments(#[from] TooManySegments),
    /// The domain has no area.
    #[error("the parameter domain is empty: u from {} to {}, v from {} to {}", .domain.min.x, .domain.max.x, .domain.min.y, .domain.max.y)]
    EmptyDomain {
        /// The domain.
        domain: UvRect,
    },
}

/// A derived face.
#[derive(Debug, Clone, PartialEq)]
pub struct Face {
    /// Rectangle of native parameters that the unit square of trimming stands for.
    pub domain: UvRect,
    /// Patches that cover the domain; their `uv_min..uv_max` are native parameters (beyond the knots of a
    /// periodic surface they are shifted copies). Patches with nothing inside are left out.
    pub patches: Vec<BezierPatch>,
    /// Exact trim loops in normalised parameters.
    pub pieces: PieceList,
    /// Their segments on f32 vertices.
    pub segments: SegmentSet,
    /// The default trimming structure (normalised parameters).
    pub grid: ParityGrid,
    /// Numbers along the pipeline.
    pub counts: PipelineCounts,
    /// Box around the patches' control points.
    pub bounds: Bounds,
}

impl Face {
    /// Derives patches and trimming of one face.
    ///
    /// # Errors
    /// See [`FaceError`].
    pub fn derive(record: &FaceRecord) -> Result<Self, FaceError> {
        let surface = &record.surface;
        let ((u0, u1), (v0, v1)) = (surface.knots_u().domain(), surface.knots_v().domain());
        let domain = UvRect { min: DVec2::new(u0, v0), max: DVec2::new(u1, v1) };
        let mut pieces = PieceList::default();
        let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        for i in 0..4 {
            pieces.push(&[corners[i], corners[(i + 1) % 4]], &[1.0, 1.0], None);
        }
        pieces.close_chain();
        let segments = SegmentSet::new(&pieces);
        let packed = PackedSegments::new(&pieces, &segments)?;
        let grid = ParityGrid::new(&segments, &packed, &GridOptions::default());
        let patches = surface.to_bezier();
        let bounds = patches.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
        Ok(Self { domain, patches, pieces, segments, grid, counts: PipelineCounts::default(), bounds })
    }

    /// Where the native point `(u, v)` lies, by the grid (never [`Side::On`]).
    pub fn classify_native(&self, u: f64, v: f64) -> Side {
        let p = self.domain.normalise(DVec2::new(u, v));
        if self.grid.classify(Vec2::new(p.x as f32, p.y as f32)) { Side::In } else { Side::Out }
    }
}
