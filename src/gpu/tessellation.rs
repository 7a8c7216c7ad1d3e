//! Triangles of a finished tessellation in place of the exact surfaces, in the whole picture or to the right of a divider.
//!
//! They go into the same visibility buffer as the rays, sample by sample, so that both halves of a comparison are shaded,
//! smoothed, picked and highlighted alike and only their geometry differs.

use super::GpuError;
use super::attachments::{group, view_binding};
use super::buffers::{Mirror, Uploaded};
use super::pipelines::{self, Pass};
use super::renderer::Renderer;
use crate::encoding::TessellationScene;
use crate::encoding::view::CAST_FACETS;

/// What is drawn of a tessellation, and where.
#[derive(Debug, Default)]
pub(super) struct Tessellated {
    pass: Option<TessellationPass>,
    /// Share of the width of a picture from which on triangles are drawn; none: nowhere.
    from: Option<f32>,
    facets: bool,
    /// Casts show the exact surfaces all over, triangles are drawn apart.
    apart: bool,
}

/// Pipeline and buffers.
#[derive(Debug)]
struct TessellationPass {
    pass: Pass,
    vertices: Mirror,
    parts: Mirror,
    corners: Mirror,
    levels: Mirror,
    corner_count: u32,
    group: Option<wgpu::BindGroup>,
}

impl TessellationPass {
    fn new(device: &wgpu::Device) -> Self {
        let mirror = |label| Mirror::new(device, label, 4096);
        Self {
            pass: pipelines::tessellation(device),
            vertices: mirror("tessellation vertices"),
            parts: mirror("tessellation parts"),
            corners: mirror("tessellation corners"),
            levels: mirror("tessellation levels"),
            corner_count: 0,
            group: None,
        }
    }

    fn update(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &mut TessellationScene,
    ) -> Result<Uploaded, GpuError> {
        // Nothing is drawn while some of it does not fit.
        self.corner_count = 0;
        let parts = [
            self.vertices.update(device, queue, &mut scene.vertices)?,
            self.parts.update(device, queue, &mut scene.parts)?,
            self.corners.update(device, queue, &mut scene.corners)?,
            self.levels.update(device, queue, &mut scene.levels)?,
        ];
        self.corner_count = scene.corners.data().len() as u32;
        let (bytes, renewed) = parts.iter().fold((0, false), |all, part| (all.0 + part.0, all.1 || part.1));
        if renewed {
            self.group = None;
        }
        Ok(Uploaded { bytes, renewed })
    }
}

impl Tessellated {
    /// Flags of views that it is drawn with.
    pub fn flags(&self) -> u32 {
        if self.facets { CAST_FACETS } else { 0 }
    }

    /// Whether both the exact surfaces and triangles are seen.
    pub fn is_wiped(&self) -> bool {
        self.from.is_some_and(|from| from > 0.0)
    }

    /// How many columns from the left show the exact surfaces.
    pub fn exact_columns(&self, width: u32) -> u32 {
        if self.apart { width } else { self.divider(width) }
    }

    /// The column from which on triangles are shown.
    pub fn divider(&self, width: u32) -> u32 {
        match self.from {
            Some(from) if self.pass.is_some() => ((from * width as f32).round() as u32).min(width),
            _ => width,
        }
    }

    /// Draws the triangles; `view_slot` is the offset of the view's uniform block.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, view_slot: u32, size: [u32; 2]) {
        self.draw_from(pass, view_slot, size, self.exact_columns(size[0]));
    }

    /// The same all over the picture.
    pub fn draw_all(&self, pass: &mut wgpu::RenderPass, view_slot: u32, size: [u32; 2]) {
        self.draw_from(pass, view_slot, size, 0);
    }

    fn draw_from(&self, pass: &mut wgpu::RenderPass, view_slot: u32, [width, height]: [u32; 2], from: u32) {
        let Some(own) = self.pass.as_ref().filter(|own| own.corner_count > 0 && from < width) else { return };
        pass.set_scissor_rect(from, 0, width - from, height);
        pass.set_pipeline(&own.pass.pipeline);
        pass.set_bind_group(0, &own.group, &[view_slot]);
        pass.draw(0..own.corner_count, 0..1);
    }
}

impl Renderer {
    /// Sends the triangles of a tessellation.
    ///
    /// # Errors
    /// An array is larger than the device can bind; no triangles are drawn then.
    pub fn upload_tessellation(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &mut TessellationScene,
    ) -> Result<Uploaded, GpuError> {
        let pass = self.tessellated.pass.get_or_insert_with(|| {
            scene.touch_all();
            TessellationPass::new(device)
        });
        pass.update(device, queue, scene)
    }

    /// From which share of their width on pictures show the triangles that were sent in place of the exact surfaces: 0 all
    /// over; `None`: nowhere. `facets`: flat, not with the normals of the surface. Counts from the next cast on.
    pub fn show_tessellation(&mut self, from: Option<f32>, facets: bool) {
        self.tessellated.from = from;
        self.tessellated.facets = facets && from.is_some();
    }

    /// Casts are of the exact surfaces all over, for [`Self::keep_both`], though triangles are shown somewhere. Counts from the
    /// next cast on.
    pub fn show_both(&mut self, apart: bool) {
        self.tessellated.apart = apart && self.tessellated.from.is_some();
    }

    /// Makes the bind group that drawing uses.
    pub(super) fn prepare_tessellation(&mut self, device: &wgpu::Device) {
        let Some(own) = self.tessellated.pass.as_mut().filter(|own| own.group.is_none()) else { return };
        let mut resources = vec![view_binding(&self.uniforms)];
        let arrays = [&own.vertices, &own.parts, &own.corners, &own.levels];
        resources.extend(arrays.map(|mirror| mirror.buffer.as_entire_binding()));
        own.group = Some(group(device, "tessellation", &own.pass.layout, resources));
    }
}
