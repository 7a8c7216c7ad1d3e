//! How much memory an edit holds: what a history counts against its cap.

use std::mem::size_of;

use glam::{DVec2, DVec3};

use super::{Change, Edit, ModelHead, NetPoint};
use crate::kernel::nurbs::{NurbsCurve2, NurbsSurface};
use crate::scene::document::FaceAttributes;
use crate::scene::records::{FaceRecord, LoopRecord, ModelRecord, PartRecord};

impl Edit {
    /// Bytes of the edit, its heap included (allocators' overhead is not).
    pub fn bytes(&self) -> usize {
        size_of::<Self>() + self.label.len() + self.changes.iter().map(Change::bytes).sum::<usize>()
    }
}

impl Change {
    /// Bytes of the change, its heap included.
    pub fn bytes(&self) -> usize {
        let heap = match self {
            Self::Curves { before, after, .. } => sum(before, curve) + sum(after, curve),
            Self::Loops { before, after, .. } => sum(before, trim_loop) + sum(after, trim_loop),
            Self::Role { .. } => 0,
            Self::Surface { before, after, .. } => surface(before) + surface(after),
            Self::Net { before, after, .. } => (before.len() + after.len()) * size_of::<NetPoint>(),
            Self::Attributes { before, after, .. } => attributes(before) + attributes(after),
            Self::Faces { before, after, .. } => sum(before, face) + sum(after, face),
            Self::Model { before, after, .. } => head(before) + head(after),
            Self::Models { before, after, .. } => sum(before, model) + sum(after, model),
        };
        size_of::<Self>() + heap
    }
}

fn sum<T>(list: &[T], of: impl Fn(&T) -> usize) -> usize {
    list.iter().map(of).sum()
}

fn curve(curve: &NurbsCurve2) -> usize {
    size_of::<NurbsCurve2>()
        + curve.points().len() * (size_of::<DVec2>() + 8)
        + curve.knots().as_slice().len() * 8
}

fn trim_loop(trim: &LoopRecord) -> usize {
    size_of::<LoopRecord>() + sum(&trim.curves, curve)
}

fn surface(surface: &NurbsSurface) -> usize {
    let knots = surface.knots_u().as_slice().len() + surface.knots_v().as_slice().len();
    size_of::<NurbsSurface>() + surface.points().len() * (size_of::<DVec3>() + 8) + knots * 8
}

fn text(text: Option<&String>) -> usize {
    text.map_or(0, String::len)
}

fn attributes(of: &FaceAttributes) -> usize {
    size_of::<FaceAttributes>() + text(of.name.as_ref()) + text(of.source.as_ref().map(|s| &s.entity))
}

fn face(face: &FaceRecord) -> usize {
    let text = text(face.name.as_ref()) + text(face.source.as_ref().map(|s| &s.entity));
    size_of::<FaceRecord>() + text + surface(&face.surface) + sum(&face.loops, trim_loop)
}

fn parts(parts: &[PartRecord]) -> usize {
    sum(parts, |p| size_of::<PartRecord>() + p.name.len())
}

fn head(head: &ModelHead) -> usize {
    size_of::<ModelHead>() + head.name.len() + parts(&head.parts)
}

fn model(model: &ModelRecord) -> usize {
    size_of::<ModelRecord>() + model.name.len() + parts(&model.parts) + sum(&model.faces, face)
}
