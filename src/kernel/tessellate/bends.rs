//! How much a surface bends along its two parameters, at a grid of samples.

use glam::DVec2;

use super::balance::{BALANCE, Bend};
use super::outline::Ground;
use super::places::FAST;
use crate::kernel::nurbs::surface::SurfaceJet;
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
        let jets: Vec<_> = (0..COUNT)
            .map(|k| {
                let share =
                    DVec2::new((k / SAMPLES) as f64 + 0.5, (k % SAMPLES) as f64 + 0.5) / SAMPLES as f64;
                ground.jet(bounds.native(share))
            })
            .collect();
        let speeds = [0, 1].map(|axis| {
            let of = |jet: &SurfaceJet| if axis == 0 { jet.du.length() } else { jet.dv.length() };
            jets.iter().map(|jet| jet.as_ref().map_or(0.0, of)).collect::<Vec<_>>()
        });
        // Rows that are run through in no time say nothing of the rest.
        let fastest = speeds.each_ref().map(|all| usual(all));
        let fast = |k: usize| {
            (0..SAMPLES).any(|i| {
                let (beside_u, beside_v) = (k / SAMPLES * SAMPLES + i, i * SAMPLES + k % SAMPLES);
                speeds[0][beside_u] > fastest[0] || speeds[1][beside_v] > fastest[1]
            })
        };
        for (k, jet) in jets.iter().enumerate() {
            let Some(jet) = jet else { continue };
            if fast(k) {
                continue;
            }
            speed += DVec2::new(speeds[0][k], speeds[1][k]) / COUNT as f64;
            let Some(bend) = Bend::new(jet) else { continue };
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

/// What is not much faster than most of some speeds.
fn usual(speeds: &[f64]) -> f64 {
    let (low, high) = speeds.iter().fold((f64::INFINITY, 0.0f64), |r, x| (r.0.min(*x), r.1.max(*x)));
    if high <= FAST * low {
        return high;
    }
    let mut sorted = speeds.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let middle = sorted[sorted.len() / 2];
    // Most of it may stand still.
    if middle > 0.0 { FAST * middle } else { high }
}
