//! From a scene to the bytes of its file.

use rayon::prelude::*;
use ruzstd::encoding::{CompressionLevel, compress_to_vec};
use serde::Serialize;

use super::{FORMAT, LARGE, Packing};
use crate::scene::document::SceneRecord;
use crate::scene::records::{FaceRecord, ModelRecord};

/// Faces written by one task.
const CHUNK: usize = 256;
/// Text packed by one task, bytes: one frame each. Frames side by side are one Zstandard file.
const FRAME: usize = 1 << 20;

/// Why a scene has no file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WriteError {
    /// JSON has no word for infinities and NaN.
    #[error("{place} is not finite and cannot be saved")]
    NotFinite {
        /// What.
        place: String,
    },
    /// serde refuses.
    #[error("cannot be written as JSON: {reason}")]
    Json {
        /// Why.
        reason: String,
    },
}

impl From<serde_json::Error> for WriteError {
    fn from(error: serde_json::Error) -> Self {
        Self::Json { reason: error.to_string() }
    }
}

pub(super) fn to_bytes(scene: &SceneRecord, packing: Packing) -> Result<Vec<u8>, WriteError> {
    check_finite(scene)?;
    let parts = text(scene)?;
    let length: usize = parts.iter().map(Vec::len).sum();
    let packed = match packing {
        Packing::Automatic => length >= LARGE,
        Packing::Plain => false,
        Packing::Packed => true,
    };
    if !packed {
        return Ok(parts.concat());
    }
    let frames = frames(&parts);
    let packed: Vec<Vec<u8>> =
        frames.par_iter().map(|f| compress_to_vec(f.as_slice(), CompressionLevel::Fastest)).collect();
    Ok(packed.concat())
}

/// The text cut to pieces of even size.
fn frames(parts: &[Vec<u8>]) -> Vec<Vec<u8>> {
    let mut frames = vec![Vec::new()];
    for part in parts {
        if frames.last().is_some_and(|f| f.len() + part.len() > FRAME) {
            frames.push(Vec::new());
        }
        if let Some(frame) = frames.last_mut() {
            frame.extend_from_slice(part);
        }
    }
    frames
}

/// The text in pieces.
fn text(scene: &SceneRecord) -> Result<Vec<Vec<u8>>, WriteError> {
    let SceneRecord { models, hidden, camera, views, display } = scene;
    let mut head = format!(
        "{{\"hairline\":\"scene\",\"version\":{FORMAT},\"program\":\"{}\",\n",
        env!("CARGO_PKG_VERSION")
    )
    .into_bytes();
    member(&mut head, "camera", camera)?;
    member(&mut head, "views", views)?;
    member(&mut head, "display", display)?;
    member(&mut head, "hidden", hidden)?;
    head.extend_from_slice(b"\"models\":[");
    let mut parts = vec![head];
    for (number, model) in models.iter().enumerate() {
        let ModelRecord { name, unit, parts: groups, faces } = model;
        let mut head = if number == 0 { b"\n{".to_vec() } else { b",\n{".to_vec() };
        member(&mut head, "name", name)?;
        member(&mut head, "unit", unit)?;
        member(&mut head, "parts", groups)?;
        head.extend_from_slice(b"\"faces\":[");
        parts.push(head);
        let chunks: Vec<_> = faces.chunks(CHUNK).enumerate().collect();
        let written: Result<Vec<_>, _> = chunks.into_par_iter().map(|(k, c)| lines(c, k == 0)).collect();
        parts.extend(written?);
        parts.push(b"\n]}".to_vec());
    }
    parts.push(b"\n]}\n".to_vec());
    Ok(parts)
}

fn member(out: &mut Vec<u8>, key: &str, value: &impl Serialize) -> Result<(), WriteError> {
    out.push(b'"');
    out.extend_from_slice(key.as_bytes());
    out.extend_from_slice(b"\":");
    serde_json::to_writer(&mut *out, value)?;
    out.extend_from_slice(b",\n");
    Ok(())
}

fn lines(faces: &[FaceRecord], first: bool) -> Result<Vec<u8>, WriteError> {
    let mut out = Vec::new();
    for (k, face) in faces.iter().enumerate() {
        out.extend_from_slice(if first && k == 0 { b"\n" } else { b",\n" });
        serde_json::to_writer(&mut out, face)?;
    }
    Ok(out)
}

/// Curves and surfaces are finite by construction; the rest is looked at here.
fn check_finite(scene: &SceneRecord) -> Result<(), WriteError> {
    let refuse = |finite: bool, place: &dyn Fn() -> String| match finite {
        true => Ok(()),
        false => Err(WriteError::NotFinite { place: place() }),
    };
    let finite = |camera: &crate::kernel::view::Camera| {
        use crate::kernel::view::Projection::{Orthographic, Perspective};
        let (Perspective { fov_y: size } | Orthographic { height: size }) = camera.projection;
        camera.eye.is_finite() && camera.target.is_finite() && camera.up.is_finite() && size.is_finite()
    };
    if let Some(camera) = &scene.camera {
        refuse(finite(camera), &|| "the camera".into())?;
    }
    for view in &scene.views {
        refuse(finite(&view.camera), &|| format!("the view {}", view.name))?;
    }
    for (m, model) in scene.models.iter().enumerate() {
        refuse(model.unit.millimetres.is_finite(), &|| format!("the unit of model {}", m + 1))?;
        for (f, face) in model.faces.iter().enumerate() {
            let finite = face.colour.is_none_or(|c| c.iter().all(|c| c.is_finite()));
            refuse(finite, &|| format!("the colour of face {} of model {}", f + 1, m + 1))?;
        }
    }
    Ok(())
}
