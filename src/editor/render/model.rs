//! The model pass: casts, shades and presents by the plan of [`Quality`].

use std::time::Instant;

use bevy::prelude::*;
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::{ViewDepthTexture, ViewTarget};
use glam::{DVec2, DVec3};

use super::faces::RenderFaces;
use super::frame::FrameView;
use super::quality::{Next, Plan, Quality, SAMPLES, STRIPS, Way};
use super::ribbons::RenderRibbons;
use super::tessellation::RenderTessellation;
use super::triangles::RenderTriangles;
use crate::editor::diagnostics::RenderFigures;
use crate::editor::inspection::are_marked;
use crate::editor::redraw::Waker;
use crate::editor::settings::{DisplayMode, Surfaces};
use crate::encoding::options::jitter;
use crate::encoding::{self, Conceal, DepthRange, EdgeStyle, LevelView, Theme};
use crate::gpu::renderer::Presentation;
use crate::gpu::{Renderer, Sample};
use crate::kernel::view::{Bounds, Camera as ViewPoint};

/// Name of the GPU time span of casting and shading a whole picture.
pub(super) const CAST_SPAN: &str = "hairline_cast";
/// The same for a band of the picture at rest.
pub(super) const BAND_SPAN: &str = "hairline_band";
/// The same for triangles in place of rays.
pub(super) const MESH_SPAN: &str = "hairline_mesh";

/// The renderer and what its picture shows.
#[derive(Resource)]
pub(super) struct ModelPass {
    pub renderer: Option<(wgpu::TextureFormat, Renderer)>,
    pub quality: Quality,
    cast: Option<CastKey>,
    shade: Option<ShadeKey>,
    started: Instant,
    /// Counts changes of the visibility buffer.
    pub casts: u64,
    failure: Option<String>,
    /// Revision of the fat lines on the GPU.
    ribbons: Option<u64>,
    /// Revision of the tessellation on the GPU.
    tessellation: Option<u64>,
    /// Where the divider was.
    divider: Option<f32>,
}

/// What decides which ray hits what.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CastKey {
    camera: ViewPoint,
    size: UVec2,
    geometry: u64,
    heat: bool,
    untrimmed: bool,
    surfaces: Surfaces,
    /// Revision of the triangles, where they are what is shown at rest.
    triangles: Option<u64>,
    /// Of triangles of a tessellation in the place of faces: whether they are all over, whether they are flat, what
    /// changes with them.
    tessellation: Option<(bool, bool, u64)>,
    /// Whether they carry their errors.
    error: bool,
}

/// What decides the colour of a hit.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ShadeKey {
    mode: encoding::DisplayMode,
    edges: bool,
    holes: Conceal,
    /// Revision of the fat lines.
    ribbons: u64,
}

/// At start, and again after a device loss: everything is made anew from the extracted faces.
pub(super) fn create(
    mut commands: Commands,
    mut faces: ResMut<RenderFaces>,
    mut triangles: ResMut<RenderTriangles>,
) {
    faces.repack();
    triangles.scene.touch_all();
    commands.insert_resource(ModelPass {
        ribbons: None,
        tessellation: None,
        divider: None,
        renderer: None,
        quality: Quality::careful(),
        cast: None,
        shade: None,
        started: Instant::now(),
        casts: 0,
        failure: None,
    });
}

/// The mode as the renderer calls it.
fn mode_of(mode: DisplayMode) -> encoding::DisplayMode {
    match mode {
        DisplayMode::Shaded => encoding::DisplayMode::Shaded,
        DisplayMode::Faces => encoding::DisplayMode::Faces,
        DisplayMode::Uv => encoding::DisplayMode::Uv,
        DisplayMode::Heat => encoding::DisplayMode::Heat,
        DisplayMode::Untrimmed => encoding::DisplayMode::Untrimmed,
    }
}

