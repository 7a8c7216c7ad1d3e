//! The report as one self-contained page: summary, histogram, pictures of the worst gaps, table.
//!
//! No file or server is needed beside it: style and script are inline, pictures embedded as PNG with labels
//! and scale bars drawn over them as SVG. Everything that comes from a file is escaped.

use std::fmt::Write;

use super::Outcome;
use super::histogram;
use super::picture::{Picture, SIZE};
use super::text::{faces, kind_word, sense_word};
use crate::inspect::Length;
use crate::inspect::report::{Finding, Report};

/// Rows of the table; the JSON has them all.
const ROWS: usize = 2_000;

/// The whole page.
pub(super) fn page(outcomes: &[Outcome]) -> String {
    let title = match outcomes {
        [Outcome::Checked { report, .. }] => format!("Gaps of {}", escaped(&report.model)),
        _ => format!("Gaps of {} models", outcomes.len()),
    };
    let mut out = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\
         <title>{title}</title>\n<style>\n{}</style></head>\n<body><main>\n",
        include_str!("page.css")
    );
    for outcome in outcomes {
        match outcome {
            Outcome::Checked { report, pictures } => section(&mut out, report, pictures),
            Outcome::Unreadable { file, reason } => {
                let (file, reason) = (escaped(file), escaped(reason));
                let _ = writeln!(
                    out,
                    "<section><header><h1>{file}</h1><span class=\"verdict fail\">not checked</span></header>\
                     <p class=\"panel error\">{reason}</p></section>"
                );
            }
        }
    }
    let _ = writeln!(
        out,
        "<footer>Made by hairline {}. Gaps are distances between the exact curves in space on either side of an edge; \
         no triangles are involved. Faces, loops and curves are numbered from 1 in the order of the file.</footer>\n\
         </main>\n<script>\n{}</script></body></html>",
        env!("CARGO_PKG_VERSION"),
        include_str!("page.js")
    );
    out
}

/// Text as it may stand in HTML, in attributes too.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if c.is_control() && c != '\n' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

fn length(mm: f64) -> String {
    Length { mm }.to_string()
}

fn section(out: &mut String, report: &Report, pictures: &[Picture]) {
    let (class, word) = if report.passes { ("pass", "passes") } else { ("fail", "fails") };
    let _ = writeln!(
        out,
        "<section><header><h1>{}</h1><span class=\"verdict {class}\">{word} at {}</span></header>\n\
         <p class=\"note\">{} &middot; {} faces &middot; {} across &middot; file in {}{}</p>",
        escaped(&report.model),
        length(report.tolerance_mm),
        escaped(&report.file),
        report.faces,
        length(report.size_mm),
        escaped(&report.unit.name),
        if report.skipped > 0 {
            format!(" &middot; {} entities could not be read", report.skipped)
        } else {
            String::new()
        }
    );
    cards(out, report);
    if report.gaps.count > 0 {
        let _ = writeln!(
            out,
            "<h2>How large the gaps are</h2><div class=\"panel\">{}</div>",
            histogram::svg(report)
        );
    }
    let shown: Vec<_> = report.findings.iter().filter(|f| f.gap.is_some()).zip(pictures).collect();
    if !shown.is_empty() {
        out.push_str("<h2>The worst</h2><div class=\"gallery\">\n");
        shown
            .into_iter()
            .enumerate()
            .for_each(|(k, (finding, picture))| figure(out, k + 1, finding, picture));
        out.push_str("</div>\n");
    }
    table(out, report);
    out.push_str("</section>\n");
}

