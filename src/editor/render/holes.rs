//! The picture read back, for the magnifier and for pin holes: the inspection proves what shows through.
//!
//! The copy of a complete picture is made once per view at rest, and of as many pictures as can be read back while
//! the view moves if that was asked for. It is mapped without waiting, and handed to the main world, where the exact
//! faces and the gaps are.

use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, mpsc};

use bevy::prelude::*;
use bevy::render::renderer::{RenderContext, RenderDevice, ViewQuery};

use super::faces::RenderFaces;
use super::frame::FrameView;
use super::model::ModelPass;
use super::ribbons::RenderRibbons;
use crate::editor::inspection::{Findings, LatestPicture, Picture, PinHoles, are_marked};
use crate::editor::object::DerivedFace;
use crate::editor::redraw::Waker;
use crate::editor::settings::Settings;
use crate::encoding::{Conceal, View};
use crate::inspect::{EdgePairs, HoleScene, PinHole, pin_holes};
use crate::kernel::face::Face;
use crate::kernel::view::Camera as ViewPoint;
use crate::reference::cast::Fragment;
use crate::reference::visibility::VisibilityBuffer;

/// The latest picture, shared by both worlds.
#[derive(Resource, Clone, Default)]
pub(super) struct HolePictures(Arc<Mutex<Option<Picture>>>);

const COPIED: u8 = 1;
const MAPPING: u8 = 2;
const MAPPED: u8 = 3;
const FAILED: u8 = 4;

struct Copies {
    words: wgpu::Buffer,
    depths: wgpu::Buffer,
    size: [u32; 2],
    view: View,
    camera: ViewPoint,
    /// One state per buffer.
    states: [Arc<AtomicU8>; 2],
}

/// What decides which holes there are.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CopyKey {
    camera: ViewPoint,
    size: [u32; 2],
    geometry: u64,
    holes: Conceal,
    ribbons: u64,
}

/// What is on its way.
#[derive(Resource, Default)]
pub(super) struct HoleReadback {
    copies: Option<Copies>,
    /// What was copied last.
    copied: Option<CopyKey>,
}

fn padded(size: [u32; 2], pixel: u32) -> u32 {
    (size[0] * pixel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

/// Copies the first sample of a picture at rest, while holes are to be marked.
pub(super) fn copy(
    _view: ViewQuery<Entity, With<super::DrawsModel>>,
    mut readback: ResMut<HoleReadback>,
    model: Res<ModelPass>,
    (faces, ribbons): (Res<RenderFaces>, Res<RenderRibbons>),
    frame: Res<FrameView>,
    device: Res<RenderDevice>,
    waker: Res<Waker>,
    mut ctx: RenderContext,
) {
    let Some((_, renderer)) = &model.renderer else { return };
    let settings = &frame.settings;
    let (marked, full) = (are_marked(settings), model.quality.is_full());
    let wanted = full && (marked || settings.lens) || marked && settings.holes_moving;
    if !wanted || model.casts == 0 || readback.copies.is_some() || faces.is_waiting() {
        return;
    }
    let targets = renderer.shown();
    let size = targets.size;
    let key = CopyKey {
        camera: frame.camera,
        size,
        geometry: faces.geometry,
        holes: settings.holes,
        ribbons: ribbons.revision,
    };
    if readback.copied == Some(key) {
        return;
    }
    let copy = |ctx: &mut RenderContext, texture: &wgpu::Texture, pixel: u32| {
        let buffer = device.wgpu_device().create_buffer(&wgpu::BufferDescriptor {
            label: Some("pin holes"),
            size: u64::from(padded(size, pixel)) * u64::from(size[1]),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(padded(size, pixel)),
            rows_per_image: None,
        };
        ctx.command_encoder().copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            texture.size(),
        );
        buffer
    };
    let words = copy(&mut ctx, &targets.visibility, 16);
    let depths = copy(&mut ctx, &targets.depth, 4);
    let states = std::array::from_fn(|_| Arc::new(AtomicU8::new(COPIED)));
    let view = *renderer.view();
    readback.copies = Some(Copies { words, depths, size, view, camera: frame.camera, states });
    readback.copied = Some(key);
    waker.wake();
}

/// After submission: starts mapping, and takes what has been mapped.
pub(super) fn collect(
    readback: Option<ResMut<HoleReadback>>,
    pictures: Res<HolePictures>,
    faces: Res<RenderFaces>,
    device: Res<RenderDevice>,
    waker: Res<Waker>,
) {
    let Some(mut readback) = readback else { return };
    let Some(copies) = &readback.copies else { return };
    for (buffer, state) in [&copies.words, &copies.depths].into_iter().zip(&copies.states) {
        if state.load(Ordering::Acquire) == COPIED {
            state.store(MAPPING, Ordering::Release);
            let state = Arc::clone(state);
            buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
                state.store(if result.is_ok() { MAPPED } else { FAILED }, Ordering::Release);
            });
        }
    }
    // Does not wait. A lost device is reported by Bevy.
    let _ = device.wgpu_device().poll(wgpu::PollType::Poll);
    let states = [0, 1].map(|k| copies.states[k].load(Ordering::Acquire));
    if states.contains(&FAILED) {
        readback.copies = None;
    } else if states == [MAPPED; 2] {
        let picture = read(copies, &faces);
        *pictures.0.lock().unwrap_or_else(|e| e.into_inner()) = Some(picture);
        readback.copies = None;
        waker.wake();
    } else {
        waker.wake_after(std::time::Duration::from_millis(4));
    }
}

