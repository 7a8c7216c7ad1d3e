//! Handles over the model: lines and marks of constant width, faded where the model hides them.
//!
//! Everything is drawn twice: where it is in front of the model, and faintly where it is behind. The depth of
//! both is taken a little nearer than it is, because trim curves lie on the surface.

use std::sync::Arc;

use bevy::prelude::*;
use bevy::render::Extract;
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::{ViewDepthTexture, ViewTarget};
use bevy_egui::egui::{Color32, Rgba};
use glam::DVec3;

use super::frame::FrameView;
use super::strokes::{LineInstance, MarkInstance, Stroke, StrokeDraw, Uniform, draw_all};
use crate::editor::handles::{HandleDrawing, HandlePicture};

/// Opacity of what is hidden.
const HIDDEN: f32 = 0.22;
/// Depth is multiplied by this: lines on a surface win against it.
const NEARER: f32 = 1.002;
/// For marks, which are wider.
const MUCH_NEARER: f32 = 1.004;

/// What the main world wants drawn.
#[derive(Resource, Default)]
pub(super) struct ExtractedHandles(Arc<HandlePicture>);

/// Takes over the picture.
pub(super) fn extract(mut handles: ResMut<ExtractedHandles>, drawing: Extract<Option<Res<HandleDrawing>>>) {
    if let Some(drawing) = drawing.as_ref()
        && !Arc::ptr_eq(&handles.0, &drawing.picture)
    {
        handles.0 = Arc::clone(&drawing.picture);
    }
}

/// Lines hidden, lines in front, marks hidden, marks in front.
#[derive(Resource)]
pub(super) struct HandlePass([StrokeDraw; 4]);

/// Makes what does not depend on the target's format.
pub(super) fn create(mut commands: Commands, device: Res<RenderDevice>) {
    // Depth is reversed: what is behind has less.
    let (behind, before) = (wgpu::CompareFunction::Less, wgpu::CompareFunction::GreaterEqual);
    let make = |stroke, compare| StrokeDraw::new(device.wgpu_device(), "handles", stroke, compare);
    commands.insert_resource(HandlePass([
        make(Stroke::Lines, behind),
        make(Stroke::Lines, before),
        make(Stroke::Marks, behind),
        make(Stroke::Marks, before),
    ]));
}

fn rgba(color: Color32) -> [f32; 4] {
    Rgba::from(color).to_rgba_unmultiplied()
}

/// Draws the handles, if there are any.
pub(super) fn draw(
    view: ViewQuery<(&ViewTarget, &ViewDepthTexture), With<super::DrawsModel>>,
    pass: Option<ResMut<HandlePass>>,
    handles: Res<ExtractedHandles>,
    frame: Res<FrameView>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut ctx: RenderContext,
) {
    let Some(mut pass) = pass else { return };
    let picture = &handles.0;
    if picture.lines.is_empty() && picture.marks.is_empty() {
        return;
    }
    let (target, depth) = view.into_inner();
    let eye = frame.camera.eye;
    let pixels = frame.viewport.scale_factor;
    let relative = |p: DVec3| (p - eye).as_vec3().to_array();
    let line = |l: &crate::editor::handles::HandleLine| {
        LineInstance::new(relative(l.start), relative(l.end), rgba(l.color), pixels * l.width_px)
    };
    let lines: Vec<LineInstance> = picture.lines.iter().map(line).collect();
    let mark = |m: &crate::editor::handles::HandleMark| MarkInstance {
        at: relative(m.at),
        fill: rgba(m.fill),
        line: rgba(m.line),
        size_px: pixels * m.size_px,
        round: f32::from(u8::from(m.round)),
    };
    let marks: Vec<MarkInstance> = picture.marks.iter().map(mark).collect();
    let (_, size) = frame.viewport.physical();
    let (device, format) = (device.wgpu_device(), target.main_texture_format());
    for (k, draw) in pass.0.iter_mut().enumerate() {
        let uniform = Uniform {
            depth: if k < 2 { NEARER } else { MUCH_NEARER },
            opacity: if k % 2 == 0 { HIDDEN } else { 1.0 },
            ..Uniform::without_fade(&frame.clip, size)
        };
        if k < 2 {
            draw.prepare(device, &queue, format, &uniform, &lines);
        } else {
            draw.prepare(device, &queue, format, &uniform, &marks);
        }
    }
    draw_all(&pass.0, "handles", (target, depth), &frame, &mut ctx);
}
