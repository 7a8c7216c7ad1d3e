//! The edges of triangles as smooth lines of a pixel, tested against the depth of what is shown.
//!
//! Over the exact surfaces the chords lie above or below them by up to the error of the mesh, so the lines are drawn that
//! much nearer than they are. Where edges are closer together than a few pixels they fade, or dense meshes would be a
//! patch of ink. Instances are made anew only when the view or the mesh changes.

use std::sync::Arc;

use bevy::prelude::*;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::{ViewDepthTexture, ViewTarget};
use glam::DVec3;
use rayon::prelude::*;

use super::frame::FrameView;
use super::strokes::{LineInstance, Stroke, StrokeDraw, Uniform, begin, ink};
use super::tessellation::RenderTessellation;
use crate::editor::camera::clip::ClipView;
use crate::editor::inspection::ramp;
use crate::editor::settings::Settings;
use crate::editor::tessellation::{Made, TessellationView};
use crate::kernel::view::{Camera as ViewPoint, Projection};

/// How much nearer the lines are drawn than they are, in widths of a pixel.
const NEARER_PX: f64 = 2.0;
/// Most lines drawn; of more the shortest are left out.
const MOST: usize = 500_000;
/// Lines at least this long, pixels, have their full strength, and those of no length this part of it.
const CLEAR_PX: f64 = 9.0;
const FAINTEST: f64 = 0.16;
const STRENGTH: f32 = 0.85;
/// Open edges at least.
const OPEN: f32 = 0.6;
/// Edges inside a body.
const CLOSED: [u8; 3] = [14, 26, 58];

