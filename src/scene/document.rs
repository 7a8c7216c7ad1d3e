//! A whole scene as one record, and the reading access that operations need to it.
//!
//! Operations read a [`Document`] and never write one, so that the editor can hold the same data in
//! components: it lends [`FaceView`]s of them. [`SceneRecord`] is the form that files and scripts use.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::edit::FaceId;
use super::records::{FaceRecord, LoopRecord, ModelRecord, SourceRecord};
use super::settings::{DisplayRecord, ViewRecord};
use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::trim::{Periods, UvRect};
use crate::kernel::view::Camera;

/// All that a scene file holds.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SceneRecord {
    /// The models, in the order they were opened.
    pub models: Vec<ModelRecord>,
    /// Faces that are not shown, in order.
    pub hidden: Vec<FaceId>,
    /// Where the scene was looked at from.
    pub camera: Option<Camera>,
    /// Views to come back to.
    pub views: Vec<ViewRecord>,
    /// How the scene is displayed.
    pub display: DisplayRecord,
}

/// All of a face but its geometry.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FaceAttributes {
    /// Name to show.
    pub name: Option<String>,
    /// Where it came from.
    pub source: Option<SourceRecord>,
    /// Linear RGB in 0..=1.
    pub colour: Option<[f32; 3]>,
    /// Layer (IGES level) number.
    pub layer: Option<i32>,
    /// Position of its part in the parts of its model.
    pub part: Option<usize>,
    /// Whether the face's normal is opposite to `du x dv`.
    pub reversed: bool,
}

/// A face lent for reading.
#[derive(Debug, Clone)]
pub struct FaceView<'a> {
    /// All but the geometry.
    pub attributes: FaceAttributes,
    /// The untrimmed surface.
    pub surface: &'a NurbsSurface,
    /// Its trim loops in order.
    pub loops: Vec<&'a LoopRecord>,
}

/// What operations may ask about a scene.
pub trait Document {
    /// Number of models.
    fn model_count(&self) -> usize;
    /// Number of faces of a model; 0 when there is no such model.
    fn face_count(&self, model: usize) -> usize;
    /// A face.
    fn face(&self, id: FaceId) -> Option<FaceView<'_>>;
}

impl Document for SceneRecord {
    fn model_count(&self) -> usize {
        self.models.len()
    }

    fn face_count(&self, model: usize) -> usize {
        self.models.get(model).map_or(0, |m| m.faces.len())
    }

    fn face(&self, id: FaceId) -> Option<FaceView<'_>> {
        self.models.get(id.model)?.faces.get(id.face).map(FaceView::of)
    }
}

impl SceneRecord {
    /// The scene of one model.
    pub fn of_model(model: ModelRecord) -> Self {
        Self { models: vec![model], ..Self::default() }
    }

    /// The face counted from 0 through all models.
    pub fn nth_face(&self, number: usize) -> Option<FaceId> {
        FaceId { model: 0, face: number }.resolved(self)
    }
}

impl FaceAttributes {
    /// Those of a record.
    pub fn of(face: &FaceRecord) -> Self {
        let FaceRecord { name, source, colour, layer, part, reversed, surface: _, loops: _ } = face;
        Self {
            name: name.clone(),
            source: source.clone(),
            colour: *colour,
            layer: *layer,
            part: *part,
            reversed: *reversed,
        }
    }

    /// Puts them into a record.
    pub fn put(&self, face: &mut FaceRecord) {
        let Self { name, source, colour, layer, part, reversed } = self.clone();
        (face.name, face.source, face.colour) = (name, source, colour);
        (face.layer, face.part, face.reversed) = (layer, part, reversed);
    }
}

impl<'a> FaceView<'a> {
    /// The view of a record.
    pub fn of(face: &'a FaceRecord) -> Self {
        Self {
            attributes: FaceAttributes::of(face),
            surface: &face.surface,
            loops: face.loops.iter().collect(),
        }
    }

    /// A record of its own.
    pub fn to_record(&self) -> FaceRecord {
        let FaceAttributes { name, source, colour, layer, part, reversed } = self.attributes.clone();
        FaceRecord {
            name,
            source,
            colour,
            layer,
            part,
            reversed,
            surface: self.surface.clone(),
            loops: self.loops.iter().map(|l| (*l).clone()).collect(),
        }
    }

    /// The domain of the surface.
    pub fn domain(&self) -> UvRect {
        UvRect::of_surface(self.surface)
    }

    /// Period of the surface in u and v, 0 where it is not closed. Not free: it samples the border.
    pub fn periods(&self) -> DVec2 {
        Periods::of_surface(self.surface).period
    }
}
