//! Rays of the twin against the f64 oracle: hits missed at random close-ups.

use glam::{DVec2, DVec3};
use hairline::commands::bench::misses::{Closeups, compare};
use hairline::kernel::view::Projection;

use crate::pictures::demo;

#[test]
fn close_ups_of_the_demo_miss_nothing() {
    let (faces, packed) = demo();
    let mut closeups = Closeups::new(&faces, packed.bounds(), 7);
    let mut total = hairline::commands::bench::misses::Tally::default();
    for _ in 0..6 {
        let camera = closeups.camera();
        total.add(&compare(&packed, &closeups.caster, &faces, &camera, 64));
    }
    assert!(total.hits > 2000, "{total:?}");
    assert!(total.missed <= 1, "{total:?}");
}

#[test]
fn close_ups_on_the_gpu_miss_nothing_and_equal_the_twins() {
    use hairline::commands::bench::misses::{depth_of, judge, strays};
    use hairline::encoding::{DisplayMode, View, view::CAST_TRIM};
    use hairline::gpu::{Context, Renderer, Sample, picture::visibility};
    let context = Context::headless().expect("a Vulkan driver, real or software (mesa-vulkan-drivers)");
    let (faces, mut packed) = demo();
    let mut renderer = Renderer::new(&context.device, wgpu::TextureFormat::Rgba8Unorm);
    renderer.upload(&context.device, &context.queue, &mut packed).expect("room for the demo");
    let mut closeups = Closeups::new(&faces, packed.bounds(), 11);
    let mut total = hairline::commands::bench::misses::Tally::default();
    let mut unlike = 0;
    for _ in 0..4 {
        let camera = closeups.camera();
        let depth = depth_of(&packed, &camera);
        let (size, mode) = ([96, 96], DisplayMode::Shaded);
        let sample = Sample { camera, depth, size, jitter: [0.0; 2], mode };
        let picture = visibility(&context, &mut renderer, &sample).expect("visibility buffer");
        let view = View::new(&camera, size, [0.0; 2], depth, CAST_TRIM);
        let twin = hairline::reference::visibility::draw(&packed, &view);
        unlike += strays(&packed, &camera, &twin, &picture);
        total.add(&judge(&packed, &closeups.caster, &faces, &camera, &picture));
    }
    assert!(total.hits > 5000, "{total:?}");
    assert!(total.missed <= 1, "{total:?}");
    assert!(unlike <= 3, "{unlike} of {} pixels differ", total.rays);
}

#[test]
fn a_far_away_model_looks_the_same() {
    // The same patch at the origin and a million units away, at the same zoom: same hits.
    use hairline::encoding::{DepthRange, FaceShape, PackedScene, View, view::CAST_TRIM};
    use hairline::kernel::{bezier::BezierPatch, face::UvRect, view::Camera};
    let patch = |shift: DVec3| BezierPatch {
        degree_u: 2,
        degree_v: 2,
        points: (0..9)
            .map(|k| shift + DVec3::new((k / 3) as f64, (k % 3) as f64, if k == 4 { 1.0 } else { 0.0 }))
            .collect(),
        weights: vec![1.0, 2.0, 1.0, 0.5, 3.0, 1.0, 1.0, 1.0, 0.25],
        uv_min: DVec2::ZERO,
        uv_max: DVec2::ONE,
    };
    let domain = UvRect { min: DVec2::ZERO, max: DVec2::ONE };
    let draw = |shift: DVec3| {
        let patches = [patch(shift)];
        let shape = FaceShape { patches: &patches, domain, grid: None, colour: [0.5; 3], reversed: false };
        let packed = PackedScene::from_faces([shape]);
        let target = shift + DVec3::new(1.0, 1.0, 0.5);
        let camera = Camera {
            eye: target + DVec3::new(0.002, -0.003, 0.004),
            target,
            up: DVec3::Z,
            projection: Projection::Perspective { fov_y: 0.7 },
        };
        let view = View::new(&camera, [48, 48], [0.0; 2], DepthRange { near: 1e-6, far: 1.0 }, CAST_TRIM);
        hairline::reference::visibility::draw(&packed, &view)
    };
    let (near, far) = (draw(DVec3::ZERO), draw(DVec3::new(1e6, -2e6, 5e5)));
    let mut hits = 0;
    for (a, b) in near.fragments.iter().zip(&far.fragments) {
        assert_eq!(a.words[0], b.words[0]);
        hits += a.words[0];
        let uv = |w: u32| f32::from_bits(w);
        assert!((uv(a.words[1]) - uv(b.words[1])).abs() < 1e-6);
        assert!((uv(a.words[2]) - uv(b.words[2])).abs() < 1e-6);
    }
    assert!(hits > 500, "{hits}");
}
