//! A face ready to draw: its surface as Bezier patches over a parameter rectangle, and the trim loops as a
//! parity grid over the same rectangle normalised to the unit square. Derived from a surface and its loops,
//! never stored.

use std::sync::Arc;

use glam::DVec2;

use super::bezier::BezierPatch;
use super::nurbs::NurbsSurface;
use super::trim::grid::{GridOptions, SegmentEdit};
use super::trim::loop_record::LoopRecord;
use super::trim::loops::{self, TrimLoops};
use super::trim::pack::{PackedSegments, TooManySegments};
use super::trim::resume::{LoopMemory, Resumed, narrowed};
use super::trim::{
    FillRule, IntervalLists, ParityGrid, PieceList, SegmentSet, SlabGrid, TrimStructure, oracle,
};
pub use super::trim::{TrimRemark, UvRect};
use super::view::Bounds;

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
    /// Domain of the surface's knots.
    pub surface_domain: UvRect,
    /// Period in u and v where loops made it matter, else 0.
    pub period: DVec2,
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
    /// What was repaired in the loops.
    pub remarks: Vec<TrimRemark>,
    /// Box around the patches' control points.
    pub bounds: Bounds,
    memory: Memory,
}

/// What an edited face keeps of what it was derived from, so that the next edit is quick.
#[derive(Debug, Clone, Default)]
struct Memory {
    surface: Option<Arc<(NurbsSurface, Vec<BezierPatch>)>>,
    loops: Option<Arc<LoopMemory>>,
}

/// Says nothing about the face.
impl PartialEq for Memory {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Distance (normalised) within which a point is on a trim curve: the precision of trimming in f32.
pub const ON_TOLERANCE: f64 = 1e-7;
/// Nearer than this to a trim curve the f64 oracle decides instead of the grid.
pub(crate) const NEAR: f64 = 2e-6;

impl Face {
    /// Derives patches and trimming of `surface` within `loops` (none: all of it).
    ///
    /// # Errors
    /// See [`FaceError`].
    pub fn derive(surface: &NurbsSurface, loops: &[LoopRecord]) -> Result<Self, FaceError> {
        Self::derive_with(surface, loops, &GridOptions::default())
    }

    /// Derives a face from an edited surface or edited loops. The result is that of [`Self::derive`] bit for
    /// bit; what the edit left as it was is taken over from `previous`.
    ///
    /// # Errors
    /// See [`FaceError`].
    pub fn derive_after(
        previous: &Self,
        surface: &NurbsSurface,
        loops: &[LoopRecord],
    ) -> Result<Self, FaceError> {
        let bezier = match &previous.memory.surface {
            Some(known) if known.0 == *surface => Arc::clone(known),
            _ => Arc::new((surface.clone(), surface.to_bezier())),
        };
        let known = previous.memory.loops.as_ref();
        let resumed = known.and_then(|memory| memory.resume(&previous.pieces, surface, loops));
        let (trim, kept) = match resumed {
            Some(resumed) => {
                let Resumed { loops: trim, chains, memory } = resumed;
                let pieces = narrowed(&chains, &previous.pieces, &trim.pieces);
                let segments = SegmentSet::new(&trim.pieces);
                let splices = SegmentSet::splices(&previous.segments, &segments, &pieces, &chains);
                let before = (&previous.pieces, &previous.segments, &previous.grid.data[..]);
                let (packed, moves) =
                    PackedSegments::after_edit((&trim.pieces, &segments), before, &splices)?;
                let edit = SegmentEdit { before: &previous.segments, splices: &splices, moves: &moves };
                let grid = previous.grid.after_edit(&segments, &packed, &edit, &GridOptions::default());
                (Trim { trim, segments, grid }, Some(memory))
            }
            None => {
                let trim = Trim::new(surface, loops, &GridOptions::default())?;
                let memory = LoopMemory::new(surface, loops, &trim.trim);
                (trim, memory)
            }
        };
        let memory = Memory { loops: kept.map(Arc::new), surface: Some(Arc::clone(&bezier)) };
        Ok(Self::assemble(surface, loops, &bezier.1, trim, memory))
    }

