//! The gradient behind the model.

use bevy::prelude::*;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::ViewTarget;
use bevy_egui::egui::{Color32, Rgba};

use super::frame::FrameView;

/// Pipeline and uniform buffer.
#[derive(Resource)]
pub(super) struct Backdrop {
    shader: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    pipeline: Option<(wgpu::TextureFormat, wgpu::RenderPipeline)>,
}

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Uniform {
    top: [f32; 4],
    bottom: [f32; 4],
    top_px: f32,
    height_px: f32,
    padding: [f32; 2],
}

/// Makes what does not depend on the target's format.
pub(super) fn create(mut commands: Commands, device: Res<RenderDevice>) {
    let device = device.wgpu_device();
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("backdrop"),
        source: wgpu::ShaderSource::Wgsl(include_str!("../../../shaders/pass/backdrop.wgsl").into()),
    });
    let (layout, uniform, group) = super::uniform_group(device, "backdrop", size_of::<Uniform>());
    commands.insert_resource(Backdrop { shader, layout, group, uniform, pipeline: None });
}

/// Draws the gradient over the whole viewport; depth stays as it is.
pub(super) fn draw(
    view: ViewQuery<&ViewTarget, With<super::DrawsModel>>,
    backdrop: Option<ResMut<Backdrop>>,
    frame: Res<FrameView>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut ctx: RenderContext,
) {
    let Some(mut backdrop) = backdrop else { return };
    let target = view.into_inner();
    let format = target.main_texture_format();
    if backdrop.pipeline.as_ref().is_none_or(|(f, _)| *f != format) {
        let pipeline = super::pipeline(
            device.wgpu_device(),
            super::PipelineSpec {
                label: "backdrop",
                shader: &backdrop.shader,
                fragment: "fragment",
                layout: &backdrop.layout,
                buffers: &[],
                blend: None,
                depth: None,
                format,
            },
        );
        backdrop.pipeline = Some((format, pipeline));
    }
    let (min, size) = frame.viewport.physical();
    let uniform = Uniform {
        top: linear(frame.palette.sky),
        bottom: linear(frame.palette.ground),
        top_px: min.y as f32,
        height_px: size.y as f32,
        padding: [0.0; 2],
    };
    queue.write_buffer(&backdrop.uniform, 0, bytemuck::bytes_of(&uniform));
    let Some((_, pipeline)) = &backdrop.pipeline else { return };
    let mut pass = ctx.command_encoder().begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("backdrop"),
        color_attachments: &[Some(super::keep(target.main_texture_view()))],
        ..default()
    });
    super::confine(&mut pass, &frame, target.main_texture().size());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &backdrop.group, &[]);
    pass.draw(0..3, 0..1);
}

fn linear(color: Color32) -> [f32; 4] {
    Rgba::from(color).to_array()
}