fn read(copies: &Copies, faces: &RenderFaces) -> Picture {
    let [width, height] = copies.size;
    let (words, depths) =
        (copies.words.slice(..).get_mapped_range(), copies.depths.slice(..).get_mapped_range());
    let rows = words
        .chunks_exact(padded(copies.size, 16) as usize)
        .zip(depths.chunks_exact(padded(copies.size, 4) as usize));
    let fragments = rows
        .flat_map(|(words, depths)| words.chunks_exact(16).zip(depths.chunks_exact(4)).take(width as usize))
        .map(|(words, depth)| Fragment {
            words: bytemuck::pod_read_unaligned(words),
            depth: bytemuck::pod_read_unaligned(depth),
        })
        .collect();
    let buffer = VisibilityBuffer { width, height, fragments, counts: default() };
    Picture {
        buffer,
        view: copies.view,
        camera: copies.camera,
        faces: faces.entities_by_slot().to_vec(),
        headers: faces.packed.faces.data().to_vec(),
    }
}

/// The holes of a picture.
type Proved = (Vec<PinHole>, Arc<Picture>);

/// Holes that are being proved on a thread, and of which picture and edges.
#[derive(Default)]
pub(super) struct Proofs {
    /// Picture and revision of the edges that were last looked at.
    begun: Option<(Arc<Picture>, u64)>,
    result: Option<Mutex<mpsc::Receiver<Proved>>>,
    /// Whether faces changed since they were begun.
    outdated: bool,
    /// The latest picture when faces changed last: the next one is of the faces as they are.
    before_edit: Option<Arc<Picture>>,
    /// Threads of their own: on those that faces are derived on, an edit would wait for them.
    pool: Option<rayon::ThreadPool>,
}

impl Proofs {
    fn pool(&mut self) -> Option<&rayon::ThreadPool> {
        if self.pool.is_none() {
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            let builder = rayon::ThreadPoolBuilder::new().num_threads((cores - 1).max(1));
            // A defect in proving costs the marks, not the program.
            let builder = builder.thread_name(|_| "hairline-holes".into()).panic_handler(|_| ());
            self.pool = builder.build().ok();
        }
        self.pool.as_ref()
    }
}

/// In the main world: takes the latest picture and has its holes proved, one picture at a time.
pub(super) fn prove(
    pictures: Res<HolePictures>,
    findings: Res<Findings>,
    settings: Res<Settings>,
    (faces, changed): (Query<&DerivedFace>, Query<(), Changed<DerivedFace>>),
    waker: Res<Waker>,
    (mut latest, mut found): (ResMut<LatestPicture>, ResMut<PinHoles>),
    mut proofs: Local<Proofs>,
) {
    if let Some(picture) = pictures.0.lock().unwrap_or_else(|e| e.into_inner()).take() {
        latest.0 = Some(Arc::new(picture));
    }
    if !changed.is_empty() {
        (found.outdated, proofs.outdated) = (true, true);
        proofs.before_edit = latest.0.clone();
    }
    let arrived = proofs.result.as_ref().map(|r| r.lock().unwrap_or_else(|e| e.into_inner()).try_recv());
    match arrived {
        Some(Err(mpsc::TryRecvError::Empty)) => return,
        Some(Ok((holes, picture))) => {
            // While the view moves, or faces are edited, those of a moment ago are better than none.
            if !proofs.outdated || settings.holes_moving {
                found.set(holes, UVec2::new(picture.buffer.width, picture.buffer.height), picture.camera);
            }
            proofs.result = None;
        }
        Some(Err(mpsc::TryRecvError::Disconnected)) | None => proofs.result = None,
    }
    let (Some(picture), Some(inspection)) = (&latest.0, findings.shared_inspection()) else { return };
    // Again when edges were measured meanwhile.
    let known =
        |(p, revision): &(Arc<Picture>, u64)| Arc::ptr_eq(p, picture) && *revision == findings.revision;
    let before_edit = proofs.before_edit.as_ref().is_some_and(|p| Arc::ptr_eq(p, picture));
    if !are_marked(&settings) || before_edit || proofs.begun.as_ref().is_some_and(known) {
        return;
    }
    proofs.begun = Some((Arc::clone(picture), findings.revision));
    proofs.outdated = false;
    let held: Vec<Option<Arc<Face>>> =
        (0..inspection.face_count()).map(|k| faces.get(findings.face(k)?).ok()?.0.face.clone()).collect();
    let numbers: Vec<Option<usize>> = picture.faces.iter().map(|e| findings.number((*e)?)).collect();
    let (sender, receiver) = mpsc::channel();
    proofs.result = Some(Mutex::new(receiver));
    let (picture, waker) = (Arc::clone(picture), waker.clone());
    // Without threads there are no marks.
    let Some(pool) = proofs.pool() else { return };
    pool.spawn(move || {
        let face = |k: usize| held.get(k)?.as_deref();
        let slot = |k: u32| numbers.get(k as usize).copied().flatten();
        let pairs = EdgePairs::of(&inspection);
        let scene = HoleScene { inspection: &inspection, pairs: &pairs, face: &face, face_of_slot: &slot };
        let holes = pin_holes(&scene, &picture.buffer, &picture.view, &picture.camera);
        // Let go of what the main world may want to change before it hears of it.
        drop((held, inspection));
        // Fails only when the program ends.
        let _ = sender.send((holes, picture));
        waker.wake();
    });
}
