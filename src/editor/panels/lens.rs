//! A magnifier that follows the pointer: the visibility picture pixel by pixel, enlarged without interpolation, with the
//! pin holes in it.
//!
//! It shows the first sample of the picture at rest as it was read back, the same that pin holes are found in; so what it
//! shows is what was judged, and nothing is blurred by the samples of one pixel.

use bevy_egui::egui::{
    self, Align2, Color32, FontId, Mesh, Painter, Pos2, Rect, Rgba, Stroke, StrokeKind, pos2, vec2,
};

use super::Reads;
use super::inspection::hole_colour;
use crate::editor::inspection::{LatestPicture, Picture, PinHoles, are_marked};
use crate::editor::theme::size;
use crate::editor::viewport::{Pointer, Viewport};
use crate::encoding::{DisplayMode, EdgeStyle, Look, Theme};
use crate::reference::resolve::resolve;

/// Width and height of the lens, points.
const SIDE: f32 = 232.0;
/// From the pointer to the lens, points.
const BESIDE: f32 = 26.0;
/// Pixels this large have lines between them.
const LINES_FROM: f32 = 8.0;

/// Shows the lens, if it is on and the pointer is over the viewport.
pub(super) fn show(
    root: &egui::Ui,
    rect: Rect,
    reads: &Reads,
    (viewport, pointer): (&Viewport, &Pointer),
    (latest, holes): (&LatestPicture, &PinHoles),
) {
    let Some(at) = pointer.position.filter(|_| reads.settings.lens && pointer.in_viewport) else { return };
    let layer = egui::LayerId::new(egui::Order::Middle, egui::Id::new("lens"));
    let painter = root.ctx().layer_painter(layer).with_clip_rect(rect);
    let palette = &reads.palette;
    let whole = beside(rect, pos2(at.x, at.y));
    let picture = latest.of(&reads.camera.now);
    // Nothing but the caption while there is nothing to enlarge.
    let frame = match picture {
        Some(_) => whole,
        None => Rect::from_min_size(whole.min, vec2(SIDE, 22.0)),
    };
    painter.rect_filled(frame.expand(1.0), 6, palette.raised);
    let inside = Rect::from_min_max(frame.min, frame.max - vec2(0.0, 22.0));
    let caption = match picture {
        Some(picture) => {
            let centre = viewport.pixel(at);
            // The picture may be of another size than the viewport for a frame.
            let centre = [centre.x.min(picture.buffer.width - 1), centre.y.min(picture.buffer.height - 1)];
            let side = reads.settings.lens_zoom.clamp(2, 64) as f32 / viewport.scale_factor.max(0.1);
            let look = Grid { area: inside, centre, side };
            pixels(&painter.with_clip_rect(inside), reads, picture, &look);
            if are_marked(&reads.settings) {
                marks(&painter.with_clip_rect(inside), holes, reads, &look);
            }
            let here = Rect::from_min_size(look.corner(centre), vec2(side, side));
            painter.rect_stroke(here, 0, Stroke::new(1.0, palette.accent), StrokeKind::Outside);
            caption(reads, picture, centre)
        }
        None => "Magnifier: when the view is at rest".to_owned(),
    };
    let font = FontId::proportional(size::SMALL);
    let under = pos2(frame.center().x, frame.max.y - 11.0);
    painter.text(under, Align2::CENTER_CENTER, caption, font, palette.text);
    painter.rect_stroke(frame, 6, Stroke::new(1.0, palette.line), StrokeKind::Outside);
}

/// To the lower right of the pointer, or where there is room.
fn beside(rect: Rect, at: Pos2) -> Rect {
    let place = |at: f32, min: f32, max: f32| {
        let (after, before) = (at + BESIDE, at - BESIDE - SIDE);
        if after + SIDE <= max { after } else { before.max(min) }
    };
    let min = pos2(place(at.x, rect.min.x, rect.max.x), place(at.y, rect.min.y, rect.max.y));
    Rect::from_min_size(min, vec2(SIDE, SIDE))
}

