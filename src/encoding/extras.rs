//! What a picture may be drawn from besides the packed faces.

use super::mesh::MeshScene;
use super::options::Conceal;
use super::ribbon::{RibbonScene, RibbonSpan};
use super::scene::FaceSlot;

/// Optional parts of a picture.
#[derive(Debug, Clone, Default)]
pub struct Extras {
    /// Triangles that take the place of rays.
    pub meshes: Option<MeshChoice>,
    /// Fat lines.
    pub ribbons: Option<RibbonChoice>,
}

/// Fat lines for a view.
#[derive(Debug, Clone, Default)]
pub struct RibbonChoice {
    /// Packed curves.
    pub scene: RibbonScene,
    /// Their stretches to draw.
    pub spans: Vec<RibbonSpan>,
    /// What is made of them.
    pub conceal: Conceal,
}

/// Triangles chosen for a view.
#[derive(Debug, Clone, Default)]
pub struct MeshChoice {
    /// Triangles, with those of the view selected.
    pub scene: MeshScene,
    /// Faces without triangles, which are cast.
    pub lacking: Vec<FaceSlot>,
}
