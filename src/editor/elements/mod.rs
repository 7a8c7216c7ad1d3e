//! The active face and the selection of its loops, curves and control points.
//!
//! Wiring: [`ElementRequest`]s come from the uv panel and from the handles in 3D; `ApplyEdits` turns them into the
//! resource [`ElementSelection`]; `Present` takes over the face as it is now in [`ActiveFace`], which panel
//! and handles read.

mod active;
mod element;
mod selection;

use bevy::prelude::*;

pub use active::{ActiveFace, FaceInHand, FreshLoops};
pub use element::{Element, PointAddress};
pub use selection::{ElementRequest, ElementSelection};

use super::EditorSystems;

/// The moment from which [`ActiveFace`] is that of this frame.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ObserveActiveFace;

/// Adds the active face and the selection of its elements.
pub struct ElementsPlugin;

impl Plugin for ElementsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ElementSelection>()
            .init_resource::<ActiveFace>()
            .init_resource::<FreshLoops>()
            .init_resource::<active::Awaited>()
            .add_message::<ElementRequest>()
            .add_systems(
                Update,
                active::apply.in_set(EditorSystems::ApplyEdits).after(super::selection::ApplySelection),
            )
            .configure_sets(Update, ObserveActiveFace.in_set(EditorSystems::Present))
            .add_systems(Update, active::observe.in_set(ObserveActiveFace));
    }
}