fn cards(out: &mut String, report: &Report) {
    let (gaps, edges) = (&report.gaps, &report.edges);
    out.push_str("<div class=\"cards\">");
    let mut card = |value: String, what: &str| {
        let _ = write!(out, "<div class=\"card\"><b>{value}</b><span>{what}</span></div>");
    };
    card(gaps.above_tolerance.to_string(), "gaps above the tolerance");
    card(length(gaps.maximum_mm), "largest gap");
    card(length(gaps.p90_mm), "nine tenths are no larger");
    card(length(gaps.median_mm), "half are no larger");
    card(edges.shared.count.to_string(), &format!("shared edges, {}", length(edges.shared.length)));
    card(edges.naked.count.to_string(), &format!("naked edges, {}", length(edges.naked.length)));
    card(edges.non_manifold.count.to_string(), "edges of three faces or more");
    card(edges.seam.count.to_string(), "seams of faces with themselves");
    out.push_str("</div>\n");
}

fn figure(out: &mut String, rank: usize, finding: &Finding, picture: &Picture) {
    let Some(gap) = &finding.gap else { return };
    let [width, height] = SIZE;
    let p = gap.between[0].point_mm;
    let _ = writeln!(
        out,
        "<figure><div class=\"frame\"><img width=\"{width}\" height=\"{height}\" alt=\"Gap {rank}: {} between faces {}\" \
         src=\"data:image/png;base64,{}\">{}</div>\
         <figcaption><b>{rank}. {} {}</b> &middot; faces {}<br>mean {}, edge {} long, angle {:.2}&deg;<br>at {:.4}, {:.4}, {:.4} mm</figcaption></figure>",
        length(gap.maximum_mm),
        faces(finding),
        base64(&picture.png),
        overlay(picture, gap.maximum_mm),
        length(gap.maximum_mm),
        sense_word(gap.sense),
        faces(finding),
        length(gap.mean_mm),
        length(finding.length_mm),
        gap.angle_degrees,
        p.x,
        p.y,
        p.z
    );
}

/// Labels, the gap's two ends and a scale bar over a picture.
fn overlay(picture: &Picture, gap_mm: f64) -> String {
    let [width, height] = SIZE;
    let mut out = format!("<svg class=\"overlay\" viewBox=\"0 0 {width} {height}\" aria-hidden=\"true\">");
    for (face, at) in &picture.labels_px {
        let _ = write!(out, "<text x=\"{:.1}\" y=\"{:.1}\">face {face}</text>", at.x, at.y + 5.0);
    }
    let [a, b] = picture.ends_px;
    if a.distance(b) >= 3.0 {
        let _ = write!(
            out,
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"#c0362c\" stroke-width=\"2\"/>",
            a.x, a.y, b.x, b.y
        );
        let right = if a.x >= b.x { a } else { b };
        let _ = write!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\" style=\"text-anchor:start;fill:#c0362c\">{}</text>",
            right.x + 9.0,
            0.5 * (a.y + b.y) + 5.0,
            length(gap_mm)
        );
    } else {
        let _ = write!(
            out,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"9\" fill=\"none\" stroke=\"#c0362c\" stroke-width=\"2\"/>",
            a.x, a.y
        );
    }
    let (mm, px) = scale_bar(picture.mm_per_px);
    let (x, y) = (f64::from(width) - 16.0, f64::from(height) - 16.0);
    let _ = write!(
        out,
        "<path d=\"M{:.1} {:.1}v8h{px:.1}v-8\" fill=\"none\" stroke=\"white\" stroke-width=\"5\"/>\
         <path d=\"M{:.1} {:.1}v8h{px:.1}v-8\" fill=\"none\" stroke=\"#1d2733\" stroke-width=\"2\"/>\
         <text x=\"{:.1}\" y=\"{:.1}\">{}</text></svg>",
        x - px,
        y - 8.0,
        x - px,
        y - 8.0,
        x - 0.5 * px,
        y - 5.0,
        length(mm)
    );
    out
}

/// A round length that is 60 to 150 pixels wide, in mm, and its pixels.
fn scale_bar(mm_per_px: f64) -> (f64, f64) {
    let least = 60.0 * mm_per_px;
    let decade = 10f64.powf(least.log10().floor());
    let mm = [1.0, 2.0, 5.0, 10.0].map(|k| k * decade).into_iter().find(|mm| *mm >= least).unwrap_or(least);
    (mm, mm / mm_per_px)
}

