//! Trimming: which points of a face's parameter rectangle belong to the face.
//!
//! Trim loops become closed chains of bi-monotone rational segments over the unit square
//! ([`segment::Segment`]); a structure answers "inside?" for one point at a time. Three structures
//! share one interface, [`TrimStructure`]: [`brute::BruteForce`] (all segments, the yardstick),
//! P1's interval lists (Schollmeyer & Froehlich 2009, section 4) and [`grid::ParityGrid`], the
//! default, whose buffers are also what the GPU reads; [`SlabGrid`] is the same for
//! questions on the processor, where it is quicker. The f64 oracle is apart from all of them.
//!
//! Conventions: u, v normalised to `[0, 1]`; rays run in +u; a segment is crossed at `v` when
//! `v_lower <= v < v_upper` (decided on shared f32 vertices) and its `u(v) > u`.

pub mod brute;
pub mod chain;
pub mod clip;
pub mod domain;
pub mod fat;
pub mod grid;
pub mod intervals;
pub mod loop_record;
pub mod loops;
pub mod oracle;
pub mod pack;
pub mod pieces;
pub mod record;
pub mod remark;
pub mod resume;
pub mod segment;
pub mod slab_grid;
pub mod tally;
pub mod validity;

pub use brute::BruteForce;
pub use domain::{Periods, UvRect};
pub use grid::ParityGrid;
pub use intervals::IntervalLists;
pub use loop_record::{EdgeId, LoopRecord, LoopRole};
pub use pack::PackedSegments;
pub use pieces::{Piece, PieceList};
pub use remark::TrimRemark;
pub use resume::Splice;
pub use segment::{Segment, SegmentSet};
pub use slab_grid::SlabGrid;
pub use tally::{Counters, Tally};

use glam::Vec2;

/// How nested and overlapping loops add up.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FillRule {
    /// Inside where a ray crosses the loops an odd number of times; does not trust orientation.
    #[default]
    EvenOdd,
    /// Inside where the winding number is not zero; orientation matters.
    NonZero,
}

/// Points this little outside the unit square still count as on its border (rounding of the
/// solver that made them); beyond it everything is outside.
pub const BORDER: f32 = 4.8e-7;

/// The largest `f32` below 1: border points are moved to it, so that the half-open rule keeps them.
pub const BELOW_ONE: f32 = 1.0 - 0.5 * f32::EPSILON;

/// Anything that classifies points of the unit square.
pub trait TrimStructure {
    /// Whether `uv` (normalised) is inside.
    fn classify(&self, uv: Vec2) -> bool;
    /// The same, adding what it took to `counters`.
    fn classify_counted(&self, uv: Vec2, counters: &mut Counters) -> bool;
    /// Bytes of all buffers a query may read, segment records included.
    fn memory_bytes(&self) -> usize;
}

/// `uv` moved into `[0, 1)` when it is inside or within [`BORDER`] of the unit square.
pub fn clamp_to_square(uv: Vec2) -> Option<Vec2> {
    let (low, high) = (-BORDER, 1.0 + BORDER);
    if uv.x >= low && uv.x <= high && uv.y >= low && uv.y <= high {
        Some(Vec2::new(uv.x.clamp(0.0, BELOW_ONE), uv.y.clamp(0.0, BELOW_ONE)))
    } else {
        None
    }
}
