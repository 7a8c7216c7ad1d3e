//! The renderer: scene buffers, targets, and the passes from a visibility buffer to a picture. What fills the visibility
//! buffer has files of its own: rays (`casting`), triangles (`mesh`) and fat lines (`ribbons`).

use glam::DVec3;

use super::GpuError;
use super::attachments::{full_screen, group};
use super::buffers::{SceneBuffers, Uploaded};
use super::casting::nearest_buffer;
use super::mesh::MeshPass;
use super::pipelines::{self, Pass, Pipelines, Shading};
use super::ribbons::RibbonPass;
use super::targets::{Sum, Targets};
use super::tessellation::Tessellated;
use super::wipe::Both;
use crate::encoding::view::DepthRange;
use crate::encoding::{DisplayMode, EdgeStyle, Look, PackedScene, Theme, View};
use crate::kernel::view::Camera;

/// One sample of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Camera.
    pub camera: Camera,
    /// Depth planes; [`DepthRange::around`] for pictures of their own, the host's planes for mixing.
    pub depth: DepthRange,
    /// Size of the visibility buffer in pixels.
    pub size: [u32; 2],
    /// Shift of the samples within their pixels, -0.5..0.5.
    pub jitter: [f32; 2],
    /// What is drawn.
    pub mode: DisplayMode,
}

/// Uniform blocks kept per renderer: enough for the samples of one submission.
const SLOTS: u64 = 64;
const SLOT_BYTES: u64 = 512;

/// Draws packed scenes on a `wgpu` device.
#[derive(Debug)]
pub struct Renderer {
    pub(super) pipelines: Pipelines,
    /// Those that shade, by kind, made when first needed. Bind groups of one fit all.
    shading: [Option<Pass>; 4],
    pub(super) buffers: SceneBuffers,
    pub(super) uniforms: wgpu::Buffer,
    pub(super) next_slot: u64,
    pub(super) order_count: u32,
    pub(super) sampler: wgpu::Sampler,
    /// Rays of the last complete cast, and what sees them.
    pub(super) targets: Targets,
    pub(super) view: View,
    /// Rays of a cast by rows under way, and what sees them.
    pub(super) next: Option<(Targets, View)>,
    pub(super) sum: Sum,
    /// Of each pixel the nearest depth hit so far; cleared with the depth of a cast.
    pub(super) nearest: wgpu::Buffer,
    pub(super) cast_group: Option<wgpu::BindGroup>,
    pub(super) resolve_group: Option<wgpu::BindGroup>,
    pub(super) present_group: Option<wgpu::BindGroup>,
    pub(super) samples: u32,
    /// Made when triangles are first drawn.
    pub(super) mesh: Option<MeshPass>,
    /// Triangles in place of faces.
    pub(super) tessellated: Tessellated,
    /// Both pictures of a comparison with triangles, kept apart.
    pub(super) both: Option<Both>,
    /// Made when fat lines are first drawn.
    pub(super) ribbons: Option<RibbonPass>,
    /// Whether the picture shown has its holes filled, and whether what was filled stands out.
    pub(super) concealed: bool,
    pub(super) difference: bool,
}

