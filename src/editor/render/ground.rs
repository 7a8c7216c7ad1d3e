//! The ground grid and its axes, as smooth lines tested against the depth of the model.

use bevy::prelude::*;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::{ViewDepthTexture, ViewTarget};

use super::frame::FrameView;
use super::grid::Grid;
use super::strokes::{Stroke, StrokeDraw, Uniform, draw_all};

/// Depth of the grid: a little farther than it is, so that a surface in its plane covers it.
const BEHIND: f32 = 0.998;

/// The draw of the grid.
#[derive(Resource)]
pub(super) struct Lines([StrokeDraw; 1]);

/// Makes what does not depend on the target's format.
pub(super) fn create(mut commands: Commands, device: Res<RenderDevice>) {
    let compare = wgpu::CompareFunction::GreaterEqual;
    commands.insert_resource(Lines([StrokeDraw::new(device.wgpu_device(), "lines", Stroke::Lines, compare)]));
}

/// Draws the grid if it is on.
pub(super) fn draw(
    view: ViewQuery<(&ViewTarget, &ViewDepthTexture), With<super::DrawsModel>>,
    lines: Option<ResMut<Lines>>,
    frame: Res<FrameView>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut ctx: RenderContext,
) {
    let Some(mut lines) = lines.filter(|_| frame.settings.grid) else { return };
    let (target, depth) = view.into_inner();
    let grid = Grid::of(&frame.camera, &frame.bounds, &frame.palette, frame.viewport.scale_factor);
    let (_, size) = frame.viewport.physical();
    let fade = (grid.centre - frame.camera.eye).as_vec3().extend(grid.radius as f32);
    let uniform =
        Uniform { fade: fade.to_array(), depth: BEHIND, ..Uniform::without_fade(&frame.clip, size) };
    let format = target.main_texture_format();
    lines.0[0].prepare(device.wgpu_device(), &queue, format, &uniform, &grid.lines);
    draw_all(&lines.0, "lines", (target, depth), &frame, &mut ctx);
}
