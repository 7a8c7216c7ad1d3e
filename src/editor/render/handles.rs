//! Handles over the model: lines and marks of constant width, faded where the model hides them.
//!
//! Everything is drawn twice: where it is in front of the model, and faintly where it is behind. The depth of
//! both is taken a little nearer than it is, because trim curves lie on the surface.

use std::sync::Arc;

use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::{ViewDepthTexture, ViewTarget};
use bevy_egui::egui::{Color32, Rgba};
use glam::DVec3;

use super::frame::FrameView;
use super::grid::LineInstance;
use crate::editor::handles::{HandleDrawing, HandlePicture};

/// Opacity of what is hidden.
const HIDDEN: f32 = 0.22;
/// Depth is multiplied by this: lines on a surface win against it.
const NEARER: f32 = 1.002;
/// For marks, which are wider.
const MUCH_NEARER: f32 = 1.004;

/// What the main world wants drawn.
#[derive(Resource, Default)]
pub(super) struct ExtractedHandles(Arc<HandlePicture>);

/// Takes over the picture.
pub(super) fn extract(mut handles: ResMut<ExtractedHandles>, drawing: Extract<Option<Res<HandleDrawing>>>) {
    if let Some(drawing) = drawing.as_ref()
        && !Arc::ptr_eq(&handles.0, &drawing.picture)
    {
        handles.0 = Arc::clone(&drawing.picture);
    }
}

/// A mark as the shader gets it.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct MarkInstance {
    at: [f32; 3],
    fill: [f32; 4],
    line: [f32; 4],
    size_px: f32,
    round: f32,
}

impl MarkInstance {
    fn layout() -> wgpu::VertexBufferLayout<'static> {
        const ATTRIBUTES: [wgpu::VertexAttribute; 5] = wgpu::vertex_attr_array![
            0 => Float32x3, 1 => Float32x4, 2 => Float32x4, 3 => Float32, 4 => Float32
        ];
        wgpu::VertexBufferLayout {
            array_stride: size_of::<MarkInstance>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &ATTRIBUTES,
        }
    }
}

/// What both shaders get once.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Uniform {
    clip_from_relative: [[f32; 4]; 4],
    fade: [f32; 4],
    size_px: [f32; 2],
    depth_scale: f32,
    opacity: f32,
}

/// A uniform of its own for each of the four draws.
struct Draw {
    group: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
}

/// Pipelines and buffers.
#[derive(Resource)]
pub(super) struct HandlePass {
    lines: wgpu::ShaderModule,
    marks: wgpu::ShaderModule,
    /// Lines hidden, lines in front, marks hidden, marks in front.
    draws: [Draw; 4],
    line_buffer: wgpu::Buffer,
    mark_buffer: wgpu::Buffer,
    pipelines: Option<(wgpu::TextureFormat, [wgpu::RenderPipeline; 4])>,
}

fn instance_buffer(device: &wgpu::Device, bytes: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("handles"),
        size: bytes.next_power_of_two().max(1024) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Makes what does not depend on the target's format.
pub(super) fn create(mut commands: Commands, device: Res<RenderDevice>) {
    let device = device.wgpu_device();
    let shader = |label, source: &'static str| {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        })
    };
    let draw = |_| {
        let (layout, uniform, group) = super::uniform_group(device, "handles", size_of::<Uniform>());
        Draw { group, uniform, layout }
    };
    commands.insert_resource(HandlePass {
        lines: shader("handle lines", include_str!("../../../shaders/pass/lines.wgsl")),
        marks: shader("handle marks", include_str!("../../../shaders/pass/marks.wgsl")),
        draws: [0, 1, 2, 3].map(draw),
        line_buffer: instance_buffer(device, 0),
        mark_buffer: instance_buffer(device, 0),
        pipelines: None,
    });
}

fn rgba(color: Color32) -> [f32; 4] {
    Rgba::from(color).to_rgba_unmultiplied()
}

