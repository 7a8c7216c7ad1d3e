//! What axes, edges and handles share: lines and marks of constant width in pixels, one instance each, tested against
//! the depth of the model.

use bevy::math::UVec2;
use bevy::render::renderer::RenderContext;
use bevy::render::view::{ViewDepthTexture, ViewTarget};
use bevy_egui::egui::{Color32, Rgba};

use super::frame::FrameView;
use crate::editor::camera::clip::ClipView;

/// Mirror of `StrokeView` in `shaders/layout/strokes.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Uniform {
    pub clip_from_relative: [[f32; 4]; 4],
    pub fade: [f32; 4],
    pub size_px: [f32; 2],
    pub depth: f32,
    pub opacity: f32,
}

impl Uniform {
    /// For strokes that do not fade with distance and are as far as they are.
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

/// One line as the shader gets it: relative to the eye.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct LineInstance {
    pub start: [f32; 3],
    pub end: [f32; 3],
    /// Linear RGB, not premultiplied.
    pub color: [f32; 4],
    pub width_px: f32,
}

impl LineInstance {
    /// A line between two points relative to the eye; colour linear, not premultiplied.
    pub fn new(start: [f32; 3], end: [f32; 3], color: [f32; 4], width_px: f32) -> Self {
        Self { start, end, color, width_px }
    }

    /// How the buffer is read.
    fn layout() -> wgpu::VertexBufferLayout<'static> {
        const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
            wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32];
        wgpu::VertexBufferLayout {
            array_stride: size_of::<LineInstance>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &ATTRIBUTES,
        }
    }
}

/// A mark as the shader gets it.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct MarkInstance {
    pub at: [f32; 3],
    pub fill: [f32; 4],
    pub line: [f32; 4],
    pub size_px: f32,
    pub round: f32,
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

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stroke {
    Lines,
    Marks,
}

impl Stroke {
    fn source(self) -> &'static str {
        match self {
            Self::Lines => concat!(
                include_str!("../../../shaders/layout/strokes.wgsl"),
                include_str!("../../../shaders/pass/lines.wgsl")
            ),
            Self::Marks => concat!(
                include_str!("../../../shaders/layout/strokes.wgsl"),
                include_str!("../../../shaders/pass/marks.wgsl")
            ),
        }
    }

    fn layout(self) -> wgpu::VertexBufferLayout<'static> {
        match self {
            Self::Lines => LineInstance::layout(),
            Self::Marks => MarkInstance::layout(),
        }
    }
}

/// One draw: a pipeline, its uniform block and its instances.
pub(super) struct StrokeDraw {
    label: &'static str,
    stroke: Stroke,
    /// Of the (reversed) depth with what is there.
    compare: wgpu::CompareFunction,
    shader: wgpu::ShaderModule,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    instances: wgpu::Buffer,
    count: u32,
    pipeline: Option<(wgpu::TextureFormat, wgpu::RenderPipeline)>,
}

fn instance_buffer(device: &wgpu::Device, label: &str, bytes: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.next_power_of_two().max(1024) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

impl StrokeDraw {
    /// Makes what does not depend on the target's format.
    pub fn new(
        device: &wgpu::Device,
        label: &'static str,
        stroke: Stroke,
        compare: wgpu::CompareFunction,
    ) -> Self {
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(stroke.source().into()),
        });
        let (layout, uniform, group) = super::uniform_group(device, label, size_of::<Uniform>());
        let instances = instance_buffer(device, label, 0);
        Self { label, stroke, compare, shader, layout, group, uniform, instances, count: 0, pipeline: None }
    }

    /// Sends what the next [`Self::draw`] into a target of `format` draws.
    pub fn prepare<T: bytemuck::NoUninit>(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        format: wgpu::TextureFormat,
        uniform: &Uniform,
        instances: &[T],
    ) {
        if self.pipeline.as_ref().is_none_or(|(f, _)| *f != format) {
            let spec = super::PipelineSpec {
                label: self.label,
                shader: &self.shader,
                fragment: "fragment",
                layout: &self.layout,
                buffers: &[self.stroke.layout()],
                blend: Some(wgpu::BlendState::ALPHA_BLENDING),
                depth: Some(self.compare),
                format,
            };
            self.pipeline = Some((format, super::pipeline(device, spec)));
        }
        let bytes: &[u8] = bytemuck::cast_slice(instances);
        if self.instances.size() < bytes.len() as u64 {
            self.instances = instance_buffer(device, self.label, bytes.len());
        }
        self.count = instances.len() as u32;
        if self.count > 0 {
            queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(uniform));
            queue.write_buffer(&self.instances, 0, bytes);
        }
    }

    /// Draws them.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        if let Some((_, pipeline)) = self.pipeline.as_ref().filter(|_| self.count > 0) {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.set_vertex_buffer(0, self.instances.slice(..));
            pass.draw(0..6, 0..self.count);
        }
    }
}

/// Draws over the viewport what was prepared, tested against the depth of the model.
pub(super) fn draw_all(
    draws: &[StrokeDraw],
    label: &str,
    target: (&ViewTarget, &ViewDepthTexture),
    frame: &FrameView,
    ctx: &mut RenderContext,
) {
    let mut pass = begin(label, target, frame, ctx);
    draws.iter().for_each(|draw| draw.draw(&mut pass));
}

/// A pass over the viewport for such draws.
pub(super) fn begin<'a>(
    label: &str,
    (target, depth): (&ViewTarget, &ViewDepthTexture),
    frame: &FrameView,
    ctx: &'a mut RenderContext,
) -> wgpu::RenderPass<'a> {
    let mut pass = ctx.command_encoder().begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(super::keep(target.main_texture_view()))],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth.view(),
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    super::confine(&mut pass, frame, target.main_texture().size());
    pass
}

/// An opaque colour as the shader gets it.
pub(super) fn ink([r, g, b]: [u8; 3]) -> [f32; 4] {
    Rgba::from(Color32::from_rgb(r, g, b)).to_array()
}
