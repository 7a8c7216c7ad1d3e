//! When to draw the model, from what, at which resolution, and how many samples: fluid while something moves, exact at
//! rest.
//!
//! While the view changes each frame is drawn from rays where they hold the frame rate at full resolution, else from
//! triangles where there are any, at the resolution that follows the measured times; when it has been still for a moment
//! the picture is cast at full resolution, then refined sample by sample, then nothing more is drawn. At rest a cast
//! is spread over as many frames as its time demands, band by band, so that panels answer meanwhile. Pure: time and
//! measurements come in, a [`Plan`] goes out.

use std::time::Duration;

use super::pace::Pace;
use crate::editor::settings::Surfaces;

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
/// Where a picture from rays starts of which nothing is known, in [`super::pace::SCALES`].
const START: usize = 3;

/// What a picture is drawn from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Way {
    /// Rays at the exact surfaces.
    #[default]
    Rays,
    /// Triangles, trimmed exactly.
    Triangles,
}

/// What to do in a frame before the picture is presented.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Plan {
    /// Nothing: the picture is as it was.
    Keep,
    /// Colour the rays that are there anew.
    Shade,
    /// Draw one sample, or a part of it.
    Cast {
        /// From what.
        way: Way,
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
#[derive(Debug, Clone)]
pub struct Quality {
    rays: Pace,
    triangles: Pace,
    /// What the picture was drawn from, and at which resolution.
    way: Way,
    scale: f32,
    changed_at: Duration,
    samples: u32,
    full: bool,
    /// Time of a frame beside drawing the model, smoothed, milliseconds.
    beside_ms: f32,
    /// Next strip of the cast under way at rest.
    strip: u32,
    /// Strips cast per frame at rest; 0 until they are chosen.
    strips: f32,
    /// Strips measured of this picture at rest, and their time, milliseconds.
    banded: (f32, f32),
}

impl Default for Quality {
    fn default() -> Self {
        Self {
            rays: Pace::of_rays(0),
            triangles: Pace::of_triangles(),
            way: Way::Rays,
            scale: 1.0,
            changed_at: Duration::ZERO,
            samples: 0,
            full: false,
            beside_ms: 0.0,
            strip: 0,
            strips: 0.0,
            banded: (0.0, 0.0),
        }
    }
}

impl Quality {
    /// For a picture of which nothing is known: moderate resolution first.
    pub fn careful() -> Self {
        Self { rays: Pace::of_rays(START), ..Self::default() }
    }

    /// Samples in the picture.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Whether the picture has full resolution and is drawn from what it is drawn from at rest.
    pub fn is_full(&self) -> bool {
        self.full
    }

    /// Part of the full resolution of the picture.
    pub fn scale(&self) -> f32 {
        if self.full { 1.0 } else { self.scale }
    }

    /// What the picture was drawn from.
    pub fn way(&self) -> Way {
        self.way
    }

    /// Whether triangles are of use: rays would be coarse while something moves, or are not wanted.
    pub fn wants_triangles(&self, surfaces: Surfaces) -> bool {
        match surfaces {
            Surfaces::Rays => false,
            Surfaces::Triangles => true,
            Surfaces::Auto => !self.rays.is_full(),
        }
    }

    /// What to do in the frame at `now` when the hits (`cast`) or their colours (`shade`) have changed since
    /// the last frame. `triangles`: whether there are triangles of everything in sight.
    pub fn plan(
        &mut self,
        now: Duration,
        (cast, shade): (bool, bool),
        surfaces: Surfaces,
        triangles: bool,
    ) -> (Plan, Next) {
        if cast || self.samples == 0 {
            let budget = (FRAME_MS - self.beside_ms).clamp(CAST_MS.0, CAST_MS.1);
            self.rays.adapt(budget);
            self.triangles.adapt(budget);
            let from_triangles = triangles && self.wants_triangles(surfaces);
            self.way = if from_triangles { Way::Triangles } else { Way::Rays };
            let pace = if from_triangles { &self.triangles } else { &self.rays };
            self.scale = pace.scale();
            self.changed_at = now;
            self.samples = 1;
            self.full = pace.is_full() && !(from_triangles && surfaces == Surfaces::Auto);
            (self.strip, self.strips, self.banded) = (0, 0.0, (0.0, 0.0));
            let plan = Plan::Cast { way: self.way, scale: self.scale, sample: 0, from: 0, to: STRIPS };
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
        self.way = if triangles && surfaces == Surfaces::Triangles { Way::Triangles } else { Way::Rays };
        let plan = match self.way {
            Way::Rays => self.cast_band(),
            Way::Triangles => self.next_sample(0, STRIPS),
        };
        (plan, if self.full && self.samples >= SAMPLES { Next::Never } else { Next::Now })
    }

    /// Something moves over the picture, which stays as it is: refining it waits.
    pub fn hold(&mut self, now: Duration) {
        self.changed_at = now;
    }

    /// The next band of the sample under way at rest.
    fn cast_band(&mut self) -> Plan {
        if self.strips == 0.0 {
            let known = self.rays.full_ms();
            let wanted = known.map_or(FIRST_STRIPS, |ms| BAND_MS * STRIPS as f32 / ms.max(1.0));
            self.strips = wanted.clamp(1.0, STRIPS as f32);
        }
        self.next_sample(self.strip, (self.strip + self.strips as u32).min(STRIPS))
    }

    fn next_sample(&mut self, from: u32, to: u32) -> Plan {
        let sample = if self.full { self.samples } else { 0 };
        self.strip = to % STRIPS;
        if to == STRIPS {
            self.samples = sample + 1;
            self.full = true;
        }
        Plan::Cast { way: self.way, scale: 1.0, sample, from, to }
    }

    /// Takes the measured time of a picture drawn `way` at `scale`, and of the whole frame, milliseconds.
    pub fn measure(&mut self, way: Way, scale: f32, ms: f32, frame_ms: f32) {
        if !ms.is_finite() {
            return;
        }
        match way {
            Way::Rays => self.rays.measure(scale, ms),
            Way::Triangles => self.triangles.measure(scale, ms),
        }
        let beside = (frame_ms - ms).clamp(0.0, FRAME_MS);
        self.beside_ms += 0.3 * (beside - self.beside_ms);
    }

    /// Takes the measured time of a band, milliseconds. Bands get narrower at once and wider by and by, as
    /// strips differ and measurements are a few frames late.
    pub fn measure_band(&mut self, cast_ms: f32) {
        if !(cast_ms.is_finite() && self.strips > 0.0) {
            return;
        }
        let (strips, ms) = self.banded;
        self.banded = (strips + self.strips.floor(), ms + cast_ms);
        if self.banded.0 >= STRIPS as f32 {
            // A whole picture's worth: what the next motion has to reckon with.
            self.rays.measure(1.0, self.banded.1 * STRIPS as f32 / self.banded.0);
            self.banded = (0.0, 0.0);
        }
        let factor = (BAND_MS / cast_ms.max(0.1)).clamp(0.5, 1.3);
        self.strips = (self.strips * factor).clamp(1.0, STRIPS as f32);
    }
}

#[cfg(test)]
mod tests {
    use super::super::pace::SCALES;
    use super::*;

    const FRAME: Duration = Duration::from_millis(20);

    fn whole(scale: f32, sample: u32) -> Plan {
        Plan::Cast { way: Way::Rays, scale, sample, from: 0, to: STRIPS }
    }

    /// Without triangles.
    fn next(quality: &mut Quality, now: Duration, cast: bool, shade: bool) -> (Plan, Next) {
        quality.plan(now, (cast, shade), Surfaces::Auto, false)
    }

    #[test]
    fn rest_refines_to_all_samples_and_then_stops() {
        let mut quality = Quality::default();
        let mut now = Duration::from_secs(1);
        let (plan, when) = next(&mut quality, now, true, false);
        assert_eq!(plan, whole(1.0, 0));
        assert_eq!(when, Next::After(SETTLE));
        quality.measure(Way::Rays, 1.0, 0.9 * BAND_MS, BAND_MS);
        now += SETTLE;
        for sample in 1..SAMPLES {
            let (plan, when) = next(&mut quality, now, false, false);
            assert_eq!(plan, whole(1.0, sample));
            assert_eq!(when, if sample + 1 < SAMPLES { Next::Now } else { Next::Never });
            now += FRAME;
        }
        assert_eq!(next(&mut quality, now, false, false), (Plan::Keep, Next::Never));
    }

    #[test]
    fn slow_casts_get_coarser_and_return_to_full_at_rest() {
        let mut quality = Quality::default();
        let mut now = Duration::from_secs(1);
        next(&mut quality, now, true, false);
        quality.measure(Way::Rays, 1.0, 400.0, 430.0);
        now += FRAME;
        let (plan, _) = next(&mut quality, now, true, false);
        let Plan::Cast { scale, .. } = plan else { panic!("{plan:?}") };
        assert!(scale < 0.35, "{scale}");
        now += FRAME;
        assert_eq!(next(&mut quality, now, false, false).0, Plan::Keep);
        now += SETTLE;
        let mut strip = 0;
        while strip < STRIPS {
            assert!(!quality.is_full());
            let (plan, when) = next(&mut quality, now, false, false);
            let Plan::Cast { scale: 1.0, sample: 0, from, to, .. } = plan else { panic!("{plan:?}") };
            assert_eq!((from, when), (strip, Next::Now), "strips follow each other");
            let ms = 400.0 * (to - from) as f32 / STRIPS as f32;
            assert!(ms < 1.5 * BAND_MS, "{ms}");
            quality.measure_band(ms);
            strip = to;
        }
        assert!(quality.is_full());
        quality.measure_band(3.0 * BAND_MS);
        let (plan, _) = next(&mut quality, now, false, false);
        let Plan::Cast { sample: 1, from: 0, to, .. } = plan else { panic!("{plan:?}") };
        assert!(to < STRIPS / 4, "a band that took too long is followed by a narrower one: {to}");
    }

    #[test]
    fn a_motion_drops_the_cast_under_way() {
        let strips = FIRST_STRIPS as u32;
        let band =
            |k| Plan::Cast { way: Way::Rays, scale: 1.0, sample: 0, from: k * strips, to: (k + 1) * strips };
        let mut quality = Quality::careful();
        next(&mut quality, FRAME, true, false);
        let late = FRAME + SETTLE;
        assert_eq!(next(&mut quality, late, false, false).0, band(0));
        assert_eq!(next(&mut quality, late, false, false).0, band(1));
        assert_eq!(next(&mut quality, late, true, false).0, whole(SCALES[START], 0));
        assert_eq!(next(&mut quality, late + SETTLE, false, false).0, band(0));
    }

    #[test]
    fn fast_casts_return_to_full_resolution_while_moving() {
        let mut quality = Quality { rays: Pace::of_rays(5), ..Quality::default() };
        quality.measure(Way::Rays, SCALES[5], 0.05, 8.0);
        let (plan, _) = next(&mut quality, FRAME, true, false);
        assert_eq!(plan, whole(1.0, 0));
    }

    #[test]
    fn a_new_colouring_starts_the_samples_again_without_losing_resolution() {
        let mut quality = Quality::default();
        next(&mut quality, FRAME, true, false);
        quality.measure(Way::Rays, 1.0, 1.0, 16.0);
        let late = FRAME + 2 * SETTLE;
        while next(&mut quality, late, false, false).1 != Next::Never {}
        assert_eq!(next(&mut quality, late, false, true), (Plan::Shade, Next::Now));
        assert!(quality.is_full());
        assert_eq!(next(&mut quality, late, false, false).0, whole(1.0, 1));
    }

    #[test]
    fn triangles_take_over_while_rays_would_be_coarse_and_rays_come_back_at_rest() {
        let mut quality = Quality::careful();
        let mut now = Duration::from_secs(1);
        let auto = |quality: &mut Quality, now, cast| quality.plan(now, (cast, false), Surfaces::Auto, true);
        let triangles = |scale| Plan::Cast { way: Way::Triangles, scale, sample: 0, from: 0, to: STRIPS };
        assert_eq!(auto(&mut quality, now, true).0, triangles(1.0));
        assert!(!quality.is_full(), "not what is shown at rest");
        quality.measure(Way::Triangles, 1.0, 70.0, 80.0);
        now += FRAME;
        assert_eq!(auto(&mut quality, now, true).0, triangles(0.5), "coarser where triangles are slow too");
        now += SETTLE;
        let mut bands = 0;
        while !quality.is_full() {
            let (plan, next) = auto(&mut quality, now, false);
            let Plan::Cast { way: Way::Rays, scale: 1.0, sample: 0, from, to } = plan else {
                panic!("{plan:?}")
            };
            assert_eq!(next, Next::Now);
            quality.measure_band(3.0 * (to - from) as f32);
            bands += 1;
        }
        assert!(bands > 1);
        // What was measured at rest tells that rays are too slow, or quick enough.
        assert!(matches!(auto(&mut quality, now, true).0, Plan::Cast { way: Way::Triangles, .. }));
        quality.measure(Way::Rays, 1.0, 5.0, 10.0);
        assert_eq!(auto(&mut quality, now, true).0, whole(1.0, 0));
        // When told to, they stay.
        let always = quality.plan(now, (true, false), Surfaces::Triangles, true).0;
        assert!(matches!(always, Plan::Cast { way: Way::Triangles, .. }));
        let rest = quality.plan(now + SETTLE, (false, false), Surfaces::Triangles, true).0;
        assert!(matches!(rest, Plan::Cast { way: Way::Triangles, scale: 1.0, .. }), "{rest:?}");
    }
}
