//! Triangles of a tessellation in the place of the exact surfaces: where they are, what they carry, and that the rest of the
//! picture stays exact.

use glam::DVec3;
use hairline::encoding::tessellation::{LEVEL_OF_TOLERANCE, UNMEASURED};
use hairline::encoding::{
    DepthRange, DisplayMode, EdgeStyle, FaceShape, FaceSlot, PackedMesh, PackedScene, TessellationPart,
    TessellationScene, View,
};
use hairline::gpu::{Context, Renderer, Sample, picture};
use hairline::kernel::face::Face;
use hairline::kernel::tessellate::TessellationOptions;
use hairline::kernel::view::{Camera, Projection};
use hairline::meshing::{ModelMesh, Work, face_deviations, mesh_faces};
use hairline::reference::holes::z_of;
use hairline::reference::pack::{unpack_heat_normal, unpack_normal};
use hairline::reference::shade::deviation_colour;
use hairline::reference::visibility::VisibilityBuffer;

const SIZE: [u32; 2] = [240, 180];

struct Scene {
    context: Context,
    renderer: Renderer,
    faces: Vec<Face>,
    mesh: ModelMesh,
    tolerance: f64,
    sample: Sample,
}

/// Some faces of the demo.
fn few() -> (Vec<Face>, PackedScene) {
    let model = hairline::scene::demo::model();
    let kept = ["Foot", "Core", "Rim of the medal", "Ring"];
    let records: Vec<_> =
        model.faces.iter().filter(|r| kept.iter().any(|name| r.name.as_deref() == Some(name))).collect();
    assert_eq!(records.len(), kept.len());
    let faces: Vec<Face> = records.iter().map(|r| r.derive().expect("demo face")).collect();
    let shapes = faces.iter().zip(&records).map(|(f, r)| FaceShape::of(f, r.colour, r.reversed));
    let packed = PackedScene::from_faces(shapes);
    (faces, packed)
}

/// The same with a tessellation, whose error is measured if `measured` says so.
fn scene(projection: Projection, measured: bool) -> Scene {
    let context = Context::headless().expect("a Vulkan driver, real or software (mesa-vulkan-drivers)");
    let (faces, mut packed) = few();
    let bounds = packed.bounds();
    let tolerance = 2e-3 * bounds.diagonal();
    let options = TessellationOptions { conservative: false, ..TessellationOptions::new(tolerance) };
    let borrowed: Vec<Option<&Face>> = faces.iter().map(Some).collect();
    let mesh = mesh_faces(&borrowed, &options, &Work::QUIET).expect("a mesh");
    let pack = |(face, mesh): (&Face, &Result<_, _>)| {
        let mesh = mesh.as_ref().expect("a mesh");
        let packed = PackedMesh::new(face, mesh);
        if !measured {
            return packed;
        }
        packed.measured(&face_deviations(face, mesh, tolerance, &|| false).expect("figures"), tolerance)
    };
    let meshes: Vec<PackedMesh> = faces.iter().zip(&mesh.faces).map(pack).collect();
    let mut triangles =
        TessellationScene::of(meshes.iter().enumerate().map(|(k, m)| (FaceSlot(k as u32), m)));
    assert_eq!(triangles.triangle_count(), mesh.triangle_count());
    let mut renderer = Renderer::new(&context.device, wgpu::TextureFormat::Rgba8Unorm);
    renderer.upload(&context.device, &context.queue, &mut packed).expect("room for the demo");
    renderer
        .upload_tessellation(&context.device, &context.queue, &mut triangles)
        .expect("room for triangles");
    let direction = DVec3::new(-0.6, 0.9, -0.7).normalize();
    let camera = Camera::fit(&bounds, direction, DVec3::Z, projection, 4.0 / 3.0);
    let depth = DepthRange::around(&camera, bounds.centre(), 0.5 * bounds.diagonal());
    let sample = Sample { camera, depth, size: SIZE, jitter: [0.0; 2], mode: DisplayMode::Shaded };
    Scene { context, renderer, faces, mesh, tolerance, sample }
}

impl Scene {
    fn picture(&mut self, from: Option<f32>, facets: bool) -> VisibilityBuffer {
        self.renderer.show_tessellation(from, facets);
        picture::visibility(&self.context, &mut self.renderer, &self.sample).expect("a picture")
    }

    fn view(&self) -> View {
        View::new(&self.sample.camera, SIZE, [0.0; 2], self.sample.depth, 0)
    }
}

fn pixels() -> impl Iterator<Item = (i32, i32)> {
    (0..SIZE[1] as i32).flat_map(|y| (0..SIZE[0] as i32).map(move |x| (x, y)))
}