/// Draws the model into the viewport's colour and depth.
pub(super) fn draw(
    view: ViewQuery<(&ViewTarget, &ViewDepthTexture), With<super::DrawsModel>>,
    mut pass: ResMut<ModelPass>,
    (mut faces, mut triangles, mut ribbons, mut tessellation): (
        ResMut<RenderFaces>,
        ResMut<RenderTriangles>,
        ResMut<RenderRibbons>,
        ResMut<RenderTessellation>,
    ),
    frame: Res<FrameView>,
    figures: Res<RenderFigures>,
    waker: Res<Waker>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut ctx: RenderContext,
) {
    let (target, depth) = view.into_inner();
    let (device, pass) = (device.wgpu_device(), &mut *pass);
    let format = target.main_texture_format();
    if pass.renderer.as_ref().is_none_or(|(f, _)| *f != format) {
        pass.renderer = Some((format, Renderer::new(device, format)));
        ribbons.scene.touch_all();
        pass.cast = None;
        (pass.ribbons, pass.tessellation) = (None, None);
        if pass.casts > 0 {
            faces.repack();
        }
    }
    let Some((_, renderer)) = &mut pass.renderer else { return };
    if pass.cast.is_none_or(|cast| cast.geometry != faces.geometry) {
        let started = Instant::now();
        match renderer.upload(device, &queue, &mut faces.packed) {
            Ok(uploaded) => figures.lock().edit.finish(started.elapsed(), uploaded.bytes),
            Err(error) => {
                fail(&mut pass.failure, &figures, &waker, format!("The model cannot be drawn: {error}"));
                return;
            }
        }
    }
    let (min, size) = frame.viewport.physical();
    let mode = if tessellation.shows_error() {
        encoding::DisplayMode::Deviation
    } else {
        mode_of(frame.settings.mode)
    };
    if pass.tessellation != Some(tessellation.revision) {
        if let Err(error) = renderer.upload_tessellation(device, &queue, &mut tessellation.scene) {
            let text = format!("The tessellation cannot be drawn: {error}");
            fail(&mut pass.failure, &figures, &waker, text);
        }
        pass.tessellation = Some(tessellation.revision);
    }
    let (from, facets) = (tessellation.from(), frame.settings.tessellation.facets);
    renderer.show_tessellation(from, facets);
    let only_tessellated = from == Some(0.0);
    // Holes between triangles are of the triangles: where holes are looked for all the time, there are rays all the time.
    let for_holes = are_marked(&frame.settings) && frame.settings.holes_moving;
    let surfaces = match (only_tessellated, for_holes) {
        (true, _) => Surfaces::Triangles,
        (false, true) => Surfaces::Rays,
        (false, false) => frame.settings.surfaces,
    };
    triangles.forget(faces.changed.drain(..));
    if let Some((way, ms)) = frame.cast_ms {
        pass.quality.measure(way, frame.cast_scale, ms, figures.lock().frame_ms);
    }
    if let Some(ms) = frame.band_ms {
        pass.quality.measure_band(ms);
    }
    // Those for motions are half a pixel off in a picture of half the resolution: what they are drawn at where they are of use.
    let sharp = if surfaces == Surfaces::Auto { (size / 2).max(UVec2::ONE) } else { size };
    // Made ready at rest too, so that they are there when the next motion starts.
    let lacking = match pass.quality.wants_triangles(surfaces) {
        true if only_tessellated => Some(Vec::new()),
        true => triangles.prepare(&faces, &LevelView::new(&frame.camera, sharp.to_array()), &waker),
        false => None,
    };
    let are_shown = surfaces == Surfaces::Triangles && lacking.is_some();
    let cast = CastKey {
        camera: frame.camera,
        size,
        geometry: faces.geometry,
        heat: mode == encoding::DisplayMode::Heat,
        untrimmed: mode == encoding::DisplayMode::Untrimmed,
        surfaces,
        triangles: (are_shown && !only_tessellated).then(|| triangles.scene.revision()),
        tessellation: from.map(|from| (from == 0.0, facets, tessellation.seen())),
        error: tessellation.shows_error(),
    };
    // Triangles that share their vertices have no holes.
    let holes = if ribbons.is_ready() && from.is_none() { frame.settings.holes } else { Conceal::Raw };
    let fat_lines = if holes == Conceal::Raw { 0 } else { ribbons.revision };
    let shade = ShadeKey { mode, edges: frame.settings.edges, holes, ribbons: fat_lines };
    if pass.ribbons != Some(fat_lines) && holes != Conceal::Raw {
        if let Err(error) = renderer.upload_ribbons(device, &queue, &mut ribbons.scene) {
            error!("fat lines cannot be drawn: {error}");
        }
        pass.ribbons = Some(fat_lines);
    }
    let now = pass.started.elapsed();
    let mut cast_changed = pass.cast != Some(cast);
    let shade_changed = pass.shade != Some(shade);
    let wiped = std::mem::replace(&mut pass.divider, from) != from;
    if wiped && !cast_changed && renderer.has_both() {
        // Nothing is refined while the divider moves.
        pass.quality.hold(now);
        renderer.wipe(device, ctx.command_encoder());
        pass.casts += 1;
    } else {
        cast_changed |= wiped;
    }
    // At rest both pictures of a comparison are drawn whole.
    let both = from.is_some_and(|from| from > 0.0) && !cast_changed;
    renderer.show_both(both);
    if !both {
        renderer.forget_both();
    }
    let (plan, next) = if faces.is_waiting() && !cast_changed && !shade_changed {
        // More is on its way: no use in refining what is there.
        (Plan::Keep, Next::Now)
    } else {
        pass.quality.plan(now, (cast_changed, shade_changed), surfaces, lacking.is_some())
    };
    pass.cast = Some(cast);
    pass.shade = Some(shade);

    let edges = EdgeStyle { visible: shade.edges, width_px: frame.viewport.scale_factor };
    // Edges are a pixel wide: in a coarse picture they would be bars.
    let edges_at = |scale: f32| EdgeStyle { visible: edges.visible && scale > 0.45, ..edges };
    let conceal_at = |size: UVec2| match holes {
        Conceal::Raw => None,
        _ => Some(ribbons.scene.concealing_spans(&LevelView::new(&frame.camera, size.to_array()))),
    };
    let recorder = ctx.diagnostic_recorder();
    let name = match plan {
        Plan::Keep | Plan::Shade => None,
        Plan::Cast { way: Way::Triangles, .. } => Some(MESH_SPAN),
        Plan::Cast { sample: 0, from: 0, to: STRIPS, .. } => Some(CAST_SPAN),
        Plan::Cast { .. } => Some(BAND_SPAN),
    };
    let span = name.and_then(|name| Some(recorder.as_deref()?.time_span(ctx.command_encoder(), name)));
    match plan {
        Plan::Keep => {}
        Plan::Shade => {
            renderer.reveal();
            if let Some(spans) = conceal_at(UVec2::from_array(renderer.targets().size)) {
                let difference = holes == Conceal::Difference;
                renderer.conceal(device, &queue, ctx.command_encoder(), &spans, difference);
            }
            if both && renderer.has_both() {
                renderer.shade_both(device, &queue, ctx.command_encoder(), (mode, edges), true);
            } else {
                renderer.shade(device, &queue, ctx.command_encoder(), mode, edges, true);
            }
        }
        Plan::Cast { way, scale, sample, from, to } => {
            let scaled = (size.as_vec2() * scale).ceil().as_uvec2().max(UVec2::ONE);
            let rays = Sample {
                camera: frame.camera,
                depth: DepthRange { near: frame.clip.near, far: frame.clip.far },
                size: scaled.to_array(),
                jitter: jitter(sample),
                mode,
            };
            let row = |strip: u32| (u64::from(scaled.y) * u64::from(strip) / u64::from(STRIPS)) as u32;
            let rows = row(from)..row(to);
            match way {
                Way::Triangles if only_tessellated => {
                    renderer.draw_meshes(device, &queue, ctx.command_encoder(), &rays);
                }
                Way::Triangles => {
                    let (scene, lacking) = (&mut triangles.scene, lacking.as_deref().unwrap_or_default());
                    let sent = renderer.upload_meshes(device, &queue, scene, &faces.packed, lacking);
                    if let Err(error) = sent {
                        let text = format!("Triangles cannot be drawn: {error}");
                        fail(&mut pass.failure, &figures, &waker, text);
                    }
                    renderer.draw_meshes(device, &queue, ctx.command_encoder(), &rays);
                }
                Way::Rays => renderer.cast_rows(device, &queue, ctx.command_encoder(), &rays, rows),
            }
            if to == STRIPS {
                if let Some(spans) = conceal_at(scaled) {
                    let difference = holes == Conceal::Difference;
                    renderer.conceal(device, &queue, ctx.command_encoder(), &spans, difference);
                }
                let (look, first) = ((mode, edges_at(scale)), sample == 0);
                if both {
                    renderer.keep_both(device, &queue, ctx.command_encoder(), look, first);
                } else {
                    renderer.shade(device, &queue, ctx.command_encoder(), look.0, look.1, first);
                }
                pass.casts += 1;
            }
        }
    }
    if let Some(span) = span {
        span.end(ctx.command_encoder());
    }
    let presentation = Presentation {
        theme: Theme::Transparent,
        viewport: Some([min.x, min.y, size.x, size.y]),
        scissor: covered(&frame, target.main_texture().size()),
    };
    let target_view = target.main_texture_view();
    renderer.present(device, &queue, ctx.command_encoder(), target_view, Some(depth.view()), &presentation);
    report(&figures, &pass.quality, &faces);
    match next {
        _ if faces.is_waiting() => waker.wake(),
        Next::Now => waker.wake(),
        Next::After(time) => waker.wake_after(time),
        Next::Never => {}
    }
}

