//! Reading back the pixel under the pointer from the visibility buffer.
//!
//! One texel is copied into one of two small buffers; a frame or two later it is mapped without waiting and
//! turned into a face and its parameters. The model point is the surface at these parameters, in `f64`.

use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex};

use bevy::prelude::*;
use bevy::render::renderer::{RenderContext, RenderDevice, ViewQuery};
use glam::DVec2;

use super::faces::RenderFaces;
use super::frame::FrameView;
use super::model::ModelPass;
use crate::editor::picking::Picker;
use crate::editor::redraw::Waker;

/// A face and normalised parameters of it.
pub(super) type Texel = Option<(Entity, DVec2)>;

/// The latest answer, shared by both worlds.
#[derive(Resource, Clone, Default)]
pub(super) struct PickAnswers(Arc<Mutex<Option<(UVec2, Texel)>>>);

const IDLE: u8 = 0;
const COPIED: u8 = 1;
const MAPPING: u8 = 2;
const MAPPED: u8 = 3;
const FAILED: u8 = 4;

/// A buffer of one texel on its way.
struct Slot {
    buffer: wgpu::Buffer,
    state: Arc<AtomicU8>,
    pixel: UVec2,
}

/// Buffers and what was asked last.
#[derive(Resource)]
pub(super) struct PickReadback {
    slots: Vec<Slot>,
    asked: Option<(UVec2, u64)>,
}

/// Makes the buffers.
pub(super) fn create(mut commands: Commands, device: Res<RenderDevice>) {
    let slot = || Slot {
        buffer: device.wgpu_device().create_buffer(&wgpu::BufferDescriptor {
            label: Some("pick"),
            size: 16,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        }),
        state: Arc::new(AtomicU8::new(IDLE)),
        pixel: UVec2::ZERO,
    };
    commands.insert_resource(PickReadback { slots: vec![slot(), slot()], asked: None });
}

/// Copies the wanted texel when the pixel or the picture changed.
pub(super) fn copy(
    _view: ViewQuery<Entity, With<super::DrawsModel>>,
    mut readback: ResMut<PickReadback>,
    model: Res<ModelPass>,
    frame: Res<FrameView>,
    waker: Res<Waker>,
    mut ctx: RenderContext,
) {
    let (Some(pixel), Some((_, renderer))) = (frame.pick, &model.renderer) else { return };
    if readback.asked == Some((pixel, model.casts)) || model.casts == 0 {
        return;
    }
    waker.wake();
    let Some(slot) = readback.slots.iter_mut().find(|s| s.state.load(Ordering::Acquire) == IDLE) else {
        return;
    };
    let targets = renderer.targets();
    let size = UVec2::from_array(targets.size);
    let (_, viewport) = frame.viewport.physical();
    let texel = (pixel * size / viewport.max(UVec2::ONE)).min(size - 1);
    ctx.command_encoder().copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo {
            texture: &targets.visibility,
            mip_level: 0,
            origin: wgpu::Origin3d { x: texel.x, y: texel.y, z: 0 },
            aspect: wgpu::TextureAspect::All,
        },
        wgpu::TexelCopyBufferInfo { buffer: &slot.buffer, layout: wgpu::TexelCopyBufferLayout::default() },
        wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
    );
    slot.pixel = pixel;
    slot.state.store(COPIED, Ordering::Release);
    readback.asked = Some((pixel, model.casts));
}

/// After submission: starts mapping what was copied, and takes what has been mapped.
pub(super) fn collect(
    readback: Option<ResMut<PickReadback>>,
    answers: Res<PickAnswers>,
    faces: Res<RenderFaces>,
    device: Res<RenderDevice>,
    waker: Res<Waker>,
) {
    let Some(mut readback) = readback else { return };
    for slot in &mut readback.slots {
        if slot.state.load(Ordering::Acquire) == COPIED {
            let state = Arc::clone(&slot.state);
            state.store(MAPPING, Ordering::Release);
            slot.buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
                state.store(if result.is_ok() { MAPPED } else { FAILED }, Ordering::Release);
            });
        }
    }
    // Does not wait. A lost device is reported by Bevy.
    let _ = device.wgpu_device().poll(wgpu::PollType::Poll);
    for slot in &mut readback.slots {
        match slot.state.load(Ordering::Acquire) {
            MAPPED => {
                let words: [u32; 4] = bytemuck::pod_read_unaligned(&slot.buffer.slice(..).get_mapped_range());
                slot.buffer.unmap();
                slot.state.store(IDLE, Ordering::Release);
                let texel = words[0].checked_sub(1).and_then(|s| faces.entity(s)).map(|entity| {
                    (entity, DVec2::new(f32::from_bits(words[1]).into(), f32::from_bits(words[2]).into()))
                });
                *answers.0.lock().unwrap_or_else(|e| e.into_inner()) = Some((slot.pixel, texel));
                waker.wake();
            }
            FAILED => slot.state.store(IDLE, Ordering::Release),
            MAPPING => waker.wake_after(std::time::Duration::from_millis(4)),
            _ => {}
        }
    }
}

/// In the main world: hands the latest answer to picking.
pub(super) fn deliver(
    answers: Res<PickAnswers>,
    mut picker: ResMut<Picker>,
    faces: Query<(&crate::editor::object::AuthoredFace, &crate::editor::object::DerivedFace)>,
) {
    let Some((pixel, texel)) = answers.0.lock().unwrap_or_else(|e| e.into_inner()).take() else { return };
    let hit = texel.and_then(|(face, normalised)| {
        let (authored, derived) = faces.get(face).ok()?;
        let uv = derived.0.face.as_ref()?.domain.native(normalised);
        let position = authored.surface.point(uv.x, uv.y);
        Some(crate::editor::picking::Hit { face, uv, position })
    });
    picker.answer = Some((pixel, hit));
}