impl Renderer {
    /// A renderer that presents into targets of `format`; colours are encoded unless the format does that.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let uniforms = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("uniforms"),
            size: SLOTS * SLOT_BYTES,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self {
            pipelines: Pipelines::new(device, format),
            shading: Default::default(),
            buffers: SceneBuffers::new(device),
            uniforms,
            next_slot: 0,
            order_count: 0,
            sampler,
            targets: Targets::new(device, [1, 1]),
            view: bytemuck::Zeroable::zeroed(),
            next: None,
            sum: Sum::new(device, [1, 1]),
            nearest: nearest_buffer(device, [1, 1]),
            cast_group: None,
            resolve_group: None,
            present_group: None,
            samples: 0,
            mesh: None,
            tessellated: Tessellated::default(),
            both: None,
            ribbons: None,
            concealed: false,
            difference: false,
        }
    }

    /// Sends what changed in `scene`; call before [`Self::cast`] whenever it may have changed.
    ///
    /// # Errors
    /// An array is larger than the device can bind.
    pub fn upload(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &mut PackedScene,
    ) -> Result<Uploaded, GpuError> {
        let uploaded = self.buffers.update(device, queue, scene)?;
        self.order_count = scene.order.words().data().len() as u32;
        if uploaded.renewed {
            self.cast_group = None;
            self.resolve_group = None;
            if let Some(mesh) = &mut self.mesh {
                mesh.renew();
            }
        }
        Ok(uploaded)
    }

    /// Shades the visibility buffer and adds it to the sum; `first` starts a new sum.
    pub fn shade(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        mode: DisplayMode,
        edges: EdgeStyle,
        first: bool,
    ) {
        let resized = self.sum.size != self.targets.size;
        if resized {
            self.sum = Sum::new(device, self.targets.size);
            self.present_group = None;
        }
        let first = first || resized;
        let shading = self.prepare_shading(device, queue, mode, edges);
        let bound = match self.resolve_group.take() {
            Some(bound) => bound,
            None => self.resolve_group_of(device, shading.0, self.shown()),
        };
        self.samples = if first { 1 } else { self.samples + 1 };
        self.draw_shaded(encoder, shading, &bound, self.shown(), &self.sum, first);
        self.resolve_group = Some(bound);
    }

    /// Makes the pipeline that shading takes and writes its uniform block: position of the one, offset of the other.
    pub(super) fn prepare_shading(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        mode: DisplayMode,
        edges: EdgeStyle,
    ) -> (usize, u32) {
        let mut look = Look::new(&self.view, mode, edges, Theme::Transparent);
        look.difference = u32::from(self.difference);
        let slot = self.write_uniform(queue, bytemuck::bytes_of(&look));
        let plain = look.mode == Look::SHADED && look.difference == 0;
        let shading = Shading { plain, edges: edges.visible };
        self.shading[shading.index()].get_or_insert_with(|| pipelines::resolve(device, shading));
        (shading.index(), slot)
    }

    /// Shades `targets`, bound by `bound`, and adds them to `sum`; `first` starts it anew.
    pub(super) fn draw_shaded(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (shading, slot): (usize, u32),
        bound: &wgpu::BindGroup,
        targets: &Targets,
        sum: &Sum,
        first: bool,
    ) {
        let Some(resolve) = &self.shading[shading] else { return };
        let load = if first { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
        // Read only: the program reads the same texture.
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &targets.depth_view,
            depth_ops: None,
            stencil_ops: None,
        };
        let mut pass = full_screen(encoder, "shade", &sum.view, load, Some(depth));
        pass.set_pipeline(&resolve.pipeline);
        pass.set_bind_group(0, bound, &[slot]);
        pass.draw(0..3, 0..1);
    }

    /// Puts the sum over the background into `target`. With `depth` the surfaces are depth tested and
    /// blended over what is there, and the background must be [`Theme::Transparent`] to keep it.
    pub fn present(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        depth: Option<&wgpu::TextureView>,
        presentation: &Presentation,
    ) {
        let mut look = Look::new(&self.view, DisplayMode::Shaded, EdgeStyle::default(), presentation.theme);
        look.samples = self.samples.max(1) as f32;
        let slot = self.write_uniform(queue, bytemuck::bytes_of(&look));
        if self.present_group.is_none() {
            self.present_group = Some(self.make_present_group(device));
        }
        let attachment = depth.map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        });
        let load =
            if depth.is_some() { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
        let mut pass = full_screen(encoder, "present", target, load, attachment);
        let chosen = if depth.is_some() { &self.pipelines.present } else { &self.pipelines.present_flat };
        pass.set_pipeline(&chosen.pipeline);
        pass.set_bind_group(0, &self.present_group, &[slot]);
        if let Some([x, y, width, height]) = presentation.viewport {
            pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
        }
        if let Some([x, y, width, height]) = presentation.scissor {
            pass.set_scissor_rect(x, y, width, height);
        }
        pass.draw(0..3, 0..1);
    }

    /// The rays of the last complete cast, for reading back.
    pub fn targets(&self) -> &Targets {
        &self.targets
    }

    /// The view of the last cast.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Samples in the sum.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Cells drawn by each cast, and places kept free for more.
    pub fn cell_count(&self) -> u32 {
        self.order_count
    }

    pub(super) fn write_uniform(&mut self, queue: &wgpu::Queue, bytes: &[u8]) -> u32 {
        let offset = (self.next_slot % SLOTS) * SLOT_BYTES;
        self.next_slot += 1;
        queue.write_buffer(&self.uniforms, offset, bytes);
        offset as u32
    }

    pub(super) fn uniform_binding(&self, size: usize) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &self.uniforms,
            offset: 0,
            size: wgpu::BufferSize::new(size as u64),
        })
    }

    /// Binds `targets` to be shaded; what is filled in them tells the difference to the last cast.
    pub(super) fn resolve_group_of(
        &self,
        device: &wgpu::Device,
        shading: usize,
        targets: &Targets,
    ) -> wgpu::BindGroup {
        let resolve = self.shading[shading].as_ref().expect("invariant: made by prepare_shading");
        let resources = vec![
            self.uniform_binding(size_of::<Look>()),
            wgpu::BindingResource::TextureView(&targets.visibility_view),
            wgpu::BindingResource::TextureView(&targets.depth_view),
            self.buffers.faces().as_entire_binding(),
            wgpu::BindingResource::TextureView(&self.targets.visibility_view),
        ];
        group(device, "shade", &resolve.layout, resources)
    }

    fn make_present_group(&self, device: &wgpu::Device) -> wgpu::BindGroup {
        let resources = vec![
            self.uniform_binding(size_of::<Look>()),
            wgpu::BindingResource::TextureView(&self.sum.view),
            wgpu::BindingResource::Sampler(&self.sampler),
            wgpu::BindingResource::TextureView(&self.shown().depth_view),
        ];
        group(device, "present", &self.pipelines.present.layout, resources)
    }
}

/// How a picture is put into its target.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Presentation {
    /// Background.
    pub theme: Theme,
    /// x, y, width and height in target pixels; `None`: the whole target.
    pub viewport: Option<[u32; 4]>,
    /// The only pixels that may be drawn, in the same way, inside the target.
    pub scissor: Option<[u32; 4]>,
}

/// A sphere around a scene for [`DepthRange::around`].
pub fn bounding_sphere(scene: &PackedScene) -> (DVec3, f64) {
    let bounds = scene.bounds();
    (bounds.centre(), 0.5 * bounds.diagonal())
}
