//! Number of gaps by size, on a logarithmic scale; the tolerance is dragged in it.

use bevy_egui::egui::{Align2, Color32, CornerRadius, FontId, Rect, Sense, Stroke, Ui, pos2, vec2};

use super::InspectionState;
use crate::editor::inspection::ramp;
use crate::editor::theme::{Palette, size};
use crate::inspect::Length;

/// Exponents of ten of the lowest and the highest bin's outer ends, millimetres: 1 pm to 10 mm.
const RANGE: (i32, i32) = (-9, 1);
/// Bins in a decade.
const FINENESS: i32 = 3;

/// Shows the histogram in what is left of the height.
pub(super) fn show(ui: &mut Ui, palette: &Palette, state: &mut InspectionState) {
    let height = ui.available_height().clamp(60.0, 240.0);
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click_and_drag());
    let plot = Rect::from_min_max(rect.min + vec2(2.0, 6.0), rect.max - vec2(2.0, 18.0));
    let decades = f64::from(RANGE.1 - RANGE.0);
    let x_of = |mm: f64| {
        let part = ((mm.log10() - f64::from(RANGE.0)) / decades).clamp(0.0, 1.0);
        plot.min.x + plot.width() * part as f32
    };
    let bins = bins(&state.findings.statistics().gaps);
    let most = bins.iter().copied().max().unwrap_or(0).max(1);
    let painter = ui.painter_at(rect);
    painter.rect_filled(plot, CornerRadius::same(3), palette.sunken);
    // The number of the bin under the pointer, else of the fullest.
    let pointer_x = response.hover_pos().map_or(f32::NAN, |p| p.x);
    let wide = plot.width() / bins.len() as f32;
    let font = FontId::proportional(size::SMALL - 1.0);
    for (k, number) in bins.iter().enumerate().filter(|(_, n)| **n > 0) {
        // Square root: one bad gap beside a thousand good ones is still seen.
        let share = (*number as f32 / most as f32).sqrt();
        let left = plot.min.x + wide * k as f32;
        let top = plot.max.y - (share * (plot.height() - 14.0)).max(2.0);
        let exponent = f64::from(RANGE.0) + (k as f64 + 0.5) / f64::from(FINENESS);
        let [r, g, b] = ramp::colour(10f64.powf(exponent));
        let bar = Rect::from_min_max(pos2(left + 0.5, top), pos2(left + wide - 0.5, plot.max.y));
        painter.rect_filled(bar, CornerRadius::same(1), Color32::from_rgb(r, g, b));
        if bar.expand(1.0).x_range().contains(pointer_x) || (pointer_x.is_nan() && *number == most) {
            let at = pos2(bar.center().x, top - 1.0);
            painter.text(at, Align2::CENTER_BOTTOM, number, font.clone(), palette.text);
        }
    }
    for (exponent, text) in [(-9, "1 pm"), (-6, "1 nm"), (-3, "1 um"), (0, "1 mm")] {
        let x = x_of(10f64.powi(exponent));
        painter.vline(x, plot.max.y..=plot.max.y + 3.0, Stroke::new(1.0, palette.weak));
        let align = if exponent == RANGE.0 { Align2::LEFT_TOP } else { Align2::CENTER_TOP };
        painter.text(pos2(x, plot.max.y + 4.0), align, text, font.clone(), palette.weak);
    }
    let x = x_of(state.choices.tolerance);
    painter.vline(x, plot.y_range(), Stroke::new(1.5, palette.accent));
    if let Some(pointer) = response.interact_pointer_pos() {
        let part = f64::from(((pointer.x - plot.min.x) / plot.width()).clamp(0.0, 1.0));
        let mm = 10f64.powf(f64::from(RANGE.0) + part * decades).clamp(1e-6, 1.0);
        if state.choices.tolerance != mm {
            state.choices.tolerance = mm;
            ui.ctx().request_repaint();
        }
    }
    response.on_hover_text(format!(
        "Gaps by size. Drag to set the tolerance, now {}",
        Length { mm: state.choices.tolerance }
    ));
}

/// Numbers of gaps per bin; smaller and larger ones are in the outer bins.
fn bins(gaps: &[f64]) -> Vec<usize> {
    let mut bins = vec![0; ((RANGE.1 - RANGE.0) * FINENESS) as usize];
    let last = bins.len() - 1;
    for gap in gaps {
        let at = if *gap > 0.0 { (gap.log10() - f64::from(RANGE.0)) * f64::from(FINENESS) } else { 0.0 };
        bins[at.floor().clamp(0.0, last as f64) as usize] += 1;
    }
    bins
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_gap_is_in_one_bin() {
        let gaps = [0.0, 1e-15, 1.001e-9, 0.999e-3, 1.001e-3, 0.5, 1e9];
        let bins = bins(&gaps);
        assert_eq!(bins.iter().sum::<usize>(), gaps.len());
        assert_eq!((bins[0], bins[17], bins[18], bins[29]), (3, 1, 1, 1));
    }
}
