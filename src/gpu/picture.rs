//! Pictures without a window.

use super::renderer::{Presentation, Renderer, Sample, bounding_sphere};
use super::{Context, GpuError};
use crate::encoding::options::jitter;
use crate::encoding::{
    Conceal, DepthRange, DisplayMode, Extras, Image, MeshChoice, PackedScene, RenderOptions,
};
use crate::reference::cast::Fragment;
use crate::reference::visibility::VisibilityBuffer;

/// Draws `scene` on `context`.
///
/// # Errors
/// The scene or the picture is too large for the device, or the device is lost.
pub fn render_image(
    context: &Context,
    scene: &mut PackedScene,
    options: &RenderOptions,
) -> Result<Image, GpuError> {
    render_image_with(context, scene, options, &mut Extras::default())
}

/// The same with what `extras` hold.
///
/// # Errors
/// As [`render_image`].
pub fn render_image_with(
    context: &Context,
    scene: &mut PackedScene,
    options: &RenderOptions,
    extras: &mut Extras,
) -> Result<Image, GpuError> {
    let Context { device, queue, .. } = context;
    let [width, height] = options.size;
    let limit = device.limits().max_texture_dimension_2d;
    if width > limit || height > limit {
        return Err(GpuError::PictureTooLarge { width, height, limit });
    }
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let mut renderer = Renderer::new(device, format);
    scene.touch_all();
    renderer.upload(device, queue, scene)?;
    if let Some(MeshChoice { scene: meshes, lacking }) = &mut extras.meshes {
        renderer.upload_meshes(device, queue, meshes, scene, lacking)?;
    }
    if let Some(choice) = &mut extras.ribbons {
        renderer.upload_ribbons(device, queue, &mut choice.scene)?;
    }
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width: width.max(1), height: height.max(1), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let (centre, radius) = bounding_sphere(scene);
    for k in 0..options.samples.max(1) {
        let mut encoder = device.create_command_encoder(&Default::default());
        let sample = Sample {
            camera: options.camera,
            depth: DepthRange::around(&options.camera, centre, radius),
            size: options.size,
            jitter: jitter(k),
            mode: options.mode,
        };
        if extras.meshes.is_some() {
            renderer.draw_meshes(device, queue, &mut encoder, &sample);
        } else {
            renderer.cast(device, queue, &mut encoder, &sample);
        }
        if let Some(choice) = extras.ribbons.as_ref().filter(|r| r.conceal != Conceal::Raw) {
            let difference = choice.conceal == Conceal::Difference;
            renderer.conceal(device, queue, &mut encoder, &choice.spans, difference);
        }
        renderer.shade(device, queue, &mut encoder, options.mode, options.edges, k == 0);
        queue.submit([encoder.finish()]);
        // One sample at a time keeps software drivers from hoarding work.
        context.wait()?;
    }
    let presentation = Presentation { theme: options.theme, viewport: None, scissor: None };
    let mut encoder = device.create_command_encoder(&Default::default());
    let view = target.create_view(&Default::default());
    renderer.present(device, queue, &mut encoder, &view, None, &presentation);
    queue.submit([encoder.finish()]);
    let rgba = read_texture(context, &target)?;
    Ok(Image { width: width.max(1), height: height.max(1), rgba })
}

/// Casts one sample with an up-to-date `renderer` and reads the visibility buffer back.
///
/// # Errors
/// The device is lost.
pub fn visibility(
    context: &Context,
    renderer: &mut Renderer,
    sample: &Sample,
) -> Result<VisibilityBuffer, GpuError> {
    let mut encoder = context.device.create_command_encoder(&Default::default());
    renderer.cast(&context.device, &context.queue, &mut encoder, sample);
    context.queue.submit([encoder.finish()]);
    context.wait()?;
    read_visibility(context, renderer)
}

/// Reads the visibility buffer that is shown back: of the last complete cast, with holes filled if they were.
///
/// # Errors
/// The device is lost.
pub fn read_visibility(context: &Context, renderer: &Renderer) -> Result<VisibilityBuffer, GpuError> {
    let words = read_texture(context, &renderer.shown().visibility)?;
    let depths = read_texture(context, &renderer.shown().depth)?;
    let pixels = words.chunks_exact(16).zip(depths.chunks_exact(4));
    let fragments = pixels.map(|(words, depth)| Fragment {
        words: bytemuck::pod_read_unaligned(words),
        depth: bytemuck::pod_read_unaligned(depth),
    });
    let [width, height] = renderer.targets().size;
    Ok(VisibilityBuffer { width, height, fragments: fragments.collect(), counts: Default::default() })
}

/// Copies a texture to the CPU, rows packed.
///
/// # Errors
/// The device is lost.
pub fn read_texture(context: &Context, texture: &wgpu::Texture) -> Result<Vec<u8>, GpuError> {
    let Context { device, queue, .. } = context;
    let pixel = texture.format().block_copy_size(None).unwrap_or(4);
    let (width, height) = (texture.width(), texture.height());
    let row = (width * pixel) as usize;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: (padded * height as usize) as u64,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded as u32),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    queue.submit([encoder.finish()]);
    let (sender, receiver) = std::sync::mpsc::channel();
    buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
        // The receiver waits below; if it is gone nobody wants the answer.
        let _ = sender.send(result);
    });
    context.wait()?;
    let lost = |reason: String| GpuError::Lost { reason };
    receiver.recv().map_err(|e| lost(e.to_string()))?.map_err(|e| lost(e.to_string()))?;
    let bytes = buffer.slice(..).get_mapped_range();
    Ok(bytes.chunks_exact(padded).flat_map(|line| line[..row].iter().copied()).collect())
}

/// Whether a mode casts differently from shaded pictures, so that switching to or from it needs new rays.
pub fn casts_apart(mode: DisplayMode) -> bool {
    matches!(mode, DisplayMode::Heat | DisplayMode::Untrimmed)
}
