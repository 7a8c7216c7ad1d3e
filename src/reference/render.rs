//! Pictures drawn on the CPU: the same as the GPU's, on any machine.

use glam::{Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::resolve::{resolve, resolve_difference};
use super::shade::srgb_from_linear;
use super::{mesh, ribbon, visibility};
use crate::encoding::options::{cast_flags, jitter};
use crate::encoding::{
    Conceal, DepthRange, Extras, Image, Look, MeshChoice, PackedScene, RenderOptions, View,
};

/// Draws `scene`. Uses all cores; the result does not depend on their number.
pub fn render_image(scene: &PackedScene, options: &RenderOptions) -> Image {
    render_image_with(scene, options, &Extras::default())
}

/// The same with what `extras` hold.
pub fn render_image_with(scene: &PackedScene, options: &RenderOptions, extras: &Extras) -> Image {
    let size = options.size.map(|s| s.max(1));
    let bounds = scene.bounds();
    let depth = DepthRange::around(&options.camera, bounds.centre(), 0.5 * bounds.diagonal());
    let samples = options.samples.max(1);
    let [width, height] = size;
    let mut sum = vec![Vec4::ZERO; width as usize * height as usize];
    let mut look = None;
    for k in 0..samples {
        let view = View::new(&options.camera, size, jitter(k), depth, cast_flags(options.mode));
        let buffer = match &extras.meshes {
            Some(MeshChoice { scene: meshes, lacking }) => mesh::draw(scene, meshes, lacking, &view),
            None => visibility::draw(scene, &view),
        };
        let fat = extras.ribbons.as_ref().filter(|r| r.conceal != Conceal::Raw);
        let raw = buffer;
        let concealed = fat.map(|r| ribbon::conceal(scene, &r.scene, &r.spans, &raw, &view));
        let buffer = concealed.as_ref().unwrap_or(&raw);
        let difference = fat.is_some_and(|r| r.conceal == Conceal::Difference);
        let sample = Look::new(&view, options.mode, options.edges, options.theme);
        let faces = scene.faces.data();
        sum.par_chunks_mut(width as usize).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                let (x, y) = (x as i32, y as i32);
                *pixel += if difference {
                    resolve_difference(&sample, faces, (buffer, &raw), x, y)
                } else {
                    resolve(&sample, faces, buffer, x, y)
                };
            }
        });
        look = Some(sample);
    }
    let rgba = match look {
        Some(look) => sum
            .par_iter()
            .enumerate()
            .flat_map_iter(|(k, pixel)| {
                let v = ((k / width as usize) as f32 + 0.5) / height as f32;
                present(&look, *pixel / samples as f32, v)
            })
            .collect(),
        None => Vec::new(),
    };
    Image { width, height, rgba }
}

/// Twin of `composed` in `shaders/pass/present.wgsl`, then rounding to 8 bits.
fn present(look: &Look, sum: Vec4, v: f32) -> [u8; 4] {
    let background = Vec4::from(look.background_top) * (1.0 - v) + Vec4::from(look.background_bottom) * v;
    let over = (background.xyz() * background.w).extend(background.w);
    let colour = sum + (1.0 - sum.w.clamp(0.0, 1.0)) * over;
    let straight = colour.xyz() / colour.w.max(1e-6);
    let encoded = srgb_from_linear(straight.clamp(glam::Vec3::ZERO, glam::Vec3::ONE));
    let byte = |x: f32| (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    [byte(encoded.x), byte(encoded.y), byte(encoded.z), byte(colour.w)]
}
