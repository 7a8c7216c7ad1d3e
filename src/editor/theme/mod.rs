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

/// Sets fonts once and the style whenever the theme changes.
pub(super) fn install(
    mut contexts: EguiContexts,
    settings: Res<Settings>,
    mut installed: Local<Option<bool>>,
    mut palette: ResMut<Palette>,
) -> Result {
    if *installed == Some(settings.light) {
        return Ok(());
    }
    let ctx = contexts.ctx_mut()?;
    if installed.is_none() {
        ctx.set_fonts(style::fonts());
    }
    *palette = Palette::of(settings.light);
    style::apply(ctx, &palette);
    *installed = Some(settings.light);
    Ok(())
}