    /// The same as [`Self::derive`] with choices for the grid.
    ///
    /// # Errors
    /// See [`FaceError`].
    pub fn derive_with(
        surface: &NurbsSurface,
        loops: &[LoopRecord],
        options: &GridOptions,
    ) -> Result<Self, FaceError> {
        let trim = Trim::new(surface, loops, options)?;
        Ok(Self::assemble(surface, loops, &surface.to_bezier(), trim, Memory::default()))
    }

    fn assemble(
        surface: &NurbsSurface,
        loops: &[LoopRecord],
        bezier: &[BezierPatch],
        Trim { trim, segments, grid }: Trim,
        memory: Memory,
    ) -> Self {
        let TrimLoops { domain, pieces, bezier: bezier_curves, period, remarks, .. } = trim;
        let surface_domain = UvRect::of_surface(surface);
        let patches = cover(&surface_domain, bezier, &domain, period, |p| is_needed(&grid, &domain, p));
        let bounds = patches.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
        let counts = PipelineCounts {
            nurbs: loops.iter().map(|l| l.curves.len()).sum(),
            bezier: bezier_curves,
            monotone: pieces.pieces().len(),
            kept: segments.segments.iter().filter(|s| !s.is_horizontal()).count(),
            entries: grid.entries.len(),
        };
        Self {
            domain,
            surface_domain,
            period,
            patches,
            pieces,
            segments,
            grid,
            counts,
            remarks,
            bounds,
            memory,
        }
    }

    /// Number of curves in P1's structure, after clipping to the v-intervals (P1, table 1).
    pub fn clipped_count(&self) -> usize {
        IntervalLists::count_clipped(&self.segments)
    }

    /// P1's structure over the same segments, for its tables and as the baseline.
    pub fn interval_lists(&self) -> IntervalLists {
        IntervalLists::new(&self.pieces, &self.segments, FillRule::EvenOdd)
    }

    /// The trimming structure for questions on the processor: the same answers as [`Self::grid`], bit for bit, and
    /// where a cell is asked often in about half the time.
    pub fn slab_grid(&self) -> SlabGrid {
        match PackedSegments::new(&self.pieces, &self.segments) {
            Ok(packed) => SlabGrid::new(&self.segments, &packed, &GridOptions::default()),
            Err(_) => SlabGrid::over(self.grid.clone()),
        }
    }

    /// Where the native point `(u, v)` lies; [`Side::On`] within [`ON_TOLERANCE`] of a trim curve. On a
    /// closed surface whose loops run past its knots, a point of the surface far outside of the domain
    /// stands for its image a period away; one close to the domain is taken literally.
    pub fn classify_native(&self, u: f64, v: f64) -> Side {
        let native = DVec2::new(u, v);
        let side = self.classify_normalised(self.domain.normalise(native));
        if side == Side::Out && self.is_far(native) && self.surface_domain.contains(native) {
            let images = self.images(native).map(|p| self.classify_normalised(self.domain.normalise(p)));
            return images.fold(Side::Out, |a, b| if a == Side::Out { b } else { a });
        }
        side
    }

    /// Where a normalised point lies.
    pub fn classify_normalised(&self, p: DVec2) -> Side {
        if !p.is_finite() || p.min_element() < -ON_TOLERANCE || p.max_element() > 1.0 + ON_TOLERANCE {
            return Side::Out;
        }
        let inside = if !oracle::is_on(&self.pieces, p, NEAR) {
            self.grid.classify(p.as_vec2())
        } else if oracle::is_on(&self.pieces, p, ON_TOLERANCE) {
            return Side::On;
        } else {
            oracle::inside(&self.pieces, p, FillRule::EvenOdd)
        };
        if inside { Side::In } else { Side::Out }
    }

