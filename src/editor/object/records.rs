//! From entities back to records: what operations work on and files are written from.

use std::sync::Arc;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::{AuthoredFace, Model, ModelEntry, TrimLoop};
use crate::kernel::nurbs::NurbsSurface;
use crate::scene::records::{FaceRecord, LoopRecord, ModelRecord};
use crate::scene::{FaceAttributes, FaceView};

/// Reads records from the authored components.
#[derive(SystemParam)]
pub struct Records<'w, 's> {
    models: Query<'w, 's, &'static Model>,
    faces: Query<'w, 's, &'static AuthoredFace>,
    loops: Query<'w, 's, &'static TrimLoop>,
}

/// The authored parts of a face as they were at a moment; cheap to take, and to compare with another.
#[derive(Debug, Clone)]
pub struct FaceParts {
    /// The untrimmed surface.
    pub surface: Arc<NurbsSurface>,
    /// Name, colour and the like.
    pub attributes: Arc<FaceAttributes>,
    /// Its trim loops in order.
    pub loops: Vec<Arc<LoopRecord>>,
}

impl FaceParts {
    /// Whether nothing was replaced between the two.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface)
            && Arc::ptr_eq(&self.attributes, &other.attributes)
            && self.loops.len() == other.loops.len()
            && self.loops.iter().zip(&other.loops).all(|(a, b)| Arc::ptr_eq(a, b))
    }

    /// The parts lent to an operation.
    pub fn view(&self) -> FaceView<'_> {
        FaceView {
            attributes: (*self.attributes).clone(),
            surface: &self.surface,
            loops: self.loops.iter().map(|l| &**l).collect(),
        }
    }

    /// The whole record.
    pub fn to_record(&self) -> FaceRecord {
        self.view().to_record()
    }
}

impl Records<'_, '_> {
    /// The parts of a face as they are now.
    pub fn parts(&self, face: Entity) -> Option<FaceParts> {
        let AuthoredFace { surface, attributes, .. } = self.faces.get(face).ok()?.clone();
        Some(FaceParts { surface, attributes, loops: self.loops(face).cloned().collect() })
    }

    /// The authored component of a face.
    pub fn authored(&self, face: Entity) -> Option<&AuthoredFace> {
        self.faces.get(face).ok()
    }

    /// The loops of a face in order. Loops that were despawned behind the face's back are left out.
    pub fn loops(&self, face: Entity) -> impl Iterator<Item = &Arc<LoopRecord>> {
        let entities = self.faces.get(face).map_or(&[][..], |f| &f.loops);
        self.loops.iter_many(entities).map(|l| &l.record)
    }

    /// One loop of a face, by position.
    pub fn trim_loop(&self, face: Entity, index: usize) -> Option<&Arc<LoopRecord>> {
        self.loops.get(*self.faces.get(face).ok()?.loops.get(index)?).ok().map(|l| &l.record)
    }

    /// A face lent to an operation.
    pub fn view(&self, face: Entity) -> Option<FaceView<'_>> {
        let authored = self.faces.get(face).ok()?;
        Some(FaceView {
            attributes: (*authored.attributes).clone(),
            surface: &authored.surface,
            loops: self.loops(face).map(|l| &**l).collect(),
        })
    }

    /// The whole record of a face.
    pub fn face(&self, face: Entity) -> Option<FaceRecord> {
        Some(self.parts(face)?.to_record())
    }

    /// The whole record of a model.
    pub fn model(&self, entry: &ModelEntry) -> Option<ModelRecord> {
        let model = self.models.get(entry.entity).ok()?;
        Some(ModelRecord {
            name: model.name.clone(),
            unit: model.unit.clone(),
            parts: model.parts.clone(),
            faces: entry.order.iter().filter_map(|f| self.face(*f)).collect(),
        })
    }
}
