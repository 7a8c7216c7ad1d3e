//! Colours of the uv panel and of the handles in 3D, by role.

use bevy_egui::egui::Color32;

use crate::editor::theme::Palette;

/// Colours for a theme.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Colors {
    /// Beyond the surface's domain.
    pub canvas: Color32,
    /// The domain of the surface, trimmed away.
    pub domain: Color32,
    /// The face.
    pub inside: Color32,
    pub grid_minor: Color32,
    pub grid_major: Color32,
    pub border: Color32,
    pub knot: Color32,
    pub outer: Color32,
    pub hole: Color32,
    pub polygon: Color32,
    pub point: Color32,
    pub selected: Color32,
    pub hovered: Color32,
    pub snap: Color32,
    pub problem: Color32,
    pub ruler: Color32,
    pub ruler_text: Color32,
    /// A shape being drawn.
    pub drawing: Color32,
    pub structure: Color32,
}

impl Colors {
    /// The colours that go with `palette`.
    pub fn of(palette: &Palette) -> Self {
        let rgb = Color32::from_rgb;
        if palette.light {
            Self {
                canvas: rgb(222, 225, 230),
                domain: rgb(240, 242, 245),
                inside: rgb(198, 215, 233),
                grid_minor: Color32::from_black_alpha(9),
                grid_major: Color32::from_black_alpha(20),
                border: rgb(128, 136, 148),
                knot: Color32::from_rgba_unmultiplied(96, 70, 170, 120),
                outer: rgb(30, 36, 46),
                hole: rgb(0, 92, 168),
                polygon: Color32::from_rgba_unmultiplied(40, 50, 66, 120),
                point: rgb(255, 255, 255),
                selected: palette.accent,
                hovered: rgb(255, 130, 20),
                snap: rgb(160, 30, 150),
                problem: palette.error,
                ruler: Color32::from_rgba_unmultiplied(243, 244, 246, 235),
                ruler_text: palette.weak,
                drawing: palette.accent,
                structure: rgb(0, 122, 104),
            }
        } else {
            Self {
                canvas: rgb(20, 21, 24),
                domain: rgb(36, 38, 43),
                inside: rgb(58, 70, 86),
                grid_minor: Color32::from_white_alpha(5),
                grid_major: Color32::from_white_alpha(13),
                border: rgb(104, 111, 122),
                knot: Color32::from_rgba_unmultiplied(168, 142, 255, 110),
                outer: rgb(232, 236, 242),
                hole: rgb(116, 190, 255),
                polygon: Color32::from_rgba_unmultiplied(200, 210, 224, 100),
                point: rgb(20, 21, 24),
                selected: palette.accent,
                hovered: rgb(255, 190, 122),
                snap: rgb(236, 120, 228),
                problem: palette.error,
                ruler: Color32::from_rgba_unmultiplied(26, 28, 31, 235),
                ruler_text: palette.weak,
                drawing: palette.accent,
                structure: rgb(72, 200, 176),
            }
        }
    }

    /// The colour of a loop's curves.
    pub fn of_loop(&self, is_hole: bool) -> Color32 {
        if is_hole { self.hole } else { self.outer }
    }
}
