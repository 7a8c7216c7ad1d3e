//! The ground grid and its axes, tested against the depth of the model.

use bevy::prelude::*;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::{ViewDepthTexture, ViewTarget};

use super::frame::FrameView;
use super::grid::{Grid, GridUniform};
use super::strokes::{Stroke, StrokeDraw, Uniform, begin};

/// Depth of the grid: a little farther than it is, so that a surface in its plane covers it.
const BEHIND: f32 = 0.998;

/// The draws of the grid.
#[derive(Resource)]
pub(super) struct Ground {
    shader: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    pipeline: Option<(wgpu::TextureFormat, wgpu::RenderPipeline)>,
    axes: StrokeDraw,
}

/// Makes what does not depend on the target's format.
pub(super) fn create(mut commands: Commands, device: Res<RenderDevice>) {
    let device = device.wgpu_device();
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("grid"),
        source: wgpu::ShaderSource::Wgsl(include_str!("../../../shaders/pass/grid.wgsl").into()),
    });
    let (layout, uniform, group) = super::uniform_group(device, "grid", size_of::<GridUniform>());
    let axes = StrokeDraw::new(device, "axes", Stroke::Lines, wgpu::CompareFunction::GreaterEqual);
    commands.insert_resource(Ground { shader, layout, group, uniform, pipeline: None, axes });
}

/// Draws the grid if it is on.
pub(super) fn draw(
    view: ViewQuery<(&ViewTarget, &ViewDepthTexture), With<super::DrawsModel>>,
    ground: Option<ResMut<Ground>>,
    frame: Res<FrameView>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut ctx: RenderContext,
) {
    let Some(mut ground) = ground.filter(|_| frame.settings.grid) else { return };
    let ground = &mut *ground;
    let ((target, depth), device) = (view.into_inner(), device.wgpu_device());
    let (eye, pixels) = (frame.camera.eye, frame.viewport.scale_factor);
    let grid = Grid::of(&frame.camera, &frame.bounds, frame.palette.light);
    let format = target.main_texture_format();
    if ground.pipeline.as_ref().is_none_or(|(f, _)| *f != format) {
        let spec = super::PipelineSpec {
            label: "grid",
            shader: &ground.shader,
            fragment: "fragment",
            layout: &ground.layout,
            buffers: &[],
            blend: Some(wgpu::BlendState::ALPHA_BLENDING),
            depth: Some(wgpu::CompareFunction::GreaterEqual),
            format,
        };
        ground.pipeline = Some((format, super::pipeline(device, spec)));
    }
    let plane = GridUniform {
        clip_from_relative: frame.clip.for_shader().to_cols_array_2d(),
        depth: BEHIND,
        ..grid.uniform(eye, &frame.palette, pixels)
    };
    queue.write_buffer(&ground.uniform, 0, bytemuck::bytes_of(&plane));
    let (_, size) = frame.viewport.physical();
    let lines = Uniform { fade: grid.fade(eye), depth: BEHIND, ..Uniform::without_fade(&frame.clip, size) };
    let axes = grid.axes(eye, &frame.palette, pixels);
    ground.axes.prepare(device, &queue, format, &lines, &axes);
    let Some((_, pipeline)) = &ground.pipeline else { return };
    let mut pass = begin("ground", (target, depth), &frame, &mut ctx);
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &ground.group, &[]);
    pass.draw(0..6, 0..1);
    ground.axes.draw(&mut pass);
}
