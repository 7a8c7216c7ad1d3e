//! What is told of the gap between the two sides of an edge.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// How the two sides of an edge lie to each other where they are furthest apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GapSense {
    /// Within rounding of each other.
    Closed,
    /// One sees through between them.
    Opening,
    /// Each runs on past the other's end.
    Overlap,
    /// One lies above the other: apart along the normal.
    Step,
}

/// One of the two points between which a gap is measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GapEnd {
    /// Position of the use in [`super::Edge::uses`].
    pub side: usize,
    /// Parameter of the trim curve.
    pub t: f64,
    /// Parameters of the surface.
    pub uv: DVec2,
    /// The point.
    pub point: DVec3,
}

/// The gap between two sides of an edge, as distances between the two exact curves in space: the largest of
/// the distances of each point of either to the other (Hausdorff).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Gap {
    /// Largest distance (model units).
    pub maximum: f64,
    /// The largest distance is expected to be less than `maximum + error_bound`: what cubics miss at the middles
    /// of intervals, with a margin of four, and rounding ([`super::measure`]). An estimate that tests hold
    /// against dense sampling, not a proof: a spike narrower than an interval could hide from it.
    pub error_bound: f64,
    /// Mean distance along the edge.
    pub mean: f64,
    /// Where it is largest: on the edge's first use, or the side measured from, and on the other.
    pub between: [GapEnd; 2],
    /// How the sides lie to each other there.
    pub sense: GapSense,
    /// Distance there across the edge in the surfaces, positive where they overlap, negative where they
    /// stand apart.
    pub across: f64,
    /// Distance there along the normal.
    pub step: f64,
    /// Distance there along the edge: not zero only where one side ends before the other.
    pub along: f64,
    /// Largest angle between the tangent planes of the two sides (radians, 0 where one goes on smoothly in the other).
    pub angle: f64,
}
