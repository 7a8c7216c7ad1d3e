//! Who gets the pointer: the viewport or a panel.

use bevy::prelude::*;
use bevy::window::PrimaryWindow;
use bevy_egui::{EguiContexts, egui};
use egui_file_dialog::DialogState;

use super::Picker;
use crate::editor::camera::Drag;
use crate::editor::files::FileDialogs;
use crate::editor::uv::UvPanel;
use crate::editor::viewport::{Pointer, Viewport};

/// Decides anew while no button is down; a drag stays where it began.
pub(super) fn route(
    windows: Query<&Window, With<PrimaryWindow>>,
    buttons: Res<ButtonInput<MouseButton>>,
    viewport: Res<Viewport>,
    uv: Res<UvPanel>,
    dialogs: Res<FileDialogs>,
    drag: Res<Drag>,
    mut contexts: EguiContexts,
    mut pointer: ResMut<Pointer>,
    mut picker: ResMut<Picker>,
) {
    let Ok(window) = windows.single() else { return };
    let mut now = *pointer;
    now.position = window.cursor_position();
    let ctx = contexts.ctx_mut().ok();
    now.keyboard_taken = ctx.as_ref().is_some_and(|ctx| ctx.text_edit_focused());
    now.sheet_open = ctx.as_ref().is_some_and(|ctx| ctx.memory(|m| m.top_modal_layer().is_some()))
        || *dialogs.dialog.state() == DialogState::Open;
    let held_before = buttons.get_pressed().any(|b| !buttons.just_pressed(*b));
    if !held_before {
        let free = |position: Vec2| {
            let above = ctx.as_ref().is_some_and(|ctx| {
                let layer = ctx.layer_id_at(egui::pos2(position.x, position.y));
                layer.is_some_and(|l| l.order != egui::Order::Background)
                    || ctx.egui_is_using_pointer()
                    || ctx.any_popup_open()
            });
            !above
        };
        let free_at = now.position.filter(|p| free(*p));
        now.in_viewport = free_at.is_some_and(|p| viewport.contains(p));
        now.in_uv = uv.open && free_at.is_some_and(|p| uv.view.contains(p.as_dvec2()));
    }
    pointer.set_if_neq(now);
    // Nothing lights up while the view turns, which saves looking too.
    let looks = pointer.in_viewport && !drag.is_on();
    let wanted = pointer.position.filter(|_| looks).map(|p| viewport.pixel(p));
    // A click keeps its pixel until it is answered, wherever the pointer goes meanwhile.
    if picker.wanted != wanted && picker.click.is_none() {
        picker.wanted = wanted;
    }
}
