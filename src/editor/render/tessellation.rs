//! The tessellation in the render world: packed faces put together as they are shown, and where they take the place of
//! the exact surfaces.

use std::sync::Arc;

use bevy::prelude::*;
use bevy::render::Extract;

use super::faces::RenderFaces;
use crate::editor::settings::Settings;
use crate::editor::tessellation::{Made, Tessellation, TessellationView, Wipe};
use crate::encoding::TessellationScene;

/// Triangles to draw.
#[derive(Resource, Default)]
pub(super) struct RenderTessellation {
    pub scene: TessellationScene,
    /// What it was put together from.
    pub made: Option<Arc<Made>>,
    made_of: Option<(u64, u64)>,
    /// Faces that are shown, by position in the scene.
    pub shown: Vec<bool>,
    /// Counts changes.
    pub revision: u64,
    /// Counts changes of the triangles, whatever was measured of them.
    shapes: u64,
    view: TessellationView,
    share: f32,
}

impl RenderTessellation {
    /// From which share of its width on the picture shows triangles; none: nowhere.
    pub fn from(&self) -> Option<f32> {
        self.made.as_ref()?;
        match self.view {
            TessellationView::Off | TessellationView::Wireframe => None,
            TessellationView::Overlay | TessellationView::Error => Some(0.0),
            TessellationView::Wipe => Some(self.share),
        }
    }

    /// Whether triangles are coloured by their distance from the exact surfaces.
    pub fn shows_error(&self) -> bool {
        self.view == TessellationView::Error && self.made.is_some()
    }

    /// Changes with what a picture shows of the triangles.
    pub fn seen(&self) -> u64 {
        if self.shows_error() { self.revision } else { self.shapes }
    }
}

/// Takes over what changed since the last frame. After the faces, whose slots it needs.
pub(super) fn extract(
    mut own: ResMut<RenderTessellation>,
    faces: Res<RenderFaces>,
    state: Extract<Res<Tessellation>>,
    settings: Extract<Res<Settings>>,
    wipe: Extract<Res<Wipe>>,
) {
    let own = &mut *own;
    (own.view, own.share) = (settings.tessellation.view, wipe.share);
    let made = state.made().filter(|_| own.view != TessellationView::Off);
    let Some(made) = made else {
        if own.made.take().is_some() {
            own.scene = TessellationScene::default();
            own.made_of = None;
            own.revision += 1;
            own.shapes += 1;
        }
        return;
    };
    let key = (state.revision, faces.geometry);
    if own.made_of == Some(key) || faces.is_waiting() && own.made.is_some() {
        return;
    }
    let slots: Vec<_> = made.faces().iter().map(|face| faces.shown_slot(*face)).collect();
    let parts = slots.iter().zip(&made.packed);
    let scene =
        TessellationScene::of(parts.filter_map(|(slot, packed)| Some(((*slot)?, &**packed.as_ref()?))));
    own.shapes += u64::from(!scene.has_triangles_of(&own.scene));
    own.scene = scene;
    own.shown = slots.iter().map(Option::is_some).collect();
    own.made = Some(Arc::clone(made));
    own.made_of = Some(key);
    own.revision += 1;
}
