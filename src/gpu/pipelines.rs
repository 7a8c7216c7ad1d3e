//! Pipelines and bind-group layouts of the three passes.

use super::shaders;
use super::targets::{DEPTH_FORMAT, SUM_FORMAT, VISIBILITY_FORMAT};
use crate::encoding::{Look, View};

/// A pipeline with the layout of its only bind group.
#[derive(Debug)]
pub struct Pass {
    /// Pipeline.
    pub pipeline: wgpu::RenderPipeline,
    /// Layout of group 0.
    pub layout: wgpu::BindGroupLayout,
}

/// All pipelines.
#[derive(Debug)]
pub struct Pipelines {
    /// Casts rays.
    pub cast: Pass,
    /// Shades, adding to the sum.
    pub resolve: Pass,
    /// Presents with depth.
    pub present: Pass,
    /// Presents colour only.
    pub present_flat: Pass,
}

pub(super) fn uniform(size: usize) -> wgpu::BindingType {
    wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: true,
        min_binding_size: wgpu::BufferSize::new(size as u64),
    }
}

pub(super) const STORAGE: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Storage { read_only: true },
    has_dynamic_offset: false,
    min_binding_size: None,
};

/// Written by the fragment stage.
const WRITABLE: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Storage { read_only: false },
    has_dynamic_offset: false,
    min_binding_size: None,
};

const fn texture(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}

struct Recipe<'a> {
    label: &'a str,
    source: &'a str,
    fragment: &'a str,
    bindings: &'a [wgpu::BindingType],
    target: wgpu::ColorTargetState,
    depth: Option<wgpu::CompareFunction>,
    /// Triangle strips, and which of their sides are left out.
    strip: Option<Option<wgpu::Face>>,
}

impl Pipelines {
    /// Makes all pipelines; `format` is the target's that [`present`](super::Renderer::present) draws to.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let mut cast_bindings = vec![uniform(size_of::<View>())];
        cast_bindings.extend([STORAGE; 7]);
        cast_bindings.push(WRITABLE);
        let look = uniform(size_of::<Look>());
        let add = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let unblended =
            |format| wgpu::ColorTargetState { format, blend: None, write_mask: wgpu::ColorWrites::ALL };
        let over = wgpu::ColorTargetState {
            blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            ..unblended(format)
        };
        let present_bindings = [
            look,
            texture(wgpu::TextureSampleType::Float { filterable: true }),
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            texture(wgpu::TextureSampleType::Depth),
        ];
        let (present_fragment, flat_fragment) = match format.is_srgb() {
            true => ("fragment_linear", "fragment_flat_linear"),
            false => ("fragment", "fragment_flat"),
        };
        let present = |fragment, target, depth| Recipe {
            label: "present",
            source: shaders::PRESENT,
            fragment,
            bindings: &present_bindings,
            target,
            depth,
            strip: None,
        };
        Self {
            cast: build(
                device,
                &Recipe {
                    label: "cast",
                    source: shaders::CAST,
                    fragment: "fragment",
                    bindings: &cast_bindings,
                    target: unblended(VISIBILITY_FORMAT),
                    depth: Some(wgpu::CompareFunction::Greater),
                    strip: Some(Some(wgpu::Face::Front)),
                },
            ),
            resolve: build(
                device,
                &Recipe {
                    label: "resolve",
                    source: shaders::RESOLVE,
                    fragment: "fragment",
                    bindings: &[
                        look,
                        texture(wgpu::TextureSampleType::Uint),
                        texture(wgpu::TextureSampleType::Depth),
                        STORAGE,
                        texture(wgpu::TextureSampleType::Uint),
                    ],
                    target: wgpu::ColorTargetState {
                        blend: Some(wgpu::BlendState { color: add, alpha: add }),
                        ..unblended(SUM_FORMAT)
                    },
                    depth: None,
                    strip: None,
                },
            ),
            present: build(
                device,
                &present(present_fragment, over.clone(), Some(wgpu::CompareFunction::GreaterEqual)),
            ),
            present_flat: build(device, &present(flat_fragment, unblended(format), None)),
        }
    }
}

/// The pipeline that fills holes in a copy of the visibility buffer.
pub(super) fn conceal(device: &wgpu::Device) -> Pass {
    let mut bindings = vec![uniform(size_of::<View>())];
    bindings.extend([STORAGE; 5]);
    bindings.extend([texture(wgpu::TextureSampleType::Uint), texture(wgpu::TextureSampleType::Depth)]);
    build(
        device,
        &Recipe {
            label: "conceal",
            source: shaders::CONCEAL,
            fragment: "fragment",
            bindings: &bindings,
            target: wgpu::ColorTargetState {
                format: VISIBILITY_FORMAT,
                blend: None,
                write_mask: wgpu::ColorWrites::ALL,
            },
            depth: Some(wgpu::CompareFunction::Greater),
            strip: Some(None),
        },
    )
}

/// A pipeline that draws triangles into the visibility buffer, with a fragment stage that trims or one that does not; both
/// sides of a surface are seen.
pub(super) fn mesh(device: &wgpu::Device, trims: bool) -> Pass {
    build(
        device,
        &Recipe {
            label: if trims { "mesh trimmed" } else { "mesh whole" },
            source: shaders::MESH,
            fragment: if trims { "fragment" } else { "fragment_whole" },
            bindings: &super::mesh::bindings(),
            target: wgpu::ColorTargetState {
                format: VISIBILITY_FORMAT,
                blend: None,
                write_mask: wgpu::ColorWrites::ALL,
            },
            depth: Some(wgpu::CompareFunction::Greater),
            strip: None,
        },
    )
}

/// The pipeline that draws the triangles of a tessellation; both sides are seen.
pub(super) fn tessellation(device: &wgpu::Device) -> Pass {
    let mut bindings = vec![uniform(size_of::<View>())];
    bindings.extend([STORAGE; 4]);
    build(
        device,
        &Recipe {
            label: "tessellation",
            source: shaders::TESSELLATION,
            fragment: "fragment",
            bindings: &bindings,
            target: wgpu::ColorTargetState {
                format: VISIBILITY_FORMAT,
                blend: None,
                write_mask: wgpu::ColorWrites::ALL,
            },
            depth: Some(wgpu::CompareFunction::Greater),
            strip: None,
        },
    )
}

fn build(device: &wgpu::Device, recipe: &Recipe) -> Pass {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(recipe.label),
        source: wgpu::ShaderSource::Wgsl(recipe.source.into()),
    });
    let entries: Vec<_> = recipe
        .bindings
        .iter()
        .enumerate()
        .map(|(k, ty)| wgpu::BindGroupLayoutEntry {
            binding: k as u32,
            visibility: if *ty == WRITABLE {
                wgpu::ShaderStages::FRAGMENT
            } else {
                wgpu::ShaderStages::VERTEX_FRAGMENT
            },
            ty: *ty,
            count: None,
        })
        .collect();
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(recipe.label),
        entries: &entries,
    });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(recipe.label),
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let primitive = match recipe.strip {
        Some(cull_mode) => wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            cull_mode,
            ..Default::default()
        },
        None => wgpu::PrimitiveState::default(),
    };
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(recipe.label),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive,
        depth_stencil: recipe.depth.map(|compare| wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(recipe.fragment),
            compilation_options: Default::default(),
            targets: &[Some(recipe.target.clone())],
        }),
        multiview_mask: None,
        cache: None,
    });
    Pass { pipeline, layout }
}