/// The draw of the wires.
#[derive(Resource)]
pub(super) struct Wires {
    draw: StrokeDraw,
    made_of: Option<Key>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Key {
    camera: ViewPoint,
    clip: ClipView,
    size: UVec2,
    revision: u64,
    view: TessellationView,
    format: wgpu::TextureFormat,
}

/// Makes what does not depend on the target's format.
pub(super) fn create(mut commands: Commands, device: Res<RenderDevice>) {
    let compare = wgpu::CompareFunction::GreaterEqual;
    let draw = StrokeDraw::new(device.wgpu_device(), "wires", Stroke::Lines, compare);
    commands.insert_resource(Wires { draw, made_of: None });
}

/// Draws them, if they are shown.
pub(super) fn draw(
    view: ViewQuery<(&ViewTarget, &ViewDepthTexture), With<super::DrawsModel>>,
    wires: Option<ResMut<Wires>>,
    tessellation: Res<RenderTessellation>,
    frame: Res<FrameView>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut ctx: RenderContext,
) {
    let Some(mut wires) = wires else { return };
    let Settings { tessellation: choices, .. } = &frame.settings;
    let Some(made) = tessellation.made.as_ref().filter(|_| choices.shows_edges()) else { return };
    let (target, depth) = view.into_inner();
    let (min, size) = frame.viewport.physical();
    let key = Key {
        camera: frame.camera,
        clip: frame.clip,
        size,
        revision: tessellation.revision,
        view: choices.view,
        format: target.main_texture_format(),
    };
    if wires.made_of != Some(key) {
        let instances = instances(made, &tessellation.shown, &frame, choices.view);
        let uniform = Uniform::without_fade(&frame.clip, size);
        wires.draw.prepare(device.wgpu_device(), &queue, key.format, &uniform, &instances);
        wires.made_of = Some(key);
    }
    let extent = target.main_texture().size();
    let mut pass = begin("wires", (target, depth), &frame, &mut ctx);
    if choices.view == TessellationView::Wipe {
        let from = tessellation.from().unwrap_or(0.0);
        let left = (min.x + (from * size.x as f32).round() as u32).min(extent.width);
        let top = min.y.min(extent.height);
        let (right, bottom) = ((min.x + size.x).min(extent.width), (min.y + size.y).min(extent.height));
        if left >= right || top >= bottom {
            return;
        }
        pass.set_scissor_rect(left, top, right - left, bottom - top);
    }
    wires.draw.draw(&mut pass);
}

/// The edges in sight, relative to the eye.
fn instances(
    made: &Arc<Made>,
    shown: &[bool],
    frame: &FrameView,
    view: TessellationView,
) -> Vec<LineInstance> {
    let camera = &frame.camera;
    let (_, _, back) = camera.axes();
    let (_, size) = frame.viewport.physical();
    let pixel = 2.0 * camera.half_extent(1.0).y / f64::from(size.y.max(1));
    let parallel = matches!(camera.projection, Projection::Orthographic { .. });
    let distance = camera.distance().max(f64::MIN_POSITIVE);
    // Over the exact surfaces; the triangles' own edges lie on what is drawn.
    let reach = if view == TessellationView::Wireframe { made.reach() } else { 0.0 };
    let place = |p: DVec3| -> (DVec3, f64) {
        let relative = p - camera.eye;
        let width = if parallel { pixel } else { pixel * (-relative.dot(back)).max(0.0) / distance };
        let nearer = NEARER_PX * width + reach;
        let towards = if parallel { back } else { -relative.normalize_or(-back) };
        // Never past the eye.
        let most = if parallel { nearer } else { nearer.min(0.5 * relative.length()) };
        (relative + towards * most, width)
    };
    let [sides, planes] = sight(frame);
    let is_shown = |face: u32| shown.get(face as usize).copied().unwrap_or_default();
    let width_px = frame.viewport.scale_factor;
    let full = if view == TessellationView::Error { 0.5 * STRENGTH } else { STRENGTH };
    // In the heat map colours mean errors.
    let (closed, open) = match view {
        TessellationView::Error => (ink(CLOSED), ink(CLOSED)),
        _ => (ink(CLOSED), ink(ramp::NAKED)),
    };
    let line = |edge: &crate::meshing::MeshEdge| {
        if !(is_shown(edge.face) || edge.other.is_some_and(is_shown)) {
            return None;
        }
        let positions = &made.mesh.faces[edge.face as usize].as_ref().ok()?.positions;
        let [a, b] = edge.ends.map(|v| positions[v as usize]);
        let beyond = |k: usize| planes[k].dot(a - sides[k]) < 0.0 && planes[k].dot(b - sides[k]) < 0.0;
        if (0..4).any(beyond) {
            return None;
        }
        let ((start, width), (end, other)) = (place(a), place(b));
        let along = (b - a) - back * (b - a).dot(back);
        let length = along.length() / width.max(other).max(f64::MIN_POSITIVE);
        let strength = (length / CLEAR_PX).clamp(FAINTEST, 1.0) as f32;
        let [red, green, blue, _] = if edge.is_open() { open } else { closed };
        // Open ones are to be found, but a model of loose faces is full of them.
        let strength = if edge.is_open() { strength.max(OPEN) } else { full * strength };
        let (start, end) = (start.as_vec3().to_array(), end.as_vec3().to_array());
        Some((length, LineInstance { start, end, color: [red, green, blue, strength], width_px }))
    };
    let mut lines: Vec<(f64, LineInstance)> = made.edges.par_iter().filter_map(line).collect();
    if lines.len() > MOST {
        lines.select_nth_unstable_by(MOST, |a, b| b.0.total_cmp(&a.0));
        lines.truncate(MOST);
    }
    lines.into_iter().map(|(_, line)| line).collect()
}

/// Points on and inward normals of the four planes that bound what is seen.
fn sight(frame: &FrameView) -> [[DVec3; 4]; 2] {
    let camera = &frame.camera;
    let (right, up, back) = camera.axes();
    let half = camera.half_extent(frame.viewport.aspect());
    match camera.projection {
        Projection::Perspective { .. } => {
            let normal = |across: DVec3, half: f64| (across * camera.distance() - back * half).normalize();
            let planes =
                [normal(right, half.x), normal(-right, half.x), normal(up, half.y), normal(-up, half.y)];
            [[camera.eye; 4], planes]
        }
        Projection::Orthographic { .. } => {
            let sides = [-right * half.x, right * half.x, -up * half.y, up * half.y];
            [sides.map(|side| camera.target + side), [right, -right, up, -up]]
        }
    }
}
