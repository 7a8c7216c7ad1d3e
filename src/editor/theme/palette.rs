//! Colours. Greys carry the interface, one accent marks what is active or selected.

use bevy::prelude::Resource;
use bevy_egui::egui::Color32;

/// The colours of a theme.
#[derive(Resource, Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Palette {
    pub light: bool,
    /// Side panels.
    pub panel: Color32,
    /// Menu bar, toolbar and status bar.
    pub bar: Color32,
    /// Menus, dialogs, tooltips.
    pub raised: Color32,
    /// Text fields and progress troughs.
    pub sunken: Color32,
    pub line: Color32,
    pub text: Color32,
    pub weak: Color32,
    pub strong: Color32,
    pub accent: Color32,
    /// Text and icons on `accent`.
    pub on_accent: Color32,
    /// Rows that are selected.
    pub selected: Color32,
    /// Rows and buttons under the pointer.
    pub hovered: Color32,
    pub warning: Color32,
    pub error: Color32,
    pub note: Color32,
    /// Viewport background, above and below.
    pub sky: Color32,
    pub ground: Color32,
    pub grid: Color32,
    pub axis_x: Color32,
    pub axis_y: Color32,
    pub axis_z: Color32,
}

impl Default for Palette {
    fn default() -> Self {
        Self::of(false)
    }
}

const fn grey(v: u8) -> Color32 {
    Color32::from_rgb(v, v, v)
}

impl Palette {
    /// The light or the dark palette.
    pub const fn of(light: bool) -> Self {
        if light { Self::LIGHT } else { Self::DARK }
    }

    const DARK: Self = Self {
        light: false,
        panel: Color32::from_rgb(33, 35, 39),
        bar: Color32::from_rgb(26, 28, 31),
        raised: Color32::from_rgb(43, 46, 51),
        sunken: Color32::from_rgb(22, 23, 26),
        line: Color32::from_rgb(54, 57, 63),
        text: Color32::from_rgb(205, 209, 215),
        weak: Color32::from_rgb(135, 141, 150),
        strong: Color32::from_rgb(240, 242, 245),
        accent: Color32::from_rgb(255, 149, 61),
        on_accent: Color32::from_rgb(28, 20, 12),
        selected: Color32::from_rgb(82, 58, 36),
        hovered: Color32::from_rgb(50, 53, 59),
        warning: Color32::from_rgb(232, 190, 84),
        error: Color32::from_rgb(240, 104, 96),
        note: Color32::from_rgb(122, 170, 220),
        sky: Color32::from_rgb(68, 74, 84),
        ground: Color32::from_rgb(29, 31, 35),
        grid: grey(150),
        axis_x: Color32::from_rgb(224, 86, 86),
        axis_y: Color32::from_rgb(112, 190, 92),
        axis_z: Color32::from_rgb(84, 140, 236),
    };

    const LIGHT: Self = Self {
        light: true,
        panel: Color32::from_rgb(243, 244, 246),
        bar: Color32::from_rgb(232, 234, 237),
        raised: Color32::from_rgb(252, 252, 253),
        sunken: Color32::from_rgb(255, 255, 255),
        line: Color32::from_rgb(208, 211, 217),
        text: Color32::from_rgb(45, 49, 56),
        weak: Color32::from_rgb(108, 114, 124),
        strong: Color32::from_rgb(16, 18, 22),
        accent: Color32::from_rgb(214, 96, 10),
        on_accent: Color32::from_rgb(255, 255, 255),
        selected: Color32::from_rgb(255, 226, 200),
        hovered: Color32::from_rgb(225, 228, 232),
        warning: Color32::from_rgb(168, 112, 0),
        error: Color32::from_rgb(196, 40, 34),
        note: Color32::from_rgb(30, 98, 168),
        sky: Color32::from_rgb(250, 251, 252),
        ground: Color32::from_rgb(206, 212, 220),
        grid: grey(90),
        axis_x: Color32::from_rgb(200, 50, 50),
        axis_y: Color32::from_rgb(60, 146, 46),
        axis_z: Color32::from_rgb(40, 98, 204),
    };
}
