//! What a row of the model tree looks like, and drawing it.

use bevy::prelude::Entity;
use bevy_egui::egui::{Align2, Color32, CornerRadius, FontId, Rect, Ui, pos2, vec2};

use super::format::plural;
use super::icon::{self, Icon};
use super::tree_rows::Row;
use super::{FaceViewItem, Owned, Reads};
use crate::editor::theme::size;
use crate::scene::records::LoopRole;

/// What a row looks like.
pub(super) struct Look {
    pub depth: f32,
    pub text: String,
    pub detail: String,
    pub swatch: Option<Color32>,
    pub open: Option<bool>,
    pub eye: Option<bool>,
    pub strong: bool,
    pub selected: bool,
}

/// The look of a row, unless what it is about is gone.
pub(super) fn look(row: Row, faces: &[Entity], reads: &Reads, owned: &Owned) -> Option<Look> {
    let shown = || faces.iter().any(|f| reads.faces.get(*f).is_ok_and(|f| f.shown.0));
    let model_rows = |m: usize| {
        reads.scene.models.len() > 1 || reads.scene.models.get(m).is_some_and(|m| m.parts.len() < 2)
    };
    let rows = &owned.state.tree.rows;
    match row {
        Row::Model(m) => {
            let entry = reads.scene.models.get(m)?;
            Some(Look {
                depth: 0.0,
                text: {
                    let star = if reads.editing.is_unsaved() { "*" } else { "" };
                    format!("{star}{}", reads.models.get(entry.entity).ok()?.name)
                },
                detail: plural(faces.len(), "face"),
                swatch: None,
                open: Some(!rows.closed.contains(&entry.entity)),
                eye: Some(shown()),
                strong: true,
                selected: false,
            })
        }
        Row::Part(m, p) => {
            let entry = reads.scene.models.get(m)?.parts.get(p)?;
            Some(Look {
                depth: if model_rows(m) { 1.0 } else { 0.0 },
                text: reads.parts.get(entry.entity).ok()?.name.clone(),
                detail: plural(faces.len(), "face"),
                swatch: None,
                open: Some(!rows.closed.contains(&entry.entity)),
                eye: Some(shown()),
                strong: true,
                selected: false,
            })
        }
        Row::Face(face) => {
            let FaceViewItem { authored, place, shown, .. } = reads.faces.get(face).ok()?;
            let record = &authored.attributes;
            let text = match &record.name {
                Some(name) => format!("{}  {name}", place.number),
                None => format!("Face {}", place.number),
            };
            let (u, v) = (authored.surface.knots_u().degree(), authored.surface.knots_v().degree());
            Some(Look {
                depth: 1.0,
                text,
                detail: format!("{u} × {v}"),
                swatch: record.colour.map(srgb),
                open: (!authored.loops.is_empty()).then(|| rows.open_faces.contains(&face)),
                eye: Some(shown.0),
                strong: false,
                selected: owned.selection.contains(face),
            })
        }
        Row::Loop(face, index) => {
            let record = reads.records.trim_loop(face, index)?;
            let role = match record.role {
                LoopRole::Outer => "Outer loop",
                LoopRole::Inner => "Inner loop",
                LoopRole::Unknown => "Loop",
            };
            Some(Look {
                depth: 2.2,
                text: format!("{role} {}", index + 1),
                detail: plural(record.curves.len(), "curve"),
                swatch: None,
                open: None,
                eye: None,
                strong: false,
                selected: false,
            })
        }
    }
}

/// A linear colour of a record as egui wants it.
pub(super) fn srgb(linear: [f32; 3]) -> Color32 {
    let encode = |x: f32| {
        let x = x.clamp(0.0, 1.0);
        let y = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
        (255.0 * y).round() as u8
    };
    Color32::from_rgb(encode(linear[0]), encode(linear[1]), encode(linear[2]))
}

/// Draws a row.
pub(super) fn paint_row(ui: &Ui, rect: Rect, look: &Look, hovered: bool, reads: &Reads) {
    let p = &reads.palette;
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    if look.selected {
        painter.rect_filled(rect.shrink2(vec2(4.0, 0.5)), CornerRadius::same(4), p.selected);
        let mark = Rect::from_min_size(rect.min + vec2(4.0, 4.0), vec2(2.5, rect.height() - 8.0));
        painter.rect_filled(mark, CornerRadius::same(1), p.accent);
    } else if hovered {
        painter.rect_filled(rect.shrink2(vec2(4.0, 0.5)), CornerRadius::same(4), p.hovered);
    }
    let hidden = look.eye == Some(false);
    let mut x = rect.min.x + 6.0 + 14.0 * look.depth;
    let cell = |x: f32| Rect::from_min_size(pos2(x, rect.min.y), vec2(16.0, rect.height()));
    if let Some(open) = look.open {
        icon::paint(&painter, cell(x), if open { Icon::Down } else { Icon::Right }, p.weak);
    }
    x += 19.0;
    if let Some(color) = look.swatch {
        let swatch = Rect::from_center_size(pos2(x + 5.0, rect.center().y), vec2(10.0, 10.0));
        painter.rect_filled(swatch, CornerRadius::same(3), color);
        x += 17.0;
    }
    let color = match (hidden, look.selected || look.strong) {
        (true, _) => p.weak.gamma_multiply(0.7),
        (false, true) => p.strong,
        (false, false) => p.text,
    };
    let font = FontId::proportional(size::BODY);
    let detail = painter.layout_no_wrap(look.detail.clone(), FontId::proportional(size::SMALL), p.weak);
    let right = rect.max.x - 38.0;
    let detail_at = pos2(right - detail.size().x, rect.center().y - 0.5 * detail.size().y);
    let text_clip =
        Rect::from_min_max(rect.min, pos2(detail_at.x - 6.0, rect.max.y)).intersect(ui.clip_rect());
    painter.with_clip_rect(text_clip).text(
        pos2(x, rect.center().y),
        Align2::LEFT_CENTER,
        &look.text,
        font,
        color,
    );
    painter.galley(detail_at, detail, p.weak);
    if let Some(eye) = look.eye
        && (hovered || !eye)
    {
        icon::paint(&painter, cell(rect.max.x - 28.0), if eye { Icon::Eye } else { Icon::EyeOff }, p.weak);
    }
}
