//! Both pictures of a comparison, kept whole: the divider between the exact surfaces and their triangles moves without
//! anything being cast or shaded anew.
//!
//! A picture is its visibility, depth and accumulated colour. What is shown, picked and highlighted are the renderer's own
//! textures, put together from the columns of both.

use super::attachments::{group, visibility_pass};
use super::pipelines::{self, Pass};
use super::renderer::Renderer;
use super::targets::{Sum, Targets};
use crate::encoding::{DisplayMode, EdgeStyle};

/// The two pictures and what puts them together.
#[derive(Debug)]
pub(super) struct Both {
    compose: Pass,
    exact: Picture,
    triangles: Picture,
    /// Samples in each; 0: they show nothing.
    samples: u32,
}

#[derive(Debug)]
struct Picture {
    targets: Targets,
    sum: Sum,
}

impl Picture {
    fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        Self { targets: Targets::new(device, size), sum: Sum::new(device, size) }
    }
}

impl Renderer {
    /// Whether both pictures of a comparison are kept, so that [`Self::wipe`] can put them together.
    pub fn has_both(&self) -> bool {
        self.both.as_ref().is_some_and(|both| both.samples > 0)
    }

    /// What is kept is not what is to be shown any more.
    pub fn forget_both(&mut self) {
        if !self.tessellated.is_wiped() {
            self.both = None;
        } else if let Some(both) = &mut self.both {
            both.samples = 0;
        }
    }

    /// Takes the last complete cast, which must be of the exact surfaces all over ([`Self::show_both`]), as a sample of one
    /// picture, draws the triangles as the same sample of the other, shades both, and puts them together at the divider.
    /// `first` starts both anew.
    pub fn keep_both(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        (mode, edges): (DisplayMode, EdgeStyle),
        first: bool,
    ) {
        let size = self.targets.size;
        let kept = self
            .both
            .take()
            .map(|both| if both.exact.targets.size == size { Ok(both) } else { Err(both.compose) });
        let mut both = kept.unwrap_or_else(|| Err(pipelines::wipe(device))).unwrap_or_else(|compose| Both {
            compose,
            exact: Picture::new(device, size),
            triangles: Picture::new(device, size),
            samples: 0,
        });
        std::mem::swap(&mut self.targets, &mut both.exact.targets);
        let view = self.view;
        let slot = self.write_uniform(queue, bytemuck::bytes_of(&view));
        self.prepare_tessellation(device);
        let mut pass = visibility_pass(encoder, "triangles", &both.triangles.targets, true);
        self.tessellated.draw_all(&mut pass, slot, size);
        drop(pass);
        let first = first || both.samples == 0;
        self.both = Some(both);
        self.shade_both(device, queue, encoder, (mode, edges), first);
    }

    /// Shades the last sample of both pictures and puts them together; `first` starts their sums anew.
    pub fn shade_both(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        (mode, edges): (DisplayMode, EdgeStyle),
        first: bool,
    ) {
        let shading = self.prepare_shading(device, queue, mode, edges);
        let Some(mut both) = self.both.take() else { return };
        for picture in [&both.exact, &both.triangles] {
            let group = self.resolve_group_of(device, shading.0, &picture.targets);
            self.draw_shaded(encoder, shading, &group, &picture.targets, &picture.sum, first);
        }
        both.samples = if first { 1 } else { both.samples + 1 };
        self.samples = both.samples;
        self.both = Some(both);
        self.wipe(device, encoder);
    }

    /// Puts the kept pictures together at the divider ([`Self::show_tessellation`]).
    pub fn wipe(&mut self, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder) {
        let Some(both) = self.both.as_ref().filter(|both| both.samples > 0) else { return };
        let size = both.exact.targets.size;
        if self.targets.size != size {
            self.targets = Targets::new(device, size);
        }
        if self.sum.size != size {
            self.sum = Sum::new(device, size);
        }
        let clear = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("wipe"),
            color_attachments: &[clear(&self.targets.visibility_view), clear(&self.sum.view)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.targets.depth_view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&both.compose.pipeline);
        let divider = self.tessellated.divider(size[0]);
        for (picture, columns) in [(&both.exact, 0..divider), (&both.triangles, divider..size[0])] {
            if columns.is_empty() {
                continue;
            }
            let views = [&picture.targets.visibility_view, &picture.sum.view, &picture.targets.depth_view];
            let resources = views.map(wgpu::BindingResource::TextureView).to_vec();
            let bound = group(device, "wipe", &both.compose.layout, resources);
            pass.set_scissor_rect(columns.start, 0, columns.end - columns.start, size[1]);
            pass.set_bind_group(0, &bound, &[]);
            pass.draw(0..3, 0..1);
        }
        drop(pass);
        // The textures may have changed places.
        self.resolve_group = None;
        self.present_group = None;
    }
}
