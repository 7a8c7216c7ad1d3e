//! Tint of selected and hovered faces over the finished picture.

use bevy::prelude::*;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::ViewTarget;
use bevy_egui::egui::Rgba;

use super::faces::RenderFaces;
use super::frame::FrameView;
use super::model::{ModelPass, covered};

/// Pipeline and buffers.
#[derive(Resource)]
pub(super) struct Highlight {
    shader: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    marks: wgpu::Buffer,
    marks_revision: u64,
    /// With borders, and without.
    pipelines: Option<(wgpu::TextureFormat, [wgpu::RenderPipeline; 2])>,
}

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Uniform {
    selected: [f32; 4],
    hovered: [f32; 4],
    min_px: [f32; 2],
    size_px: [f32; 2],
    buffer_px: [f32; 2],
    border_px: f32,
    padding: f32,
}

fn marks_buffer(device: &wgpu::Device, slots: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("marks"),
        size: (4 * slots.max(64)) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Makes what does not depend on the target's format.
pub(super) fn create(mut commands: Commands, device: Res<RenderDevice>) {
    let device = device.wgpu_device();
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("highlight"),
        source: wgpu::ShaderSource::Wgsl(include_str!("../../../shaders/pass/highlight.wgsl").into()),
    });
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("highlight"),
        entries: &[
            entry(0, buffer(wgpu::BufferBindingType::Uniform)),
            entry(
                1,
                wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Uint,
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
            ),
            entry(2, buffer(wgpu::BufferBindingType::Storage { read_only: true })),
        ],
    });
    let uniform = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("highlight"),
        size: size_of::<Uniform>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let marks = marks_buffer(device, 64);
    commands.insert_resource(Highlight {
        shader,
        layout,
        uniform,
        marks,
        marks_revision: 0,
        pipelines: None,
    });
}

/// Draws the tint, if anything is marked.
pub(super) fn draw(
    view: ViewQuery<&ViewTarget, With<super::DrawsModel>>,
    mut highlight: ResMut<Highlight>,
    model: Res<ModelPass>,
    faces: Res<RenderFaces>,
    frame: Res<FrameView>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut ctx: RenderContext,
) {
    let Some((_, renderer)) = &model.renderer else { return };
    if faces.marks.iter().all(|m| *m == 0) || model.casts == 0 {
        return;
    }
    let (target, highlight) = (view.into_inner(), &mut *highlight);
    let device = device.wgpu_device();
    if highlight.marks.size() < 4 * faces.marks.len() as u64 {
        highlight.marks = marks_buffer(device, 2 * faces.marks.len());
        highlight.marks_revision = 0;
    }
    if highlight.marks_revision != faces.marks_revision {
        highlight.marks_revision = faces.marks_revision;
        queue.write_buffer(&highlight.marks, 0, bytemuck::cast_slice(&faces.marks));
    }
    let format = target.main_texture_format();
    if highlight.pipelines.as_ref().is_none_or(|(f, _)| *f != format) {
        let make = |fragment| {
            let spec = super::PipelineSpec {
                label: "highlight",
                shader: &highlight.shader,
                fragment,
                layout: &highlight.layout,
                buffers: &[],
                blend: Some(wgpu::BlendState::ALPHA_BLENDING),
                depth: None,
                format,
            };
            super::pipeline(device, spec)
        };
        highlight.pipelines = Some((format, [make("fragment"), make("fragment_plain")]));
    }
    let (min, size) = frame.viewport.physical();
    let buffer = renderer.shown().size;
    let color = |color, strength| {
        let c = Rgba::from(color).to_array();
        [c[0], c[1], c[2], strength]
    };
    let light = frame.palette.light;
    let coarse = buffer[0] < size.x;
    let uniform = Uniform {
        selected: color(frame.palette.accent, if light { 0.5 } else { 0.45 }),
        hovered: if light { [0.0, 0.12, 0.30, 0.14] } else { [1.0, 1.0, 1.0, 0.10] },
        min_px: min.as_vec2().to_array(),
        size_px: size.as_vec2().to_array(),
        buffer_px: [buffer[0] as f32, buffer[1] as f32],
        border_px: 1.2 * frame.viewport.scale_factor,
        padding: 0.0,
    };
    queue.write_buffer(&highlight.uniform, 0, bytemuck::bytes_of(&uniform));
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("highlight"),
        layout: &highlight.layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: highlight.uniform.as_entire_binding() },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&renderer.shown().visibility_view),
            },
            wgpu::BindGroupEntry { binding: 2, resource: highlight.marks.as_entire_binding() },
        ],
    });
    let Some((_, pipelines)) = &highlight.pipelines else { return };
    let scissor = covered(&frame, target.main_texture().size());
    let mut pass = ctx.command_encoder().begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("highlight"),
        color_attachments: &[Some(super::keep(target.main_texture_view()))],
        ..default()
    });
    super::confine(&mut pass, &frame, target.main_texture().size());
    if let Some([x, y, width, height]) = scissor {
        pass.set_scissor_rect(x, y, width, height);
    }
    pass.set_pipeline(&pipelines[usize::from(coarse)]);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
}
