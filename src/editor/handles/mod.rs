//! Handles in the 3D view: trim curves and control points of the active face on its surface, or the net of
//! the surface's own control points, to be dragged there.
//!
//! Wiring: `Input` follows the mouse over handles, before picking sees its clicks, and writes element and edit
//! requests; `Present` traces the curves anew where something changed and makes the picture that `render`
//! draws over the model.

pub mod aim;
pub mod drag;
mod drawing;
mod input;
pub mod overlay;
pub mod shapes;
pub mod surface_map;
pub mod trace;

use bevy::prelude::*;

pub use drawing::{HandleDrawing, HandleLine, HandleMark, HandlePicture};
pub use input::{Grip, HandleHand};
pub use shapes::HandleShapes;
pub use surface_map::SurfaceMap;

use super::EditorSystems;
use super::camera::ViewCamera;
use super::editing::Editing;
use super::elements::{ActiveFace, ObserveActiveFace};
use super::settings::{Handles, Settings};
use super::uv::UvPanel;
use super::viewport::Viewport;

/// The system that looks at presses before others do.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct HandleInput;

/// Adds the handles.
pub struct HandlesPlugin;

impl Plugin for HandlesPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<HandleShapes>()
            .init_resource::<HandleHand>()
            .init_resource::<HandleDrawing>()
            .add_systems(Update, input::follow.in_set(super::NavigationInput).in_set(HandleInput))
            .add_systems(
                Update,
                (trace_handles, drawing::draw)
                    .chain()
                    .in_set(EditorSystems::Present)
                    .after(ObserveActiveFace),
            );
    }
}

/// Shapes follow face, camera and settings.
fn trace_handles(
    mut shapes: ResMut<HandleShapes>,
    active: Res<ActiveFace>,
    settings: Res<Settings>,
    camera: Res<ViewCamera>,
    viewport: Res<Viewport>,
    editing: Res<Editing>,
    panel: Res<UvPanel>,
    mut hand: ResMut<HandleHand>,
) {
    if hand.is_dragging() && !editing.is_dragging() {
        hand.grip = Grip::None;
    }
    let shapes = shapes.bypass_change_detection();
    // With the uv panel open, what is selected or under the pointer there is shown here, not to be dragged.
    let passive = settings.handles == Handles::None && panel.open;
    let kind = if passive { Handles::Curves } else { settings.handles };
    if shapes.passive != passive {
        shapes.passive = passive;
        shapes.revision += 1;
    }
    shapes.update(kind, active.face.as_ref(), &camera, &viewport);
}
