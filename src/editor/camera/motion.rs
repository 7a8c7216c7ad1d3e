//! How a camera moves: orbit, pan, zoom and projection as pure functions of a [`Camera`].
//!
//! Every motion is a rigid motion or a uniform scaling about a point of the model, so that point keeps
//! its place on the screen exactly, up to rounding: orbiting about the picked point and zooming to the
//! cursor need no correction afterwards. Orbiting is a turntable: yaw about world z, pitch about the
//! screen's horizontal, never over the poles, so the horizon stays level.

use glam::{DQuat, DVec2, DVec3};

use crate::kernel::view::{Bounds, Camera, Projection};

/// Opening angle of perspective views, radians (35 degrees: little distortion, as CAD systems use).
pub const FIELD_OF_VIEW: f64 = 35.0 * std::f64::consts::PI / 180.0;

/// Turns the camera about `pivot`: by `yaw` radians about world z, then by `pitch` radians about the
/// screen's horizontal (positive lifts the eye). The pitch stops at the poles.
pub fn orbit(camera: &Camera, pivot: DVec3, yaw: f64, pitch: f64) -> Camera {
    let turned = turn(camera, pivot, DQuat::from_rotation_z(yaw));
    let (right, up, back) = turned.axes();
    let elevation = back.z.atan2(up.z);
    let limit = std::f64::consts::FRAC_PI_2;
    let pitch = (elevation + pitch).clamp(-limit, limit) - elevation;
    turn(&turned, pivot, DQuat::from_axis_angle(right, -pitch))
}

/// Rigid rotation of the camera about `pivot`; the up vector becomes the true one.
fn turn(camera: &Camera, pivot: DVec3, rotation: DQuat) -> Camera {
    let (_, up, _) = camera.axes();
    Camera {
        eye: pivot + rotation * (camera.eye - pivot),
        target: pivot + rotation * (camera.target - pivot),
        up: rotation * up,
        projection: camera.projection,
    }
}

/// Scales the view by `factor` (below 1 comes nearer) about the model point `about`, which stays under
/// the same pixel. `scale` is the size of the scene and bounds how near and far one can get.
pub fn zoom(camera: &Camera, about: DVec3, factor: f64, scale: f64) -> Camera {
    let size = view_size(camera);
    let (least, most) = (1e-7 * scale.max(1e-9), 1e3 * scale.max(1e-9));
    // Out of bounds already (another model was opened): still let the user come back.
    let factor = (size * factor).clamp(least.min(size), most.max(size)) / size;
    let mut zoomed = *camera;
    zoomed.target = about + (camera.target - about) * factor;
    match &mut zoomed.projection {
        Projection::Perspective { .. } => zoomed.eye = about + (camera.eye - about) * factor,
        Projection::Orthographic { height } => {
            *height *= factor;
            zoomed.eye = zoomed.target + (camera.eye - camera.target);
        }
    }
    zoomed
}

/// The camera that looks at `point` along `direction` and sees `size` model units of the plane through it, from top
/// to bottom.
pub fn approach(camera: &Camera, point: DVec3, direction: DVec3, up: DVec3, size: f64) -> Camera {
    let direction = direction.normalize_or(DVec3::NEG_Z);
    match camera.projection {
        Projection::Perspective { fov_y } => {
            let distance = 0.5 * size / (0.5 * fov_y).tan();
            Camera { eye: point - direction * distance, target: point, up, projection: camera.projection }
        }
        Projection::Orthographic { .. } => {
            let distance = camera.distance().max(size);
            let projection = Projection::Orthographic { height: size };
            Camera { eye: point - direction * distance, target: point, up, projection }
        }
    }
}

/// Height of what is seen in the plane through the target, model units.
pub fn view_size(camera: &Camera) -> f64 {
    2.0 * camera.half_extent(1.0).y
}

/// Shifts the camera in its image plane so that the model point `at` moves with the pointer from
/// `from` to `to` (both in -1..1, y up).
pub fn pan(camera: &Camera, at: DVec3, from: DVec2, to: DVec2, aspect: f64) -> Camera {
    let shift = on_plane(camera, at, from, aspect) - on_plane(camera, at, to, aspect);
    if !shift.is_finite() {
        return *camera;
    }
    Camera { eye: camera.eye + shift, target: camera.target + shift, ..*camera }
}

/// Where the ray through `ndc` meets the plane through `at` that faces the viewer.
pub fn on_plane(camera: &Camera, at: DVec3, ndc: DVec2, aspect: f64) -> DVec3 {
    let ray = camera.ray(ndc, aspect);
    let (_, _, back) = camera.axes();
    let t = (at - ray.origin).dot(back) / ray.direction.dot(back);
    ray.origin + ray.direction * t
}

