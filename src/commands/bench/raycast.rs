//! `hairline bench raycast`: CPU time of a frame on the graphics driver and on the twin.
//!
//! The whole model from above at 1024 x 768, one sample, structures built. On a software driver CPU time
//! is the work itself, whatever else the machine does. The floor is one converged solve per pixel: a
//! single patch of the model's most common degrees that fills the window, every pixel hit at once.

use std::io::{self, Write};

use glam::{DVec2, DVec3};

use super::sheet::{Sheet, cpu_medians, number};
use crate::encoding::options::cast_flags;
use crate::encoding::{
    DepthRange, DisplayMode, FaceShape, FaceSlot, LevelView, MeshChoice, MeshScene, PackedScene, View,
};
use crate::kernel::bezier::BezierPatch;
use crate::kernel::face::{Face, UvRect};
use crate::kernel::view::{Camera, Projection, StandardView};
use crate::reference::cast::CastCounts;
use crate::reference::{mesh, visibility};
use crate::scene::records::ModelRecord;

const SIZE: [u32; 2] = [1024, 768];
/// Frames of each kind, one after the other; the median counts.
const ROUNDS: u32 = 5;
/// The same for frames from triangles, which are short, so that several are timed at a time.
#[cfg(feature = "gpu")]
const MESH_ROUNDS: u32 = 40;
#[cfg(feature = "gpu")]
const MESH_FRAMES: u32 = 4;
/// What is compared: with trims and without.
const MODES: [DisplayMode; 2] = [DisplayMode::Shaded, DisplayMode::Untrimmed];
/// Error of the second renderer's triangles on the screen, pixels.
const MESH_ERROR_PX: f64 = 0.5;

/// CPU seconds of a frame and the pixels it fills.
#[derive(Debug, Clone, Copy)]
struct Frame {
    seconds: f64,
    filled: usize,
    counts: CastCounts,
}

/// Something that draws frames in either of [`MODES`]: the twin, or the renderer on a driver.
type Caster<'a> = dyn FnMut(&mut PackedScene, Option<&mut MeshChoice>, &Camera) -> Option<[Frame; 2]> + 'a;

/// Prints a table for each backend.
///
/// # Errors
/// `out` cannot be written.
pub fn run(models: &[ModelRecord], out: &mut impl Write) -> io::Result<()> {
    let demo = [crate::scene::demo::model()];
    let models = if models.is_empty() { &demo[..] } else { models };
    table("the CPU twin", models, &mut twin_frames, out)?;
    #[cfg(feature = "gpu")]
    match crate::gpu::Context::headless() {
        Ok(context) => {
            let name = context.adapter_name.clone();
            let mut caster = |scene: &mut PackedScene, meshes: Option<&mut MeshChoice>, camera: &Camera| {
                gpu_frames(&context, scene, meshes, camera).ok()
            };
            table(&name, models, &mut caster, out)?;
        }
        Err(error) => writeln!(out, "No table for the graphics driver: {error}\n")?,
    }
    Ok(())
}

