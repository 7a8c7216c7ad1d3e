//! What is under the pointer, read from the visibility buffer; hover and click selection.
//!
//! Wiring: `Input` decides who gets the pointer and notes the pixel to ask for; `render` answers a frame or
//! two later in [`Picker`]; `Tools` turns answers into hover and clicks into `SelectRequest`s.

mod click;
mod left_button;
mod pointer;

use bevy::prelude::*;
use glam::{DVec2, DVec3};

use super::EditorSystems;
pub use left_button::{LeftButton, PressClaims};

/// A point of a face under a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The face.
    pub face: Entity,
    /// Native parameters.
    pub uv: DVec2,
    /// Model point.
    pub position: DVec3,
}

/// The pixel asked about and the latest answer.
#[derive(Resource, Debug, Default)]
pub struct Picker {
    /// Pixel of the viewport to ask about.
    pub wanted: Option<UVec2>,
    /// The latest answer: which pixel, and what is there.
    pub answer: Option<(UVec2, Option<Hit>)>,
    /// A click that waits for its answer.
    click: Option<click::Click>,
}

impl Picker {
    /// What is at `pixel`, as far as known: an answer for a pixel a few away will do.
    pub fn hit_near(&self, pixel: UVec2) -> Option<Hit> {
        let (at, hit) = self.answer?;
        hit.filter(|_| (at.as_ivec2() - pixel.as_ivec2()).abs().max_element() <= 4)
    }

    /// The waiting click met something else than a face.
    pub fn drop_click(&mut self) {
        self.click = None;
    }

    /// Whether an answer is still due.
    pub fn is_waiting(&self) -> bool {
        self.wanted.is_some() && self.wanted != self.answer.map(|a| a.0)
    }
}

/// A click into the viewport, before it is known which face it meets.
#[derive(Message, Debug, Clone, Copy, PartialEq)]
pub struct ViewportClick {
    /// In the window, logical pixels.
    pub position: Vec2,
}

/// Systems that look at clicks before faces do.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ClickTargets;

/// Adds picking.
pub struct PickingPlugin {
    /// Whether there is a window with panels that may want the pointer.
    pub windowed: bool,
}

impl Plugin for PickingPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Picker>()
            .init_resource::<super::viewport::Pointer>()
            .init_resource::<super::viewport::Viewport>()
            .init_resource::<LeftButton>()
            .init_resource::<PressClaims>()
            .add_message::<bevy::window::WindowEvent>()
            .add_message::<ViewportClick>()
            .configure_sets(Update, ClickTargets.after(click::press).before(click::resolve))
            .add_systems(
                Update,
                (left_button::follow, click::press, click::resolve).chain().in_set(EditorSystems::Tools),
            );
        if self.windowed {
            app.add_systems(
                Update,
                pointer::route.in_set(EditorSystems::Input).before(super::NavigationInput),
            );
        }
    }
}
