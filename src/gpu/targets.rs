//! The offscreen textures of one picture size.

/// Visibility, depth and accumulated colour.
#[derive(Debug)]
pub struct Targets {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// `Rgba32Uint`: face slot + 1, u, v, normal.
    pub visibility: wgpu::Texture,
    /// View of it.
    pub visibility_view: wgpu::TextureView,
    /// `Depth32Float`, reverse z.
    pub depth: wgpu::Texture,
    /// View of it.
    pub depth_view: wgpu::TextureView,
    /// `Rgba16Float`: sum of premultiplied linear colours.
    pub sum_view: wgpu::TextureView,
}

/// Format of the visibility buffer.
pub const VISIBILITY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
/// Format of the depth buffer.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Format of the accumulated colours.
pub const SUM_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

impl Targets {
    /// Textures of `size`, at least one pixel each way.
    pub fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let size = size.map(|s| s.clamp(1, device.limits().max_texture_dimension_2d));
        let make = |label, format, extra| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING | extra,
                view_formats: &[],
            })
        };
        let copy = wgpu::TextureUsages::COPY_SRC;
        let visibility = make("visibility", VISIBILITY_FORMAT, copy);
        let depth = make("depth", DEPTH_FORMAT, copy);
        let sum = make("sum", SUM_FORMAT, wgpu::TextureUsages::empty());
        let view = |t: &wgpu::Texture| t.create_view(&wgpu::TextureViewDescriptor::default());
        Self {
            size,
            visibility_view: view(&visibility),
            depth_view: view(&depth),
            sum_view: view(&sum),
            visibility,
            depth,
        }
    }
}
