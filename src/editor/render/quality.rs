//! When to cast rays, at which resolution, and how many samples: fluid while something moves, exact at rest.
//!
//! While the view changes each frame is cast at a part of the resolution that follows the measured time;
//! when it has been still for a moment the picture is cast at full resolution, then refined sample by sample,
//! then nothing more is drawn. At rest a cast is spread over as many frames as its time demands, band by band,
//! so that panels answer meanwhile. Pure: time and measurements come in, a [`Plan`] goes out.

use std::time::Duration;

/// Samples per pixel at rest.
pub const SAMPLES: u32 = 8;
/// Time without change after which the picture is refined.
pub const SETTLE: Duration = Duration::from_millis(140);
/// Time that a frame may take while something moves, milliseconds: 15 frames per second and a reserve.
const FRAME_MS: f32 = 58.0;
/// Bounds of the part of it that casting gets, whatever the rest of the frame takes.
const CAST_MS: (f32, f32) = (10.0, 40.0);
/// Time that casting may take per frame at rest, milliseconds: no less, because every frame draws the rest of
/// the window too.
const BAND_MS: f32 = 90.0;
/// A picture is cast in bands of whole strips at rest; this many make a picture.
pub const STRIPS: u32 = 64;
/// Strips of the first band when nothing was measured yet.
const FIRST_STRIPS: f32 = 8.0;
/// Resolutions while something moves, as parts of the full one in each direction. Few, because textures are
/// made anew when it changes.
const SCALES: [f32; 7] = [1.0, 0.75, 0.5, 0.375, 0.25, 0.1875, 0.140625];
/// Where a picture starts of which nothing is known, in [`SCALES`].
const START: usize = 3;

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
        /// First strip of the picture, of [`STRIPS`] from the top.
        from: u32,
        /// One past the last strip; [`STRIPS`] completes the sample.
        to: u32,
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
    /// Casting time of the whole picture at full resolution as last estimated, milliseconds.
    full_ms: Option<f32>,
    /// Time of a frame beside casting, smoothed, milliseconds.
    beside_ms: f32,
    /// Next strip of the cast under way at rest.
    strip: u32,
    /// Strips cast per frame at rest; 0 until they are chosen.
    strips: f32,
}