/// Draws the handles, if there are any.
pub(super) fn draw(
    view: ViewQuery<(&ViewTarget, &ViewDepthTexture), With<super::DrawsModel>>,
    pass: Option<ResMut<HandlePass>>,
    handles: Res<ExtractedHandles>,
    frame: Res<FrameView>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut ctx: RenderContext,
) {
    let Some(mut pass) = pass else { return };
    let picture = &handles.0;
    if picture.lines.is_empty() && picture.marks.is_empty() {
        return;
    }
    let (target, depth) = view.into_inner();
    let (pass, device) = (&mut *pass, device.wgpu_device());
    prepare_pipelines(pass, device, target.main_texture_format());
    let eye = frame.camera.eye;
    let pixels = frame.viewport.scale_factor;
    let relative = |p: DVec3| (p - eye).as_vec3().to_array();
    let line = |l: &crate::editor::handles::HandleLine| {
        LineInstance::new(relative(l.start), relative(l.end), rgba(l.color), pixels * l.width_px)
    };
    let lines: Vec<LineInstance> = picture.lines.iter().map(line).collect();
    let mark = |m: &crate::editor::handles::HandleMark| MarkInstance {
        at: relative(m.at),
        fill: rgba(m.fill),
        line: rgba(m.line),
        size_px: pixels * m.size_px,
        round: f32::from(u8::from(m.round)),
    };
    let marks: Vec<MarkInstance> = picture.marks.iter().map(mark).collect();
    upload(device, &queue, &mut pass.line_buffer, bytemuck::cast_slice(&lines));
    upload(device, &queue, &mut pass.mark_buffer, bytemuck::cast_slice(&marks));
    let (_, size) = frame.viewport.physical();
    for (k, draw) in pass.draws.iter().enumerate() {
        let uniform = Uniform {
            clip_from_relative: frame.clip.for_shader().to_cols_array_2d(),
            // Nothing fades with the distance.
            fade: [0.0, 0.0, 0.0, 1e30],
            size_px: [size.x as f32, size.y as f32],
            depth_scale: if k < 2 { NEARER } else { MUCH_NEARER },
            opacity: if k % 2 == 0 { HIDDEN } else { 1.0 },
        };
        queue.write_buffer(&draw.uniform, 0, bytemuck::bytes_of(&uniform));
    }
    let Some((_, pipelines)) = &pass.pipelines else { return };
    let mut render = ctx.command_encoder().begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("handles"),
        color_attachments: &[Some(super::keep(target.main_texture_view()))],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth.view(),
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..default()
    });
    super::confine(&mut render, &frame, target.main_texture().size());
    for (k, (pipeline, draw)) in pipelines.iter().zip(&pass.draws).enumerate() {
        let (buffer, count) =
            if k < 2 { (&pass.line_buffer, lines.len()) } else { (&pass.mark_buffer, marks.len()) };
        if count == 0 {
            continue;
        }
        render.set_pipeline(pipeline);
        render.set_bind_group(0, &draw.group, &[]);
        render.set_vertex_buffer(0, buffer.slice(..));
        render.draw(0..6, 0..count as u32);
    }
}

fn prepare_pipelines(pass: &mut HandlePass, device: &wgpu::Device, format: wgpu::TextureFormat) {
    if pass.pipelines.as_ref().is_some_and(|(f, _)| *f == format) {
        return;
    }
    let pipeline = |k: usize| {
        let layouts = if k < 2 { [LineInstance::layout()] } else { [MarkInstance::layout()] };
        // Depth is reversed: what is behind has less.
        let behind = wgpu::CompareFunction::Less;
        let before = wgpu::CompareFunction::GreaterEqual;
        super::pipeline(
            device,
            super::PipelineSpec {
                label: "handles",
                shader: if k < 2 { &pass.lines } else { &pass.marks },
                layout: &pass.draws[k].layout,
                buffers: &layouts,
                blend: Some(wgpu::BlendState::ALPHA_BLENDING),
                depth: Some(if k % 2 == 0 { behind } else { before }),
                format,
            },
        )
    };
    pass.pipelines = Some((format, [0, 1, 2, 3].map(pipeline)));
}

fn upload(device: &wgpu::Device, queue: &wgpu::Queue, buffer: &mut wgpu::Buffer, bytes: &[u8]) {
    if buffer.size() < bytes.len() as u64 {
        *buffer = instance_buffer(device, bytes.len());
    }
    if !bytes.is_empty() {
        queue.write_buffer(buffer, 0, bytes);
    }
}
