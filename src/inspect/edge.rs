//! What pairing gives: edges, each with the stretches of trim curves that lie on it.

use serde::{Deserialize, Serialize};

use super::gap::Gap;

/// Which trim curve: face, loop and curve by position, from 0. A face without loops has one loop of four
/// curves here, the sides of its surface: smallest v, largest u, largest v, smallest u.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct CurveAddress {
    /// Position of the face.
    pub face: usize,
    /// Position of the loop in the face.
    pub trim_loop: usize,
    /// Position of the curve in the loop.
    pub curve: usize,
}

/// What an edge is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeKind {
    /// Two faces meet in it.
    Shared,
    /// Only one face borders on it.
    Naked,
    /// Three or more faces meet in it.
    NonManifold,
    /// A face meets itself in it, as a closed surface does where it is cut open.
    Seam,
    /// Its image is one point, such as a pole.
    Degenerate,
}

/// The name of a kind, as users read it.
pub fn edge_name(kind: EdgeKind) -> &'static str {
    match kind {
        EdgeKind::Shared => "shared",
        EdgeKind::Naked => "naked",
        EdgeKind::NonManifold => "non-manifold",
        EdgeKind::Seam => "seam",
        EdgeKind::Degenerate => "degenerate",
    }
}

/// A stretch of a trim curve on an edge.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EdgeUse {
    /// The curve.
    pub curve: CurveAddress,
    /// First and last parameter of the stretch (the curve's own), rising.
    pub interval: (f64, f64),
    /// Whether it runs in the direction of the edge's first use.
    pub forward: bool,
    /// Length of its image (model units).
    pub length: f64,
}

/// A stretch of boundary with those who share it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Edge {
    /// What it is.
    pub kind: EdgeKind,
    /// The stretches on it in the order of their addresses; the first gives the edge its direction.
    pub uses: Vec<EdgeUse>,
    /// The gap between the sides; of three or more, the worst of any side to the first.
    pub gap: Option<Gap>,
}

impl Edge {
    /// Length of the image of the first use (model units).
    pub fn length(&self) -> f64 {
        self.uses.first().map_or(0.0, |u| u.length)
    }

    /// The faces it borders on, each once, in order.
    pub fn faces(&self) -> Vec<usize> {
        let mut faces: Vec<usize> = self.uses.iter().map(|u| u.curve.face).collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }
}

/// Finds an edge: its first use's curve, and the how manieth edge it is along it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct EdgeKey {
    /// The curve of the first use.
    pub curve: CurveAddress,
    /// Position among the edges that start with this curve, by rising parameter.
    pub position: usize,
}
