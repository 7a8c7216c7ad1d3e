//! From a model to the buffers that are drawn.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::encoding::{FaceShape, FaceSlot, PackedScene};
use crate::kernel::face::Face;
use crate::scene::records::ModelRecord;

/// Derives and packs all faces of `model`: slot `k` of the scene is face `k` (from 0). Faces that cannot
/// be derived leave their slot empty and give a line that names them. `progress` is told the part done.
pub fn pack(model: &ModelRecord, progress: &(dyn Fn(f64) + Sync)) -> (PackedScene, Vec<String>) {
    let done = AtomicUsize::new(0);
    let faces: Vec<_> = model
        .faces
        .par_iter()
        .map(|record| {
            let face = Face::derive(record);
            let so_far = 1 + done.fetch_add(1, Ordering::Relaxed);
            progress(so_far as f64 / model.faces.len() as f64);
            face
        })
        .collect();
    let (mut scene, mut problems, mut unused) = (PackedScene::default(), Vec::new(), Vec::new());
    for (index, (record, face)) in model.faces.iter().zip(&faces).enumerate() {
        let colour = record.colour;
        match face {
            Ok(face) => {
                scene.add(&FaceShape::of(face, colour, record.reversed));
            }
            Err(error) => {
                let domain = crate::kernel::face::UvRect { min: glam::DVec2::ZERO, max: glam::DVec2::ONE };
                let shape = FaceShape { patches: &[], domain, grid: None, colour: [0.0; 3], reversed: false };
                unused.push(scene.add(&shape));
                problems.push(format!("face {}: {error}", index + 1));
            }
        }
    }
    unused.into_iter().for_each(|slot: FaceSlot| scene.remove(slot));
    (scene, problems)
}
