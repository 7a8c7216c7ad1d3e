//! The uv panel: the parameter plane of the active face, its trim loops, and the hand that edits them.
//!
//! Wiring: `Input` follows mouse and keys over the canvas and writes element and edit requests, which are applied,
//! derived and drawn in the same frame; `Present` brings the polylines up to date; `panels` calls [`show`].
//! Geometry is drawn from polylines that are made again only where a curve changed.

mod colors;
mod draw_hand;
mod draw_loops;
mod draw_plane;
pub mod draw_problems;
pub mod draw_shape;
mod draw_structure;
mod fields;
pub mod fill;
pub mod flat;
pub mod geometry;
pub mod gesture;
mod header;
pub mod hit;
pub mod input;
mod menu;
pub mod moving;
mod panel;
pub mod ruler;
mod show;
pub mod snap;
mod tool;
pub mod view;

use bevy::prelude::*;

pub use colors::Colors;
pub use geometry::UvGeometry;
pub use panel::{Overlay, UvPanel};
pub use show::{UvDrawing, UvParams, show};
pub use tool::{PANEL_KEYS, PanelKey, Tool};

use super::EditorSystems;
use super::editing::Editing;
use super::elements::{ActiveFace, ElementSelection, ObserveActiveFace};
use super::settings::{Handles, Settings};

/// Adds the uv panel.
pub struct UvPlugin;

impl Plugin for UvPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<UvPanel>()
            .init_resource::<UvGeometry>()
            .add_message::<super::editing::EditRequest>()
            .init_resource::<UvDrawing>()
            .init_resource::<show::Outbox>()
            .add_systems(Last, show::send)
            .add_systems(Update, input::follow.in_set(super::NavigationInput))
            .add_systems(Update, bring_up_to_date.in_set(EditorSystems::Present).after(ObserveActiveFace));
    }
}

/// Polylines and what is shown of control points follow face and view.
fn bring_up_to_date(
    mut panel: ResMut<UvPanel>,
    mut geometry: ResMut<UvGeometry>,
    active: Res<ActiveFace>,
    selection: Res<ElementSelection>,
    settings: Res<Settings>,
    editing: Res<Editing>,
) {
    let panel = panel.bypass_change_detection();
    if !editing.is_dragging() {
        // Undone, or what was dragged is gone: the mouse goes on with nothing.
        panel.drop_drag();
    }
    panel.attend(active.face.as_ref());
    match (std::mem::take(&mut panel.wanted_fit), &active.face) {
        (panel::Fit::All, Some(face)) => panel.fit(face),
        (panel::Fit::Selection, Some(face)) => panel.fit_selection(face, &selection),
        _ => {}
    }
    let wanted = panel.open || settings.handles != Handles::None;
    let face = active.face.as_ref().filter(|_| wanted);
    geometry.bypass_change_detection().update(face, &panel.view);
    if let Some(face) = &active.face {
        panel.shown = hit::ShownPoints::choose(face, &panel.view, &selection);
    }
}
