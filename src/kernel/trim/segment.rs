//! Trim segments on f32 vertices: the combinatorial side of the trim loops.
//!
//! Every vertex of every chain is rounded to f32 once and shared by the two segments that meet
//! there; which segments a ray crosses depends on these vertices only, so neighbours can never both count, nor
//! both miss, a ray through their common vertex. Segments whose rounded ends coincide are left out.

use glam::DVec2;

use super::pieces::{Piece, PieceList};
use super::resume::Splice;

/// Vertices nearer than this to the border of the unit square are put on it, so that the sides of a
/// face that follow the border need no entries in the grid.
const SNAP: f64 = 1e-7;

/// A bi-monotone segment between two shared f32 vertices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Number of its piece in the [`PieceList`].
    pub piece: u32,
    /// `u0 v0 u1 v1`: lower and upper end, `v0 <= v1`.
    pub ends: [f32; 4],
    /// Whether its piece runs downwards along the loop.
    pub down: bool,
    /// Number of the segment that shares the lower end.
    pub below: u32,
    /// Number of the segment that shares the upper end.
    pub above: u32,
}

impl Segment {
    /// Whether both ends have the same v: such a segment is never crossed.
    pub fn is_horizontal(&self) -> bool {
        self.ends[1] == self.ends[3]
    }
}

/// All segments of a face, in loop order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SegmentSet {
    /// The segments.
    pub segments: Vec<Segment>,
}

/// The f32 vertex of a point of a loop.
pub fn vertex(point: DVec2) -> [f32; 2] {
    let round = |x: f64| {
        if x < SNAP {
            0.0
        } else if x > 1.0 - SNAP {
            1.0
        } else {
            x as f32
        }
    };
    [round(point.x), round(point.y)]
}

impl SegmentSet {
    /// The segments of closed chains.
    pub fn new(list: &PieceList) -> Self {
        let mut segments: Vec<Segment> = Vec::with_capacity(list.pieces().len());
        for chain in 0..list.chain_count() {
            let first = segments.len();
            for number in list.chain(chain) {
                let piece = &list.pieces()[number];
                segments.extend(Self::segment(list, piece, number as u32));
            }
            link(&mut segments, first);
        }
        Self { segments }
    }

    /// The segments of replaced `pieces`, which belong to the replaced `chains`. A chain that lost all its
    /// segments or got its first ones is replaced as a whole.
    pub fn splices(before: &Self, after: &Self, pieces: &[Splice], chains: &[Splice]) -> Vec<Splice> {
        let of = |splice: &Splice| Splice {
            before: before.of_pieces(&splice.before),
            after: after.of_pieces(&splice.after),
        };
        let splices = pieces.iter().zip(chains).map(|(pieces, chain)| {
            let whole = of(chain);
            if whole.before.is_empty() == whole.after.is_empty() { of(pieces) } else { whole }
        });
        splices.collect()
    }

    fn of_pieces(&self, pieces: &std::ops::Range<usize>) -> std::ops::Range<usize> {
        let at = |piece: usize| self.segments.partition_point(|s| (s.piece as usize) < piece);
        at(pieces.start)..at(pieces.end)
    }

    fn segment(list: &PieceList, piece: &Piece, number: u32) -> Option<Segment> {
        let (a, b) = (vertex(list.start(piece)), vertex(list.end(piece)));
        let down = b[1] < a[1];
        let ends = if down { [b[0], b[1], a[0], a[1]] } else { [a[0], a[1], b[0], b[1]] };
        (a != b).then_some(Segment { piece: number, ends, down, below: 0, above: 0 })
    }
}

/// Makes the segments from `first` on neighbours of each other, round in a circle.
fn link(segments: &mut Vec<Segment>, first: usize) {
    let count = segments.len() - first;
    if count < 2 {
        segments.truncate(first);
        return;
    }
    for i in 0..count {
        let previous = (first + (i + count - 1) % count) as u32;
        let next = (first + (i + 1) % count) as u32;
        let segment = &mut segments[first + i];
        (segment.below, segment.above) = if segment.down { (next, previous) } else { (previous, next) };
    }
}
