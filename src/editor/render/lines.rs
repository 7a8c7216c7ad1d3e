//! The ground grid and its axes, as smooth lines tested against the depth of the model.

use bevy::prelude::*;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::{ViewDepthTexture, ViewTarget};

use super::frame::FrameView;
use super::grid::{Grid, LineInstance};
use crate::editor::camera::clip::ClipView;

/// Most lines drawn.
const CAPACITY: usize = 1024;

/// Depth of the grid: a little farther than it is, so that a surface in its plane covers it.
const BEHIND: f32 = 0.998;

/// Pipeline and buffers.
#[derive(Resource)]
pub(super) struct Lines {
    shader: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    instances: wgpu::Buffer,
    pipeline: Option<(wgpu::TextureFormat, wgpu::RenderPipeline)>,
}

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Uniform {
    clip_from_relative: [[f32; 4]; 4],
    fade: [f32; 4],
    size_px: [f32; 2],
    /// Factor of the (reversed) depth: below 1 is farther than it is.
    depth: f32,
    opacity: f32,
}

impl Uniform {
    /// For lines that do not fade with distance and are as far as they are.
    pub fn without_fade(clip: &ClipView, size: UVec2) -> Self {
        Self {
            clip_from_relative: clip.for_shader().to_cols_array_2d(),
            fade: [0.0, 0.0, 0.0, f32::MAX],
            size_px: [size.x as f32, size.y as f32],
            depth: 1.0,
            opacity: 1.0,
        }
    }
}

/// An opaque colour as the shader gets it.
pub(super) fn ink([r, g, b]: [u8; 3]) -> [f32; 4] {
    bevy_egui::egui::Rgba::from(bevy_egui::egui::Color32::from_rgb(r, g, b)).to_array()
}

/// Makes what does not depend on the target's format.
pub(super) fn create(mut commands: Commands, device: Res<RenderDevice>) {
    let device = device.wgpu_device();
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("lines"),
        source: wgpu::ShaderSource::Wgsl(include_str!("../../../shaders/pass/lines.wgsl").into()),
    });
    let (layout, uniform, group) = super::uniform_group(device, "lines", size_of::<Uniform>());
    let instances = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("lines"),
        size: (CAPACITY * size_of::<LineInstance>()) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    commands.insert_resource(Lines { shader, layout, group, uniform, instances, pipeline: None });
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
    let format = target.main_texture_format();
    if lines.pipeline.as_ref().is_none_or(|(f, _)| *f != format) {
        let pipeline = super::pipeline(
            device.wgpu_device(),
            super::PipelineSpec {
                label: "lines",
                shader: &lines.shader,
                layout: &lines.layout,
                buffers: &[LineInstance::layout()],
                blend: Some(wgpu::BlendState::ALPHA_BLENDING),
                depth: Some(wgpu::CompareFunction::GreaterEqual),
                format,
            },
        );
        lines.pipeline = Some((format, pipeline));
    }
    let grid = Grid::of(&frame.camera, &frame.bounds, &frame.palette, frame.viewport.scale_factor);
    let count = grid.lines.len().min(CAPACITY);
    let (_, size) = frame.viewport.physical();
    let fade = (grid.centre - frame.camera.eye).as_vec3().extend(grid.radius as f32);
    let uniform = Uniform {
        clip_from_relative: frame.clip.for_shader().to_cols_array_2d(),
        fade: fade.to_array(),
        size_px: [size.x as f32, size.y as f32],
        depth: BEHIND,
        opacity: 1.0,
    };
    queue.write_buffer(&lines.uniform, 0, bytemuck::bytes_of(&uniform));
    queue.write_buffer(&lines.instances, 0, bytemuck::cast_slice(&grid.lines[..count]));
    let Some((_, pipeline)) = &lines.pipeline else { return };
    let mut pass = ctx.command_encoder().begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("lines"),
        color_attachments: &[Some(super::keep(target.main_texture_view()))],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth.view(),
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..default()
    });
    super::confine(&mut pass, &frame, target.main_texture().size());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &lines.group, &[]);
    pass.set_vertex_buffer(0, lines.instances.slice(..));
    pass.draw(0..6, 0..count as u32);
}
