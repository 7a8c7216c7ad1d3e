//! Which level of detail a face is drawn with: the coarsest whose error is small on the screen.

use glam::DVec3;

use crate::kernel::view::{Bounds, Camera, Projection};

/// Error of a level, model units.
pub fn level_error(level: i32) -> f64 {
    f64::from(level).exp2()
}

/// The coarsest level whose error is at most `error`.
pub fn level_for(error: f64) -> i32 {
    error.max(f64::MIN_POSITIVE).log2().floor() as i32
}

/// How a view sees boxes.
#[derive(Debug, Clone, Copy)]
pub struct LevelView {
    axes: (DVec3, DVec3, DVec3),
    reference: DVec3,
    /// Half the window at depth z is `half[0] + half[1] * z`, in x and y.
    half: [[f64; 2]; 2],
    /// A pixel is `pixel[0] + pixel[1] * z` wide.
    pixel: [f64; 2],
    /// What is nearer than this counts as this near.
    nearest: f64,
}

impl LevelView {
    /// The view of `camera` in a window of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let [width, height] = size.map(|s| f64::from(s.max(1)));
        let half = camera.half_extent(width / height);
        let (reference, constant, slope) = match camera.projection {
            Projection::Perspective { .. } => (camera.eye, 0.0, 1.0 / camera.distance()),
            Projection::Orthographic { .. } => (camera.target, 1.0, 0.0),
        };
        let pixel = 2.0 * half.y / height;
        Self {
            axes: camera.axes(),
            reference,
            half: [[half.x * constant, half.x * slope], [half.y * constant, half.y * slope]],
            pixel: [pixel * constant, pixel * slope],
            nearest: 1e-3 * camera.distance(),
        }
    }

    /// The level at which a face in `bounds` is wrong by at most `error_px` pixels; `None`: out of sight.
    pub fn level(&self, bounds: &Bounds, error_px: f64) -> Option<i32> {
        self.pixel_size(bounds).map(|pixel| level_for(error_px * pixel))
    }

    /// Size of a pixel where `bounds` is nearest, model units; `None`: out of sight.
    pub fn pixel_size(&self, bounds: &Bounds) -> Option<f64> {
        if bounds.is_empty() {
            return None;
        }
        let (right, up, back) = self.axes;
        let seen: [DVec3; 8] = std::array::from_fn(|k| {
            let pick = |bit: usize, a: f64, b: f64| if k & bit == 0 { a } else { b };
            let (a, b) = (bounds.min, bounds.max);
            let p = DVec3::new(pick(1, a.x, b.x), pick(2, a.y, b.y), pick(4, a.z, b.z)) - self.reference;
            DVec3::new(p.dot(right), p.dot(up), -p.dot(back))
        });
        let perspective = self.pixel[1] != 0.0;
        let (mut nearest, mut farthest) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in seen {
            nearest = nearest.min(p.z);
            farthest = farthest.max(p.z);
        }
        // Beyond one side plane with all corners. A thousandth of the window covers jitter and rounding.
        let beyond = |along: &dyn Fn(&DVec3) -> f64, [constant, slope]: [f64; 2]| {
            seen.iter().all(|p| along(p) > 1.001 * (constant + slope * p.z))
        };
        let out = beyond(&|p| p.x, self.half[0])
            || beyond(&|p| -p.x, self.half[0])
            || beyond(&|p| p.y, self.half[1])
            || beyond(&|p| -p.y, self.half[1]);
        if out || (perspective && farthest <= 0.0) {
            return None;
        }
        Some(self.pixel[0] + self.pixel[1] * nearest.max(self.nearest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_box(at: DVec3) -> Bounds {
        Bounds { min: at - 0.5, max: at + 0.5 }
    }

    #[test]
    fn levels_follow_the_distance_and_leave_out_what_is_out_of_sight() {
        let camera = Camera {
            eye: DVec3::new(0.0, 0.0, 10.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: 1.0 },
        };
        let view = LevelView::new(&camera, [1000, 1000]);
        let size = |at: DVec3| view.pixel_size(&unit_box(at));
        let near = size(DVec3::ZERO).expect("in the middle");
        assert!((near - 2.0 * (0.5f64).tan() * 9.5 / 1000.0).abs() < 1e-12, "{near}");
        let far = size(DVec3::new(0.0, 0.0, -190.0)).expect("behind it");
        assert!((far / near - 199.5 / 9.5).abs() < 1e-9);
        assert_eq!(size(DVec3::new(9.0, 0.0, 0.0)), None);
        assert_eq!(size(DVec3::new(0.0, 0.0, 20.0)), None);
        assert!(size(DVec3::new(0.0, 0.0, 10.0)).is_some(), "around the eye");
        for error in [1e-9, 0.3, 0.5, 7.0] {
            let level = level_for(error);
            assert!(level_error(level) <= error && error < level_error(level + 1), "{error}");
        }
    }
}
