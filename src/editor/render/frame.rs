//! What the passes need to know of the view, copied to the render world each frame.

use bevy::diagnostic::{DiagnosticPath, DiagnosticsStore};
use bevy::prelude::*;
use bevy::render::Extract;

use super::quality::Way;
use crate::editor::camera::ViewCamera;
use crate::editor::camera::clip::ClipView;
use crate::editor::derive::SceneBounds;
use crate::editor::diagnostics::RenderFigures;
use crate::editor::panels::Notices;
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
    /// A new measurement of the GPU time of a picture while something moved, and the resolution it was made at.
    pub cast_ms: Option<(Way, f32)>,
    pub cast_scale: f32,
    /// A new measurement of the GPU time of a band of the picture at rest.
    pub band_ms: Option<f32>,
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
            band_ms: None,
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
    let (rays, triangles) = (cast_time.whole.fresh, cast_time.mesh.fresh);
    view.cast_ms = triangles.map(|ms| (Way::Triangles, ms)).or(rays.map(|ms| (Way::Rays, ms)));
    view.cast_scale = cast_time.scale;
    view.band_ms = cast_time.band.fresh;
    view.camera = camera.now;
    view.viewport = **viewport;
    view.bounds = bounds.all;
    view.palette = **palette;
    if view.settings != **settings {
        view.settings = settings.clone();
    }
    view.clip = ClipView::of(&view.camera, view.viewport.aspect(), &view.bounds);
}

/// GPU times of casting as last measured, in the main world.
#[derive(Resource, Debug, Default)]
pub(super) struct CastTime {
    whole: SpanTime,
    mesh: SpanTime,
    band: SpanTime,
    scale: f32,
}

/// One span: a measurement that came in since the last frame, and when the last one was made.
#[derive(Debug, Default)]
struct SpanTime {
    fresh: Option<f32>,
    seen: Option<std::time::Instant>,
}

impl SpanTime {
    fn read(&mut self, store: &DiagnosticsStore, span: &str) -> Option<f32> {
        self.fresh = None;
        let path = DiagnosticPath::new(format!("render/{span}/elapsed_gpu"));
        let measurement = store.get(&path)?.measurement()?;
        if self.seen.replace(measurement.time) != Some(measurement.time) {
            self.fresh = Some(measurement.value as f32);
        }
        self.fresh
    }
}

/// Reads the measurements from Bevy's diagnostics; they are a few frames old. Frames that cast nothing
/// measure nothing, so that the last figure stays.
pub(super) fn read_cast_time(
    store: Res<DiagnosticsStore>,
    mut time: ResMut<CastTime>,
    figures: Res<RenderFigures>,
) {
    let time = &mut *time;
    let whole = time.whole.read(&store, super::model::CAST_SPAN);
    let mesh = time.mesh.read(&store, super::model::MESH_SPAN);
    let band = time.band.read(&store, super::model::BAND_SPAN);
    let mut figures = figures.lock();
    time.scale = figures.resolution;
    figures.gpu_ms = whole.or(mesh).or(band).or(figures.gpu_ms);
}

/// Shows what cannot be drawn.
pub(super) fn tell_failure(figures: Res<RenderFigures>, mut notices: ResMut<Notices>) {
    if let Some(text) = figures.take_failure() {
        notices.error(text);
    }
}
