//! The second renderer against rays and against its twin.

use glam::DVec3;
use hairline::encoding::view::CAST_TRIM;
use hairline::encoding::{DepthRange, DisplayMode, FaceSlot, LevelView, MeshScene, View};
use hairline::gpu::{Context, Renderer, Sample, picture};
use hairline::kernel::view::{Camera, Projection};
use hairline::reference::holes::z_of;
use hairline::reference::mesh;
use hairline::reference::visibility::VisibilityBuffer;

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

#[test]
fn triangles_show_what_rays_show_and_the_twin_draws_the_same() {
    let context = Context::headless().expect("a Vulkan driver, real or software (mesa-vulkan-drivers)");
    let (faces, mut packed) = demo();
    let mut renderer = Renderer::new(&context.device, wgpu::TextureFormat::Rgba8Unorm);
    renderer.upload(&context.device, &context.queue, &mut packed).expect("room for the demo");
    let bounds = packed.bounds();
    let mut meshes = MeshScene::default();
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
        let depth = DepthRange::around(&camera, bounds.centre(), 0.5 * bounds.diagonal());
        let sample = Sample { camera, depth, size: SIZE, jitter: [0.0; 2], mode: DisplayMode::Shaded };
        let rays = picture::visibility(&context, &mut renderer, &sample).expect("rays");
        let face = |slot: FaceSlot| faces.get(slot.0 as usize);
        let lacking = meshes.prepare(&packed, face, &LevelView::new(&camera, SIZE), 0.5);
        let count = meshes.indices().len() / 3;
        assert!(lacking.len() < faces.len() / 4 && (100..400_000).contains(&count), "{count} triangles");
        renderer
            .upload_meshes(&context.device, &context.queue, &mut meshes, &packed, &lacking)
            .expect("room for triangles");
        let mut encoder = context.device.create_command_encoder(&Default::default());
        renderer.draw_meshes(&context.device, &context.queue, &mut encoder, &sample);
        context.queue.submit([encoder.finish()]);
        let triangles = picture::read_visibility(&context, &renderer).expect("triangles");
        let view = View::new(&camera, SIZE, [0.0; 2], depth, CAST_TRIM);
        let shown = rays.fragments.iter().filter(|f| f.words[0] != 0).count();
        assert!(shown > 8_000, "{shown}");
        let unlike = strays(&view, &rays, &triangles, 4.0);
        assert!(500 * unlike <= shown, "{unlike} of {shown} pixels differ from rays");
        let twin = mesh::draw(&packed, &meshes, &lacking, &view);
        let unlike = strays(&view, &twin, &triangles, 0.5);
        assert!(1000 * unlike <= shown, "{unlike} of {shown} pixels differ from the twin");
    }
}

/// The picture of triangles in a mode.
fn drawn(context: &Context, renderer: &mut Renderer, sample: &Sample) -> VisibilityBuffer {
    let mut encoder = context.device.create_command_encoder(&Default::default());
    renderer.draw_meshes(&context.device, &context.queue, &mut encoder, sample);
    context.queue.submit([encoder.finish()]);
    picture::read_visibility(context, renderer).expect("triangles")
}

#[test]
fn triangles_with_a_lone_curve_are_trimmed_as_by_the_grid() {
    let context = Context::headless().expect("a Vulkan driver, real or software (mesa-vulkan-drivers)");
    let (faces, mut packed) = demo();
    let mut renderer = Renderer::new(&context.device, wgpu::TextureFormat::Rgba8Unorm);
    renderer.upload(&context.device, &context.queue, &mut packed).expect("room for the demo");
    let bounds = packed.bounds();
    let mut meshes = MeshScene::default();
    let size = [480, 360];
    for direction in [DVec3::NEG_Z, DVec3::new(-0.4, 0.9, -0.6).normalize()] {
        let up = if direction.z == -1.0 { DVec3::Y } else { DVec3::Z };
        let camera = Camera::fit(&bounds, direction, up, Projection::Perspective { fov_y: 0.5 }, 4.0 / 3.0);
        let face = |slot: FaceSlot| faces.get(slot.0 as usize);
        let lacking = meshes.prepare(&packed, face, &LevelView::new(&camera, size), 0.5);
        let [whole, lone, all] = meshes.ends();
        assert!(whole < lone && lone - whole > (all - lone) / 4, "{whole} {lone} {all}");
        renderer
            .upload_meshes(&context.device, &context.queue, &mut meshes, &packed, &lacking)
            .expect("room for triangles");
        let depth = DepthRange::around(&camera, bounds.centre(), 0.5 * bounds.diagonal());
        let mut sample = Sample { camera, depth, size, jitter: [0.0; 2], mode: DisplayMode::Shaded };
        let shaded = drawn(&context, &mut renderer, &sample);
        // The heat of trimming asks the grid everywhere, and shows what it cuts off too.
        sample.mode = DisplayMode::Heat;
        let asked = drawn(&context, &mut renderer, &sample);
        let (mut kept, mut cut) = (0, 0);
        for (a, b) in shaded.fragments.iter().zip(&asked.fragments) {
            if b.words[0] == 0 {
                assert_eq!(a.words[0], 0);
            } else if b.words[3] & 128 != 0 {
                assert_eq!((a.words[..3].to_vec(), a.depth), (b.words[..3].to_vec(), b.depth));
                kept += 1;
            } else {
                assert!(a.words[..3] != b.words[..3]);
                cut += 1;
            }
        }
        assert!(kept > 15_000 && cut > 1_000, "{kept} {cut}");
    }
}
