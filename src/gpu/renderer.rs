//! The renderer: scene buffers, targets and the three passes of a picture.

use std::ops::Range;

use glam::DVec3;

use super::GpuError;
use super::buffers::{SceneBuffers, Uploaded};
use super::mesh::MeshPass;
use super::pipelines::Pipelines;
use super::ribbons::RibbonPass;
use super::targets::{Sum, Targets, within};
use crate::encoding::options::cast_flags;
use crate::encoding::view::DepthRange;
use crate::encoding::{
    DisplayMode, EdgeLook, EdgeStyle, FaceSlot, Look, MeshScene, PackedScene, RibbonScene, RibbonSpan, Theme,
    View,
};
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
    pipelines: Pipelines,
    buffers: SceneBuffers,
    uniforms: wgpu::Buffer,
    next_slot: u64,
    order_count: u32,
    sampler: wgpu::Sampler,
    /// Rays of the last complete cast, and what sees them.
    targets: Targets,
    view: View,
    /// Rays of a cast by rows under way, and what sees them.
    next: Option<(Targets, View)>,
    sum: Sum,
    /// Of each pixel the nearest depth hit so far; cleared with the depth of a cast.
    nearest: wgpu::Buffer,
    cast_group: Option<wgpu::BindGroup>,
    resolve_group: Option<wgpu::BindGroup>,
    present_group: Option<wgpu::BindGroup>,
    samples: u32,
    /// Made when triangles are first drawn.
    mesh: Option<MeshPass>,
    /// Made when fat lines or edges are first drawn.
    ribbons: Option<RibbonPass>,
    /// Whether the picture shown has its holes filled, and whether what was filled stands out.
    concealed: bool,
    difference: bool,
    format: wgpu::TextureFormat,
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
            ribbons: None,
            concealed: false,
            difference: false,
            format,
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

    /// Sends the triangles that [`MeshScene::select`] chose; call after [`Self::upload`] and before
    /// [`Self::draw_meshes`]. `lacking`: the faces that it has no triangles of, which are cast.
    ///
    /// # Errors
    /// An array is larger than the device can bind.
    pub fn upload_meshes(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        meshes: &mut MeshScene,
        scene: &PackedScene,
        lacking: &[FaceSlot],
    ) -> Result<Uploaded, GpuError> {
        let mesh = self.mesh.get_or_insert_with(|| {
            meshes.touch_all();
            MeshPass::new(device)
        });
        mesh.update(device, queue, meshes, scene, lacking)
    }

    /// Sends packed curves for [`Self::conceal`] and [`Self::draw_edges`].
    ///
    /// # Errors
    /// An array is larger than the device can bind.
    pub fn upload_ribbons(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        ribbons: &mut RibbonScene,
    ) -> Result<u64, GpuError> {
        let format = self.format;
        let pass = self.ribbons.get_or_insert_with(|| {
            ribbons.touch_all();
            RibbonPass::new(device, format)
        });
        pass.update(device, queue, ribbons)
    }

    /// Sends how edges look, by their numbers; call after [`Self::upload_ribbons`].
    ///
    /// # Errors
    /// There are more than the device can bind.
    pub fn set_edge_looks(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        looks: &[EdgeLook],
    ) -> Result<(), GpuError> {
        self.ribbons.as_mut().map_or(Ok(()), |pass| pass.set_looks(device, queue, looks))
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
        let filled = self.ribbons.as_ref().and_then(|pass| pass.targets.as_ref());
        filled.filter(|_| self.concealed).unwrap_or(&self.targets)
    }

    /// Draws edges along `spans` in the looks set, over `target`, hidden behind what is nearer in `depth`.
    #[expect(clippy::too_many_arguments, reason = "what a pass reads and writes, each by name")]
    pub fn draw_edges(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        (target, depth): (&wgpu::TextureView, &wgpu::TextureView),
        sample: &Sample,
        spans: &[RibbonSpan],
        viewport: Option<[u32; 4]>,
    ) {
        let view =
            View::new(&sample.camera, sample.size, sample.jitter, sample.depth, cast_flags(sample.mode));
        let slot = self.write_uniform(queue, bytemuck::bytes_of(&view));
        let uniform = view_binding(&self.uniforms);
        let Some(ribbons) = &mut self.ribbons else { return };
        let attachment = wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        };
        let mut pass = full_screen(encoder, "edges", target, wgpu::LoadOp::Load, Some(attachment));
        if let Some([x, y, width, height]) = viewport {
            pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
        }
        ribbons.draw_edges(device, queue, (uniform, slot), &self.buffers, spans, &mut pass);
    }

    /// Draws one sample from triangles, trimmed per pixel, in place of [`Self::cast`].
    pub fn draw_meshes(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        sample: &Sample,
    ) {
        let size = within(device, sample.size);
        let view = View::new(&sample.camera, size, sample.jitter, sample.depth, cast_flags(sample.mode));
        let slot = self.write_uniform(queue, bytemuck::bytes_of(&view));
        if self.targets.size != size {
            self.targets = Targets::new(device, size);
            self.resolve_group = None;
            self.present_group = None;
        }
        self.next = None;
        self.view = view;
        self.fit_nearest(device, size);
        self.reveal();
        let uniform = view_binding(&self.uniforms);
        let cast = &self.pipelines.cast;
        let Some(mesh) = &mut self.mesh else { return };
        mesh.prepare(device, uniform, &self.buffers, &self.nearest, cast);
        let mut pass = begin_visibility(encoder, "mesh", &self.targets, &self.nearest, true);
        mesh.draw(&mut pass, slot, cast);
    }

    /// Makes room for the nearest depths of a picture.
    fn fit_nearest(&mut self, device: &wgpu::Device, size: [u32; 2]) {
        if self.nearest.size() < nearest_bytes(size) {
            self.nearest = nearest_buffer(device, size);
            self.cast_group = None;
            if let Some(mesh) = &mut self.mesh {
                mesh.renew();
            }
        }
    }

    /// Casts the rays of one sample.
    pub fn cast(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        sample: &Sample,
    ) {
        self.cast_rows(device, queue, encoder, sample, 0..u32::MAX);
    }

    /// Casts the rays of some rows of a sample: all of them, or band after band from row 0 on with the same
    /// sample. What [`Self::shade`] and [`Self::present`] see is the last complete cast until the last row
    /// is there; a cast that starts at row 0 drops one that was not completed.
    pub fn cast_rows(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        sample: &Sample,
        rows: Range<u32>,
    ) {
        let size = within(device, sample.size);
        let rows = rows.start.min(size[1])..rows.end.min(size[1]);
        let view = View::new(&sample.camera, size, sample.jitter, sample.depth, cast_flags(sample.mode));
        let whole = rows == (0..size[1]);
        let slot = self.write_uniform(queue, bytemuck::bytes_of(&view));
        self.fit_nearest(device, size);
        if self.cast_group.is_none() {
            self.cast_group = Some(self.make_cast_group(device));
        }
        if rows.end == size[1] {
            self.reveal();
        }
        if whole && self.targets.size == size {
            // In place: a picture in one go needs no second set of textures.
            self.view = view;
            self.draw_rays(encoder, &self.targets, slot, rows);
            return;
        }
        let next = match self.next.take() {
            Some((targets, _)) if targets.size == size => targets,
            _ => Targets::new(device, size),
        };
        self.draw_rays(encoder, &next, slot, rows.clone());
        if rows.end == size[1] {
            let last = std::mem::replace(&mut self.targets, next);
            // Kept for the next cast by rows, if there was one.
            self.next = (!whole).then_some((last, self.view));
            self.view = view;
            self.resolve_group = None;
            self.present_group = None;
        } else {
            self.next = Some((next, view));
        }
    }

    fn draw_rays(&self, encoder: &mut wgpu::CommandEncoder, targets: &Targets, slot: u32, rows: Range<u32>) {
        let first = rows.start == 0;
        let mut pass = begin_visibility(encoder, "cast", targets, &self.nearest, first);
        if self.order_count > 0 && !rows.is_empty() {
            pass.set_scissor_rect(0, rows.start, targets.size[0], rows.end - rows.start);
            pass.set_pipeline(&self.pipelines.cast.pipeline);
            pass.set_bind_group(0, &self.cast_group, &[slot]);
            pass.draw(0..14, 0..self.order_count);
        }
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
        let mut look = Look::new(&self.view, mode, edges, Theme::Transparent);
        look.difference = u32::from(self.difference);
        let slot = self.write_uniform(queue, bytemuck::bytes_of(&look));
        if self.resolve_group.is_none() {
            self.resolve_group = Some(self.make_resolve_group(device));
        }
        let load = if first { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
        self.samples = if first { 1 } else { self.samples + 1 };
        let mut pass = full_screen(encoder, "shade", &self.sum.view, load, None);
        pass.set_pipeline(&self.pipelines.resolve.pipeline);
        pass.set_bind_group(0, &self.resolve_group, &[slot]);
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

    fn write_uniform(&mut self, queue: &wgpu::Queue, bytes: &[u8]) -> u32 {
        let offset = (self.next_slot % SLOTS) * SLOT_BYTES;
        self.next_slot += 1;
        queue.write_buffer(&self.uniforms, offset, bytes);
        offset as u32
    }

    fn uniform_binding(&self, size: usize) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &self.uniforms,
            offset: 0,
            size: wgpu::BufferSize::new(size as u64),
        })
    }

    fn make_cast_group(&self, device: &wgpu::Device) -> wgpu::BindGroup {
        let mut resources =
            vec![self.uniform_binding(size_of::<View>()), self.buffers.order().as_entire_binding()];
        resources.extend(self.buffers.bindings().map(|b| b.as_entire_binding()));
        resources.push(self.nearest.as_entire_binding());
        group(device, "cast", &self.pipelines.cast.layout, resources)
    }

    fn make_resolve_group(&self, device: &wgpu::Device) -> wgpu::BindGroup {
        let resources = vec![
            self.uniform_binding(size_of::<Look>()),
            wgpu::BindingResource::TextureView(&self.shown().visibility_view),
            wgpu::BindingResource::TextureView(&self.shown().depth_view),
            self.buffers.faces().as_entire_binding(),
            wgpu::BindingResource::TextureView(&self.targets.visibility_view),
        ];
        group(device, "shade", &self.pipelines.resolve.layout, resources)
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

fn nearest_bytes(size: [u32; 2]) -> u64 {
    4 * u64::from(size[0]) * u64::from(size[1])
}

fn nearest_buffer(device: &wgpu::Device, size: [u32; 2]) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("nearest depths"),
        size: nearest_bytes(size),
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// The view's uniform block, at a dynamic offset.
fn view_binding(uniforms: &wgpu::Buffer) -> wgpu::BindingResource<'_> {
    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
        buffer: uniforms,
        offset: 0,
        size: wgpu::BufferSize::new(size_of::<View>() as u64),
    })
}

/// A pass into visibility and depth; `first` clears them and the nearest depths.
fn begin_visibility<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    targets: &Targets,
    nearest: &wgpu::Buffer,
    first: bool,
) -> wgpu::RenderPass<'a> {
    if first {
        encoder.clear_buffer(nearest, 0, Some(nearest_bytes(targets.size)));
    }
    visibility_pass(encoder, label, targets, first)
}

/// A pass into visibility and depth; `first` clears them.
pub(super) fn visibility_pass<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    targets: &Targets,
    first: bool,
) -> wgpu::RenderPass<'a> {
    let clear = |value: wgpu::Color| if first { wgpu::LoadOp::Clear(value) } else { wgpu::LoadOp::Load };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &targets.visibility_view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &targets.depth_view,
            depth_ops: Some(wgpu::Operations {
                load: if first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load },
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

pub(super) fn group(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: Vec<wgpu::BindingResource>,
) -> wgpu::BindGroup {
    let entries: Vec<_> = resources
        .into_iter()
        .enumerate()
        .map(|(k, resource)| wgpu::BindGroupEntry { binding: k as u32, resource })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}

fn full_screen<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    label: &str,
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
    depth: Option<wgpu::RenderPassDepthStencilAttachment>,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: depth,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}
