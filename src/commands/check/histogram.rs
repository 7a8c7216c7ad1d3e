//! The spread of gaps as an inline SVG: bars over half decades from 1 nm to 10 mm, and the tolerance.

use std::fmt::Write;

use crate::inspect::Length;
use crate::inspect::report::Report;

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 220.0;
const LEFT: f64 = 46.0;
const BOTTOM: f64 = 40.0;
const TOP: f64 = 26.0;

/// The SVG element.
pub fn svg(report: &Report) -> String {
    let bins = &report.gaps.histogram;
    let most = bins.iter().map(|b| b.count).max().unwrap_or(0).max(1) as f64;
    let step = (WIDTH - LEFT - 10.0) / bins.len() as f64;
    let floor = HEIGHT - BOTTOM;
    let height = |count: usize| (floor - TOP) * count as f64 / most;
    let mut out = format!(
        "<svg class=\"histogram\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" \
         aria-label=\"Number of gaps by size on a logarithmic scale\">"
    );
    for (k, bin) in bins.iter().enumerate() {
        let x = LEFT + step * k as f64;
        let h = height(bin.count);
        let over = bin.from_mm >= report.tolerance_mm * (1.0 - 1e-9);
        let class = if over { "bar over" } else { "bar" };
        let range = match bin.to_mm {
            Some(to) if bin.from_mm == 0.0 => format!("below {}", Length { mm: to }),
            Some(to) => format!("{} to {}", Length { mm: bin.from_mm }, Length { mm: to }),
            None => format!("{} and more", Length { mm: bin.from_mm }),
        };
        let _ = write!(
            out,
            "<g><title>{}: {}</title><rect class=\"{class}\" x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" rx=\"2\"/>",
            range,
            bin.count,
            x + 2.0,
            floor - h,
            step - 4.0,
            h
        );
        if bin.count > 0 {
            let _ = write!(
                out,
                "<text class=\"count\" x=\"{:.1}\" y=\"{:.1}\">{}</text>",
                x + 0.5 * step,
                floor - h - 5.0,
                bin.count
            );
        }
        out.push_str("</g>");
    }
    let _ = write!(
        out,
        "<line class=\"axis\" x1=\"{LEFT}\" y1=\"{floor}\" x2=\"{:.1}\" y2=\"{floor}\"/>",
        WIDTH - 10.0
    );
    // A tick at each whole decade: the limits between bins are every second one.
    for (k, bin) in bins.iter().enumerate().skip(1).step_by(2) {
        let x = LEFT + step * k as f64;
        let label = ticks(bin.from_mm);
        let _ = write!(
            out,
            "<line class=\"axis\" x1=\"{x:.1}\" y1=\"{floor}\" x2=\"{x:.1}\" y2=\"{:.1}\"/>",
            floor + 5.0
        );
        let _ = write!(out, "<text class=\"tick\" x=\"{x:.1}\" y=\"{:.1}\">{label}</text>", floor + 18.0);
    }
    // Bins start at 1 nm; each is half a decade wide.
    let decades = (report.tolerance_mm / 1e-6).log10();
    let x = (LEFT + step * (1.0 + 2.0 * decades)).clamp(LEFT, WIDTH - 10.0);
    let _ = write!(
        out,
        "<line class=\"limit\" x1=\"{x:.1}\" y1=\"{:.1}\" x2=\"{x:.1}\" y2=\"{floor}\"/>\
         <text class=\"limit-text\" x=\"{:.1}\" y=\"12\">tolerance {}</text>",
        TOP - 10.0,
        x.clamp(LEFT + 60.0, WIDTH - 70.0),
        Length { mm: report.tolerance_mm }
    );
    let _ = write!(
        out,
        "<text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\">largest gap of each edge</text></svg>",
        0.5 * (LEFT + WIDTH),
        HEIGHT - 6.0
    );
    out
}

/// `1 nm`, `10 um`: whole powers of ten without decimals.
fn ticks(mm: f64) -> String {
    let text = Length { mm: mm * (1.0 + 1e-9) }.to_string();
    match text.split_once(' ') {
        Some((number, unit)) => {
            let whole = number.parse::<f64>().map_or(number.to_owned(), |n| format!("{n:.0}"));
            format!("{whole} {unit}")
        }
        None => text,
    }
}