fn table(name: &str, models: &[ModelRecord], caster: &mut Caster, out: &mut impl Write) -> io::Result<()> {
    let mut sheet = Sheet::new(
        format!("Ray casting on {name}, from above, {} x {}, CPU time", SIZE[0], SIZE[1]),
        &[
            "model",
            "cells",
            "filled %",
            "s/frame",
            "us/pixel",
            "untrimmed s",
            "trimming",
            "solve us",
            "frame/(filled x solve)",
            "entered/px",
            "hidden/px",
            "solves/px",
            "eval/px",
            "trims/px",
            "triangles",
            "mesh s",
            "mesh untrimmed s",
            "mesh trims %",
            "rays/mesh",
        ],
    );
    for model in models {
        let faces: Vec<Face> = model.faces.iter().filter_map(|r| r.derive().ok()).collect();
        let mut scene = PackedScene::from_faces(faces.iter().map(|f| FaceShape::of(f, None, false)));
        let (direction, up) = StandardView::Top.directions();
        let projection = Projection::Perspective { fov_y: 0.6 };
        let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
        let camera = tight(&scene, Camera::fit(&scene.bounds(), direction, up, projection, aspect));
        let pair = |frames: Option<[Frame; 2]>| (frames.map(|f| f[0]), frames.map(|f| f[1]));
        let (trimmed, untrimmed) = pair(caster(&mut scene, None, &camera));
        let (mut patch_scene, patch_camera) = one_patch(common_degrees(&faces));
        let (_, solved) = pair(caster(&mut patch_scene, None, &patch_camera));
        let solve = solved.map(|f| f.seconds / f.filled.max(1) as f64);
        let mut meshes = MeshScene::default();
        let face = |slot: FaceSlot| faces.get(slot.0 as usize);
        let lacking = meshes.prepare(&scene, face, &LevelView::new(&camera, SIZE), MESH_ERROR_PX);
        let triangles = (meshes.indices().len() / 3).to_string();
        let mut choice = MeshChoice { scene: meshes, lacking };
        let (meshed, meshed_whole) = pair(caster(&mut scene, Some(&mut choice), &camera));
        let share = |a: Frame, b: Frame| 100.0 * (1.0 - b.seconds / a.seconds);
        let per_pixel = trimmed.map(|f| f.seconds / f.filled.max(1) as f64);
        let ratio = |a: Option<f64>, b: Option<f64>| Some(a? / b?);
        let mut row = vec![
            model.name.clone(),
            scene.counts().0.to_string(),
            number(trimmed.map(|f| 100.0 * f.filled as f64 / f64::from(SIZE[0] * SIZE[1]))),
            number(trimmed.map(|f| f.seconds)),
            number(per_pixel.map(|s| 1e6 * s)),
            number(untrimmed.map(|f| f.seconds)),
            number(ratio(trimmed.map(|f| f.seconds), untrimmed.map(|f| f.seconds))),
            number(solve.map(|s| 1e6 * s)),
            number(ratio(per_pixel, solve)),
        ];
        let filled = trimmed.map_or(1, |f| f.filled.max(1)) as f64;
        let counts = trimmed.map(|f| f.counts).filter(|c| c.entered > 0);
        let counts = counts.map(|c| [c.entered, c.hidden, c.solves, c.evaluations, c.classified]);
        row.extend((0..5).map(|k| number(counts.map(|c| c[k] as f64 / filled))));
        row.extend([
            triangles,
            number(meshed.map(|f| f.seconds)),
            number(meshed_whole.map(|f| f.seconds)),
            number(meshed.zip(meshed_whole).map(|(a, b)| share(a, b))),
            number(ratio(trimmed.map(|f| f.seconds), meshed.map(|f| f.seconds))),
        ]);
        sheet.row(row);
    }
    writeln!(out, "{sheet}")
}

/// `camera` moved and narrowed until what is seen of the scene touches the border of the picture.
fn tight(scene: &PackedScene, mut camera: Camera) -> Camera {
    for _ in 0..3 {
        let size = [256, 192];
        let view =
            View::new(&camera, size, [0.0; 2], depth_of(scene, &camera), cast_flags(DisplayMode::Shaded));
        let buffer = visibility::draw(scene, &view);
        let (mut low, mut high) = (DVec2::ONE, DVec2::NEG_ONE);
        for (k, _) in buffer.fragments.iter().enumerate().filter(|(_, f)| f.words[0] != 0) {
            let pixel = DVec2::new((k % 256) as f64, (k / 256) as f64) / DVec2::new(256.0, 192.0);
            let ndc = DVec2::new(2.0 * pixel.x - 1.0, 1.0 - 2.0 * pixel.y);
            (low, high) = (low.min(ndc), high.max(ndc));
        }
        if low.x >= high.x || low.y >= high.y {
            return camera;
        }
        let (right, up, _) = camera.axes();
        let half = camera.half_extent(f64::from(size[0]) / f64::from(size[1]));
        let middle = 0.5 * (low + high) * half;
        let by = right * middle.x + up * middle.y;
        (camera.eye, camera.target) = (camera.eye + by, camera.target + by);
        if let Projection::Perspective { fov_y } = &mut camera.projection {
            let part = (0.5 * (high - low)).max_element() * 1.02;
            *fov_y = 2.0 * ((0.5 * *fov_y).tan() * part).atan();
        }
    }
    camera
}

/// The degrees that most patches have.
fn common_degrees(faces: &[Face]) -> (usize, usize) {
    let mut counts = std::collections::BTreeMap::new();
    for patch in faces.iter().flat_map(|f| &f.patches) {
        *counts.entry((patch.degree_u, patch.degree_v)).or_insert(0usize) += 1;
    }
    counts.into_iter().max_by_key(|(_, n)| *n).map_or((3, 3), |(degrees, _)| degrees)
}

