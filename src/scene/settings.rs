//! What travels along with the models of a scene: views and how it is displayed.
//!
//! Plain data that the editor maps to and from its own settings; nothing here changes geometry.

use serde::{Deserialize, Serialize};

use crate::kernel::view::Camera;

/// A view to come back to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewRecord {
    /// Name to show.
    pub name: String,
    /// Where from.
    pub camera: Camera,
}

/// How the scene is displayed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DisplayRecord {
    /// What the colours show, by the editor's name for it (`shaded`, `faces`, `uv`, ...).
    pub mode: Option<String>,
    /// Whether edges are drawn.
    pub edges: Option<bool>,
    /// Whether the ground grid is drawn.
    pub grid: Option<bool>,
    /// How seams and gaps are drawn, by the editor's name for it (`raw`, `concealed`, ...).
    pub gaps: Option<String>,
}
