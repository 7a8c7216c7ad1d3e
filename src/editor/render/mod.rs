//! From derived data to pixels: extraction, upload and the passes of the viewport.
//!
//! Wiring: `ExtractSchedule` takes over what changed; `Core3d` runs backdrop, model, highlight and lines between
//! Bevy's opaque and transparent passes, so that depth is shared with whatever Bevy draws. The pixel under the
//! pointer and the GPU time come back to `Update` a frame or two later. Everything on the GPU is made in
//! `RenderStartup`, again after a device loss.

mod backdrop;
mod edges;
mod faces;
mod frame;
mod grid;
mod ground;
mod handles;
mod highlight;
mod holes;
mod model;
mod pace;
mod pick;
pub mod quality;
mod ribbons;
mod strokes;
mod tessellation;
mod triangles;
mod wires;

use bevy::core_pipeline::Core3d;
use bevy::core_pipeline::Core3dSystems;
use bevy::core_pipeline::core_3d::{CORE_3D_DEPTH_FORMAT, main_opaque_pass_3d, main_transparent_pass_3d};
use bevy::prelude::*;
use bevy::render::diagnostic::RenderDiagnosticsPlugin;
use bevy::render::sync_world::RenderEntity;
use bevy::render::{Extract, ExtractSchedule, Render, RenderApp, RenderStartup, RenderSystems};
use bevy::shader::Shader;
use bevy_egui::render::EGUI_SHADER_HANDLE;

use super::EditorSystems;
use super::camera::ViewportCamera;
use super::redraw::Waker;

/// Adds the viewport's rendering.
pub struct RenderPlugin;

impl Plugin for RenderPlugin {
    fn build(&self, app: &mut App) {
        let answers = pick::PickAnswers::default();
        let pictures = holes::HolePictures::default();
        // The panels' shader under bevy_egui's handle: its plugin is there already.
        let panels = include_str!("../../../shaders/pass/panels.wgsl");
        let panels = Shader::from_wgsl(panels, "shaders/pass/panels.wgsl");
        if let Err(error) =
            app.world_mut().resource_mut::<Assets<Shader>>().insert(&EGUI_SHADER_HANDLE, panels)
        {
            warn!("the panels keep their slower shader: {error}");
        }
        app.add_plugins(RenderDiagnosticsPlugin)
            .insert_resource(answers.clone())
            .insert_resource(pictures.clone())
            .init_resource::<frame::CastTime>()
            .add_systems(
                Update,
                (pick::deliver, holes::prove, frame::read_cast_time, frame::tell_failure)
                    .before(EditorSystems::Input),
            );
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .insert_resource(answers)
            .insert_resource(pictures)
            .init_resource::<holes::HoleReadback>()
            .init_resource::<frame::FrameView>()
            .init_resource::<faces::RenderFaces>()
            .init_resource::<ribbons::RenderRibbons>()
            .init_resource::<triangles::RenderTriangles>()
            .init_resource::<tessellation::RenderTessellation>()
            .init_resource::<edges::RenderEdges>()
            .init_resource::<handles::ExtractedHandles>()
            .init_resource::<Waker>()
            .add_systems(
                RenderStartup,
                (
                    backdrop::create,
                    ground::create,
                    edges::create,
                    wires::create,
                    model::create,
                    highlight::create,
                    pick::create,
                    handles::create,
                ),
            )
            .add_systems(
                ExtractSchedule,
                (
                    frame::extract,
                    (faces::extract, ribbons::extract, tessellation::extract).chain(),
                    edges::extract,
                    handles::extract,
                    mark,
                ),
            )
            .add_systems(
                Core3d,
                (
                    backdrop::draw,
                    model::draw,
                    highlight::draw,
                    pick::copy,
                    holes::copy,
                    ground::draw,
                    wires::draw,
                    edges::draw,
                    handles::draw,
                )
                    .chain()
                    .after(main_opaque_pass_3d)
                    .before(main_transparent_pass_3d)
                    .in_set(Core3dSystems::MainPass),
            )
            .add_systems(Render, (pick::collect, holes::collect).in_set(RenderSystems::Cleanup));
    }
}

/// Marks the view that shows the model, in the render world.
#[derive(Component, Debug, Clone, Copy, Default)]
pub(crate) struct DrawsModel;

/// Marks the extracted viewport camera.
fn mark(mut commands: Commands, cameras: Extract<Query<RenderEntity, With<ViewportCamera>>>) {
    for entity in &cameras {
        commands.entity(entity).insert(DrawsModel);
    }
}

/// What a pipeline of this folder is made from.
struct PipelineSpec<'a> {
    label: &'static str,
    shader: &'a wgpu::ShaderModule,
    /// Its entry point for pixels; that for vertices is `vertex`.
    fragment: &'static str,
    layout: &'a wgpu::BindGroupLayout,
    buffers: &'a [wgpu::VertexBufferLayout<'a>],
    blend: Option<wgpu::BlendState>,
    depth: Option<wgpu::CompareFunction>,
    format: wgpu::TextureFormat,
}

/// A pipeline with one bind group, triangles.
fn pipeline(device: &wgpu::Device, spec: PipelineSpec) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(spec.label),
        bind_group_layouts: &[Some(spec.layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(spec.label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: spec.shader,
            entry_point: Some("vertex"),
            compilation_options: default(),
            buffers: spec.buffers,
        },
        fragment: Some(wgpu::FragmentState {
            module: spec.shader,
            entry_point: Some(spec.fragment),
            compilation_options: default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: spec.format,
                blend: spec.blend,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        primitive: default(),
        depth_stencil: spec.depth.map(|compare| wgpu::DepthStencilState {
            format: CORE_3D_DEPTH_FORMAT,
            depth_write_enabled: Some(false),
            depth_compare: Some(compare),
            stencil: default(),
            bias: default(),
        }),
        multisample: default(),
        multiview_mask: None,
        cache: None,
    })
}

/// A uniform buffer of `bytes` with the bind group that holds it.
fn uniform_group(
    device: &wgpu::Device,
    label: &'static str,
    bytes: usize,
) -> (wgpu::BindGroupLayout, wgpu::Buffer, wgpu::BindGroup) {
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let uniform = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout: &layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
    });
    (layout, uniform, group)
}

/// An attachment that keeps what was drawn before.
fn keep(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
    }
}

/// Confines a pass to the viewport's rectangle, as far as it lies inside the target.
fn confine(pass: &mut wgpu::RenderPass, frame: &frame::FrameView, target: wgpu::Extent3d) {
    let (min, size) = frame.viewport.physical();
    let min = min.min(UVec2::new(target.width, target.height).saturating_sub(UVec2::ONE));
    let size = size.min(UVec2::new(target.width, target.height) - min);
    pass.set_viewport(min.x as f32, min.y as f32, size.x as f32, size.y as f32, 0.0, 1.0);
    pass.set_scissor_rect(min.x, min.y, size.x, size.y);
}
