//! From a model to the buffers that are drawn.

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec2;
use rayon::prelude::*;

use crate::encoding::{FaceShape, PackedScene};
use crate::kernel::face::{Face, UvRect};
use crate::scene::records::ModelRecord;

/// A model made ready to draw.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// Every face by position; `None` where one cannot be derived.
    pub faces: Vec<Option<Face>>,
    /// The same packed: slot `k` is face `k`.
    pub scene: PackedScene,
    /// A line for each face that is left out.
    pub problems: Vec<String>,
}

/// Derives and packs all faces of `model`. `progress` is told the part done, 0 to 1.
pub fn prepare(model: &ModelRecord, progress: &(dyn Fn(f64) + Sync)) -> Prepared {
    let done = AtomicUsize::new(0);
    let derived: Vec<_> = model
        .faces
        .par_iter()
        .map(|record| {
            let face = record.derive().map(|face| {
                let packed = FaceShape::of(&face, record.colour, record.reversed).pack();
                (face, packed)
            });
            let so_far = 1 + done.fetch_add(1, Ordering::Relaxed);
            progress(so_far as f64 / model.faces.len() as f64);
            face
        })
        .collect();
    let (mut scene, mut problems, mut unused) = (PackedScene::default(), Vec::new(), Vec::new());
    let mut faces = Vec::with_capacity(derived.len());
    for (index, (record, face)) in model.faces.iter().zip(derived).enumerate() {
        match face {
            Ok((face, packed)) => {
                scene.add_packed(&FaceShape::of(&face, record.colour, record.reversed), packed);
                faces.push(Some(face));
            }
            Err(error) => {
                // Holds the slot until all others have theirs.
                unused.push(scene.add(&NOTHING));
                problems.push(format!("face {}: {error}", index + 1));
                faces.push(None);
            }
        }
    }
    unused.into_iter().for_each(|slot| scene.remove(slot));
    Prepared { faces, scene, problems }
}

const NOTHING: FaceShape<'static> = FaceShape {
    patches: &[],
    domain: UvRect { min: DVec2::ZERO, max: DVec2::ONE },
    grid: None,
    colour: [0.0; 3],
    reversed: false,
};
