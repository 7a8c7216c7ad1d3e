//! Faces that meet exactly show no slits between them: rounding may not open any.

use glam::{DVec2, DVec3};
use hairline::encoding::view::CAST_TRIM;
use hairline::encoding::{DepthRange, DisplayMode, FaceShape, PackedScene, View};
use hairline::gpu::{Context, Renderer, Sample, picture};
use hairline::kernel::face::Face;
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
use hairline::kernel::trim::{LoopRecord, LoopRole};
use hairline::kernel::view::{Camera, Projection};
use hairline::reference::visibility::VisibilityBuffer;
use hairline::reference::{holes, visibility};

fn sheet() -> NurbsSurface {
    let knots = || KnotVector::new(3, vec![0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0]).expect("knots");
    let points = (0..25).map(|k| {
        let (x, y) = ((k / 5) as f64 * 25.0, (k % 5) as f64 * 25.0);
        DVec3::new(x + 3.0, y - 7.0, 12.0 * (0.05 * x).sin() * (0.04 * y).cos())
    });
    let weights = (0..25).map(|k| 1.0 + 0.3 * ((k * 7 % 5) as f64 / 5.0)).collect();
    NurbsSurface::new(knots(), knots(), points.collect(), weights).expect("surface")
}

/// Two faces of one surface on both sides of a wavy curve.
fn halves() -> Vec<(NurbsSurface, Vec<LoopRecord>)> {
    let p = DVec2::new;
    let wave = NurbsCurve2::new(
        KnotVector::new(3, vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0]).expect("knots"),
        vec![p(0.52, 0.0), p(0.41, 0.3), p(0.7, 0.45), p(0.3, 0.8), p(0.47, 1.0)],
        vec![1.0; 5],
    )
    .expect("curve");
    let line = |a: DVec2, b: DVec2| NurbsCurve2::line(a, b);
    let left = vec![
        line(p(0.0, 0.0), p(0.52, 0.0)),
        wave.clone(),
        line(p(0.47, 1.0), p(0.0, 1.0)),
        line(p(0.0, 1.0), p(0.0, 0.0)),
    ];
    let right = vec![
        line(p(0.52, 0.0), p(1.0, 0.0)),
        line(p(1.0, 0.0), p(1.0, 1.0)),
        line(p(1.0, 1.0), p(0.47, 1.0)),
        wave.reversed(),
    ];
    [left, right].into_iter().map(|c| (sheet(), vec![LoopRecord::new(LoopRole::Outer, c)])).collect()
}

/// A view of a point of the shared curve, slanted, at a zoom between 1 and 10,000.
fn close_up(k: u32, zoom: f64) -> Camera {
    let (surface, wave) = (sheet(), halves()[0].1[0].curves[1].clone());
    let uv = wave.point(0.1 + 0.1 * f64::from(k));
    let at = surface.jet(uv.x, uv.y);
    let normal = at.du.cross(at.dv).normalize();
    let slant = 0.5 * at.du.normalize() + 0.06 * f64::from(k) * at.dv.normalize();
    let direction = -(normal + slant).normalize();
    let projection = Projection::Perspective { fov_y: 0.3 };
    Camera { eye: at.point - direction * (400.0 / zoom), target: at.point, up: DVec3::Z, projection }
}

#[test]
fn faces_that_meet_exactly_show_no_pin_holes_at_any_zoom() {
    let faces: Vec<Face> = halves().iter().map(|(s, l)| Face::derive(s, l).expect("face")).collect();
    let mut scene = PackedScene::from_faces(faces.iter().map(|f| FaceShape::of(f, None, false)));
    let context = Context::headless().expect("a Vulkan driver, real or software (mesa-vulkan-drivers)");
    let mut renderer = Renderer::new(&context.device, wgpu::TextureFormat::Rgba8Unorm);
    renderer.upload(&context.device, &context.queue, &mut scene).expect("a small scene");
    let bounds = scene.bounds();
    let mut along = 0;
    for (k, zoom) in (0..8).flat_map(|k| [10.0, 1e3, 1e4].map(|zoom| (k, zoom))) {
        let camera = close_up(k, zoom);
        let depth = DepthRange::around(&camera, bounds.centre(), 0.5 * bounds.diagonal());
        let (size, mode) = ([256, 256], DisplayMode::Shaded);
        let sample = Sample { camera, depth, size, jitter: [0.0; 2], mode };
        let on_gpu = picture::visibility(&context, &mut renderer, &sample).expect("rays");
        let view = View::new(&camera, size, [0.0; 2], depth, CAST_TRIM);
        let mut check = |name: &str, buffer: &VisibilityBuffer| {
            let found = holes::candidates(buffer, &view, &|a, b| a != b);
            assert!(found.is_empty(), "{name}, view {k}, zoom {zoom}: {} pin holes", found.len());
            let face = |x: i32, y: i32| buffer.at(x, y).words[0];
            let row = |y: i32| {
                (1..256)
                    .filter(|x| face(x - 1, y).min(face(*x, y)) > 0 && face(x - 1, y) != face(*x, y))
                    .count()
            };
            along += (0..256).map(row).sum::<usize>();
        };
        check("driver", &on_gpu);
        if k == 0 {
            check("twin", &visibility::draw(&scene, &view));
        }
    }
    assert!(along > 4000, "the views show the shared curve: {along} pixels of it");
}