#[test]
fn triangles_lie_within_their_error_of_the_exact_picture() {
    for projection in [Projection::Perspective { fov_y: 0.7 }, Projection::Orthographic { height: 1.0 }] {
        let mut scene = scene(projection, false);
        let exact = scene.picture(None, false);
        let triangles = scene.picture(Some(0.0), false);
        let view = scene.view();
        let width = |z: f32| view.pixel[0] + view.pixel[1] * z.abs();
        // Where the exact picture is one smooth face all around.
        let calm = |x: i32, y: i32| {
            let here = exact.at(x, y);
            let z = z_of(&view, &here);
            here.words[0] != 0
                && (-3..=3).all(|dy| {
                    (-3..=3).all(|dx| {
                        let there = exact.at(x + dx, y + dy);
                        there.words[0] == here.words[0] && (z_of(&view, &there) - z).abs() < 12.0 * width(z)
                    })
                })
        };
        let (mut seen, mut strays, mut turned) = (0, 0, 0);
        for (x, y) in pixels().filter(|(x, y)| calm(*x, *y)) {
            let (a, b) = (exact.at(x, y), triangles.at(x, y));
            seen += 1;
            let (z, other) = (z_of(&view, &a), z_of(&view, &b));
            // Seen at a slant the same distance is deeper.
            let reach = 8.0 * scene.tolerance as f32 + 4.0 * width(z);
            strays += usize::from(a.words[0] != b.words[0] || (z - other).abs() > reach);
            turned += usize::from(unpack_normal(a.words[3]).dot(unpack_normal(b.words[3])) < 0.9);
        }
        assert!(seen > 700, "{seen}");
        assert!(100 * strays <= seen, "{strays} of {seen} pixels are off");
        assert!(100 * turned <= seen, "{turned} of {seen} normals are off");
        let facets = scene.picture(Some(0.0), true);
        let same =
            pixels().filter(|(x, y)| facets.at(*x, *y).words[..3] == triangles.at(*x, *y).words[..3]).count();
        assert_eq!(same, pixels().count(), "flat triangles are in the same place");
        let other =
            pixels().filter(|(x, y)| facets.at(*x, *y).words[3] != triangles.at(*x, *y).words[3]).count();
        assert!(other > seen / 10, "{other}");
    }
}

#[test]
fn both_pictures_of_a_wipe_are_kept_while_its_divider_moves() {
    let mut scene = scene(Projection::Perspective { fov_y: 0.7 }, false);
    let (exact, triangles) = (scene.picture(None, false), scene.picture(Some(0.0), false));
    let look = (DisplayMode::Shaded, EdgeStyle::default());
    let Scene { context, renderer, sample, .. } = &mut scene;
    let (device, queue) = (&context.device, &context.queue);
    renderer.show_tessellation(Some(0.5), false);
    renderer.show_both(true);
    assert!(!renderer.has_both());
    let mut encoder = device.create_command_encoder(&Default::default());
    renderer.cast(device, queue, &mut encoder, sample);
    renderer.keep_both(device, queue, &mut encoder, look, true);
    queue.submit([encoder.finish()]);
    assert!(renderer.has_both());
    assert_eq!(renderer.samples(), 1);
    for share in [0.5, 0.25, 0.9, 0.0, 1.0] {
        renderer.show_tessellation(Some(share), false);
        let mut encoder = device.create_command_encoder(&Default::default());
        renderer.wipe(device, &mut encoder);
        queue.submit([encoder.finish()]);
        let wiped = picture::read_visibility(context, renderer).expect("a picture");
        let divider = (share * SIZE[0] as f32).round() as i32;
        for (x, y) in pixels() {
            let expected = if x < divider { &exact } else { &triangles };
            assert_eq!(wiped.at(x, y), expected.at(x, y), "{x} {y}, divider at {divider}");
        }
    }
    renderer.forget_both();
    assert!(!renderer.has_both());
}

#[test]
fn a_wipe_is_exact_to_the_left_and_triangles_to_the_right() {
    let mut scene = scene(Projection::Perspective { fov_y: 0.7 }, false);
    let exact = scene.picture(None, false);
    let triangles = scene.picture(Some(0.0), false);
    for share in [0.4f32, 0.0, 1.0] {
        let wiped = scene.picture(Some(share), false);
        let divider = (share * SIZE[0] as f32).round() as i32;
        for (x, y) in pixels() {
            let expected = if x < divider { &exact } else { &triangles };
            assert_eq!(wiped.at(x, y), expected.at(x, y), "{x} {y}, divider at {divider}");
        }
    }
}

#[test]
fn pixels_carry_the_level_of_their_triangle() {
    let mut scene = scene(Projection::Perspective { fov_y: 0.7 }, true);
    let smooth = scene.picture(Some(0.0), false);
    scene.sample.mode = DisplayMode::Deviation;
    let levels = scene.picture(Some(0.0), false);
    let mut seen = std::collections::BTreeSet::new();
    for (x, y) in pixels().filter(|(x, y)| smooth.at(*x, *y).words[0] != 0) {
        let (a, b) = (smooth.at(x, y), levels.at(x, y));
        assert_eq!(a.words[..3], b.words[..3]);
        let level = b.words[3] & 255;
        assert_ne!(level, UNMEASURED);
        seen.insert(level);
        assert!((unpack_normal(a.words[3]) - unpack_heat_normal(b.words[3])).length() < 0.03);
    }
    assert!(seen.len() > 20, "{seen:?}");
    let worst = scene
        .faces
        .iter()
        .zip(&scene.mesh.faces)
        .flat_map(|(f, m)| {
            face_deviations(f, m.as_ref().expect("a mesh"), scene.tolerance, &|| false).expect("figures")
        })
        .fold(0.0, f64::max);
    let most = (f64::from(LEVEL_OF_TOLERANCE) * worst / scene.tolerance).ceil() as u32 + 1;
    assert!(seen.iter().all(|level| *level <= most), "{seen:?} {most}");
}

#[test]
fn colours_of_levels_are_told_apart() {
    let colours: Vec<_> = (0..=LEVEL_OF_TOLERANCE).step_by(50).map(deviation_colour).collect();
    for (k, a) in colours.iter().enumerate() {
        for b in &colours[k + 1..] {
            assert!((*a - *b).length() > 0.25, "{a} {b}");
        }
    }
    assert!((deviation_colour(LEVEL_OF_TOLERANCE) - deviation_colour(LEVEL_OF_TOLERANCE + 1)).length() > 0.3);
    assert_eq!(size_of::<TessellationPart>(), 32);
}
