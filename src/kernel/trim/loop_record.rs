//! Trim loops as files and edits give them: pcurves in native parameters, end to end.

use serde::{Deserialize, Serialize};

use crate::kernel::nurbs::NurbsCurve2;

/// What a loop is said to be by its file. Not trusted for drawing: nesting decides.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LoopRole {
    /// Bounds the face from outside.
    Outer,
    /// Bounds a hole (or an island in a hole).
    Inner,
    /// The file does not say.
    #[default]
    Unknown,
}

/// An edge of the model: pcurves with the same number bound their faces along the same edge. Numbers
/// count from 0 within one model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct EdgeId(pub u32);

/// One closed trim loop: curves end to start, in order, each running in the loop's direction.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoopRecord {
    /// What the file says it is.
    #[serde(default)]
    pub role: LoopRole,
    /// Pcurves in native (u, v).
    pub curves: Vec<NurbsCurve2>,
    /// The edge of the model that each curve lies on, where the file says so (IGES 504); empty where it
    /// does not. Read it by [`LoopRecord::edge`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edges: Vec<Option<EdgeId>>,
}

impl LoopRecord {
    /// A loop of `curves` of which no edges are known.
    pub fn new(role: LoopRole, curves: Vec<NurbsCurve2>) -> Self {
        Self { role, curves, edges: Vec::new() }
    }

    /// The edge of the model that curve `curve` lies on, if known. When curves were added or taken away
    /// since, nothing is known of any of them any more.
    pub fn edge(&self, curve: usize) -> Option<EdgeId> {
        if self.edges.len() == self.curves.len() { self.edges.get(curve).copied().flatten() } else { None }
    }
}
