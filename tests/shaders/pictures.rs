//! The GPU's pictures against the CPU twin's.

use glam::DVec3;
use hairline::encoding::{DisplayMode, FaceShape, Image, PackedScene, RenderOptions};
use hairline::gpu::{Context, render_image};
use hairline::kernel::face::Face;
use hairline::kernel::view::{Camera, Projection};
use hairline::{reference, scene};

pub fn demo() -> (Vec<Face>, PackedScene) {
    let model = scene::demo::model();
    let faces: Vec<Face> = model.faces.iter().map(|r| r.derive().expect("demo face")).collect();
    let shapes = faces.iter().zip(&model.faces).map(|(f, r)| FaceShape::of(f, r.colour, r.reversed));
    let packed = PackedScene::from_faces(shapes);
    (faces, packed)
}

fn pixel(image: &Image, x: i32, y: i32) -> [u8; 4] {
    let at = |v: i32, n: u32| v.clamp(0, n as i32 - 1) as usize;
    let k = 4 * (at(y, image.height) * image.width as usize + at(x, image.width));
    [image.rgba[k], image.rgba[k + 1], image.rgba[k + 2], image.rgba[k + 3]]
}

fn far(a: [u8; 4], b: [u8; 4], limit: u8) -> bool {
    a.iter().zip(b).any(|(x, y)| x.abs_diff(y) > limit)
}

/// Pixels that differ though nothing changes around them: not beside a silhouette or a trim.
fn stray(a: &Image, b: &Image) -> usize {
    let calm = |x: i32, y: i32| {
        (-1..=1).all(|dy| (-1..=1).all(|dx| !far(pixel(a, x, y), pixel(a, x + dx, y + dy), 24)))
    };
    let (width, height) = (a.width as i32, a.height as i32);
    (0..width * height)
        .map(|k| (k % width, k / width))
        .filter(|(x, y)| far(pixel(a, *x, *y), pixel(b, *x, *y), 4) && calm(*x, *y))
        .count()
}

#[test]
fn the_twin_draws_the_same_picture() {
    let context = Context::headless().expect("a Vulkan driver, real or software (mesa-vulkan-drivers)");
    let (_, mut packed) = demo();
    let bounds = packed.bounds();
    let modes =
        [DisplayMode::Shaded, DisplayMode::Faces, DisplayMode::Uv, DisplayMode::Heat, DisplayMode::Untrimmed];
    for (k, mode) in modes.into_iter().enumerate() {
        let direction = DVec3::new(-1.0 + 0.4 * k as f64, 0.9, -0.7).normalize();
        let projection = if k % 2 == 0 {
            Projection::Perspective { fov_y: 0.7 }
        } else {
            Projection::Orthographic { height: 1.0 }
        };
        let camera = Camera::fit(&bounds, direction, DVec3::Z, projection, 1.25);
        let mut options = RenderOptions::new(camera, [200, 160]);
        options.mode = mode;
        options.samples = 1;
        options.edges.visible = k < 2;
        let gpu = render_image(&context, &mut packed, &options).expect("picture");
        let cpu = reference::render_image(&packed, &options);
        let differ = stray(&gpu, &cpu);
        assert!(differ <= 3, "{mode:?}: {differ} of {} pixels differ", gpu.width * gpu.height);
        let filled = gpu.rgba.chunks_exact(4).filter(|p| p[..3] != gpu.rgba[..3]).count();
        assert!(filled > 1000, "{mode:?}: picture is empty");
    }
}

#[test]
fn hidden_faces_are_not_drawn() {
    let context = Context::headless().expect("a Vulkan driver, real or software (mesa-vulkan-drivers)");
    let (_, mut packed) = demo();
    let camera = Camera::fit(
        &packed.bounds(),
        DVec3::new(-1.0, 1.0, -1.0).normalize(),
        DVec3::Z,
        Projection::Perspective { fov_y: 0.7 },
        1.0,
    );
    let mut options = RenderOptions::new(camera, [64, 64]);
    options.samples = 1;
    options.theme = hairline::encoding::Theme::Transparent;
    for slot in packed.slots().collect::<Vec<_>>() {
        packed.set_flag(slot, hairline::encoding::FaceHeader::VISIBLE, false);
    }
    let image = render_image(&context, &mut packed, &options).expect("picture");
    assert!(image.rgba.iter().all(|b| *b == 0));
}
