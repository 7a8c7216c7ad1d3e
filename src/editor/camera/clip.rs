//! The projection from model space to clip space that all passes share.
//!
//! Depth is reversed (1 near, 0 far). Positions are taken relative to the eye, in `f64` until then, so that
//! models far from the origin and large zooms keep all digits.

use glam::{DMat4, DVec3, DVec4, Mat4};

use crate::kernel::view::{Bounds, Camera, Projection};

/// Nearest distance drawn in perspective, as a fraction of the distance to the target. Small, because
/// reversed floating-point depth has digits to spare near the eye.
const NEAR: f64 = 1e-3;

/// Clip space from positions relative to the eye, and the depths it spans.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClipView {
    /// Clip from (model position - eye).
    pub clip_from_relative: DMat4,
    /// Distance in front of the eye at which depth is 1.
    pub near: f64,
    /// Distance at which depth is 0; infinite in perspective.
    pub far: f64,
}

impl ClipView {
    /// The projection of `camera` in a window of `aspect`, with room in depth for `scene`.
    pub fn of(camera: &Camera, aspect: f64, scene: &Bounds) -> Self {
        let (right, up, back) = camera.axes();
        let view = DMat4::from_cols(
            DVec4::new(right.x, up.x, back.x, 0.0),
            DVec4::new(right.y, up.y, back.y, 0.0),
            DVec4::new(right.z, up.z, back.z, 0.0),
            DVec4::W,
        );
        match camera.projection {
            Projection::Perspective { fov_y } => {
                let near = (NEAR * camera.distance()).max(1e-12);
                let projection = DMat4::perspective_infinite_reverse_rh(fov_y, aspect, near);
                Self { clip_from_relative: projection * view, near, far: f64::INFINITY }
            }
            Projection::Orthographic { height } => {
                let centre = if scene.is_empty() { camera.target } else { scene.centre() };
                let middle = (camera.eye - centre).dot(back);
                let reach = scene.diagonal() + 2.0 * height;
                let (near, far) = (middle - reach, middle + reach);
                let (w, h) = (0.5 * height * aspect, 0.5 * height);
                // Near and far exchanged: reversed depth.
                let projection = DMat4::orthographic_rh(-w, w, -h, h, far, near);
                Self { clip_from_relative: projection * view, near, far }
            }
        }
    }

    /// For shaders that get positions relative to the eye.
    pub fn for_shader(&self) -> Mat4 {
        self.clip_from_relative.as_mat4()
    }

    /// Normalised device coordinates (x, y in -1..1, depth) of a point; `None` behind the eye.
    pub fn project(&self, camera: &Camera, point: DVec3) -> Option<DVec3> {
        let clip = self.clip_from_relative * (point - camera.eye).extend(1.0);
        (clip.w > 0.0).then(|| clip.truncate() / clip.w)
    }
}
