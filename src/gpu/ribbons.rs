//! Fat lines: strips along exact trim curves, evaluated by the vertex stage, that conceal holes. They are drawn into a
//! copy of the rays' textures, so that both pictures stay at hand.

use super::GpuError;
use super::attachments::{group, view_binding, visibility_pass};
use super::buffers::{Mirror, SceneBuffers};
use super::pipelines::{self, Pass};
use super::renderer::Renderer;
use super::targets::Targets;
use crate::encoding::ribbon::SEGMENTS;
use crate::encoding::{RibbonScene, RibbonSpan};
use crate::reference::ribbon::ROUNDS;

/// Corners of the strip of a span: a pair between segments, and one beyond each end.
const CORNERS: u32 = 2 * (SEGMENTS + 3);

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
    pieces: Mirror,
    points: Mirror,
    curves: Mirror,
    spans: Spans,
    /// The rays' picture with holes filled, after the last round and the one before.
    targets: Option<[Targets; 2]>,
}

impl RibbonPass {
    pub fn new(device: &wgpu::Device) -> Self {
        let mirror = |label| Mirror::new(device, label, 4096);
        Self {
            conceal: pipelines::conceal(device),
            pieces: mirror("ribbon pieces"),
            points: mirror("ribbon patches"),
            curves: mirror("ribbon curves"),
            spans: Spans::new(device, 4096),
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

    fn resources<'a>(
        &'a self,
        uniform: wgpu::BindingResource<'a>,
        scene: &'a SceneBuffers,
    ) -> Vec<wgpu::BindingResource<'a>> {
        let buffers = [
            &self.pieces.buffer,
            &self.spans.buffer,
            &self.points.buffer,
            &self.curves.buffer,
            scene.faces(),
        ];
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
        self.spans.write(device, queue, spans);
        let mut targets = match self.targets.take() {
            Some(targets) if targets[0].size == raw.size => targets,
            _ => [Targets::new(device, raw.size), Targets::new(device, raw.size)],
        };
        for round in 0..ROUNDS {
            let [to, before] = &targets;
            let from = if round == 0 { raw } else { before };
            for (from, to) in [(&from.visibility, &to.visibility), (&from.depth, &to.depth)] {
                encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
            }
            let mut resources = self.resources(uniform.clone(), scene);
            resources.push(wgpu::BindingResource::TextureView(&from.visibility_view));
            resources.push(wgpu::BindingResource::TextureView(&from.depth_view));
            let bind_group = group(device, "conceal", &self.conceal.layout, resources);
            if self.spans.count > 0 {
                let mut pass = visibility_pass(encoder, "conceal", to, false);
                pass.set_pipeline(&self.conceal.pipeline);
                pass.set_bind_group(0, &bind_group, &[slot]);
                pass.draw(0..CORNERS, 0..self.spans.count);
            }
            if round + 1 < ROUNDS {
                targets.swap(0, 1);
            }
        }
        self.targets = Some(targets);
    }

    /// The picture with holes filled.
    fn filled(&self) -> Option<&Targets> {
        self.targets.as_ref().map(|[filled, _]| filled)
    }
}

impl Renderer {
    /// Sends packed curves for [`Self::conceal`].
    ///
    /// # Errors
    /// An array is larger than the device can bind.
    pub fn upload_ribbons(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        ribbons: &mut RibbonScene,
    ) -> Result<u64, GpuError> {
        let pass = self.ribbons.get_or_insert_with(|| {
            ribbons.touch_all();
            RibbonPass::new(device)
        });
        pass.update(device, queue, ribbons)
    }

    /// Fills holes between faces along `spans` in a copy of the last complete cast, which is then what
    /// [`Self::shade`] and [`Self::present`] see, until the next cast. `difference`: shading is to tell what was filled.
    pub fn conceal(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        spans: &[RibbonSpan],
        difference: bool,
    ) {
        let view = self.view;
        let slot = self.write_uniform(queue, bytemuck::bytes_of(&view));
        let uniform = view_binding(&self.uniforms);
        let Some(pass) = &mut self.ribbons else { return };
        pass.fill(device, queue, encoder, (uniform, slot), &self.buffers, &self.targets, spans);
        self.concealed = true;
        self.difference = difference;
        self.resolve_group = None;
        self.present_group = None;
    }

    /// Shows the picture as the rays left it.
    pub fn reveal(&mut self) {
        if self.concealed {
            self.concealed = false;
            self.difference = false;
            self.resolve_group = None;
            self.present_group = None;
        }
    }

    /// The textures that are shown.
    pub fn shown(&self) -> &Targets {
        let filled = self.ribbons.as_ref().and_then(RibbonPass::filled);
        filled.filter(|_| self.concealed).unwrap_or(&self.targets)
    }
}