/// Where the pixels of the picture are in the lens.
struct Grid {
    area: Rect,
    /// The pixel in the middle.
    centre: [u32; 2],
    /// Width of a pixel, points.
    side: f32,
}

impl Grid {
    /// The upper left corner of a pixel.
    fn corner(&self, [x, y]: [u32; 2]) -> Pos2 {
        let off = |v: u32, k: usize| (f64::from(v) - f64::from(self.centre[k]) - 0.5) as f32 * self.side;
        self.area.center() + vec2(off(x, 0), off(y, 1))
    }

    /// The pixels that are seen, along an axis: first and one past the last.
    fn range(&self, axis: usize, size: u32) -> (u32, u32) {
        let reach = (0.5 * self.area.size()[axis] / self.side).ceil() as u32 + 1;
        (self.centre[axis].saturating_sub(reach), (self.centre[axis] + reach + 1).min(size))
    }
}

/// The picture, a square for each pixel.
fn pixels(painter: &Painter, reads: &Reads, picture: &Picture, grid: &Grid) {
    painter.rect_filled(grid.area, 0, reads.palette.sky);
    let mode = match reads.settings.mode {
        crate::editor::settings::DisplayMode::Faces => DisplayMode::Faces,
        crate::editor::settings::DisplayMode::Uv => DisplayMode::Uv,
        crate::editor::settings::DisplayMode::Heat => DisplayMode::Heat,
        _ => DisplayMode::Shaded,
    };
    let edges = EdgeStyle { visible: false, ..EdgeStyle::default() };
    let look = Look::new(&picture.view, mode, edges, Theme::Transparent);
    let mut mesh = Mesh::default();
    let (width, height) = (picture.buffer.width, picture.buffer.height);
    let (columns, rows) = (grid.range(0, width), grid.range(1, height));
    for y in rows.0..rows.1 {
        for x in columns.0..columns.1 {
            let fragment = picture.buffer.at(x as i32, y as i32);
            if fragment.words[0] == 0 || picture.headers.len() < fragment.words[0] as usize {
                continue;
            }
            let colour = resolve(&look, &picture.headers, &picture.buffer, x as i32, y as i32);
            let colour = Rgba::from_rgb(colour.x, colour.y, colour.z);
            let square = Rect::from_min_size(grid.corner([x, y]), vec2(grid.side, grid.side));
            mesh.add_colored_rect(square, Color32::from(colour));
        }
    }
    painter.add(mesh);
    if grid.side >= LINES_FROM {
        let line = Stroke::new(0.5, Color32::from_black_alpha(70));
        for x in columns.0..=columns.1 {
            painter.vline(grid.corner([x, 0]).x, grid.area.y_range(), line);
        }
        for y in rows.0..=rows.1 {
            painter.hline(grid.area.x_range(), grid.corner([0, y]).y, line);
        }
    }
}

/// A frame round each pin hole.
fn marks(painter: &Painter, holes: &PinHoles, reads: &Reads, grid: &Grid) {
    for hole in holes.of(&reads.camera.now).unwrap_or_default() {
        let square = Rect::from_min_size(grid.corner(hole.pixel), vec2(grid.side, grid.side));
        if square.intersects(grid.area) {
            let stroke = Stroke::new((0.18 * grid.side).max(1.0), hole_colour(hole.class));
            painter.rect_stroke(square, 0, stroke, StrokeKind::Inside);
        }
    }
}

fn caption(reads: &Reads, picture: &Picture, [x, y]: [u32; 2]) -> String {
    let slot = picture.buffer.at(x as i32, y as i32).words[0];
    let entity = slot.checked_sub(1).and_then(|k| picture.faces.get(k as usize).copied().flatten());
    let number = entity.and_then(|entity| reads.faces.get(entity).ok()).map(|view| view.place.number);
    let what = number.map_or_else(|| "background".to_owned(), |number| format!("face {number}"));
    format!("{}×   pixel {x}, {y}   {what}", reads.settings.lens_zoom)
}
