//! Trim loops as files and edits give them: pcurves in native parameters, end to end.

use serde::{Deserialize, Serialize};

use crate::kernel::nurbs::NurbsCurve2;

/// What a loop is said to be by its file. Not trusted for drawing: nesting decides.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum LoopRole {
    /// Bounds the face from outside.
    Outer,
    /// Bounds a hole (or an island in a hole).
    Inner,
    /// The file does not say.
    #[default]
    Unknown,
}

/// One closed trim loop: curves end to start, in order, each running in the loop's direction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LoopRecord {
    /// What the file says it is.
    pub role: LoopRole,
    /// Pcurves in native (u, v).
    pub curves: Vec<NurbsCurve2>,
}
