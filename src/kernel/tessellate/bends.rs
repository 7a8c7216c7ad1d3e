//! How much a surface bends along its two parameters, at a grid of samples.

use glam::DVec2;

use super::outline::Ground;
use crate::kernel::trim::UvRect;

/// Samples in each direction.
pub(super) const SAMPLES: usize = 5;

/// Normal parts of the second derivatives in u and in v, model units per squared native parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bends {
    /// What the samples cover: each stands in the middle of its cell.
    pub(super) bounds: UvRect,
    /// The samples, v running fastest.
    pub(super) bends: [DVec2; SAMPLES * SAMPLES],
}

impl Bends {
    /// Of the part `bounds` of a surface; with the mean length of the first derivatives.
    pub(super) fn new(ground: &Ground, bounds: &UvRect) -> (Self, DVec2) {
        let mut bends = [DVec2::ZERO; SAMPLES * SAMPLES];
        let mut speed = DVec2::ZERO;
        for (k, bend) in bends.iter_mut().enumerate() {
            let share = DVec2::new((k / SAMPLES) as f64 + 0.5, (k % SAMPLES) as f64 + 0.5) / SAMPLES as f64;
            let Some((patch, local)) = ground.locate(bounds.native(share)) else { continue };
            let jet = patch.jet(local.x, local.y);
            let width = patch.uv_max - patch.uv_min;
            let normal = jet.du.cross(jet.dv).normalize_or_zero();
            *bend = DVec2::new(jet.duu.dot(normal).abs(), jet.dvv.dot(normal).abs()) / (width * width);
            speed += DVec2::new(jet.du.length(), jet.dv.length()) / width / (SAMPLES * SAMPLES) as f64;
        }
        (Self { bounds: *bounds, bends }, speed)
    }

    /// The mean of the samples.
    pub(super) fn mean(&self) -> DVec2 {
        self.bends.iter().copied().sum::<DVec2>() / (SAMPLES * SAMPLES) as f64
    }

    /// The sample for `uv` (native).
    pub(super) fn at(&self, uv: DVec2) -> DVec2 {
        let share = (uv - self.bounds.min) / self.bounds.size() * SAMPLES as f64;
        let of = |x: f64| (x.max(0.0) as usize).min(SAMPLES - 1);
        self.bends[of(share.x) * SAMPLES + of(share.y)]
    }
}
