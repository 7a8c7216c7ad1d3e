//! Strips along exact trim curves, evaluated by the vertex stage: fat lines that conceal holes, and edges in colours.
//!
//! Fat lines are drawn into a copy of the rays' textures, so that both pictures stay at hand.

use super::GpuError;
use super::buffers::{Mirror, SceneBuffers};
use super::pipelines::{self, Pass};
use super::renderer::{group, visibility_pass};
use super::targets::Targets;
use crate::encoding::arena::Arena;
use crate::encoding::ribbon::SEGMENTS;
use crate::encoding::{EdgeLook, RibbonScene, RibbonSpan};

/// Corners of the strip of a span.
const CORNERS: u32 = 2 * (SEGMENTS + 1);

/// A list of spans on the GPU.
#[derive(Debug)]
struct Spans {
    buffer: wgpu::Buffer,
    count: u32,
}

impl Spans {
    fn new(device: &wgpu::Device, bytes: u64) -> Self {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("ribbon spans"),
            size: bytes,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { buffer, count: 0 }
    }

    fn write(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, spans: &[RibbonSpan]) {
        let bytes: &[u8] = bytemuck::cast_slice(spans);
        if bytes.len() as u64 > self.buffer.size() {
            *self = Self::new(device, (bytes.len() as u64 * 3 / 2).next_multiple_of(256));
        }
        queue.write_buffer(&self.buffer, 0, bytes);
        self.count = spans.len() as u32;
    }
}

/// Buffers, pipelines and the concealed picture.
#[derive(Debug)]
pub(super) struct RibbonPass {
    conceal: Pass,
    edges: Pass,
    pieces: Mirror,
    points: Mirror,
    curves: Mirror,
    looks: Mirror,
    look_data: Arena<EdgeLook>,
    conceal_spans: Spans,
    edge_spans: Spans,
    /// The rays' picture with holes filled.
    pub targets: Option<Targets>,
}

impl RibbonPass {
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let mirror = |label| Mirror::new(device, label, 4096);
        Self {
            conceal: pipelines::conceal(device),
            edges: pipelines::edges(device, format),
            pieces: mirror("ribbon pieces"),
            points: mirror("ribbon patches"),
            curves: mirror("ribbon curves"),
            looks: mirror("edge looks"),
            look_data: Arena::default(),
            conceal_spans: Spans::new(device, 4096),
            edge_spans: Spans::new(device, 4096),
            targets: None,
        }
    }

    pub fn update(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        ribbons: &mut RibbonScene,
    ) -> Result<u64, GpuError> {
        let (pieces, _) = self.pieces.update(device, queue, &mut ribbons.pieces)?;
        let (points, _) = self.points.update(device, queue, &mut ribbons.points)?;
        let (curves, _) = self.curves.update(device, queue, &mut ribbons.curves)?;
        Ok(pieces + points + curves)
    }

    pub fn set_looks(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        looks: &[EdgeLook],
    ) -> Result<(), GpuError> {
        self.look_data = Arena::default();
        self.look_data.insert(looks);
        self.looks.update(device, queue, &mut self.look_data).map(|_| ())
    }

    fn resources<'a>(
        &'a self,
        uniform: wgpu::BindingResource<'a>,
        spans: &'a Spans,
        scene: &'a SceneBuffers,
    ) -> Vec<wgpu::BindingResource<'a>> {
        let buffers =
            [&self.pieces.buffer, &spans.buffer, &self.points.buffer, &self.curves.buffer, scene.faces()];
        let mut resources = vec![uniform];
        resources.extend(buffers.map(wgpu::Buffer::as_entire_binding));
        resources
    }

    /// Copies `raw` and fills its holes along `spans`.
    #[expect(clippy::too_many_arguments, reason = "what a pass reads and writes, each by name")]
    pub fn fill(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        (uniform, slot): (wgpu::BindingResource, u32),
        scene: &SceneBuffers,
        raw: &Targets,
        spans: &[RibbonSpan],
    ) {
        self.conceal_spans.write(device, queue, spans);
        let targets = match self.targets.take() {
            Some(targets) if targets.size == raw.size => targets,
            _ => Targets::new(device, raw.size),
        };
        for (from, to) in [(&raw.visibility, &targets.visibility), (&raw.depth, &targets.depth)] {
            encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
        }
        let mut resources = self.resources(uniform, &self.conceal_spans, scene);
        resources.push(wgpu::BindingResource::TextureView(&raw.visibility_view));
        resources.push(wgpu::BindingResource::TextureView(&raw.depth_view));
        let bind_group = group(device, "conceal", &self.conceal.layout, resources);
        if self.conceal_spans.count > 0 {
            let mut pass = visibility_pass(encoder, "conceal", &targets, false);
            pass.set_pipeline(&self.conceal.pipeline);
            pass.set_bind_group(0, &bind_group, &[slot]);
            pass.draw(0..CORNERS, 0..self.conceal_spans.count);
        }
        self.targets = Some(targets);
    }

    /// Draws edges in their looks into a pass with the surfaces' depth.
    pub fn draw_edges(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        (uniform, slot): (wgpu::BindingResource, u32),
        scene: &SceneBuffers,
        spans: &[RibbonSpan],
        pass: &mut wgpu::RenderPass,
    ) {
        self.edge_spans.write(device, queue, spans);
        if spans.is_empty() || self.look_data.data().is_empty() {
            return;
        }
        let mut resources = self.resources(uniform, &self.edge_spans, scene);
        resources.push(self.looks.buffer.as_entire_binding());
        let bind_group = group(device, "edges", &self.edges.layout, resources);
        pass.set_pipeline(&self.edges.pipeline);
        pass.set_bind_group(0, &bind_group, &[slot]);
        pass.draw(0..CORNERS, 0..self.edge_spans.count);
    }
}