/// Screen position of a model point (x right, y up, both in -1..1 inside the window) and its distance in
/// front of the eye (or of the target plane, for parallel projection). `None` behind a perspective eye.
pub fn project(camera: &Camera, point: DVec3, aspect: f64) -> Option<(DVec2, f64)> {
    let (right, up, back) = camera.axes();
    match camera.projection {
        Projection::Perspective { fov_y } => {
            let d = point - camera.eye;
            let depth = -d.dot(back);
            let tan = (0.5 * fov_y).tan();
            (depth > 0.0).then(|| {
                (DVec2::new(d.dot(right) / (depth * tan * aspect), d.dot(up) / (depth * tan)), depth)
            })
        }
        Projection::Orthographic { height } => {
            let d = point - camera.target;
            let half = 0.5 * height;
            Some((DVec2::new(d.dot(right) / (half * aspect), d.dot(up) / half), -d.dot(back)))
        }
    }
}

/// The other projection, showing the plane through the target at the same size.
pub fn toggle_projection(camera: &Camera, radius: f64) -> Camera {
    let mut toggled = *camera;
    let (_, up, back) = camera.axes();
    toggled.up = up;
    match camera.projection {
        Projection::Perspective { .. } => {
            toggled.projection = Projection::Orthographic { height: view_size(camera) };
            toggled.eye = camera.target + back * camera.distance().max(2.0 * radius);
        }
        Projection::Orthographic { height } => {
            toggled.projection = Projection::Perspective { fov_y: FIELD_OF_VIEW };
            toggled.eye = camera.target + back * (0.5 * height / (0.5 * FIELD_OF_VIEW).tan());
        }
    }
    toggled
}

/// A camera of the same kind that looks along `direction` and shows all `boxes` as large as they fit in a
/// window of `aspect`, with a margin of 6 %. The same camera as [`Camera::fit`] for one box that is seen
/// square on, and closer wherever the boxes leave the corners of their common box empty.
pub fn fit_boxes(
    boxes: &[Bounds],
    direction: DVec3,
    up: DVec3,
    projection: Projection,
    aspect: f64,
) -> Option<Camera> {
    let all = boxes.iter().fold(Bounds::EMPTY, |a, b| a.union(*b));
    if all.is_empty() || !all.diagonal().is_finite() {
        return None;
    }
    let centre = all.centre();
    let look = Camera { eye: centre - direction, target: centre, up, projection };
    let (right, up_axis, back) = look.axes();
    const MARGIN: f64 = 1.06;
    let tan_y = match projection {
        Projection::Perspective { fov_y } => (0.5 * fov_y).tan() / MARGIN,
        Projection::Orthographic { .. } => 0.0,
    };
    let tan_x = tan_y * aspect;
    // Extremes over all corners of x + z tan and -x + z tan, the same for y, and of z.
    let mut extremes = [f64::NEG_INFINITY; 6];
    for b in boxes.iter().filter(|b| !b.is_empty()) {
        for k in 0..8 {
            let pick = |bit: i32, axis: usize| if k & bit == 0 { b.min[axis] } else { b.max[axis] };
            let d = DVec3::new(pick(1, 0), pick(2, 1), pick(4, 2)) - centre;
            let (x, y, z) = (d.dot(right), d.dot(up_axis), d.dot(back));
            let values = [x + z * tan_x, -x + z * tan_x, y + z * tan_y, -y + z * tan_y, z, -z];
            for (extreme, value) in extremes.iter_mut().zip(values) {
                *extreme = extreme.max(value);
            }
        }
    }
    let [x_high, x_low, y_high, y_low, near, far] = extremes;
    let target = centre
        + right * (0.5 * (x_high - x_low))
        + up_axis * (0.5 * (y_high - y_low))
        + back * (0.5 * (near - far));
    let depth = (near + far).max(1e-9 * all.diagonal());
    let least = 1e-6 * all.diagonal().max(1e-9);
    Some(match projection {
        Projection::Perspective { .. } => {
            // Distance of the eye from the centre, along back: wide enough for both directions.
            let distance = (0.5 * (x_high + x_low) / tan_x).max(0.5 * (y_high + y_low) / tan_y);
            let from_target = (distance - 0.5 * (near - far)).max(0.51 * depth).max(least);
            Camera { eye: target + back * from_target, target, up, projection }
        }
        Projection::Orthographic { .. } => {
            let height = MARGIN * (y_high + y_low).max((x_high + x_low) / aspect).max(least);
            let eye = target + back * (depth + all.diagonal());
            Camera { eye, target, up, projection: Projection::Orthographic { height } }
        }
    })
}

/// The camera turned to look along `direction` with `up` upwards; target and size of view stay.
pub fn look_along(camera: &Camera, direction: DVec3, up: DVec3) -> Camera {
    Camera { eye: camera.target - direction * camera.distance(), up, ..*camera }
}
