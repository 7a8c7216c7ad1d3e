//! When to cast rays, at which resolution, and how many samples: fluid while something moves, exact at rest.
//!
//! While the view changes each frame is cast at a part of the resolution that follows the measured time;
//! when it has been still for a moment the picture is cast at full resolution, then refined sample by sample,
//! then nothing more is drawn. Pure: time and measurements come in, a [`Plan`] goes out.

use std::time::Duration;

/// Samples per pixel at rest.
pub const SAMPLES: u32 = 8;
/// Time without change after which the picture is refined.
pub const SETTLE: Duration = Duration::from_millis(140);
/// Time that casting may take per frame while something moves, milliseconds: leaves room for panels within
/// the 66 ms of 15 frames per second.
const BUDGET_MS: f32 = 30.0;
/// Resolutions while something moves, as parts of the full one in each direction. Few, because textures are
/// made anew when it changes.
const SCALES: [f32; 6] = [1.0, 0.75, 0.5, 0.375, 0.25, 0.1875];

/// What to do in a frame before the picture is presented.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Plan {
    /// Nothing: the picture is as it was.
    Keep,
    /// Colour the rays that are there anew.
    Shade,
    /// Cast one sample.
    Cast {
        /// Part of the full resolution.
        scale: f32,
        /// Number of the sample, from 0; 0 starts the picture.
        sample: u32,
    },
}

/// When the next frame is needed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Next {
    /// Not before something changes.
    Never,
    /// As soon as possible.
    Now,
    /// When this time has passed.
    After(Duration),
}

/// State of the picture.
#[derive(Debug, Clone, Default)]
pub struct Quality {
    /// Position in [`SCALES`] while something moves.
    level: usize,
    changed_at: Duration,
    samples: u32,
    full: bool,
    measured_for: Option<(usize, f32)>,
}

impl Quality {
    /// Samples in the picture.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Whether the picture has full resolution.
    pub fn is_full(&self) -> bool {
        self.full
    }

    /// Part of the full resolution of the picture.
    pub fn scale(&self) -> f32 {
        if self.full { 1.0 } else { SCALES[self.level] }
    }

    /// What to do in the frame at `now` when the rays (`cast`) or their colours (`shade`) have changed since
    /// the last frame.
    pub fn plan(&mut self, now: Duration, cast: bool, shade: bool) -> (Plan, Next) {
        if cast || self.samples == 0 {
            self.adapt();
            self.changed_at = now;
            self.samples = 1;
            self.full = self.level == 0;
            return (Plan::Cast { scale: SCALES[self.level], sample: 0 }, Next::After(SETTLE));
        }
        let still = now.saturating_sub(self.changed_at);
        if shade {
            self.samples = 1;
            return (Plan::Shade, if still < SETTLE { Next::After(SETTLE - still) } else { Next::Now });
        }
        if still < SETTLE {
            return (Plan::Keep, Next::After(SETTLE - still));
        }
        if !self.full {
            self.full = true;
            self.samples = 1;
            return (Plan::Cast { scale: 1.0, sample: 0 }, Next::Now);
        }
        if self.samples < SAMPLES {
            let sample = self.samples;
            self.samples += 1;
            let next = if self.samples < SAMPLES { Next::Now } else { Next::Never };
            return (Plan::Cast { scale: 1.0, sample }, next);
        }
        (Plan::Keep, Next::Never)
    }

    /// Takes the measured time of a cast at `scale`, milliseconds.
    pub fn measure(&mut self, scale: f32, cast_ms: f32) {
        if let Some(level) = SCALES.iter().position(|s| *s == scale)
            && cast_ms.is_finite()
        {
            self.measured_for = Some((level, cast_ms));
        }
    }

    /// Moves to the finest resolution that stays within the budget, as far as the last measurement tells.
    /// Getting coarser is quick; getting finer needs a clear reserve, so that it does not swing.
    fn adapt(&mut self) {
        let Some((level, ms)) = self.measured_for.take() else { return };
        let full_ms = ms / (SCALES[level] * SCALES[level]);
        let fits = |scale: f32, budget: f32| full_ms * scale * scale <= budget;
        let last = SCALES.len() - 1;
        let wanted = SCALES.iter().position(|s| fits(*s, BUDGET_MS)).unwrap_or(last);
        if wanted > self.level {
            self.level = wanted;
        } else if wanted < self.level {
            let finer = SCALES.iter().position(|s| fits(*s, 0.7 * BUDGET_MS)).unwrap_or(last);
            self.level = self.level.min(finer.max(wanted));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Duration = Duration::from_millis(20);

    #[test]
    fn rest_refines_to_all_samples_and_then_stops() {
        let mut quality = Quality::default();
        let mut now = Duration::from_secs(1);
        let (plan, next) = quality.plan(now, true, false);
        assert_eq!(plan, Plan::Cast { scale: 1.0, sample: 0 });
        assert_eq!(next, Next::After(SETTLE));
        now += SETTLE;
        for sample in 1..SAMPLES {
            let (plan, next) = quality.plan(now, false, false);
            assert_eq!(plan, Plan::Cast { scale: 1.0, sample });
            assert_eq!(next, if sample + 1 < SAMPLES { Next::Now } else { Next::Never });
            now += FRAME;
        }
        assert_eq!(quality.plan(now, false, false), (Plan::Keep, Next::Never));
    }

    #[test]
    fn slow_casts_get_coarser_and_return_to_full_at_rest() {
        let mut quality = Quality::default();
        let mut now = Duration::from_secs(1);
        quality.plan(now, true, false);
        quality.measure(1.0, 400.0);
        now += FRAME;
        let (plan, _) = quality.plan(now, true, false);
        let Plan::Cast { scale, .. } = plan else { panic!("{plan:?}") };
        assert!(scale < 0.3, "{scale}");
        now += FRAME;
        assert_eq!(quality.plan(now, false, false).0, Plan::Keep);
        now += SETTLE;
        assert_eq!(quality.plan(now, false, false), (Plan::Cast { scale: 1.0, sample: 0 }, Next::Now));
    }

    #[test]
    fn fast_casts_return_to_full_resolution_while_moving() {
        let mut quality = Quality { level: 5, ..Quality::default() };
        quality.measure(SCALES[5], 0.05);
        let (plan, _) = quality.plan(FRAME, true, false);
        assert_eq!(plan, Plan::Cast { scale: 1.0, sample: 0 });
    }

    #[test]
    fn a_new_colouring_starts_the_samples_again_without_losing_resolution() {
        let mut quality = Quality::default();
        quality.plan(FRAME, true, false);
        let late = FRAME + 2 * SETTLE;
        while quality.plan(late, false, false).1 != Next::Never {}
        assert_eq!(quality.plan(late, false, true), (Plan::Shade, Next::Now));
        assert!(quality.is_full());
        assert_eq!(quality.plan(late, false, false).0, Plan::Cast { scale: 1.0, sample: 1 });
    }
}
