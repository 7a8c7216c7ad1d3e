//! How much a surface bends along its two parameters, at a grid of samples.

use glam::DVec2;

use super::balance::{BALANCE, Bend};
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
    /// Largest normal part of the mixed derivatives.
    pub(super) twist: f64,
    /// How many tolerances deep triangles may be at the samples.
    pub(super) depths: [f64; SAMPLES * SAMPLES],
}

impl Bends {
    /// Of the part `bounds` of a surface, for vertices that may lie off it if they are to be `balanced`; with the mean length
    /// of the first derivatives.
    pub(super) fn new(ground: &Ground, bounds: &UvRect, balanced: bool) -> (Self, DVec2) {
        const COUNT: usize = SAMPLES * SAMPLES;
        let mut found =
            Self { bounds: *bounds, bends: [DVec2::ZERO; COUNT], twist: 0.0, depths: [1.0; COUNT] };
        let mut speed = DVec2::ZERO;
        for k in 0..COUNT {
            let share = DVec2::new((k / SAMPLES) as f64 + 0.5, (k % SAMPLES) as f64 + 0.5) / SAMPLES as f64;
            let Some(jet) = ground.jet(bounds.native(share)) else { continue };
            speed += DVec2::new(jet.du.length(), jet.dv.length()) / COUNT as f64;
            let Some(bend) = Bend::new(&jet) else { continue };
            found.bends[k] = DVec2::new(bend.second.x.abs(), bend.second.z.abs());
            found.twist = found.twist.max(bend.second.y.abs());
            if balanced && bend.side != 0.0 {
                found.depths[k] = 1.0 + BALANCE;
            }
        }
        (found, speed)
    }

    /// The mean of the samples.
    pub(super) fn mean(&self) -> DVec2 {
        self.bends.iter().copied().sum::<DVec2>() / (SAMPLES * SAMPLES) as f64
    }

    /// The sample for `uv` (native), for each tolerance that triangles may be deep.
    pub(super) fn at(&self, uv: DVec2) -> DVec2 {
        let share = (uv - self.bounds.min) / self.bounds.size() * SAMPLES as f64;
        let of = |x: f64| (x.max(0.0) as usize).min(SAMPLES - 1);
        let k = of(share.x) * SAMPLES + of(share.y);
        self.bends[k] / self.depths[k]
    }
}
