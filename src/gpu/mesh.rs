//! The second renderer: triangles of the untrimmed surfaces, trimmed per pixel by the same functions as the rays
//! (Schollmeyer & Froehlich 2009, section 5, figure 10), into the same visibility buffer.
//!
//! What is drawn is what [`MeshScene::select`] chose; faces that have no triangles are cast in the same pass.

use super::GpuError;
use super::attachments::{group, view_binding};
use super::buffers::{Mirror, SceneBuffers, Uploaded};
use super::casting::{begin_visibility, cast_resources};
use super::pipelines::{self, Pass};
use super::renderer::{Renderer, Sample};
use super::targets::{Targets, within};
use crate::encoding::options::cast_flags;
use crate::encoding::view::{CAST_HEAT, CAST_TRIM};
use crate::encoding::{FaceSlot, MeshScene, PackedScene, View};

/// Buffers, pipelines and draw lists.
#[derive(Debug)]
pub(super) struct MeshPass {
    /// For the lists of [`MeshScene::ends`].
    passes: [Pass; 3],
    vertices: Mirror,
    origins: Mirror,
    indices: wgpu::Buffer,
    /// Where lists end in the indices.
    ends: [u32; 3],
    revision: Option<u64>,
    /// For each pipeline.
    groups: Option<[wgpu::BindGroup; 3]>,
    /// Cells of the faces without triangles.
    order: wgpu::Buffer,
    order_count: u32,
    cast_group: Option<wgpu::BindGroup>,
    lacking: (Vec<FaceSlot>, Option<u64>),
}

impl MeshPass {
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            passes: pipelines::meshes(device),
            vertices: Mirror::new(device, "mesh vertices", 4096),
            origins: Mirror::new(device, "mesh origins", 4096),
            indices: buffer(device, "mesh indices", 4096, wgpu::BufferUsages::INDEX),
            ends: [0; 3],
            revision: None,
            groups: None,
            order: buffer(device, "mesh order", 4096, wgpu::BufferUsages::STORAGE),
            order_count: 0,
            cast_group: None,
            lacking: (Vec::new(), None),
        }
    }

    /// Sends what changed. `lacking`: the faces to cast.
    pub fn update(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        meshes: &mut MeshScene,
        scene: &PackedScene,
        lacking: &[FaceSlot],
    ) -> Result<Uploaded, GpuError> {
        let (mut bytes, first) = self.vertices.update(device, queue, &mut meshes.vertices)?;
        let (more, second) = self.origins.update(device, queue, &mut meshes.origins)?;
        bytes += more;
        if first || second {
            self.groups = None;
        }
        if self.revision != Some(meshes.revision()) {
            let data: &[u8] = bytemuck::cast_slice(meshes.indices());
            fit(device, &mut self.indices, "mesh indices", data.len(), wgpu::BufferUsages::INDEX);
            queue.write_buffer(&self.indices, 0, data);
            self.ends = meshes.ends().map(|end| end as u32);
            self.revision = Some(meshes.revision());
            bytes += data.len() as u64;
        }
        if self.lacking.0 != lacking || self.lacking.1 != Some(scene.revision()) {
            let order: Vec<u32> = lacking.iter().flat_map(|slot| scene.cells_of(*slot)).collect();
            let data: &[u8] = bytemuck::cast_slice(&order);
            if fit(device, &mut self.order, "mesh order", data.len(), wgpu::BufferUsages::STORAGE) {
                self.cast_group = None;
            }
            queue.write_buffer(&self.order, 0, data);
            self.order_count = order.len() as u32;
            self.lacking = (lacking.to_vec(), Some(scene.revision()));
            bytes += data.len() as u64;
        }
        Ok(Uploaded { bytes, renewed: first || second })
    }

    /// The scene's buffers were made anew.
    pub fn renew(&mut self) {
        self.groups = None;
        self.cast_group = None;
    }

    /// Makes the bind groups that [`Self::draw`] uses.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        uniform: wgpu::BindingResource,
        buffers: &SceneBuffers,
        nearest: &wgpu::Buffer,
        cast: &Pass,
    ) {
        if self.groups.is_none() {
            let arrays = || buffers.trims().into_iter().chain([&self.vertices.buffer, &self.origins.buffer]);
            self.groups = Some(self.passes.each_ref().map(|pass| {
                let mut resources = vec![uniform.clone()];
                resources.extend(arrays().map(wgpu::Buffer::as_entire_binding));
                group(device, "mesh", &pass.layout, resources)
            }));
        }
        if self.cast_group.is_none() {
            let resources = cast_resources(uniform, buffers, &self.order, nearest);
            self.cast_group = Some(group(device, "mesh rays", &cast.layout, resources));
        }
    }

    /// Draws triangles, those that need no trimming first, then casts what has none; `view_slot` is the offset of the view's
    /// uniform block.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, view_slot: u32, flags: u32, cast: &Pass) {
        let [whole, lone, all] = self.ends;
        // What the grid takes to tell is asked for as a picture: then it is asked everywhere.
        let ends = match (flags & CAST_TRIM != 0, flags & CAST_HEAT != 0) {
            (false, _) => [all; 3],
            (true, true) => [whole, whole, all],
            (true, false) => [whole, lone, all],
        };
        let mut from = 0;
        for ((with, group), end) in self.passes.iter().zip(self.groups.iter().flatten()).zip(ends) {
            if from < end {
                pass.set_pipeline(&with.pipeline);
                pass.set_bind_group(0, group, &[view_slot]);
                pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(from..end, 0, 0..1);
            }
            from = end;
        }
        if self.order_count > 0 {
            pass.set_pipeline(&cast.pipeline);
            pass.set_bind_group(0, &self.cast_group, &[view_slot]);
            pass.draw(0..14, 0..self.order_count);
        }
    }
}

