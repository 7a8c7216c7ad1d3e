//! The second renderer against rays and against its twin.

use glam::DVec3;
use hairline::encoding::level::level_error;
use hairline::encoding::view::CAST_TRIM;
use hairline::encoding::{
    DepthRange, DisplayMode, FaceShape, FaceSlot, LevelView, MeshScene, PackedScene, View,
};
use hairline::exchange::iges;
use hairline::gpu::{Context, Renderer, Sample, picture};
use hairline::kernel::face::{Face, UvRect};
use hairline::kernel::view::{Bounds, Camera, Projection};
use hairline::reference::holes::z_of;
use hairline::reference::mesh;
use hairline::reference::visibility::VisibilityBuffer;

use crate::folder::models;
use crate::pictures::demo;

const SIZE: [u32; 2] = [240, 180];

/// Pixels at which two pictures differ in face, or by more than `pixels` in depth, though the first shows one smooth face
/// all around them.
fn strays(view: &View, a: &VisibilityBuffer, b: &VisibilityBuffer, pixels: f32) -> usize {
    let apart = |p: (i32, i32), q: (i32, i32), other: &VisibilityBuffer, pixels: f32| {
        let (p, q) = (a.at(p.0, p.1), other.at(q.0, q.1));
        let z = z_of(view, &p);
        let width = view.pixel[0] + view.pixel[1] * z.abs();
        p.words[0] != q.words[0] || (p.words[0] != 0 && (z - z_of(view, &q)).abs() > pixels * width)
    };
    let calm =
        |x: i32, y: i32| (-2..=2).all(|dy| (-2..=2).all(|dx| !apart((x, y), (x + dx, y + dy), a, 8.0)));
    let (width, height) = (a.width as i32, a.height as i32);
    (0..width * height)
        .map(|k| (k % width, k / width))
        .filter(|(x, y)| apart((*x, *y), (*x, *y), b, pixels) && calm(*x, *y))
        .count()
}

/// A model on a device, and its triangles.
struct Scene {
    context: Context,
    renderer: Renderer,
    faces: Vec<Face>,
    packed: PackedScene,
    meshes: MeshScene,
}

impl Scene {
    fn new((faces, mut packed): (Vec<Face>, PackedScene)) -> Self {
        let context = Context::headless().expect("a Vulkan driver, real or software (mesa-vulkan-drivers)");
        let mut renderer = Renderer::new(&context.device, wgpu::TextureFormat::Rgba8Unorm);
        renderer.upload(&context.device, &context.queue, &mut packed).expect("room for the model");
        Self { context, renderer, faces, packed, meshes: MeshScene::default() }
    }

    fn sample(&self, camera: Camera, size: [u32; 2], mode: DisplayMode) -> Sample {
        let bounds = self.packed.bounds();
        let depth = DepthRange::around(&camera, bounds.centre(), 0.5 * bounds.diagonal());
        Sample { camera, depth, size, jitter: [0.0; 2], mode }
    }

    /// Makes the triangles that a picture needs. Returns the faces to be cast.
    fn prepare(&mut self, sample: &Sample) -> Vec<FaceSlot> {
        let face = |slot: FaceSlot| self.faces.get(slot.0 as usize);
        let view = LevelView::new(&sample.camera, sample.size);
        let lacking = self.meshes.prepare(&self.packed, face, &view, 0.5);
        let Context { device, queue, .. } = &self.context;
        self.renderer
            .upload_meshes(device, queue, &mut self.meshes, &self.packed, &lacking)
            .expect("room for triangles");
        lacking
    }

    /// The picture of the triangles that were prepared.
    fn drawn(&mut self, sample: &Sample) -> VisibilityBuffer {
        let Context { device, queue, .. } = &self.context;
        let mut encoder = device.create_command_encoder(&Default::default());
        self.renderer.draw_meshes(device, queue, &mut encoder, sample);
        queue.submit([encoder.finish()]);
        picture::read_visibility(&self.context, &self.renderer).expect("triangles")
    }

