//! Edited scenes against scenes packed anew, on the GPU.

use glam::DVec3;
use hairline::encoding::{FaceShape, PackedScene, RenderOptions};
use hairline::gpu::{Context, render_image};
use hairline::kernel::face::Face;
use hairline::kernel::view::{Camera, Projection};

#[test]
fn a_scene_edited_at_random_equals_one_packed_anew() {
    let model = hairline::scene::demo::model();
    let faces: Vec<Face> = model.faces.iter().map(|r| r.derive().expect("demo face")).collect();
    let shape = |k: usize| FaceShape::of(&faces[k], model.faces[k].colour, model.faces[k].reversed);
    let fresh = PackedScene::from_faces((0..faces.len()).map(shape));
    let mut edited = fresh.clone();
    let slots: Vec<_> = edited.slots().collect();
    let mut random = 12_345u32;
    for _ in 0..150 {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let k = (random >> 8) as usize % slots.len();
        // Any other face's shape, then in the end its own.
        edited.replace(slots[k], &shape((random >> 20) as usize % faces.len()));
    }
    for (k, slot) in slots.iter().enumerate() {
        edited.replace(*slot, &shape(k));
    }
    assert_eq!(edited.counts(), fresh.counts());
    assert_eq!(edited.bytes(), fresh.bytes());
    let camera = Camera::fit(
        &fresh.bounds(),
        DVec3::new(-1.0, 1.0, -1.0).normalize(),
        DVec3::Z,
        Projection::Perspective { fov_y: 0.7 },
        1.0,
    );
    let mut options = RenderOptions::new(camera, [96, 96]);
    options.samples = 1;
    let context = Context::headless().expect("a Vulkan driver, real or software (mesa-vulkan-drivers)");
    let (mut a, mut b) = (fresh, edited);
    let first = render_image(&context, &mut a, &options).expect("picture");
    let second = render_image(&context, &mut b, &options).expect("picture");
    assert!(first == second, "pictures differ");
}