/// Says what cannot be drawn, once in a row.
fn fail(last: &mut Option<String>, figures: &RenderFigures, waker: &Waker, text: String) {
    if last.as_ref() != Some(&text) {
        error!("{text}");
        figures.fail(text.clone());
        *last = Some(text);
        waker.wake();
    }
}

/// The pixels of the target that the model can cover: x, y, width, height. `None`: all of them.
pub(super) fn covered(frame: &FrameView, target: wgpu::Extent3d) -> Option<[u32; 4]> {
    if frame.bounds.is_empty() {
        return None;
    }
    let (min, size) = frame.viewport.physical();
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let Bounds { min: a, max: b } = frame.bounds;
    for k in 0..8 {
        let pick = |bit: u32, a: f64, b: f64| if k & bit == 0 { a } else { b };
        let corner = DVec3::new(pick(1, a.x, b.x), pick(2, a.y, b.y), pick(4, a.z, b.z));
        let ndc = frame.clip.project(&frame.camera, corner)?.truncate();
        low = low.min(ndc);
        high = high.max(ndc);
    }
    // Two texels of the coarsest picture.
    const MARGIN_PX: f64 = 16.0;
    let (min, size) = (min.as_dvec2(), size.as_dvec2());
    let pixel = |x: f64, y: f64| min + DVec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y) * size;
    let limit = DVec2::new(target.width.into(), target.height.into());
    let from = (pixel(low.x, high.y) - MARGIN_PX).clamp(DVec2::ZERO, limit).as_uvec2();
    let to = (pixel(high.x, low.y) + MARGIN_PX).clamp(DVec2::ZERO, limit).as_uvec2();
    let extent = to.saturating_sub(from);
    Some([from.x, from.y, extent.x, extent.y])
}

fn report(figures: &RenderFigures, quality: &Quality, faces: &RenderFaces) {
    let mut figures = figures.lock();
    figures.samples = quality.samples();
    figures.samples_wanted = SAMPLES;
    figures.resolution = quality.scale();
    figures.triangles = quality.way() == Way::Triangles;
    figures.gpu_bytes = faces.packed.bytes() as u64;
}