    fn cast(&mut self, sample: &Sample) -> VisibilityBuffer {
        picture::visibility(&self.context, &mut self.renderer, sample).expect("rays")
    }

    /// Counts pixels that are kept and that are cut off where the heat of trimming asks the grid everywhere: each is kept alike
    /// without.
    fn alike_by_the_grid(&mut self, camera: Camera, size: [u32; 2]) -> [usize; 2] {
        let mut sample = self.sample(camera, size, DisplayMode::Shaded);
        self.prepare(&sample);
        let shaded = self.drawn(&sample);
        // It shows what it cuts off, too.
        sample.mode = DisplayMode::Heat;
        let asked = self.drawn(&sample);
        let mut counts = [0; 2];
        for (a, b) in shaded.fragments.iter().zip(&asked.fragments) {
            if b.words[0] == 0 {
                assert_eq!(a.words[0], 0);
            } else if b.words[3] & 128 != 0 {
                assert_eq!((a.words[..3].to_vec(), a.depth), (b.words[..3].to_vec(), b.depth));
                counts[0] += 1;
            } else {
                assert!(a.words[..3] != b.words[..3]);
                counts[1] += 1;
            }
        }
        counts
    }
}

#[test]
fn triangles_show_what_rays_show_and_the_twin_draws_the_same() {
    let mut scene = Scene::new(demo());
    let bounds = scene.packed.bounds();
    for (k, projection) in [Projection::Perspective { fov_y: 0.7 }, Projection::Orthographic { height: 1.0 }]
        .into_iter()
        .enumerate()
    {
        let direction = DVec3::new(-1.0 + 1.4 * k as f64, 0.9, -0.7).normalize();
        let mut camera = Camera::fit(&bounds, direction, DVec3::Z, projection, 4.0 / 3.0);
        if k == 0 {
            // Closer, so that some of it is out of sight.
            camera.eye = camera.target.lerp(camera.eye, 0.6);
        }
        let sample = scene.sample(camera, SIZE, DisplayMode::Shaded);
        let rays = scene.cast(&sample);
        let lacking = scene.prepare(&sample);
        let count = scene.meshes.indices().len() / 3;
        assert!(lacking.is_empty() && (100..400_000).contains(&count), "{count} triangles");
        let triangles = scene.drawn(&sample);
        let view = View::new(&camera, SIZE, [0.0; 2], sample.depth, CAST_TRIM);
        let shown = rays.fragments.iter().filter(|f| f.words[0] != 0).count();
        assert!(shown > 8_000, "{shown}");
        let unlike = strays(&view, &rays, &triangles, 4.0);
        assert!(500 * unlike <= shown, "{unlike} of {shown} pixels differ from rays");
        let twin = mesh::draw(&scene.packed, &scene.meshes, &lacking, &view);
        let unlike = strays(&view, &twin, &triangles, 0.5);
        assert!(1000 * unlike <= shown, "{unlike} of {shown} pixels differ from the twin");
    }
}

/// Places at the rims of holes and the normals there.
fn rims(faces: &[Face]) -> Vec<(DVec3, DVec3)> {
    let scene = hairline::scene::demo::model();
    let rim = |(face, record): (&Face, &hairline::scene::records::FaceRecord)| {
        let curve = record.loops.get(1)?.curves.first()?;
        let uv = curve.point(curve.domain().0);
        let patch = face.patches.iter().find(|p| uv == uv.clamp(p.uv_min, p.uv_max))?;
        let at = patch.local(uv);
        let at = patch.tangents(at.x, at.y);
        Some((at.point, at.du.cross(at.dv).try_normalize()?))
    };
    faces.iter().zip(&scene.faces).filter_map(rim).collect()
}