fn table(out: &mut String, report: &Report) {
    if report.findings.is_empty() {
        return;
    }
    out.push_str(
        "<h2>All findings</h2><div class=\"scroll\"><table><thead><tr>\
         <th class=\"text\" data-sort=\"text\">edge</th><th data-sort=\"number\">gap</th><th data-sort=\"number\">mean</th>\
         <th class=\"text\" data-sort=\"text\">sense</th><th data-sort=\"number\">angle</th><th data-sort=\"number\">length</th>\
         <th class=\"text\" data-sort=\"text\">faces</th><th class=\"text\">curves (face.loop.curve)</th><th class=\"text\">at (mm)</th>\
         </tr></thead><tbody>\n",
    );
    for finding in report.findings.iter().take(ROWS) {
        row(out, finding);
    }
    out.push_str("</tbody></table></div>\n");
    if report.findings.len() > ROWS {
        let _ = writeln!(out, "<p class=\"note\">{} more are in the JSON.</p>", report.findings.len() - ROWS);
    }
}

fn row(out: &mut String, finding: &Finding) {
    let class = if finding.exceeds { " class=\"over\"" } else { "" };
    let _ = write!(out, "<tr{class}><td class=\"text\">{}</td>", kind_word(finding.kind));
    match &finding.gap {
        Some(gap) => {
            let _ = write!(
                out,
                "<td data-key=\"{}\">{}</td><td data-key=\"{}\">{}</td><td class=\"text\">{}</td><td data-key=\"{}\">{:.2}&deg;</td>",
                gap.maximum_mm,
                length(gap.maximum_mm),
                gap.mean_mm,
                length(gap.mean_mm),
                sense_word(gap.sense),
                gap.angle_degrees,
                gap.angle_degrees
            );
        }
        None => out.push_str("<td data-key=\"-1\"></td><td data-key=\"-1\"></td><td class=\"text\"></td><td data-key=\"-1\"></td>"),
    }
    let curves: Vec<String> =
        finding.sides.iter().take(6).map(|s| format!("{}.{}.{}", s.face, s.trim_loop, s.curve)).collect();
    let names: Vec<String> =
        finding.sides.iter().take(6).filter_map(|s| s.name.as_deref().map(escaped)).collect();
    let at = finding.gap.as_ref().map_or(String::new(), |g| {
        let p = g.between[0].point_mm;
        format!("{:.4}, {:.4}, {:.4}", p.x, p.y, p.z)
    });
    let _ = writeln!(
        out,
        "<td data-key=\"{}\">{}</td><td class=\"text\" title=\"{}\">{}</td><td class=\"text\">{}</td><td class=\"text\">{at}</td></tr>",
        finding.length_mm,
        length(finding.length_mm),
        names.join(", "),
        faces(finding),
        curves.join(" "),
    );
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = chunk.iter().fold(0u32, |w, b| (w << 8) | u32::from(*b)) << (8 * (3 - chunk.len()));
        for k in 0..4 {
            let digit = char::from(DIGITS[(word >> (18 - 6 * k)) as usize & 63]);
            out.push(if k <= chunk.len() { digit } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_as_in_rfc_4648() {
        for (plain, code) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(plain.as_bytes()), code);
        }
    }

    #[test]
    fn names_cannot_break_out() {
        let bad = "\"><script>alert('x')</script>&\u{1}";
        assert_eq!(escaped(bad), "&quot;&gt;&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&amp;\u{fffd}");
        let page = page(&[Outcome::Unreadable { file: bad.into(), reason: bad.into() }]);
        assert!(!page.contains("<script>alert"));
    }

    #[test]
    fn scale_bars_are_round() {
        for (mm_per_px, expected) in [(1e-3, 0.1), (3.0, 200.0), (0.017, 2.0), (7.7e-7, 5e-5)] {
            let (mm, px) = scale_bar(mm_per_px);
            assert!((mm / expected - 1.0).abs() < 1e-12, "{mm_per_px}: {mm}");
            assert!((60.0..151.0).contains(&px));
        }
    }
}
