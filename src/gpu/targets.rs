//! The offscreen textures of one picture size.

/// Visibility and depth.
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
}

/// Accumulated colour.
#[derive(Debug)]
pub struct Sum {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// `Rgba16Float`: sum of premultiplied linear colours.
    pub view: wgpu::TextureView,
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
        let size = within(device, size);
        let make = |label, format| {
            texture(
                device,
                size,
                label,
                format,
                wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST,
            )
        };
        let visibility = make("visibility", VISIBILITY_FORMAT);
        let depth = make("depth", DEPTH_FORMAT);
        let view = |t: &wgpu::Texture| t.create_view(&wgpu::TextureViewDescriptor::default());
        Self { size, visibility_view: view(&visibility), depth_view: view(&depth), visibility, depth }
    }
}

impl Sum {
    /// A texture of `size`, at least one pixel each way.
    pub fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let size = within(device, size);
        let sum = texture(device, size, "sum", SUM_FORMAT, wgpu::TextureUsages::empty());
        Self { size, view: sum.create_view(&wgpu::TextureViewDescriptor::default()) }
    }
}

/// The size that the device can make.
pub fn within(device: &wgpu::Device, size: [u32; 2]) -> [u32; 2] {
    size.map(|s| s.clamp(1, device.limits().max_texture_dimension_2d))
}

fn texture(
    device: &wgpu::Device,
    size: [u32; 2],
    label: &str,
    format: wgpu::TextureFormat,
    extra: wgpu::TextureUsages,
) -> wgpu::Texture {
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
}
