//! Edges in the colours of their gaps, as smooth lines tested against the depth of the model.
//!
//! Points come from the main world in `f64` and are taken relative to the eye here, every frame, so that the lines
//! stay on the surfaces at any zoom. They are drawn a little nearer than they are, or the surfaces they lie on would
//! cut them.

use std::sync::Arc;

use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::{ViewDepthTexture, ViewTarget};
use glam::DVec3;

use super::frame::FrameView;
use super::strokes::{LineInstance, Stroke, StrokeDraw, Uniform, draw_all, ink};
use crate::editor::inspection::{EdgeLine, EdgeLines};
use crate::kernel::view::Projection;

/// Most stretches drawn; the last lines are the important ones, so the first are left out.
const MOST: usize = 400_000;
/// How much nearer the lines are drawn than they are, in widths of a pixel.
const NEARER_PX: f64 = 2.5;

/// The draw of the edges.
#[derive(Resource)]
pub(super) struct Edges([StrokeDraw; 1]);

/// The lines of this frame.
#[derive(Resource, Default)]
pub(super) struct RenderEdges {
    lines: Arc<Vec<EdgeLine>>,
    revision: u64,
}

/// Takes over the lines if they changed.
pub(super) fn extract(lines: Extract<Res<EdgeLines>>, mut edges: ResMut<RenderEdges>) {
    if edges.revision != lines.revision {
        edges.revision = lines.revision;
        edges.lines = lines.lines.clone();
    }
}

/// Makes what does not depend on the target's format.
pub(super) fn create(mut commands: Commands, device: Res<RenderDevice>) {
    let compare = wgpu::CompareFunction::GreaterEqual;
    commands.insert_resource(Edges([StrokeDraw::new(device.wgpu_device(), "edges", Stroke::Lines, compare)]));
}

/// Draws the edges, if there are any.
pub(super) fn draw(
    view: ViewQuery<(&ViewTarget, &ViewDepthTexture), With<super::DrawsModel>>,
    mut edges: ResMut<Edges>,
    extracted: Res<RenderEdges>,
    frame: Res<FrameView>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut ctx: RenderContext,
) {
    let instances = instances(&extracted.lines, &frame);
    if instances.is_empty() {
        return;
    }
    let (target, depth) = view.into_inner();
    let (_, size) = frame.viewport.physical();
    let uniform = Uniform::without_fade(&frame.clip, size);
    let format = target.main_texture_format();
    edges.0[0].prepare(device.wgpu_device(), &queue, format, &uniform, &instances);
    draw_all(&edges.0, "edges", (target, depth), &frame, &mut ctx);
}

/// The stretches relative to the eye.
fn instances(lines: &[EdgeLine], frame: &FrameView) -> Vec<LineInstance> {
    let camera = &frame.camera;
    let (_, _, back) = camera.axes();
    let (_, size) = frame.viewport.physical();
    let pixel = 2.0 * camera.half_extent(1.0).y / f64::from(size.y.max(1));
    let pull = NEARER_PX * pixel / camera.distance().max(f64::MIN_POSITIVE);
    let place = |p: DVec3| -> [f32; 3] {
        let relative = p - camera.eye;
        let nearer = match camera.projection {
            Projection::Perspective { .. } => relative * (1.0 - pull),
            Projection::Orthographic { .. } => relative + back * (NEARER_PX * pixel),
        };
        nearer.as_vec3().to_array()
    };
    let total: usize = lines.iter().map(|l| l.points.len().saturating_sub(1)).sum();
    let mut skip = total.saturating_sub(MOST);
    let mut made = Vec::with_capacity(total - skip);
    for line in lines {
        let stretches = line.points.len().saturating_sub(1);
        if stretches <= skip {
            skip -= stretches;
            continue;
        }
        let color = ink(line.colour);
        let width_px = line.width * frame.viewport.scale_factor;
        let placed: Vec<[f32; 3]> = line.points.iter().map(|p| place(*p)).collect();
        made.extend(placed.windows(2).map(|w| LineInstance { start: w[0], end: w[1], color, width_px }));
    }
    made
}
