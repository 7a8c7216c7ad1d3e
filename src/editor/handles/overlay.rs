//! Words over the 3D view: what is wrong where the rings are, and how far a drag has come.

use bevy_egui::egui::{Rect, Ui, pos2};

use super::aim::Lens;
use crate::editor::elements::ActiveFace;
use crate::editor::theme::Palette;
use crate::editor::uv::{Colors, draw_problems};
use crate::editor::viewport::Viewport;
use crate::kernel::view::Camera;

/// Draws the labels.
pub fn show(
    root: &Ui,
    rect: Rect,
    camera: &Camera,
    viewport: &Viewport,
    active: &ActiveFace,
    palette: &Palette,
) {
    let Some(face) = active.face.as_ref().filter(|f| f.problems.iter().any(|p| p.is_serious())) else {
        return;
    };
    let (lens, colors) = (Lens::new(camera, viewport), Colors::of(palette));
    let painter = root.painter().with_clip_rect(rect);
    let mut labels = draw_problems::Labels::default();
    for problem in face.problems.iter().filter(|p| p.is_serious()).take(draw_problems::MOST) {
        let Some((at, _)) = lens.project(face.point_in_space(problem.uv)) else { continue };
        let (text, color) = (draw_problems::label(problem), draw_problems::color(problem, palette));
        labels.words(&painter, pos2(at.x, at.y), text, color, colors.ruler);
    }
}
