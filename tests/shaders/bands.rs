//! A cast in bands against one in a single go, on the GPU.

use glam::{DVec2, DVec3};
use hairline::encoding::{DepthRange, DisplayMode, FaceShape, PackedScene};
use hairline::gpu::picture::read_texture;
use hairline::gpu::renderer::bounding_sphere;
use hairline::gpu::{Context, Renderer, Sample};
use hairline::kernel::face::Face;
use hairline::kernel::view::{Camera, Projection};

const SIZE: [u32; 2] = [64, 48];

#[test]
fn bands_make_the_same_rays_and_leave_the_last_picture_until_they_are_complete() {
    let model = hairline::scene::demo::model();
    let faces: Vec<Face> = model.faces.iter().map(|r| r.derive().expect("demo face")).collect();
    let shape = |k: usize| FaceShape::of(&faces[k], model.faces[k].colour, model.faces[k].reversed);
    let mut scene = PackedScene::from_faces((0..faces.len()).map(shape));
    let (centre, radius) = bounding_sphere(&scene);
    let sample = |direction: DVec3, size, jitter: DVec2| {
        let projection = Projection::Perspective { fov_y: 0.7 };
        let camera = Camera::fit(&scene.bounds(), direction.normalize(), DVec3::Z, projection, 1.3);
        Sample {
            camera,
            depth: DepthRange::around(&camera, centre, radius),
            size,
            jitter: jitter.as_vec2().to_array(),
            mode: DisplayMode::Shaded,
        }
    };
    let coarse = sample(DVec3::new(1.0, 1.0, -1.0), [16, 12], DVec2::ZERO);
    let fine = [0.0, 0.25].map(|j| sample(DVec3::new(-1.0, 1.0, -1.0), SIZE, DVec2::splat(j)));

    let context = Context::headless().expect("a Vulkan driver, real or software (mesa-vulkan-drivers)");
    let Context { device, queue, .. } = &context;
    let mut renderer = Renderer::new(device, wgpu::TextureFormat::Rgba8Unorm);
    renderer.upload(device, queue, &mut scene).expect("a small scene");
    let mut cast = |sample: &Sample, rows: std::ops::Range<u32>| {
        let mut encoder = device.create_command_encoder(&Default::default());
        renderer.cast_rows(device, queue, &mut encoder, sample, rows);
        queue.submit([encoder.finish()]);
        read_texture(&context, &renderer.targets().visibility).expect("rays")
    };
    let wanted = fine.map(|sample| cast(&sample, 0..SIZE[1]));
    assert!(wanted[0] != wanted[1] && wanted[0].iter().any(|byte| *byte != 0));
    let before = cast(&coarse, 0..12);
    for (sample, wanted) in fine.iter().zip(&wanted) {
        let shown = cast(&coarse, 0..12);
        assert!(shown == before);
        // One that is dropped for another.
        assert!(cast(&fine[0], 0..20) == shown);
        assert!(cast(sample, 0..7) == shown);
        assert!(cast(sample, 7..40) == shown);
        assert!(cast(sample, 40..SIZE[1]) == *wanted);
    }
}
