//! Where a point of the parameter plane lies on the screen, and back.
//!
//! In `f64` all the way, so that a zoom of a million shows no jitter. Both axes have a scale of their own: a
//! face's parameters seldom run at the same speed along u and v, and a hole that is round on the part should
//! look round here. v points up.

use glam::DVec2;

use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::trim::UvRect;

/// Free space around what is fitted, logical pixels.
const MARGIN_PX: f64 = 28.0;
/// Closest zoom: this part of the fitted scale; below it the digits of a parameter run out.
const CLOSEST: f64 = 1e10;
/// Farthest zoom.
const FARTHEST: f64 = 1e-3;
/// Longest and shortest side of a domain on the screen differ at most by this factor.
const MOST_STRETCH: f64 = 6.0;

/// A window onto the parameter plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvView {
    /// Parameters in the middle of the canvas.
    pub centre: DVec2,
    /// Logical pixels for one unit of u and of v.
    pub scale: DVec2,
    /// Left upper corner of the canvas in the window, logical pixels.
    pub min_px: DVec2,
    /// Size of the canvas, logical pixels.
    pub size_px: DVec2,
    /// Scale at which everything fits: what the limits of zooming go by.
    pub(super) fitted: DVec2,
}

impl Default for UvView {
    fn default() -> Self {
        Self {
            centre: DVec2::splat(0.5),
            scale: DVec2::splat(100.0),
            min_px: DVec2::ZERO,
            size_px: DVec2::ONE,
            fitted: DVec2::splat(100.0),
        }
    }
}

impl UvView {
    /// Window position of parameters.
    pub fn to_screen(&self, uv: DVec2) -> DVec2 {
        let d = (uv - self.centre) * self.scale;
        self.min_px + 0.5 * self.size_px + DVec2::new(d.x, -d.y)
    }

    /// Parameters at a window position.
    pub fn to_uv(&self, position: DVec2) -> DVec2 {
        let d = position - self.min_px - 0.5 * self.size_px;
        self.centre + DVec2::new(d.x, -d.y) / self.scale
    }

    /// Difference of parameters for a difference of positions.
    pub fn delta_uv(&self, delta_px: DVec2) -> DVec2 {
        DVec2::new(delta_px.x, -delta_px.y) / self.scale
    }

    /// Distance on the screen of two points of the parameter plane, logical pixels.
    pub fn distance_px(&self, a: DVec2, b: DVec2) -> f64 {
        ((a - b) * self.scale).length()
    }

    /// Whether a window position lies on the canvas.
    pub fn contains(&self, position: DVec2) -> bool {
        let p = position - self.min_px;
        p.min_element() >= 0.0 && p.cmplt(self.size_px).all()
    }

    /// What the canvas shows, and `beyond` times its size on every side.
    pub fn visible(&self, beyond: f64) -> UvRect {
        let half = (0.5 + beyond) * self.size_px / self.scale;
        UvRect { min: self.centre - half, max: self.centre + half }
    }

    /// Moves what is shown by a distance on the screen.
    pub fn pan(&mut self, delta_px: DVec2) {
        let centre = self.centre - self.delta_uv(delta_px);
        if centre.is_finite() {
            self.centre = centre;
        }
    }

    /// Zooms in by `factor`; what is at `position` stays there.
    pub fn zoom(&mut self, position: DVec2, factor: f64) {
        let kept = self.to_uv(position);
        let now = self.scale.x / self.fitted.x;
        let factor = (now * factor).clamp(FARTHEST, CLOSEST) / now;
        if !(factor.is_finite() && factor > 0.0) {
            return;
        }
        self.scale *= factor;
        let moved = self.to_uv(position);
        self.centre += kept - moved;
    }

    /// Shows all of `rect`, u stretched against v by `stretch` = length of a unit of u / length of a unit of v.
    pub fn fit(&mut self, rect: &UvRect, stretch: f64) {
        if !rect.has_area() {
            return;
        }
        let scale = fitting_scale(rect, stretch, self.size_px);
        if scale.is_finite() && scale.min_element() > 0.0 {
            self.centre = 0.5 * (rect.min + rect.max);
            self.scale = scale;
            self.fitted = scale;
        }
    }

