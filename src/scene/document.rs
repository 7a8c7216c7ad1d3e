//! A whole scene as one record, and the reading access that operations need to it.
//!
//! Operations read a [`Document`] and never write one, so that the editor can hold the same data in
//! components: it lends [`FaceView`]s of them. [`SceneRecord`] is the form that files and scripts use.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::edit::FaceId;
use super::records::{FaceRecord, LoopRecord, ModelRecord, PartRecord, SourceRecord};
use super::settings::{DisplayRecord, ViewRecord};
use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::trim::validity::{self, LoopProblem};
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

    /// All models as one, faces and parts in order: what a format of single models can hold. Lengths are in
    /// the unit of the first model; the parts of each go under one of its name.
    pub fn into_model(mut self) -> ModelRecord {
        if self.models.len() == 1 {
            return self.models.remove(0);
        }
        let mut models = self.models.into_iter().peekable();
        let Some(first) = models.peek() else { return ModelRecord::default() };
        let unit = first.unit.clone();
        let mut all = ModelRecord { name: first.name.clone(), unit, ..ModelRecord::default() };
        let mut edges = 0;
        for model in models {
            let root = all.parts.len();
            all.parts.push(PartRecord { name: model.name, parent: None });
            all.parts.extend(
                model.parts.into_iter().map(|part| PartRecord {
                    parent: Some(part.parent.map_or(root, |p| root + 1 + p)),
                    ..part
                }),
            );
            let scale = model.unit.millimetres / all.unit.millimetres;
            let mut next_edges = edges;
            for mut face in model.faces {
                face.part = Some(face.part.map_or(root, |p| root + 1 + p));
                if scale != 1.0 {
                    face.surface = face.surface.map_points(|p| p * scale);
                }
                // Edges count from 0 in each model.
                for edge in face.loops.iter_mut().flat_map(|l| l.edges.iter_mut().flatten()) {
                    edge.0 += edges;
                    next_edges = next_edges.max(edge.0 + 1);
                }
                all.faces.push(face);
            }
            edges = next_edges;
        }
        all
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

    /// What is wrong with its loops, and where.
    pub fn problems(&self) -> Vec<LoopProblem> {
        validity::check(self.surface, &self.loops)
    }

    /// Period of the surface in u and v, 0 where it is not closed. Not free: it samples the border.
    pub fn periods(&self) -> DVec2 {
        Periods::of_surface(self.surface).period
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_merge_with_their_parts_and_units() {
        let one = super::super::demo::model();
        let mut two = one.clone();
        (two.unit.name, two.unit.millimetres) = ("m".into(), 1000.0);
        let count = one.faces.len();
        let scene = SceneRecord { models: vec![one.clone(), two], ..SceneRecord::default() };
        assert_eq!(scene.nth_face(count + 2), Some(FaceId { model: 1, face: 2 }));
        assert_eq!(scene.nth_face(2 * count), None);
        let all = scene.into_model();
        assert_eq!((all.faces.len(), all.parts.len()), (2 * count, 2 * one.parts.len() + 2));
        let name = |face: &FaceRecord| all.parts[face.part.expect("a part")].name.clone();
        for k in 0..count {
            assert_eq!(name(&all.faces[k]), name(&all.faces[count + k]));
            let (a, b) = (&all.faces[k].surface, &all.faces[count + k].surface);
            assert_eq!(a.points()[0] * 1000.0, b.points()[0]);
        }
        assert_eq!(SceneRecord::of_model(one.clone()).into_model(), one);
    }
}
