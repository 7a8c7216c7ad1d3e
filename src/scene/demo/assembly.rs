//! Collects the faces of the demo scene under named parts.

use crate::kernel::nurbs::{NurbsCurve2, NurbsSurface};
use crate::scene::records::{FaceRecord, LengthUnit, LoopRecord, LoopRole, ModelRecord, PartRecord};

/// A model in the making; faces go to the part begun last.
pub struct Assembly {
    model: ModelRecord,
    colour: [f32; 3],
}

impl Assembly {
    /// An empty model with one root part, all in millimetres.
    pub fn new(name: &str) -> Self {
        let root = PartRecord { name: name.into(), parent: None };
        let model = ModelRecord {
            name: name.into(),
            unit: LengthUnit::default(),
            parts: vec![root],
            faces: Vec::new(),
        };
        Self { model, colour: [0.8; 3] }
    }

    /// Begins a part below the root; its faces have `colour` (linear RGB) until told otherwise.
    pub fn part(&mut self, name: &str, colour: [f32; 3]) {
        self.model.parts.push(PartRecord { name: name.into(), parent: Some(0) });
        self.colour = colour;
    }

    /// Changes the colour of the faces to come.
    pub fn colour(&mut self, colour: [f32; 3]) {
        self.colour = colour;
    }

    /// Adds a face to the part begun last. The first of `loops` bounds it, the others are holes and
    /// islands; none: the whole surface.
    pub fn face(&mut self, name: impl Into<String>, surface: NurbsSurface, loops: Vec<Vec<NurbsCurve2>>) {
        let role = |index| if index == 0 { LoopRole::Outer } else { LoopRole::Inner };
        let loops =
            loops.into_iter().enumerate().map(|(i, curves)| LoopRecord::new(role(i), curves)).collect();
        self.model.faces.push(FaceRecord {
            name: Some(name.into()),
            source: None,
            colour: Some(self.colour),
            layer: None,
            part: Some(self.model.parts.len() - 1),
            surface,
            loops,
            reversed: false,
        });
    }

    /// Turns the outside of the face added last to the other side.
    pub fn reverse(&mut self) {
        if let Some(face) = self.model.faces.last_mut() {
            face.reversed = !face.reversed;
        }
    }

    /// The finished model.
    pub fn finish(self) -> ModelRecord {
        self.model
    }
}
