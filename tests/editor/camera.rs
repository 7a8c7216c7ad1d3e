//! Camera mathematics: what the hand holds stays under the pointer.

use glam::{DVec2, DVec3};
use hairline::editor::camera::clip::ClipView;
use hairline::editor::camera::flight::{FLIGHT_TIME, Flight};
use hairline::editor::camera::motion::{self, FIELD_OF_VIEW};
use hairline::kernel::view::{Bounds, Camera, Projection, StandardView};
use proptest::prelude::*;

const ASPECT: f64 = 1.6;

fn cameras() -> impl Strategy<Value = Camera> {
    let bounds = Bounds { min: DVec3::new(-3.0, 2.0, 10.0), max: DVec3::new(9.0, 5.0, 13.0) };
    (0.0..std::f64::consts::TAU, -1.5..1.5, any::<bool>()).prop_map(move |(yaw, pitch, parallel)| {
        let projection = match parallel {
            true => Projection::Orthographic { height: 1.0 },
            false => Projection::Perspective { fov_y: FIELD_OF_VIEW },
        };
        let (direction, up) = StandardView::Front.directions();
        let camera = Camera::fit(&bounds, direction, up, projection, ASPECT);
        motion::orbit(&camera, camera.target, yaw, pitch)
    })
}

fn points() -> impl Strategy<Value = DVec3> {
    (-3.0..9.0, 2.0..5.0, 10.0..13.0).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

proptest! {
    #[test]
    fn orbit_keeps_the_pivot_on_its_pixel(
        camera in cameras(), pivot in points(), yaw in -3.0..3.0, pitch in -3.0..3.0,
    ) {
        let (before, depth) = motion::project(&camera, pivot, ASPECT).expect("in front");
        let turned = motion::orbit(&camera, pivot, yaw, pitch);
        let (after, new_depth) = motion::project(&turned, pivot, ASPECT).expect("still in front");
        prop_assert!((before - after).length() < 1e-9, "{before} {after}");
        prop_assert!((depth - new_depth).abs() < 1e-9 * (1.0 + depth.abs()));
        // A turntable: the horizon stays level and up stays up.
        let (right, up, _) = turned.axes();
        prop_assert!(right.z.abs() < 1e-9 && up.z > -1e-9);
    }

    #[test]
    fn zoom_keeps_the_point_under_the_pointer(camera in cameras(), about in points(), factor in 0.05..20.0) {
        let (before, _) = motion::project(&camera, about, ASPECT).expect("in front");
        let zoomed = motion::zoom(&camera, about, factor, 10.0);
        let (after, _) = motion::project(&zoomed, about, ASPECT).expect("still in front");
        prop_assert!((before - after).length() < 1e-9);
        let ratio = motion::view_size(&zoomed) / motion::view_size(&camera);
        prop_assert!((ratio - factor).abs() < 1e-9 * factor);
    }

    #[test]
    fn pan_moves_the_point_with_the_pointer(
        camera in cameras(), at in points(), x in -0.9..0.9, y in -0.9..0.9,
    ) {
        let (from, _) = motion::project(&camera, at, ASPECT).expect("in front");
        let to = DVec2::new(x, y);
        let panned = motion::pan(&camera, at, from, to, ASPECT);
        let (now, _) = motion::project(&panned, at, ASPECT).expect("still in front");
        prop_assert!((now - to).length() < 1e-9, "{now} {to}");
    }

    #[test]
    fn fitting_shows_every_corner_and_wastes_no_room(camera in cameras(), a in points(), b in points(), c in points()) {
        let bounds = |p: DVec3, q: DVec3| Bounds { min: p.min(q), max: p.max(q) + 0.01 };
        let boxes = [bounds(a, b), bounds(b, c)];
        let (_, up, back) = camera.axes();
        let fitted = motion::fit_boxes(&boxes, -back, up, camera.projection, ASPECT).expect("not empty");
        let mut reach = 0.0f64;
        for corner in boxes.iter().flat_map(|b| [b.min, b.max].map(|p| (b, p))).flat_map(|(b, p)| {
            [p, DVec3::new(b.min.x, p.y, p.z), DVec3::new(p.x, b.min.y, p.z), DVec3::new(p.x, p.y, b.max.z)]
        }) {
            let (ndc, _) = motion::project(&fitted, corner, ASPECT).expect("in front of the eye");
            prop_assert!(ndc.abs().max_element() < 1.0, "{ndc}");
            reach = reach.max(ndc.abs().max_element());
        }
        prop_assert!(reach > 0.5, "{reach}");
    }

    #[test]
    fn clip_space_agrees_with_the_rays(camera in cameras(), p in points()) {
        let scene = Bounds { min: DVec3::new(-3.0, 2.0, 10.0), max: DVec3::new(9.0, 5.0, 13.0) };
        let clip = ClipView::of(&camera, ASPECT, &scene);
        let ndc = clip.project(&camera, p).expect("in front");
        let (expected, _) = motion::project(&camera, p, ASPECT).expect("in front");
        prop_assert!((ndc.truncate() - expected).length() < 1e-9);
        prop_assert!(ndc.z > 0.0 && ndc.z < 1.0, "{}", ndc.z);
        let ray = camera.ray(expected, ASPECT);
        prop_assert!((p - ray.origin).cross(ray.direction).length() < 1e-8);
    }

    #[test]
    fn changing_the_projection_keeps_the_size(camera in cameras()) {
        let there = motion::toggle_projection(&camera, 10.0);
        prop_assert!((motion::view_size(&there) / motion::view_size(&camera) - 1.0).abs() < 1e-9);
        prop_assert!(there.projection != camera.projection);
        let back = motion::toggle_projection(&there, 10.0);
        prop_assert!((motion::view_size(&back) / motion::view_size(&camera) - 1.0).abs() < 1e-9);
        prop_assert!((back.target - camera.target).length() < 1e-9);
    }

    #[test]
    fn flights_end_exactly_where_they_should(from in cameras(), to in cameras()) {
        let mut flight = Flight::new(from, to);
        let start = flight.camera();
        if matches!(from.projection, Projection::Perspective { .. }) == matches!(to.projection, Projection::Perspective { .. }) {
            prop_assert!((start.eye - from.eye).length() < 1e-6);
        }
        flight.elapsed = FLIGHT_TIME / 2;
        prop_assert!(flight.camera().eye.is_finite());
        flight.elapsed = FLIGHT_TIME;
        prop_assert_eq!(flight.camera(), to);
    }
}

#[test]
fn orbit_stops_at_the_poles() {
    let (direction, up) = StandardView::Iso.directions();
    let projection = Projection::Perspective { fov_y: FIELD_OF_VIEW };
    let bounds = Bounds { min: DVec3::ZERO, max: DVec3::ONE };
    let camera = Camera::fit(&bounds, direction, up, projection, ASPECT);
    let above = motion::orbit(&camera, DVec3::ZERO, 0.0, 10.0);
    let (_, _, back) = above.axes();
    assert!((back - DVec3::Z).length() < 1e-6, "{back}");
    // And one can turn there, and come back down.
    let turned = motion::orbit(&above, DVec3::ZERO, 1.0, -0.3);
    let (right, _, back) = turned.axes();
    assert!(right.z.abs() < 1e-9 && back.z < 0.99);
}

#[test]
fn views_of_nothing_are_refused() {
    let (direction, up) = StandardView::Top.directions();
    let projection = Projection::Orthographic { height: 1.0 };
    assert_eq!(motion::fit_boxes(&[], direction, up, projection, ASPECT), None);
    assert_eq!(motion::fit_boxes(&[Bounds::EMPTY], direction, up, projection, ASPECT), None);
    let point = Bounds { min: DVec3::ONE, max: DVec3::ONE };
    let camera = motion::fit_boxes(&[point], direction, up, projection, ASPECT).expect("a point can be seen");
    assert!(camera.eye.is_finite() && motion::view_size(&camera) > 0.0);
}