#[test]
fn however_near_few_triangles_show_what_rays_show() {
    let mut scene = Scene::new(demo());
    let rims = rims(&scene.faces);
    assert!(rims.len() >= 4);
    let diagonal = scene.packed.bounds().diagonal();
    let mut in_pieces = 0;
    for (at, normal) in rims.iter().step_by(rims.len() / 2).take(2) {
        let along = normal.any_orthonormal_vector();
        for near in [0.1, 0.004] {
            let eye = *at + (*normal - 0.7 * along).normalize() * (near * diagonal);
            let camera =
                Camera { eye, target: *at, up: along, projection: Projection::Perspective { fov_y: 0.7 } };
            let sample = scene.sample(camera, SIZE, DisplayMode::Shaded);
            let lacking = scene.prepare(&sample);
            let count = scene.meshes.indices().len() / 3;
            assert!(lacking.is_empty() && count < 80_000, "{count} triangles at {near}");
            // What is in the window is as fine as its pixels ask for.
            let size = LevelView::new(&camera, SIZE).pixel_size(&Bounds { min: *at, max: *at });
            let finest = scene.meshes.selected().map(|(.., level)| level).min().expect("some");
            assert!(level_error(finest) <= 0.5 * size.expect("in the middle"));
            let is_piece =
                |(slot, rect, _): (FaceSlot, UvRect, i32)| rect != scene.faces[slot.0 as usize].domain;
            in_pieces += usize::from(scene.meshes.selected().any(is_piece));
            let (rays, triangles) = (scene.cast(&sample), scene.drawn(&sample));
            let view = View::new(&camera, SIZE, [0.0; 2], sample.depth, CAST_TRIM);
            let shown = rays.fragments.iter().filter(|f| f.words[0] != 0).count();
            let unlike = strays(&view, &rays, &triangles, 4.0);
            assert!(500 * unlike <= shown, "{unlike} of {shown} pixels differ from rays at {near}");
            let gaps = strays(&view, &rays, &triangles, f32::INFINITY);
            assert!(gaps <= 2, "{gaps} pixels show another face, or none, at {near}");
        }
    }
    assert!(in_pieces > 0);
}

#[test]
fn triangles_with_a_lone_curve_are_trimmed_as_by_the_grid() {
    let mut scene = Scene::new(demo());
    let bounds = scene.packed.bounds();
    for direction in [DVec3::NEG_Z, DVec3::new(-0.4, 0.9, -0.6).normalize()] {
        let up = if direction.z == -1.0 { DVec3::Y } else { DVec3::Z };
        let camera = Camera::fit(&bounds, direction, up, Projection::Perspective { fov_y: 0.5 }, 4.0 / 3.0);
        let [kept, cut] = scene.alike_by_the_grid(camera, [480, 360]);
        let [whole, lone, all] = scene.meshes.ends();
        assert!(whole < lone && lone - whole > (all - lone) / 4, "{whole} {lone} {all}");
        assert!(kept > 15_000 && cut > 1_000, "{kept} {cut}");
    }
}

#[test]
fn real_models_are_trimmed_as_by_the_grid() {
    let Some(folder) = models() else { return };
    for name in ["gpucast_part.igs", "occt_hammer.iges", "freecad_SOT23.igs"] {
        let (model, _) = iges::read(&folder.join("files").join(name)).expect("a file that is there");
        let faces: Vec<Face> = model.faces.iter().filter_map(|r| r.derive().ok()).collect();
        let packed = PackedScene::from_faces(faces.iter().map(|f| FaceShape::of(f, None, false)));
        let mut scene = Scene::new((faces, packed));
        let bounds = scene.packed.bounds();
        let direction = DVec3::new(-0.4, 0.9, -0.6).normalize();
        let mut camera =
            Camera::fit(&bounds, direction, DVec3::Z, Projection::Perspective { fov_y: 0.5 }, 4.0 / 3.0);
        let [mut kept, mut cut] = scene.alike_by_the_grid(camera, [360, 270]);
        camera.eye = camera.target.lerp(camera.eye, 0.3);
        for (sum, more) in [&mut kept, &mut cut].into_iter().zip(scene.alike_by_the_grid(camera, [360, 270]))
        {
            *sum += more;
        }
        assert!(kept > 5_000 && cut > 100, "{name}: {kept} {cut}");
    }
}
