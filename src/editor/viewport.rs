//! The part of the window that shows the model, and who gets the pointer.
//!
//! egui cannot tell whether the pointer is over one of our panels, because they are built on a root of our
//! own; so the pointer belongs to the viewport when it is inside its rectangle, no popup or window is
//! above it and no widget holds it. The decision is latched while a button is down: a drag that began in
//! the viewport stays there.

use bevy::prelude::*;
use glam::DVec2;

/// Rectangle of the viewport in the window.
#[derive(Resource, Debug, Clone, Copy, PartialEq)]
pub struct Viewport {
    /// Left upper corner, logical pixels.
    pub min: Vec2,
    /// Width and height, logical pixels.
    pub size: Vec2,
    /// Physical pixels per logical pixel.
    pub scale_factor: f32,
}

impl Default for Viewport {
    fn default() -> Self {
        Self { min: Vec2::ZERO, size: Vec2::new(1.0, 1.0), scale_factor: 1.0 }
    }
}

/// The pointer, as far as the viewport is concerned.
#[derive(Resource, Debug, Clone, Copy, Default, PartialEq)]
pub struct Pointer {
    /// Position in the window, logical pixels.
    pub position: Option<Vec2>,
    /// Whether the viewport gets it.
    pub in_viewport: bool,
    /// Whether the canvas of the uv panel gets it.
    pub in_uv: bool,
    /// Whether handles are being dragged: keys are for them.
    pub drags_handle: bool,
    /// Whether a text field takes the keyboard.
    pub keyboard_taken: bool,
    /// Whether a sheet above everything is open: only commands that close it are served.
    pub sheet_open: bool,
}

impl Viewport {
    /// Width / height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size.x.max(1.0)) / f64::from(self.size.y.max(1.0))
    }

    /// Whether a window position lies in it.
    pub fn contains(&self, position: Vec2) -> bool {
        let p = position - self.min;
        p.x >= 0.0 && p.y >= 0.0 && p.x < self.size.x && p.y < self.size.y
    }

    /// Window position to -1..1, y up.
    pub fn ndc(&self, position: Vec2) -> DVec2 {
        let p = (position - self.min) / self.size.max(Vec2::ONE);
        DVec2::new(2.0 * f64::from(p.x) - 1.0, 1.0 - 2.0 * f64::from(p.y))
    }

    /// -1..1, y up, to window position.
    pub fn position(&self, ndc: DVec2) -> Vec2 {
        self.min + Vec2::new(0.5 * (1.0 + ndc.x as f32), 0.5 * (1.0 - ndc.y as f32)) * self.size
    }

    /// Left upper corner and size in physical pixels, size at least 1 x 1.
    pub fn physical(&self) -> (UVec2, UVec2) {
        let min = (self.min * self.scale_factor).round().max(Vec2::ZERO).as_uvec2();
        let max = ((self.min + self.size) * self.scale_factor).round().max(Vec2::ZERO).as_uvec2();
        (min, max.saturating_sub(min).max(UVec2::ONE))
    }

    /// Window position to physical pixel of the viewport.
    pub fn pixel(&self, position: Vec2) -> UVec2 {
        let p = ((position - self.min) * self.scale_factor).floor().max(Vec2::ZERO).as_uvec2();
        p.min(self.physical().1 - 1)
    }
}