impl Quality {
    /// For a picture of which nothing is known: moderate resolution first.
    pub fn careful() -> Self {
        Self { level: START, ..Self::default() }
    }

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
            (self.strip, self.strips) = (0, 0.0);
            let plan = Plan::Cast { scale: SCALES[self.level], sample: 0, from: 0, to: STRIPS };
            return (plan, Next::After(SETTLE));
        }
        let still = now.saturating_sub(self.changed_at);
        if shade {
            self.samples = 1;
            self.strip = 0;
            return (Plan::Shade, if still < SETTLE { Next::After(SETTLE - still) } else { Next::Now });
        }
        if still < SETTLE {
            return (Plan::Keep, Next::After(SETTLE - still));
        }
        if self.full && self.samples >= SAMPLES {
            return (Plan::Keep, Next::Never);
        }
        (self.cast_band(), if self.full && self.samples >= SAMPLES { Next::Never } else { Next::Now })
    }

    /// The next band of the sample under way at rest.
    fn cast_band(&mut self) -> Plan {
        if self.strips == 0.0 {
            let wanted = self.full_ms.map_or(FIRST_STRIPS, |ms| BAND_MS * STRIPS as f32 / ms.max(1.0));
            self.strips = wanted.clamp(1.0, STRIPS as f32);
        }
        let sample = if self.full { self.samples } else { 0 };
        let from = self.strip;
        let to = (from + self.strips as u32).min(STRIPS);
        self.strip = to % STRIPS;
        if to == STRIPS {
            self.samples = sample + 1;
            self.full = true;
        }
        Plan::Cast { scale: 1.0, sample, from, to }
    }

    /// Takes the measured time of a cast at `scale` while something moved, and of the whole frame, milliseconds.
    pub fn measure(&mut self, scale: f32, cast_ms: f32, frame_ms: f32) {
        if let Some(level) = SCALES.iter().position(|s| *s == scale)
            && cast_ms.is_finite()
        {
            self.measured_for = Some((level, cast_ms));
            self.full_ms = Some(cast_ms / (scale * scale));
            let beside = (frame_ms - cast_ms).clamp(0.0, FRAME_MS);
            self.beside_ms += 0.3 * (beside - self.beside_ms);
        }
    }

    /// Takes the measured time of a band, milliseconds. Bands get narrower at once and wider by and by, as
    /// strips differ and measurements are a few frames late.
    pub fn measure_band(&mut self, cast_ms: f32) {
        if cast_ms.is_finite() && self.strips > 0.0 {
            let factor = (BAND_MS / cast_ms.max(0.1)).clamp(0.5, 1.3);
            self.strips = (self.strips * factor).clamp(1.0, STRIPS as f32);
        }
    }

    /// Moves to the finest resolution that stays within the budget, as far as the last measurement tells.
    /// Getting coarser is quick; getting finer needs a clear reserve, so that it does not swing.
    fn adapt(&mut self) {
        let Some((level, ms)) = self.measured_for.take() else { return };
        let budget = (FRAME_MS - self.beside_ms).clamp(CAST_MS.0, CAST_MS.1);
        let full_ms = ms / (SCALES[level] * SCALES[level]);
        let fits = |scale: f32, budget: f32| full_ms * scale * scale <= budget;
        let last = SCALES.len() - 1;
        let wanted = SCALES.iter().position(|s| fits(*s, budget)).unwrap_or(last);
        if wanted > self.level {
            self.level = wanted;
        } else if wanted < self.level {
            let finer = SCALES.iter().position(|s| fits(*s, 0.7 * budget)).unwrap_or(last);
            self.level = self.level.min(finer.max(wanted));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Duration = Duration::from_millis(20);

    fn whole(scale: f32, sample: u32) -> Plan {
        Plan::Cast { scale, sample, from: 0, to: STRIPS }
    }

    #[test]
    fn rest_refines_to_all_samples_and_then_stops() {
        let mut quality = Quality::default();
        let mut now = Duration::from_secs(1);
        let (plan, next) = quality.plan(now, true, false);
        assert_eq!(plan, whole(1.0, 0));
        assert_eq!(next, Next::After(SETTLE));
        quality.measure(1.0, 0.9 * BAND_MS, BAND_MS);
        now += SETTLE;
        for sample in 1..SAMPLES {
            let (plan, next) = quality.plan(now, false, false);
            assert_eq!(plan, whole(1.0, sample));
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
        quality.measure(1.0, 400.0, 430.0);
        now += FRAME;
        let (plan, _) = quality.plan(now, true, false);
        let Plan::Cast { scale, .. } = plan else { panic!("{plan:?}") };
        assert!(scale < 0.35, "{scale}");
        now += FRAME;
        assert_eq!(quality.plan(now, false, false).0, Plan::Keep);
        now += SETTLE;
        let mut strip = 0;
        while strip < STRIPS {
            assert!(!quality.is_full());
            let (plan, next) = quality.plan(now, false, false);
            let Plan::Cast { scale: 1.0, sample: 0, from, to } = plan else { panic!("{plan:?}") };
            assert_eq!((from, next), (strip, Next::Now), "strips follow each other");
            let ms = 400.0 * (to - from) as f32 / STRIPS as f32;
            assert!(ms < 1.5 * BAND_MS, "{ms}");
            quality.measure_band(ms);
            strip = to;
        }
        assert!(quality.is_full());
        quality.measure_band(3.0 * BAND_MS);
        let (plan, _) = quality.plan(now, false, false);
        let Plan::Cast { sample: 1, from: 0, to, .. } = plan else { panic!("{plan:?}") };
        assert!(to < STRIPS / 4, "a band that took too long is followed by a narrower one: {to}");
    }

    #[test]
    fn a_motion_drops_the_cast_under_way() {
        let strips = FIRST_STRIPS as u32;
        let band = |k| Plan::Cast { scale: 1.0, sample: 0, from: k * strips, to: (k + 1) * strips };
        let mut quality = Quality::careful();
        quality.plan(FRAME, true, false);
        let late = FRAME + SETTLE;
        assert_eq!(quality.plan(late, false, false).0, band(0));
        assert_eq!(quality.plan(late, false, false).0, band(1));
        assert_eq!(quality.plan(late, true, false).0, whole(SCALES[START], 0));
        assert_eq!(quality.plan(late + SETTLE, false, false).0, band(0));
    }

    #[test]
    fn fast_casts_return_to_full_resolution_while_moving() {
        let mut quality = Quality { level: 5, ..Quality::default() };
        quality.measure(SCALES[5], 0.05, 8.0);
        let (plan, _) = quality.plan(FRAME, true, false);
        assert_eq!(plan, whole(1.0, 0));
    }

    #[test]
    fn a_new_colouring_starts_the_samples_again_without_losing_resolution() {
        let mut quality = Quality::default();
        quality.plan(FRAME, true, false);
        quality.measure(1.0, 1.0, 16.0);
        let late = FRAME + 2 * SETTLE;
        while quality.plan(late, false, false).1 != Next::Never {}
        assert_eq!(quality.plan(late, false, true), (Plan::Shade, Next::Now));
        assert!(quality.is_full());
        assert_eq!(quality.plan(late, false, false).0, whole(1.0, 1));
    }
}