    /// Shows all of `rect` without a change of the ratio of the scales.
    pub fn look_at(&mut self, rect: &UvRect) {
        let room = (self.size_px - 2.0 * MARGIN_PX).max(DVec2::splat(16.0));
        let size_px = (rect.size() * self.scale).max(DVec2::splat(1e-9));
        let factor = (room / size_px).min_element();
        let now = self.scale.x / self.fitted.x;
        let factor = (now * factor).clamp(FARTHEST, CLOSEST) / now;
        if rect.min.is_finite() && rect.max.is_finite() && factor.is_finite() && factor > 0.0 {
            self.centre = 0.5 * (rect.min + rect.max);
            self.scale *= factor;
        }
    }
}

fn fitting_scale(rect: &UvRect, stretch: f64, size_px: DVec2) -> DVec2 {
    let size = rect.size();
    // Proportions on the screen, kept within bounds so that a ribbon can still be worked on.
    let aspect = (size.x * stretch / size.y).clamp(1.0 / MOST_STRETCH, MOST_STRETCH);
    let room = (size_px - 2.0 * MARGIN_PX).max(DVec2::splat(16.0));
    let height = room.y.min(room.x / aspect);
    DVec2::new(height * aspect / size.x, height / size.y)
}

/// Mean length of a unit of u divided by that of a unit of v on `surface`, over `rect`.
pub fn natural_stretch(surface: &NurbsSurface, rect: &UvRect) -> f64 {
    const STEPS: usize = 5;
    let (mut along_u, mut along_v) = (0.0, 0.0);
    for i in 0..STEPS {
        for j in 0..STEPS {
            let t = (DVec2::new(i as f64, j as f64) + 0.5) / STEPS as f64;
            let uv = rect.native(t);
            let jet = surface.jet(uv.x, uv.y);
            along_u += jet.du.length();
            along_v += jet.dv.length();
        }
    }
    let ratio = along_u / along_v;
    if ratio.is_finite() && ratio > 0.0 { ratio } else { rect.size().y / rect.size().x }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn view() -> UvView {
        let mut view = UvView {
            min_px: DVec2::new(310.0, 520.0),
            size_px: DVec2::new(700.0, 300.0),
            ..UvView::default()
        };
        view.fit(&UvRect { min: DVec2::new(-3.0, 10.0), max: DVec2::new(5.0, 11.0) }, 0.3);
        view
    }

    proptest! {
        #[test]
        fn there_and_back(x in 0.0..1300.0f64, y in 0.0..900.0f64, zoom in -20.0..20.0f64) {
            let mut view = view();
            view.zoom(DVec2::new(500.0, 600.0), zoom.exp());
            let p = DVec2::new(x, y);
            prop_assert!((view.to_screen(view.to_uv(p)) - p).length() < 1e-4);
        }

        #[test]
        fn zooming_keeps_what_is_under_the_pointer(x in 310.0..1010.0f64, y in 520.0..820.0f64, by in -6.0..6.0f64) {
            let mut view = view();
            let p = DVec2::new(x, y);
            let uv = view.to_uv(p);
            view.zoom(p, by.exp());
            prop_assert!((view.to_screen(uv) - p).length() < 1e-6);
        }
    }

    #[test]
    fn fitting_shows_all_and_keeps_proportions() {
        let view = view();
        let low = view.to_screen(DVec2::new(-3.0, 10.0));
        let high = view.to_screen(DVec2::new(5.0, 11.0));
        assert!(view.contains(low) && view.contains(high));
        assert!(high.y < low.y, "v points up");
        let size = high - low;
        assert!((size.x / -size.y - 2.4).abs() < 1e-9, "{size}");
    }

    #[test]
    fn zoom_ends_somewhere_and_takes_no_nonsense() {
        let mut view = view();
        for _ in 0..2000 {
            view.zoom(DVec2::new(500.0, 600.0), 1.5);
        }
        assert!(view.scale.is_finite() && view.visible(0.0).has_area());
        for factor in [f64::NAN, 0.0, f64::INFINITY, -1.0] {
            view.zoom(DVec2::new(500.0, 600.0), factor);
            assert!(view.scale.is_finite() && view.scale.min_element() > 0.0);
        }
    }
}
