//! What the passes need to know of the view, copied to the render world each frame.

use bevy::diagnostic::{DiagnosticPath, DiagnosticsStore};
use bevy::prelude::*;
use bevy::render::Extract;

use crate::editor::camera::ViewCamera;
use crate::editor::camera::clip::ClipView;
use crate::editor::derive::SceneBounds;
use crate::editor::diagnostics::RenderFigures;
use crate::editor::picking::Picker;
use crate::editor::redraw::Waker;
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
    /// Pixel of the viewport to read back.
    pub pick: Option<UVec2>,
    /// A new measurement of the cast's GPU time, and the resolution it was made at.
    pub cast_ms: Option<f32>,
    pub cast_scale: f32,
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
            pick: None,
            cast_ms: None,
            cast_scale: 1.0,
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
    picker: Extract<Res<Picker>>,
    cast_time: Extract<Res<CastTime>>,
    new_waker: Extract<Res<Waker>>,
    mut waker: ResMut<Waker>,
) {
    *waker = new_waker.clone();
    view.pick = picker.wanted;
    view.cast_ms = cast_time.ms.filter(|_| cast_time.fresh);
    view.cast_scale = cast_time.scale;
    view.camera = camera.now;
    view.viewport = **viewport;
    view.bounds = bounds.all;
    view.palette = **palette;
    if view.settings != **settings {
        view.settings = settings.clone();
    }
    view.clip = ClipView::of(&view.camera, view.viewport.aspect(), &view.bounds);
}

/// The GPU time of casting as last measured, in the main world.
#[derive(Resource, Debug, Default)]
pub(super) struct CastTime {
    ms: Option<f32>,
    fresh: bool,
    scale: f32,
    seen: Option<std::time::Instant>,
}

/// Reads the measurement from Bevy's diagnostics; it is a few frames old.
pub(super) fn read_cast_time(
    store: Res<DiagnosticsStore>,
    mut time: ResMut<CastTime>,
    figures: Res<RenderFigures>,
) {
    time.fresh = false;
    let path = DiagnosticPath::new(format!("render/{}/elapsed_gpu", super::model::CAST_SPAN));
    let Some(measurement) = store.get(&path).and_then(|d| d.measurement()) else { return };
    if time.seen == Some(measurement.time) {
        return;
    }
    time.seen = Some(measurement.time);
    let mut figures = figures.lock();
    time.ms = Some(measurement.value as f32);
    time.scale = figures.resolution;
    // Frames that cast nothing are measured too, as next to nothing.
    time.fresh = measurement.value > 0.05;
    if time.fresh {
        figures.gpu_ms = time.ms;
    }
}
