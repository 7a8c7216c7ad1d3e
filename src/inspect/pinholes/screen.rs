//! A window in f64: rays of pixels, depths and sizes of pixels, and where points are in it.

use glam::{DVec2, DVec3};

use crate::encoding::View;
use crate::kernel::view::{Camera, Projection, Ray};

/// A window in f64.
pub(super) struct Screen {
    camera: Camera,
    axes: (DVec3, DVec3, DVec3),
    pub(super) size: DVec2,
    half: DVec2,
    jitter: DVec2,
    pixel: [f64; 2],
}

impl Screen {
    pub(super) fn new(camera: &Camera, view: &View) -> Self {
        let size = DVec2::new(view.size[0].into(), view.size[1].into());
        let half = camera.half_extent(size.x / size.y);
        let height = 2.0 * half.y / size.y;
        let pixel = match camera.projection {
            Projection::Perspective { .. } => [0.0, height / camera.distance()],
            Projection::Orthographic { .. } => [height, 0.0],
        };
        let jitter = DVec2::new(view.jitter[0].into(), view.jitter[1].into());
        Self { camera: *camera, axes: camera.axes(), size, half, jitter, pixel }
    }

    pub(super) fn ray(&self, pixel: [u32; 2]) -> Ray {
        let p = DVec2::new(pixel[0].into(), pixel[1].into()) + 0.5 + self.jitter;
        let ndc = (2.0 * p / self.size - 1.0) * DVec2::new(1.0, -1.0);
        self.camera.ray(ndc, self.size.x / self.size.y)
    }

    /// Depth along the line of sight, as in [`View`].
    pub(super) fn depth(&self, p: DVec3) -> f64 {
        let reference = match self.camera.projection {
            Projection::Perspective { .. } => self.camera.eye,
            Projection::Orthographic { .. } => self.camera.target,
        };
        (reference - p).dot(self.axes.2)
    }

    /// Size of a pixel at depth `z`.
    pub(super) fn width(&self, z: f64) -> f64 {
        self.pixel[0] + self.pixel[1] * z.abs()
    }

    /// Whether all within `reach` of a point is off the screen. In space, not in pixels: beside the eye, where depth is
    /// next to nothing, a pixel says nothing.
    pub(super) fn is_off(&self, p: DVec3, reach: f64) -> bool {
        let z = self.depth(p);
        let scale = match self.camera.projection {
            Projection::Perspective { .. } if z + reach <= 0.0 => return true,
            Projection::Perspective { .. } => (z + reach) / self.camera.distance(),
            Projection::Orthographic { .. } => 1.0,
        };
        let from = p - self.camera.target;
        let across = DVec2::new(from.dot(self.axes.0), from.dot(self.axes.1)).abs();
        across.cmpgt(self.half * scale + reach + 2.0 * self.width(z.abs() + reach)).any()
    }

    /// Position in pixels from the upper left of the sample grid; `None` behind the eye.
    pub(super) fn project(&self, p: DVec3) -> Option<DVec2> {
        let from = p - self.camera.target;
        let scale = match self.camera.projection {
            Projection::Perspective { .. } => self.camera.distance() / self.depth(p),
            Projection::Orthographic { .. } => 1.0,
        };
        let ndc = DVec2::new(from.dot(self.axes.0), from.dot(self.axes.1)) * scale / self.half;
        let seen = scale > 0.0 && ndc.is_finite();
        seen.then(|| (ndc * DVec2::new(1.0, -1.0) * 0.5 + 0.5) * self.size - self.jitter)
    }
}
