//! `hairline render`: a picture of a model as a PNG file.
//!
//! The model becomes a packed scene ([`prepare`]), the view a camera (`framing`), and either the graphics
//! driver or the processor draws; both run the same algorithm on the same buffers.

mod framing;
mod pack;

pub use framing::camera_for;
pub use pack::{Prepared, prepare};

use std::path::Path;

use super::arguments::{Backend, Holes, Mode, RenderArguments, Surfaces};
use super::failure::Failure;
use super::progress::Progress;
use super::{output, source};
use crate::encoding::{
    Conceal, DisplayMode, Extras, FaceSlot, Image, LevelView, MeshChoice, MeshScene, PackedScene,
    RenderOptions, RibbonChoice,
};
use crate::inspect::{self, Inspection};
use crate::reference;
use crate::scene::records::ModelRecord;

/// Draws `arguments.file` into `arguments.output`.
///
/// # Errors
/// The input cannot be read, the output not written, or the graphics driver asked for is missing.
pub fn run(arguments: &RenderArguments) -> Result<(), Failure> {
    output::check_writable(&arguments.output)?;
    let progress = Progress::start(format!("reading {}", arguments.file.display()));
    let opened = source::open(&arguments.file, &|part| progress.set(part))?;
    drop(progress);
    if let Some(line) = source::remarks_line(&arguments.file, &opened.report) {
        eprintln!("hairline: note: {line}");
    }
    let progress = Progress::start("preparing faces");
    let mut ready = prepare(&opened.model, &|part| progress.set(part));
    drop(progress);
    for problem in &ready.problems {
        eprintln!("hairline: note: {}: {problem}; the face is left out", arguments.file.display());
    }
    let size = [arguments.size.width, arguments.size.height];
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    let camera = camera_for(arguments.view, &opened.model, &ready, aspect)?;
    let options = RenderOptions {
        samples: arguments.samples,
        mode: mode(arguments.mode),
        ..RenderOptions::new(camera, size)
    };
    let mut extras = Extras::default();
    if arguments.renderer == Surfaces::Mesh {
        let progress = Progress::start("tessellating");
        extras.meshes = Some(triangles(&ready, &options));
        drop(progress);
    }
    if arguments.conceal != Holes::Raw {
        let progress = Progress::start("measuring gaps");
        extras.ribbons = Some(fat_lines(&opened.model, &ready, &options, arguments.conceal));
        drop(progress);
    }
    let progress = Progress::start("drawing");
    let image = draw_with(&mut ready.scene, &options, &mut extras, arguments.backend)?;
    drop(progress);
    write_png(&image, &arguments.output)
}

fn mode(mode: Mode) -> DisplayMode {
    match mode {
        Mode::Shaded => DisplayMode::Shaded,
        Mode::Faces => DisplayMode::Faces,
        Mode::Uv => DisplayMode::Uv,
        Mode::Heat => DisplayMode::Heat,
        Mode::Untrimmed => DisplayMode::Untrimmed,
    }
}

/// Draws with `backend`, or with the graphics driver if there is one and else with the processor.
///
/// # Errors
/// The graphics driver was asked for and there is none, or it fails.
pub fn draw(
    scene: &mut PackedScene,
    options: &RenderOptions,
    backend: Option<Backend>,
) -> Result<Image, Failure> {
    draw_with(scene, options, &mut Extras::default(), backend)
}

/// Fat lines along the edges that faces of `model` share.
fn fat_lines(model: &ModelRecord, ready: &Prepared, options: &RenderOptions, holes: Holes) -> RibbonChoice {
    let inspection = Inspection::in_unit(&model.faces, model.unit.millimetres);
    let face = |k: usize| Some((ready.faces.get(k)?.as_ref()?, FaceSlot(k as u32)));
    let scene = inspect::ribbons(&inspection, &face);
    let spans = scene.concealing_spans(&LevelView::new(&options.camera, options.size));
    let conceal = match holes {
        Holes::Raw => Conceal::Raw,
        Holes::Concealed => Conceal::Concealed,
        Holes::Difference => Conceal::Difference,
    };
    RibbonChoice { scene, spans, conceal }
}

/// Error of triangles on the screen, pixels.
const MESH_ERROR_PX: f64 = 0.5;

/// The triangles that show `ready` as `options` ask for, wrong by at most half a pixel.
pub fn triangles(ready: &Prepared, options: &RenderOptions) -> MeshChoice {
    let view = LevelView::new(&options.camera, options.size);
    let mut scene = MeshScene::default();
    let face = |slot: FaceSlot| ready.faces.get(slot.0 as usize)?.as_ref();
    let lacking = scene.prepare(&ready.scene, face, &view, MESH_ERROR_PX);
    MeshChoice { scene, lacking }
}

/// [`draw`] with what `extras` hold.
///
/// # Errors
/// As [`draw`].
pub fn draw_with(
    scene: &mut PackedScene,
    options: &RenderOptions,
    extras: &mut Extras,
    backend: Option<Backend>,
) -> Result<Image, Failure> {
    match backend {
        Some(Backend::Cpu) => Ok(reference::render_image_with(scene, options, extras)),
        Some(Backend::Gpu) => draw_on_gpu(scene, options, extras),
        None => match draw_on_gpu(scene, options, extras) {
            Err(Failure::Lacking { reason }) => {
                eprintln!("hairline: note: {reason}; the processor draws instead");
                Ok(reference::render_image_with(scene, options, extras))
            }
            result => result,
        },
    }
}

#[cfg(feature = "gpu")]
fn draw_on_gpu(
    scene: &mut PackedScene,
    options: &RenderOptions,
    extras: &mut Extras,
) -> Result<Image, Failure> {
    use crate::gpu::{Context, GpuError, render_image_with};
    let result = Context::headless().and_then(|context| render_image_with(&context, scene, options, extras));
    result.map_err(|error| match error {
        GpuError::NoDriver { .. } => Failure::Lacking { reason: error.to_string() },
        _ => Failure::Work { reason: error.to_string() },
    })
}

#[cfg(not(feature = "gpu"))]
fn draw_on_gpu(
    _scene: &mut PackedScene,
    _options: &RenderOptions,
    _extras: &mut Extras,
) -> Result<Image, Failure> {
    Err(Failure::Lacking { reason: "this program was built without graphics drivers (feature `gpu`)".into() })
}

fn write_png(image: &Image, path: &Path) -> Result<(), Failure> {
    let fail = |e: png::EncodingError| Failure::Output { path: path.into(), reason: e.to_string() };
    output::write_whole(path, &png_of(image).map_err(fail)?)
}

/// `image` as a PNG file.
///
/// # Errors
/// As the encoder: an image without pixels.
pub fn png_of(image: &Image) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width, image.height);
    // Most pictures have a background; without alpha their files are smaller.
    let opaque = image.rgba.iter().skip(3).step_by(4).all(|alpha| *alpha == 255);
    let rgb: Vec<u8>;
    let pixels = if opaque {
        rgb = image.rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        encoder.set_color(png::ColorType::Rgb);
        &rgb
    } else {
        encoder.set_color(png::ColorType::Rgba);
        &image.rgba
    };
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}
