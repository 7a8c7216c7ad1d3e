//! The look: two palettes, one accent, one font, one set of spacings.
//!
//! Wiring: `install` runs in the egui pass before any panel, at start and when the theme changes.

mod palette;
mod style;

use bevy::prelude::*;
use bevy_egui::{EguiContexts, egui};

pub use palette::Palette;

use super::settings::Settings;

/// Text sizes, points.
pub(super) mod size {
    /// Everything, unless below.
    pub const BODY: f32 = 13.0;
    /// Side remarks and column heads.
    pub const SMALL: f32 = 11.5;
    /// Titles of dialogs.
    pub const TITLE: f32 = 18.0;
    /// Height of a row in lists.
    pub const ROW: f32 = 24.0;
}

/// Whether the fonts have arrived: they do so one frame after they are set.
pub(super) fn is_ready(ctx: &egui::Context) -> bool {
    ctx.fonts(|fonts| {
        fonts.definitions().families.contains_key(&egui::FontFamily::Name(style::MEDIUM.into()))
    })
}

/// Height that the atlas of glyphs is brought to before anything is shown, texels.
const ATLAS_HEIGHT: usize = 1024;

/// Makes the atlas of glyphs grow while nothing is on the screen yet: in a frame in which it grows no panel
/// is drawn at all. It doubles when it is full, so half of it is free afterwards.
fn grow_atlas(ctx: &egui::Context) {
    ctx.fonts_mut(|fonts| {
        for size in 60..120u8 {
            if fonts.font_image_size()[1] >= ATLAS_HEIGHT {
                break;
            }
            let font = egui::FontId::proportional(size.into());
            fonts.layout_no_wrap("ABCDEFGHIJKLMNOPQRSTUVWXYZ".into(), font, egui::Color32::WHITE);
        }
    });
}

/// Sizes in which text changes while something is dragged, points.
const LIVE_SIZES: [f32; 5] = [10.5, 11.0, size::SMALL, 12.0, size::BODY];
/// Orders in which letters are drawn ahead: the place of a letter within a pixel follows from those before it, and there
/// is a picture of it for some of these places.
const ORDERS: usize = 16;

/// Draws letters ahead: one that is drawn for the first time is missing in that frame, which flickers while figures
/// follow a drag.
fn draw_ahead(ctx: &egui::Context) {
    let letters: Vec<char> = (' '..='~').chain("…–°×·²".chars()).collect();
    let count = letters.len();
    let medium = egui::FontFamily::Name(style::MEDIUM.into());
    let fonts = LIVE_SIZES.map(egui::FontId::proportional).into_iter();
    let all: Vec<egui::FontId> = fonts.chain([egui::FontId::new(size::BODY, medium)]).collect();
    for order in 0..ORDERS {
        // A step that has no factor in common with the number of letters passes all of them.
        let step = (2 * order + 1..).find(|s| greatest_divisor(*s, count) == 1).unwrap_or(1);
        let text: String = (0..count).map(|k| letters[k * step % count]).collect();
        ctx.fonts_mut(|fonts| {
            for font in &all {
                fonts.layout_no_wrap(text.clone(), font.clone(), egui::Color32::WHITE);
            }
        });
    }
}

fn greatest_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}

/// A press is a click if the button is let go within this time, seconds. Time passes from frame to frame: with egui's 0.8
/// clicks are lost where a frame takes that long, while a picture refines on a busy machine, say.
const CLICK_S: f64 = 10.0;

/// Sets fonts once and the style whenever the theme changes.
pub(super) fn install(
    mut contexts: EguiContexts,
    settings: Res<Settings>,
    mut installed: Local<Option<bool>>,
    mut grown: Local<bool>,
    mut palette: ResMut<Palette>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    if !*grown && is_ready(ctx) {
        grow_atlas(ctx);
        draw_ahead(ctx);
        *grown = true;
    }
    if *installed == Some(settings.light) {
        return Ok(());
    }
    if installed.is_none() {
        ctx.set_fonts(style::fonts());
        ctx.options_mut(|options| options.input_options.max_click_duration = CLICK_S);
    }
    *palette = Palette::of(settings.light);
    style::apply(ctx, &palette);
    *installed = Some(settings.light);
    Ok(())
}
