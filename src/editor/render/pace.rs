//! The resolution at which a way of drawing holds the frame rate, from measured times.

/// Resolutions while something moves, as parts of the full one in each direction. Few, because textures are
/// made anew when it changes.
pub(super) const SCALES: [f32; 7] = [1.0, 0.75, 0.5, 0.375, 0.25, 0.1875, 0.140625];

/// Triangles are not drawn coarser than this position in [`SCALES`]: below, most of their time is that of corners, not of
/// pixels.
const COARSEST_TRIANGLES: usize = 2;
/// Share of the time of triangles at full resolution that fewer pixels do not save.
const FIXED_TRIANGLES: f32 = 0.5;

/// Chooses among [`SCALES`]. Getting coarser is quick; getting finer needs a clear reserve, so that it does not swing.
#[derive(Debug, Clone)]
pub(super) struct Pace {
    /// Position in [`SCALES`].
    level: usize,
    coarsest: usize,
    /// Share of the time at full resolution that does not depend on the resolution.
    fixed: f32,
    /// Time of the whole picture at full resolution as last estimated, milliseconds.
    full_ms: Option<f32>,
    /// Whether it was measured since the last choice.
    fresh: bool,
}

impl Pace {
    /// Of rays, from a position in [`SCALES`] on, with nothing measured.
    pub fn of_rays(level: usize) -> Self {
        Self { level, coarsest: SCALES.len() - 1, fixed: 0.0, full_ms: None, fresh: false }
    }

    /// Of triangles, with nothing measured.
    pub fn of_triangles() -> Self {
        let (coarsest, fixed) = (COARSEST_TRIANGLES, FIXED_TRIANGLES);
        Self { level: 0, coarsest, fixed, full_ms: None, fresh: false }
    }

    /// Time at a resolution relative to that at the full one.
    fn part(&self, scale: f32) -> f32 {
        self.fixed + (1.0 - self.fixed) * scale * scale
    }

    /// The resolution chosen.
    pub fn scale(&self) -> f32 {
        SCALES[self.level]
    }

    /// Whether full resolution was chosen.
    pub fn is_full(&self) -> bool {
        self.level == 0
    }

    /// Estimated time of a picture at full resolution, milliseconds.
    pub fn full_ms(&self) -> Option<f32> {
        self.full_ms
    }

    /// Takes the time of a picture at a resolution, milliseconds.
    pub fn measure(&mut self, scale: f32, ms: f32) {
        if ms.is_finite() && scale > 0.0 {
            self.full_ms = Some(ms / self.part(scale));
            self.fresh = true;
        }
    }

    /// Moves to the finest resolution that stays within the budget, as far as the last measurement tells.
    pub fn adapt(&mut self, budget_ms: f32) {
        let Some(full_ms) = self.full_ms.filter(|_| std::mem::take(&mut self.fresh)) else { return };
        let finest = |budget: f32| {
            let fits = |scale: &f32| full_ms * self.part(*scale) <= budget;
            SCALES[..self.coarsest].iter().position(fits).unwrap_or(self.coarsest)
        };
        let wanted = finest(budget_ms);
        if wanted > self.level {
            self.level = wanted;
        } else if wanted < self.level {
            self.level = self.level.min(finest(0.7 * budget_ms).max(wanted));
        }
    }
}
