//! `hairline bench misses`: random close-ups of every face, ray by ray against the f64 oracle.
//!
//! A ray *misses* when the oracle has a kept hit well inside the trims and the picture shows nothing, or
//! something clearly behind it. Hits within a pixel of a trim curve count for neither side.

use std::io::{self, Write};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::sheet::{Sheet, number};
use crate::encoding::view::CAST_TRIM;
use crate::encoding::{DepthRange, FaceShape, PackedScene, View};
use crate::kernel::face::{Face, Side};
use crate::kernel::query::raycast::{RayHit, Raycaster};
use crate::kernel::view::{Bounds, Camera, Projection, Ray};
use crate::reference::cast::Fragment;
use crate::reference::visibility::{self, VisibilityBuffer};
use crate::scene::records::ModelRecord;

/// Close-ups per model and pixels each way of a picture.
const VIEWS: usize = 20;
const PIXELS: u32 = 160;
/// Sets of close-ups, each with its own random numbers.
const SEEDS: u64 = 1;

/// What a comparison counted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Rays cast.
    pub rays: u64,
    /// Rays on which the oracle has a kept hit.
    pub hits: u64,
    /// Of those: nothing there in the picture, or something behind.
    pub missed: u64,
    /// Rays without an oracle hit where the picture shows something.
    pub extra: u64,
}

impl Tally {
    /// Adds another tally.
    pub fn add(&mut self, other: &Self) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.missed += other.missed;
        self.extra += other.extra;
    }
}

/// A reproducible stream of close-up cameras: a random point of a random patch, from a random
/// direction, at a zoom between 1 and 1,000 (evenly in its logarithm), one in three orthographic.
#[derive(Debug)]
pub struct Closeups {
    /// The oracle.
    pub caster: Raycaster,
    bounds: Bounds,
    state: u64,
}

impl Closeups {
    /// Cameras for `faces`, the same for the same `seed`.
    pub fn new(faces: &[Face], bounds: Bounds, seed: u64) -> Self {
        Self { caster: Raycaster::new(domain_patches(faces)), bounds, state: seed }
    }

    /// The next camera.
    pub fn camera(&mut self) -> Camera {
        let patches = self.caster.patches().len();
        let index = ((self.uniform() * patches as f64) as usize).min(patches.saturating_sub(1));
        let (a, b) = (self.uniform(), self.uniform());
        let point = self.caster.patches().get(index).map_or(DVec3::ZERO, |(_, p)| p.point(a, b));
        let (z, angle) = (2.0 * self.uniform() - 1.0, std::f64::consts::TAU * self.uniform());
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let direction = DVec3::new(radius * angle.cos(), radius * angle.sin(), z);
        let zoom = 1000f64.powf(self.uniform());
        let projection = if self.uniform() < 1.0 / 3.0 {
            Projection::Orthographic { height: 1.0 }
        } else {
            Projection::Perspective { fov_y: 0.6 }
        };
        let mut camera = Camera::fit(&self.bounds, direction, DVec3::new(0.1, 0.2, 1.0), projection, 1.0);
        let distance = camera.distance() / zoom;
        camera.target = point;
        camera.eye = point - direction * distance;
        if let Projection::Orthographic { height } = &mut camera.projection {
            *height /= zoom;
        }
        camera
    }