impl Renderer {
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

    /// Draws one sample from triangles, trimmed per pixel, in place of [`Self::cast`].
    pub fn draw_meshes(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        sample: &Sample,
    ) {
        let size = within(device, sample.size);
        let mut view = View::new(&sample.camera, size, sample.jitter, sample.depth, cast_flags(sample.mode));
        view.flags |= self.tessellated.flags();
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
        self.prepare_tessellation(device);
        let uniform = view_binding(&self.uniforms);
        let cast = &self.pipelines.cast;
        let columns = self.tessellated.exact_columns(size[0]);
        if let Some(mesh) = &mut self.mesh {
            mesh.prepare(device, uniform, &self.buffers, &self.nearest, cast);
        }
        let mut pass = begin_visibility(encoder, "mesh", &self.targets, &self.nearest, true);
        if let Some(mesh) = self.mesh.as_ref().filter(|_| columns > 0) {
            pass.set_scissor_rect(0, 0, columns, size[1]);
            mesh.draw(&mut pass, slot, view.flags, cast);
        }
        self.tessellated.draw(&mut pass, slot, size);
    }
}

/// Bindings of the pass: the view and six arrays.
pub(super) fn bindings() -> Vec<wgpu::BindingType> {
    let mut list = vec![pipelines::uniform(size_of::<View>())];
    list.extend([pipelines::STORAGE; 6]);
    list
}

fn buffer(device: &wgpu::Device, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    let usage = usage | wgpu::BufferUsages::COPY_DST;
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage,
        mapped_at_creation: false,
    })
}

/// Makes a buffer anew if `bytes` do not fit. Says whether it did.
fn fit(
    device: &wgpu::Device,
    held: &mut wgpu::Buffer,
    label: &str,
    bytes: usize,
    usage: wgpu::BufferUsages,
) -> bool {
    let small = bytes as u64 > held.size();
    if small {
        *held = buffer(device, label, (bytes as u64 * 3 / 2).next_multiple_of(256), usage);
    }
    small
}
