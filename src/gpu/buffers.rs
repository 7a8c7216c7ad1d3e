//! The scene's arrays as storage buffers, kept up to date range by range.

use bytemuck::Pod;

use super::GpuError;
use crate::encoding::PackedScene;
use crate::encoding::arena::Arena;

/// One array on the GPU.
#[derive(Debug)]
pub(super) struct Mirror {
    label: &'static str,
    pub buffer: wgpu::Buffer,
}

impl Mirror {
    pub fn new(device: &wgpu::Device, label: &'static str, size: u64) -> Self {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let descriptor =
            wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        Self { label, buffer: device.create_buffer(&descriptor) }
    }

    /// Sends what changed; makes the buffer anew, with room to grow, when it is too small. Says how many
    /// bytes were sent and whether the buffer is a new one.
    pub fn update<T: Pod>(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        arena: &mut Arena<T>,
    ) -> Result<(u64, bool), GpuError> {
        let bytes = size_of_val(arena.data()) as u64;
        let limit = device.limits().max_storage_buffer_binding_size;
        if bytes > limit {
            return Err(GpuError::TooLarge { what: self.label, bytes, limit });
        }
        let renewed = bytes > self.buffer.size();
        if renewed {
            let size = (bytes + bytes / 2).min(limit).next_multiple_of(256).max(bytes);
            *self = Self::new(device, self.label, size);
            arena.touch_all();
        }
        let mut sent = 0;
        for range in arena.take_dirty() {
            let values = &arena.data()[range.start as usize..range.end as usize];
            let bytes: &[u8] = bytemuck::cast_slice(values);
            queue.write_buffer(&self.buffer, u64::from(range.start) * size_of::<T>() as u64, bytes);
            sent += bytes.len() as u64;
        }
        Ok((sent, renewed))
    }
}

/// What an upload did.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Uploaded {
    /// Bytes sent.
    pub bytes: u64,
    /// Whether a buffer was made anew, so that bind groups must be too.
    pub renewed: bool,
}

/// All arrays of a scene.
#[derive(Debug)]
pub struct SceneBuffers {
    cells: Mirror,
    points: Mirror,
    faces: Mirror,
    trim_cells: Mirror,
    trim_entries: Mirror,
    trim_data: Mirror,
    order: Mirror,
}

impl SceneBuffers {
    /// Empty buffers.
    pub fn new(device: &wgpu::Device) -> Self {
        let make = |label| Mirror::new(device, label, 4096);
        Self {
            cells: make("cells"),
            points: make("points"),
            faces: make("faces"),
            trim_cells: make("trim cells"),
            trim_entries: make("trim entries"),
            trim_data: make("trim data"),
            order: make("order"),
        }
    }

    /// Sends what changed in `scene` since the last upload.
    ///
    /// # Errors
    /// An array is larger than the device can bind.
    pub fn update(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &mut PackedScene,
    ) -> Result<Uploaded, GpuError> {
        let parts = [
            self.cells.update(device, queue, &mut scene.cells)?,
            self.points.update(device, queue, &mut scene.points)?,
            self.faces.update(device, queue, &mut scene.faces)?,
            self.trim_cells.update(device, queue, &mut scene.trim_cells)?,
            self.trim_entries.update(device, queue, &mut scene.trim_entries)?,
            self.trim_data.update(device, queue, &mut scene.trim_data)?,
            self.order.update(device, queue, scene.order.words())?,
        ];
        Ok(parts.iter().fold(Uploaded::default(), |sum, (bytes, renewed)| Uploaded {
            bytes: sum.bytes + bytes,
            renewed: sum.renewed || *renewed,
        }))
    }

    /// The list of cells to draw.
    pub fn order(&self) -> &wgpu::Buffer {
        &self.order.buffer
    }

    /// Faces and trims, in the order of the bindings 1 to 4 of `pass/trims.wgsl`.
    pub fn trims(&self) -> [&wgpu::Buffer; 4] {
        [&self.faces, &self.trim_cells, &self.trim_entries, &self.trim_data].map(|m| &m.buffer)
    }

    /// Cells and their control points.
    pub fn cells(&self) -> [&wgpu::Buffer; 2] {
        [&self.cells, &self.points].map(|m| &m.buffer)
    }

    /// The face table.
    pub fn faces(&self) -> &wgpu::Buffer {
        &self.faces.buffer
    }
}
