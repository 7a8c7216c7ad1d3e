//! Pipelines and bind-group layouts of the passes.

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

/// The pipelines that every picture needs; others are made when first asked for.
#[derive(Debug)]
pub struct Pipelines {
    /// Casts rays.
    pub cast: Pass,
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
    /// Entry points.
    vertex: &'a str,
    fragment: &'a str,
    /// Values of the shader's overridable constants.
    constants: &'a [(&'a str, f64)],
    bindings: &'a [wgpu::BindingType],
    target: wgpu::ColorTargetState,
    /// A second target.
    also: Option<wgpu::ColorTargetState>,
    /// How depths are compared, and whether they are written.
    depth: Option<(wgpu::CompareFunction, bool)>,
    /// Triangle strips, and which of their sides are left out.
    strip: Option<Option<wgpu::Face>>,
}

impl<'a> Recipe<'a> {
    /// Triangles, both sides of which are seen, with depth into the visibility buffer: the nearest stays.
    fn visibility(label: &'a str, source: &'a str, bindings: &'a [wgpu::BindingType]) -> Self {
        Self {
            label,
            source,
            vertex: "vertex",
            fragment: "fragment",
            constants: &[],
            bindings,
            target: unblended(VISIBILITY_FORMAT),
            also: None,
            depth: Some((wgpu::CompareFunction::Greater, true)),
            strip: None,
        }
    }
}

fn unblended(format: wgpu::TextureFormat) -> wgpu::ColorTargetState {
    wgpu::ColorTargetState { format, blend: None, write_mask: wgpu::ColorWrites::ALL }
}

impl Pipelines {
    /// Makes all pipelines; `format` is the target's that [`present`](super::Renderer::present) draws to.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let mut cast_bindings = vec![uniform(size_of::<View>())];
        cast_bindings.extend([STORAGE; 7]);
        cast_bindings.push(WRITABLE);
        let look = uniform(size_of::<Look>());
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
            vertex: "vertex",
            fragment,
            constants: &[],
            bindings: &present_bindings,
            target,
            also: None,
            depth,
            strip: None,
        };
        Self {
            cast: build(
                device,
                &Recipe {
                    strip: Some(Some(wgpu::Face::Front)),
                    ..Recipe::visibility("cast", shaders::CAST, &cast_bindings)
                },
            ),
            present: build(
                device,
                &present(present_fragment, over.clone(), Some((wgpu::CompareFunction::GreaterEqual, true))),
            ),
            present_flat: build(device, &present(flat_fragment, unblended(format), None)),
        }
    }
}

/// What shading may leave out of its program. Drivers that compute both sides of every branch would pay for all of it at
/// each pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shading {
    /// Only surfaces in their own colours: no other mode and no difference.
    pub plain: bool,
    /// Edges are drawn.
    pub edges: bool,
}

impl Shading {
    /// Position in a list of all kinds.
    pub fn index(self) -> usize {
        usize::from(self.plain) + 2 * usize::from(self.edges)
    }
}

/// The pipeline that shades, adding to the sum. Only pixels that show a surface: their depth is more than that of the
/// triangle drawn, 0.
pub(super) fn resolve(device: &wgpu::Device, shading: Shading) -> Pass {
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    let constants =
        [("PLAIN", f64::from(u8::from(shading.plain))), ("EDGES", f64::from(u8::from(shading.edges)))];
    build(
        device,
        &Recipe {
            label: "resolve",
            source: shaders::RESOLVE,
            vertex: "vertex",
            fragment: "fragment",
            constants: &constants,
            bindings: &[
                uniform(size_of::<Look>()),
                texture(wgpu::TextureSampleType::Uint),
                texture(wgpu::TextureSampleType::Depth),
                STORAGE,
                texture(wgpu::TextureSampleType::Uint),
            ],
            target: wgpu::ColorTargetState {
                blend: Some(wgpu::BlendState { color: add, alpha: add }),
                ..unblended(SUM_FORMAT)
            },
            also: None,
            depth: Some((wgpu::CompareFunction::Less, false)),
            strip: None,
        },
    )
}

/// The pipeline that fills holes in a copy of the visibility buffer.
pub(super) fn conceal(device: &wgpu::Device) -> Pass {
    let mut bindings = vec![uniform(size_of::<View>())];
    bindings.extend([STORAGE; 5]);
    bindings.extend([texture(wgpu::TextureSampleType::Uint), texture(wgpu::TextureSampleType::Depth)]);
    let recipe = Recipe::visibility("conceal", shaders::CONCEAL, &bindings);
    build(device, &Recipe { strip: Some(None), ..recipe })
}

/// Pipelines that draw triangles of untrimmed surfaces: those that are kept whole, that one segment alone passes through, and
/// others.
pub(super) fn meshes(device: &wgpu::Device) -> [Pass; 3] {
    let bindings = super::mesh::bindings();
    let whole = Recipe::visibility("mesh", shaders::MESH, &bindings);
    let lone = Recipe {
        label: "mesh lone",
        vertex: "vertex_lone",
        fragment: "fragment_lone",
        constants: &[("SHORT_RECORDS", 1.0)],
        ..Recipe::visibility("mesh", shaders::MESH, &bindings)
    };
    let trimmed = Recipe {
        label: "mesh trimmed",
        vertex: "vertex_trimmed",
        fragment: "fragment_trimmed",
        ..Recipe::visibility("mesh", shaders::MESH, &bindings)
    };
    [whole, lone, trimmed].map(|recipe| build(device, &recipe))
}

/// The pipeline that draws the triangles of a tessellation.
pub(super) fn tessellation(device: &wgpu::Device) -> Pass {
    let mut bindings = vec![uniform(size_of::<View>())];
    bindings.extend([STORAGE; 4]);
    build(device, &Recipe::visibility("tessellation", shaders::TESSELLATION, &bindings))
}

/// The pipeline that puts kept pictures together.
pub(super) fn wipe(device: &wgpu::Device) -> Pass {
    let bindings = [
        texture(wgpu::TextureSampleType::Uint),
        texture(wgpu::TextureSampleType::Float { filterable: false }),
        texture(wgpu::TextureSampleType::Depth),
    ];
    let recipe = Recipe {
        also: Some(unblended(SUM_FORMAT)),
        depth: Some((wgpu::CompareFunction::Always, true)),
        ..Recipe::visibility("wipe", shaders::WIPE, &bindings)
    };
    build(device, &recipe)
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
    let also = recipe.also.iter().map(|target| Some(target.clone()));
    let targets: Vec<_> = std::iter::once(Some(recipe.target.clone())).chain(also).collect();
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(recipe.label),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(recipe.vertex),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive,
        depth_stencil: recipe.depth.map(|(compare, write)| wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(write),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(recipe.fragment),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: recipe.constants,
                ..Default::default()
            },
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    });
    Pass { pipeline, layout }
}