/// A gently curved patch that more than fills the window of its camera.
fn one_patch((m, n): (usize, usize)) -> (PackedScene, Camera) {
    let (m, n) = (m.max(1), n.max(1));
    let points = (0..=m).flat_map(|i| {
        (0..=n).map(move |j| {
            let (x, y) = (i as f64 / m as f64, j as f64 / n as f64);
            DVec3::new(4.0 * x - 2.0, 4.0 * y - 2.0, 0.1 * (x * (1.0 - x) + y * y * (1.0 - y)))
        })
    });
    let patch = BezierPatch {
        degree_u: m,
        degree_v: n,
        points: points.collect(),
        weights: vec![1.0; (m + 1) * (n + 1)],
        uv_min: DVec2::ZERO,
        uv_max: DVec2::ONE,
    };
    let domain = UvRect { min: DVec2::ZERO, max: DVec2::ONE };
    let shape = FaceShape { patches: &[patch], domain, grid: None, colour: [0.5; 3], reversed: false };
    let camera = Camera {
        eye: DVec3::new(0.0, 0.0, 5.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Orthographic { height: 2.0 },
    };
    (PackedScene::from_faces([shape]), camera)
}

fn depth_of(scene: &PackedScene, camera: &Camera) -> DepthRange {
    let bounds = scene.bounds();
    DepthRange::around(camera, bounds.centre(), 0.5 * bounds.diagonal())
}

fn twin_frames(
    scene: &mut PackedScene,
    meshes: Option<&mut MeshChoice>,
    camera: &Camera,
) -> Option<[Frame; 2]> {
    let depth = depth_of(scene, camera);
    let draw = |k: usize| {
        let view = View::new(camera, SIZE, [0.0; 2], depth, cast_flags(MODES[k]));
        match &meshes {
            Some(choice) => mesh::draw(scene, &choice.scene, &choice.lacking, &view),
            None => visibility::draw(scene, &view),
        }
    };
    let seconds = cpu_medians(MODES.len(), ROUNDS, 1, |k| drop(draw(k)));
    Some(std::array::from_fn(|k| {
        let buffer = draw(k);
        let filled = buffer.fragments.iter().filter(|f| f.words[0] != 0).count();
        Frame { seconds: seconds[k], filled, counts: buffer.counts }
    }))
}

#[cfg(feature = "gpu")]
fn gpu_frames(
    context: &crate::gpu::Context,
    scene: &mut PackedScene,
    meshes: Option<&mut MeshChoice>,
    camera: &Camera,
) -> Result<[Frame; 2], crate::gpu::GpuError> {
    use crate::gpu::{Renderer, Sample, picture::read_texture};
    let (device, queue) = (&context.device, &context.queue);
    let mut renderer = Renderer::new(device, wgpu::TextureFormat::Rgba8Unorm);
    scene.touch_all();
    renderer.upload(device, queue, scene)?;
    let from_triangles = meshes.is_some();
    if let Some(MeshChoice { scene: meshes, lacking }) = meshes {
        meshes.touch_all();
        renderer.upload_meshes(device, queue, meshes, scene, lacking)?;
    }
    let depth = depth_of(scene, camera);
    let draw = |renderer: &mut Renderer, k: usize| {
        let sample = Sample { camera: *camera, depth, size: SIZE, jitter: [0.0; 2], mode: MODES[k] };
        let mut encoder = device.create_command_encoder(&Default::default());
        if from_triangles {
            renderer.draw_meshes(device, queue, &mut encoder, &sample);
        } else {
            renderer.cast(device, queue, &mut encoder, &sample);
        }
        queue.submit([encoder.finish()]);
        context.wait()
    };
    // The first frame of each kind compiles shaders.
    (0..MODES.len()).try_for_each(|k| draw(&mut renderer, k))?;
    let (rounds, frames) = if from_triangles { (MESH_ROUNDS, MESH_FRAMES) } else { (ROUNDS, 1) };
    let mut failed = Ok(());
    let seconds = cpu_medians(MODES.len(), rounds, frames, |k| {
        let waited = draw(&mut renderer, k);
        if waited.is_err() {
            failed = waited;
        }
    });
    failed?;
    let mut filled = [0; 2];
    for (k, filled) in filled.iter_mut().enumerate() {
        draw(&mut renderer, k)?;
        let words = read_texture(context, &renderer.targets().visibility)?;
        *filled = words.chunks_exact(16).filter(|w| w[..4] != [0; 4]).count();
    }
    let counts = CastCounts::default();
    Ok(std::array::from_fn(|k| Frame { seconds: seconds[k], filled: filled[k], counts }))
}
