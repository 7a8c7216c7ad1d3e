//! Rays into the visibility buffer: a whole picture at once, or band after band.

use std::ops::Range;

use super::attachments::{group, visibility_pass};
use super::buffers::SceneBuffers;
use super::renderer::{Renderer, Sample};
use super::targets::{Targets, within};
use crate::encoding::View;
use crate::encoding::options::cast_flags;

impl Renderer {
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
        let mut view = View::new(&sample.camera, size, sample.jitter, sample.depth, cast_flags(sample.mode));
        view.flags |= self.tessellated.flags();
        let whole = rows == (0..size[1]);
        let slot = self.write_uniform(queue, bytemuck::bytes_of(&view));
        self.fit_nearest(device, size);
        if self.cast_group.is_none() {
            self.cast_group = Some(self.make_cast_group(device));
        }
        self.prepare_tessellation(device);
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
        let columns = self.tessellated.exact_columns(targets.size[0]);
        let mut pass = begin_visibility(encoder, "cast", targets, &self.nearest, first);
        if self.order_count > 0 && !rows.is_empty() && columns > 0 {
            pass.set_scissor_rect(0, rows.start, columns, rows.end - rows.start);
            pass.set_pipeline(&self.pipelines.cast.pipeline);
            pass.set_bind_group(0, &self.cast_group, &[slot]);
            pass.draw(0..14, 0..self.order_count);
        }
        if rows.end == targets.size[1] {
            self.tessellated.draw(&mut pass, slot, targets.size);
        }
    }

    fn make_cast_group(&self, device: &wgpu::Device) -> wgpu::BindGroup {
        let view = self.uniform_binding(size_of::<View>());
        let resources = cast_resources(view, &self.buffers, self.buffers.order(), &self.nearest);
        group(device, "cast", &self.pipelines.cast.layout, resources)
    }

    /// Makes room for the nearest depths of a picture.
    pub(super) fn fit_nearest(&mut self, device: &wgpu::Device, size: [u32; 2]) {
        if self.nearest.size() < nearest_bytes(size) {
            self.nearest = nearest_buffer(device, size);
            self.cast_group = None;
            if let Some(mesh) = &mut self.mesh {
                mesh.renew();
            }
        }
    }
}

/// What the cast pass is bound to; `order`: the cells that it draws.
pub(super) fn cast_resources<'a>(
    view: wgpu::BindingResource<'a>,
    buffers: &'a SceneBuffers,
    order: &'a wgpu::Buffer,
    nearest: &'a wgpu::Buffer,
) -> Vec<wgpu::BindingResource<'a>> {
    let mut resources = vec![view];
    let arrays = buffers.trims().into_iter().chain([order]).chain(buffers.cells()).chain([nearest]);
    resources.extend(arrays.map(wgpu::Buffer::as_entire_binding));
    resources
}

pub(super) fn nearest_bytes(size: [u32; 2]) -> u64 {
    4 * u64::from(size[0]) * u64::from(size[1])
}

pub(super) fn nearest_buffer(device: &wgpu::Device, size: [u32; 2]) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("nearest depths"),
        size: nearest_bytes(size),
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// A pass into visibility and depth; `first` clears them and the nearest depths.
pub(super) fn begin_visibility<'a>(
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
