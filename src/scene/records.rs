//! The records of a model: parts, faces, trim loops, with names, colours, layers and units.
//! Only records are truth; everything else (patches, trimming structures, GPU ranges) is derived.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::kernel::face::{Face, FaceError};
use crate::kernel::nurbs::NurbsSurface;
pub use crate::kernel::trim::{EdgeId, LoopRecord, LoopRole};

/// A whole model as read from one file or made by the program.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelRecord {
    /// Name to show (file name or product name).
    pub name: String,
    /// Unit of every length.
    pub unit: LengthUnit,
    /// Parts (bodies, groups, shells); a face names its part by position.
    pub parts: Vec<PartRecord>,
    /// Faces in file order.
    pub faces: Vec<FaceRecord>,
}

/// Unit of length of a model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LengthUnit {
    /// Short name: `mm`, `in`, `m`, ...
    pub name: String,
    /// Millimetres in one unit.
    pub millimetres: f64,
}

impl Default for LengthUnit {
    fn default() -> Self {
        Self { name: "mm".into(), millimetres: 1.0 }
    }
}

/// A named group of faces.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PartRecord {
    /// Name to show.
    pub name: String,
    /// Position of the part that holds this one.
    pub parent: Option<usize>,
}

/// One trimmed surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FaceRecord {
    /// Name from the file, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Where it came from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<SourceRecord>,
    /// Linear RGB in 0..=1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<[f32; 3]>,
    /// Layer (IGES level) number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layer: Option<i32>,
    /// Position of its part in [`ModelRecord::parts`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<usize>,
    /// The untrimmed surface; its parameters are the face's native (u, v).
    pub surface: NurbsSurface,
    /// Trim loops in native (u, v). None at all: the whole domain of the surface.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub loops: Vec<LoopRecord>,
    /// Whether the face's normal is opposite to `du x dv`.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub reversed: bool,
}

/// The entity of a file that a face was made from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceRecord {
    /// Entity type number or name, `144` say.
    pub entity: String,
    /// Number that finds it in the file: the directory-entry sequence number for IGES.
    pub id: u64,
}

impl FaceRecord {
    /// A face that is nothing but geometry: no loops means all of the surface.
    pub fn new(surface: NurbsSurface, loops: Vec<LoopRecord>) -> Self {
        Self {
            name: None,
            source: None,
            colour: None,
            layer: None,
            part: None,
            surface,
            loops,
            reversed: false,
        }
    }

    /// The face ready to classify, measure and draw.
    ///
    /// # Errors
    /// See [`FaceError`].
    pub fn derive(&self) -> Result<Face, FaceError> {
        Face::derive(&self.surface, &self.loops)
    }

    /// The same as [`Self::derive`], bit for bit, but quick when `previous` was derived from a record that
    /// differs in a few curves.
    ///
    /// # Errors
    /// See [`FaceError`].
    pub fn derive_after(&self, previous: &Face) -> Result<Face, FaceError> {
        Face::derive_after(previous, &self.surface, &self.loops)
    }
}

impl ModelRecord {
    /// All faces derived, in parallel, in the model's order.
    pub fn derive_all(&self) -> Vec<Result<Face, FaceError>> {
        self.faces.par_iter().map(FaceRecord::derive).collect()
    }
}
