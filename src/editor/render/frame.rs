//! What the passes need to know of the view, copied to the render world each frame.

use bevy::prelude::*;
use bevy::render::Extract;

use crate::editor::camera::ViewCamera;
use crate::editor::camera::clip::ClipView;
use crate::editor::derive::SceneBounds;
use crate::editor::settings::Settings;
use crate::editor::theme::Palette;
use crate::editor::viewport::Viewport;
use crate::kernel::view::{Bounds, Camera as ViewPoint};

/// The view of one frame.
#[derive(Resource, Debug, Clone)]
pub(super) struct FrameView {
    pub camera: ViewPoint,
    pub clip: ClipView,
    pub viewport: Viewport,
    pub bounds: Bounds,
    pub palette: Palette,
    pub settings: Settings,
}

impl Default for FrameView {
    fn default() -> Self {
        let camera = ViewCamera::default().now;
        let viewport = Viewport::default();
        Self {
            camera,
            clip: ClipView::of(&camera, 1.0, &Bounds::EMPTY),
            viewport,
            bounds: Bounds::EMPTY,
            palette: Palette::default(),
            settings: Settings::default(),
        }
    }
}

/// Copies the view. Small: a few hundred bytes, whatever the model.
pub(super) fn extract(
    mut view: ResMut<FrameView>,
    camera: Extract<Res<ViewCamera>>,
    viewport: Extract<Res<Viewport>>,
    bounds: Extract<Res<SceneBounds>>,
    palette: Extract<Res<Palette>>,
    settings: Extract<Res<Settings>>,
) {
    view.camera = camera.now;
    view.viewport = **viewport;
    view.bounds = bounds.all;
    view.palette = **palette;
    if view.settings != **settings {
        view.settings = settings.clone();
    }
    view.clip = ClipView::of(&view.camera, view.viewport.aspect(), &view.bounds);
}