    /// Whether a point of a closed surface is further from the domain than its surroundings.
    fn is_far(&self, native: DVec2) -> bool {
        const SURROUNDINGS: f64 = 0.05;
        let p = self.domain.normalise(native);
        let beyond = (-p).max(p - 1.0);
        (0..2).any(|axis| self.period[axis] != 0.0 && beyond[axis] > SURROUNDINGS)
    }

    /// The images of a point, whole periods away, that lie in the domain.
    fn images(&self, native: DVec2) -> impl Iterator<Item = DVec2> {
        let along = |axis: usize| -> Vec<f64> {
            let period = self.period[axis];
            if period == 0.0 {
                return vec![0.0];
            }
            let slack = ON_TOLERANCE * self.domain.size()[axis];
            let first = ((self.domain.min[axis] - slack - native[axis]) / period).ceil();
            let last = ((self.domain.max[axis] + slack - native[axis]) / period).floor();
            let count = if last >= first { (last - first) as usize + 1 } else { 0 };
            (0..count.min(8)).map(|k| (first + k as f64) * period).collect()
        };
        let (us, vs) = (along(0), along(1));
        us.into_iter().flat_map(move |u| vs.clone().into_iter().map(move |v| native + DVec2::new(u, v)))
    }
}

/// Loops made ready.
struct Trim {
    trim: TrimLoops,
    segments: SegmentSet,
    grid: ParityGrid,
}

impl Trim {
    fn new(surface: &NurbsSurface, loops: &[LoopRecord], options: &GridOptions) -> Result<Self, FaceError> {
        let trim = loops::prepare(surface, loops);
        let domain = trim.domain;
        if !domain.has_area() {
            return Err(FaceError::EmptyDomain { domain });
        }
        let segments = SegmentSet::new(&trim.pieces);
        let packed = PackedSegments::new(&trim.pieces, &segments)?;
        let grid = ParityGrid::new(&segments, &packed, options);
        Ok(Self { trim, segments, grid })
    }
}

/// Those of a surface's `patches` over `domain` that are needed, shifted copies included.
fn cover(
    rect: &UvRect,
    patches: &[BezierPatch],
    domain: &UvRect,
    period: DVec2,
    is_needed: impl Fn(&UvRect) -> bool,
) -> Vec<BezierPatch> {
    let shifts = |axis: usize| -> Vec<f64> {
        let period = period[axis];
        if period == 0.0 {
            return vec![0.0];
        }
        let first = ((domain.min[axis] - rect.max[axis]) / period).floor();
        let last = ((domain.max[axis] - rect.min[axis]) / period).ceil();
        let count = ((last - first).clamp(0.0, 16.0)) as usize + 1;
        (0..count).map(|k| (first + k as f64) * period).collect()
    };
    let slack = 1e-12 * domain.size();
    let mut result = Vec::new();
    for by in shifts(0).iter().flat_map(|u| shifts(1).into_iter().map(|v| DVec2::new(*u, v))) {
        for patch in patches {
            let (min, max) = (patch.uv_min + by, patch.uv_max + by);
            let overlaps = (max - slack).cmpgt(domain.min).all() && (min + slack).cmplt(domain.max).all();
            if overlaps && is_needed(&UvRect { min, max }) {
                result.push(BezierPatch { uv_min: min, uv_max: max, ..patch.clone() });
            }
        }
    }
    result
}

/// Whether part of the face may lie in a patch's rectangle (P1's redundancy step).
fn is_needed(grid: &ParityGrid, domain: &UvRect, patch: &UvRect) -> bool {
    let (min, max) = (domain.normalise(patch.min), domain.normalise(patch.max));
    let (low, high) = (min.max(DVec2::ZERO), max.min(DVec2::ONE));
    let middle = (0.5 * (low + high)).as_vec2();
    grid.classify(middle) || grid.has_segments((low - 1e-6).as_vec2(), (high + 1e-6).as_vec2())
}