    /// Uniform in 0..1 (a multiplicative generator with an output hash).
    fn uniform(&mut self) -> f64 {
        self.state =
            self.state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = (self.state ^ (self.state >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
        ((x ^ (x >> 33)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// The patches of all faces cut to their faces' domains.
fn domain_patches(faces: &[Face]) -> Vec<(usize, crate::kernel::bezier::BezierPatch)> {
    let mut list = Vec::new();
    for (index, face) in faces.iter().enumerate() {
        for patch in &face.patches {
            let (min, max) = (patch.uv_min.max(face.domain.min), patch.uv_max.min(face.domain.max));
            if min.x < max.x && min.y < max.y {
                let unit = |p: DVec2| patch.local(p).clamp(DVec2::ZERO, DVec2::ONE);
                list.push((index, patch.restrict(unit(min), unit(max))));
            }
        }
    }
    list
}

/// Compares the twin's picture of `size` pixels each way with the oracle, ray by ray.
pub fn compare(scene: &PackedScene, caster: &Raycaster, faces: &[Face], camera: &Camera, size: u32) -> Tally {
    let view = View::new(camera, [size, size], [0.0; 2], depth_of(scene, camera), CAST_TRIM);
    judge(scene, caster, faces, camera, &visibility::draw(scene, &view))
}

/// The depth planes that pictures to be compared are cast with.
pub fn depth_of(scene: &PackedScene, camera: &Camera) -> DepthRange {
    let bounds = scene.bounds();
    DepthRange::around(camera, bounds.centre(), 0.5 * bounds.diagonal())
}

/// Pixels at which two pictures differ though the first shows one smooth surface all around them.
pub fn strays(scene: &PackedScene, camera: &Camera, a: &VisibilityBuffer, b: &VisibilityBuffer) -> u64 {
    let view = View::new(camera, [a.width, a.height], [0.0; 2], depth_of(scene, camera), CAST_TRIM);
    let apart = |p: Fragment, q: Fragment, pixels: f64| {
        let (z, other) = (drawn_z(&view, p.depth), drawn_z(&view, q.depth));
        let pixel = f64::from(view.pixel[0]) + f64::from(view.pixel[1]) * z.abs();
        p.words[0] != q.words[0] || (p.words[0] != 0 && (z - other).abs() > pixels * pixel)
    };
    let stray = |k: &u32| {
        let (x, y) = ((k % a.width) as i32, (k / a.width) as i32);
        let here = a.at(x, y);
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)));
        apart(here, b.at(x, y), 1.0)
            && !around.into_iter().any(|(dx, dy)| apart(here, a.at(x + dx, y + dy), 20.0))
    };
    (0..a.width * a.height).filter(stray).count() as u64
}

/// Compares a square picture with the oracle, ray by ray.
pub fn judge(
    scene: &PackedScene,
    caster: &Raycaster,
    faces: &[Face],
    camera: &Camera,
    picture: &VisibilityBuffer,
) -> Tally {
    let size = picture.width;
    let depth = depth_of(scene, camera);
    let view = View::new(camera, [size, size], [0.0; 2], depth, CAST_TRIM);
    let scene_size = scene.bounds().diagonal();
    (0..size * size)
        .into_par_iter()
        .map(|k| {
            let (x, y) = (k % size, k / size);
            let ray = pixel_ray(camera, x, y, size);
            let found = caster.hits(&ray);
            let mut tally = Tally { rays: 1, ..Tally::default() };
            let fragment = picture.at(x as i32, y as i32);
            let visible = |h: &&RayHit| {
                camera_z(camera, h.point) > depth.near.max(f64::MIN_POSITIVE)
                    || matches!(camera.projection, Projection::Orthographic { .. })
            };
            let kept = |h: &&RayHit| faces[h.face].classify_native(h.uv.x, h.uv.y) != Side::Out;
            match found.hits.iter().filter(visible).find(kept) {
                Some(hit) => {
                    tally.hits = 1;
                    let z = camera_z(camera, hit.point);
                    let pixel = f64::from(view.pixel[0]) + f64::from(view.pixel[1]) * z;
                    let slant = hit.normal.normalize_or_zero().dot(ray.direction).abs().max(1e-3);
                    let slack = 4.0 * pixel / slant + 1e-5 * z.abs() + 3e-7 * scene_size;
                    let nothing = fragment.words[0] == 0;
                    let behind = !nothing && drawn_z(&view, fragment.depth) > z + slack;
                    if (nothing || behind) && !near_trim(&faces[hit.face], hit, pixel) {
                        tally.missed = 1;
                    }
                }
                None => tally.extra = u64::from(fragment.words[0] != 0),
            }
            tally
        })
        .reduce(Tally::default, |mut a, b| {
            a.add(&b);
            a
        })
}

/// Whether a point a pixel away on the surface falls on the other side of the trims or off the domain.
fn near_trim(face: &Face, hit: &RayHit, pixel: f64) -> bool {
    let Some(patch) =
        face.patches.iter().find(|p| p.uv_min.cmple(hit.uv).all() && p.uv_max.cmpge(hit.uv).all())
    else {
        return true;
    };
    let local = patch.local(hit.uv);
    let at = patch.tangents(local.x, local.y);
    let span = patch.uv_max - patch.uv_min;
    let step = DVec2::new(
        pixel / at.du.length().max(f64::MIN_POSITIVE),
        pixel / at.dv.length().max(f64::MIN_POSITIVE),
    ) * span;
    (0..8).any(|k| {
        let angle = f64::from(k) * std::f64::consts::FRAC_PI_4;
        let p = hit.uv + DVec2::new(angle.cos(), angle.sin()) * step;
        face.classify_native(p.x, p.y) != Side::In
    })
}

fn pixel_ray(camera: &Camera, x: u32, y: u32, size: u32) -> Ray {
    let ndc = |v: u32| 2.0 * (f64::from(v) + 0.5) / f64::from(size) - 1.0;
    camera.ray(DVec2::new(ndc(x), -ndc(y)), 1.0)
}

/// Depth along the line of sight from the reference point, as in [`View`].
fn camera_z(camera: &Camera, point: DVec3) -> f64 {
    let (_, _, back) = camera.axes();
    let reference = match camera.projection {
        Projection::Perspective { .. } => camera.eye,
        Projection::Orthographic { .. } => camera.target,
    };
    (reference - point).dot(back)
}

fn drawn_z(view: &View, depth: f32) -> f64 {
    let [a, b, c, d] = view.depth.map(f64::from);
    let depth = f64::from(depth);
    (a - depth * c) / (depth * d - b)
}

/// Something that casts close-ups: the twin, or the renderer on a driver.
type Caster<'a> = dyn FnMut(&mut PackedScene, &Camera, bool) -> Option<VisibilityBuffer> + 'a;

/// Prints a line for each model, for the twin and for the graphics driver.
///
/// # Errors
/// `out` cannot be written.
pub fn run(models: &[ModelRecord], out: &mut impl Write) -> io::Result<()> {
    let demo = [crate::scene::demo::model()];
    let models = if models.is_empty() { &demo[..] } else { models };
    let mut twin = |scene: &mut PackedScene, camera: &Camera, _| Some(twin_picture(scene, camera));
    table("the CPU twin", models, &mut twin, None, out)?;
    #[cfg(feature = "gpu")]
    match crate::gpu::Context::headless() {
        Ok(context) => {
            let format = wgpu::TextureFormat::Rgba8Unorm;
            let mut renderer = crate::gpu::Renderer::new(&context.device, format);
            let mut driver = |scene: &mut PackedScene, camera: &Camera, first| {
                if first {
                    scene.touch_all();
                    renderer.upload(&context.device, &context.queue, scene).ok()?;
                }
                let sample = crate::gpu::Sample {
                    camera: *camera,
                    depth: depth_of(scene, camera),
                    size: [PIXELS; 2],
                    jitter: [0.0; 2],
                    mode: crate::encoding::DisplayMode::Shaded,
                };
                crate::gpu::picture::visibility(&context, &mut renderer, &sample).ok()
            };
            table(&context.adapter_name, models, &mut driver, Some(twin_picture), out)?;
        }
        Err(error) => writeln!(out, "No table for the graphics driver: {error}\n")?,
    }
    Ok(())
}

fn twin_picture(scene: &PackedScene, camera: &Camera) -> VisibilityBuffer {
    let view = View::new(camera, [PIXELS; 2], [0.0; 2], depth_of(scene, camera), CAST_TRIM);
    visibility::draw(scene, &view)
}

/// `twin`: what pictures are compared with, besides the oracle.
fn table(
    name: &str,
    models: &[ModelRecord],
    caster: &mut Caster,
    twin: Option<fn(&PackedScene, &Camera) -> VisibilityBuffer>,
    out: &mut impl Write,
) -> io::Result<()> {
    let mut sheet = Sheet::new(
        format!(
            "Hits missed by {name} at {VIEWS} random close-ups (zoom 1 to 1,000) of {PIXELS} x {PIXELS} rays, against the f64 oracle"
        ),
        &[
            "model",
            "faces",
            "cells",
            "rays",
            "hits",
            "missed",
            "per 100,000",
            "extra",
            "unlike the twin per 10,000",
        ],
    );
    for model in models {
        let derived: Vec<(Face, Option<[f32; 3]>)> =
            model.faces.iter().filter_map(|r| Some((r.derive().ok()?, r.colour))).collect();
        let mut scene = PackedScene::from_faces(derived.iter().map(|(f, c)| FaceShape::of(f, *c, false)));
        let faces: Vec<Face> = derived.into_iter().map(|(f, _)| f).collect();
        let (mut total, mut unlike) = (Tally::default(), 0);
        for seed in 1..=SEEDS {
            let mut closeups = Closeups::new(&faces, scene.bounds(), seed);
            for view in 0..VIEWS {
                let camera = closeups.camera();
                let Some(picture) = caster(&mut scene, &camera, seed == 1 && view == 0) else { continue };
                if let Some(twin) = twin {
                    unlike += strays(&scene, &camera, &twin(&scene, &camera), &picture);
                }
                total.add(&judge(&scene, &closeups.caster, &faces, &camera, &picture));
            }
        }
        sheet.row([
            model.name.clone(),
            faces.len().to_string(),
            scene.counts().0.to_string(),
            total.rays.to_string(),
            total.hits.to_string(),
            total.missed.to_string(),
            number(Some(1e5 * total.missed as f64 / total.rays.max(1) as f64)),
            total.extra.to_string(),
            number(twin.map(|_| 1e4 * unlike as f64 / total.rays.max(1) as f64)),
        ]);
    }
    writeln!(out, "{sheet}")
}
