//! egui's style made from a [`Palette`].

use std::sync::Arc;

use bevy_egui::egui::{
    Context, CornerRadius, FontData, FontDefinitions, FontFamily, FontId, Margin, Shadow, Stroke, Style,
    TextStyle, Theme, Vec2, Visuals, style::WidgetVisuals,
};

use super::{Palette, size};

/// Name of the medium weight.
pub(crate) const MEDIUM: &str = "medium";

/// Roboto for text (its figures are tabular), egui's own fonts for signs it lacks.
pub(super) fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    let regular = include_bytes!("../../../assets/fonts/Roboto-Regular.ttf");
    let medium = include_bytes!("../../../assets/fonts/Roboto-Medium.ttf");
    fonts.font_data.insert("roboto".into(), Arc::new(FontData::from_static(regular)));
    fonts.font_data.insert("roboto-medium".into(), Arc::new(FontData::from_static(medium)));
    let proportional = fonts.families.entry(FontFamily::Proportional).or_default();
    let mut heavy = proportional.clone();
    proportional.insert(0, "roboto".into());
    heavy.insert(0, "roboto-medium".into());
    fonts.families.insert(FontFamily::Name(MEDIUM.into()), heavy);
    fonts
}

/// Sets the style of `ctx`.
pub(super) fn apply(ctx: &Context, palette: &Palette) {
    let theme = if palette.light { Theme::Light } else { Theme::Dark };
    ctx.set_theme(theme);
    let mut style = Style { visuals: visuals(palette), ..Style::default() };
    let medium = FontFamily::Name(MEDIUM.into());
    style.text_styles = [
        (TextStyle::Body, FontId::proportional(size::BODY)),
        (TextStyle::Button, FontId::proportional(size::BODY)),
        (TextStyle::Small, FontId::proportional(size::SMALL)),
        (TextStyle::Monospace, FontId::monospace(size::BODY - 1.0)),
        (TextStyle::Heading, FontId::new(size::BODY, medium)),
    ]
    .into();
    let spacing = &mut style.spacing;
    spacing.item_spacing = Vec2::new(8.0, 4.0);
    spacing.button_padding = Vec2::new(8.0, 4.0);
    spacing.interact_size = Vec2::new(32.0, size::ROW);
    spacing.menu_margin = Margin::same(6);
    spacing.menu_width = 230.0;
    spacing.window_margin = Margin::same(14);
    spacing.scroll.floating = true;
    spacing.tooltip_width = 320.0;
    style.interaction.selectable_labels = false;
    style.interaction.tooltip_delay = 0.35;
    style.animation_time = 0.0;
    ctx.set_style_of(theme, style);
}

fn visuals(p: &Palette) -> Visuals {
    let mut v = if p.light { Visuals::light() } else { Visuals::dark() };
    let radius = CornerRadius::same(4);
    let widget = |fill, stroke, text| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, stroke),
        corner_radius: radius,
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    };
    v.widgets.noninteractive = widget(p.panel, p.line, p.text);
    v.widgets.inactive = widget(p.raised, p.line, p.text);
    v.widgets.hovered = widget(p.hovered, p.line, p.strong);
    v.widgets.active = widget(p.hovered, p.accent, p.strong);
    v.widgets.open = widget(p.hovered, p.line, p.strong);
    v.weak_text_color = Some(p.weak);
    v.selection.bg_fill = p.selected;
    v.selection.stroke = Stroke::new(1.0, p.strong);
    v.hyperlink_color = p.accent;
    v.faint_bg_color = p.hovered;
    v.extreme_bg_color = p.sunken;
    v.text_edit_bg_color = Some(p.sunken);
    v.code_bg_color = p.sunken;
    v.warn_fg_color = p.warning;
    v.error_fg_color = p.error;
    v.window_fill = p.raised;
    v.window_stroke = Stroke::new(1.0, p.line);
    v.window_corner_radius = CornerRadius::same(8);
    v.menu_corner_radius = CornerRadius::same(6);
    let alpha = if p.light { 40 } else { 110 };
    v.window_shadow = Shadow {
        offset: [0, 6],
        blur: 20,
        spread: 0,
        color: bevy_egui::egui::Color32::from_black_alpha(alpha),
    };
    v.popup_shadow = v.window_shadow;
    v.panel_fill = p.panel;
    // A blinking cursor would draw frames for ever.
    v.text_cursor.blink = false;
    v.indent_has_left_vline = false;
    v
}
