//! The report of one model for people, on standard output.

use std::io::{self, Write};

use crate::inspect::edge_name;
use crate::inspect::gap::GapSense;
use crate::inspect::report::{Finding, Report};
use crate::inspect::{EdgeKind, Length};

/// Rows of the table of the worst gaps.
const ROWS: usize = 10;

/// Writes `report` as aligned text.
///
/// # Errors
/// As `out`.
pub fn write(report: &Report, out: &mut dyn Write) -> io::Result<()> {
    let length = |mm: f64| Length { mm }.to_string();
    let e = &report.edges;
    writeln!(out, "{}: {} faces, {} across", report.file, report.faces, length(report.size_mm))?;
    if report.skipped > 0 {
        writeln!(
            out,
            "  skipped      {} entities could not be read (hairline info tells which)",
            report.skipped
        )?;
    }
    write!(out, "  edges        {} shared ({})", e.shared.count, length(e.shared.length))?;
    for (name, tally) in [("naked", e.naked), ("non-manifold", e.non_manifold), ("seam", e.seam)] {
        write!(out, ", {} {name} ({})", tally.count, length(tally.length))?;
    }
    writeln!(out, ", {} degenerate", e.degenerate.count)?;
    let gaps = &report.gaps;
    if gaps.count > 0 {
        writeln!(
            out,
            "  gaps         {} measured: half up to {}, nine tenths up to {}, largest {}",
            gaps.count,
            length(gaps.median_mm),
            length(gaps.p90_mm),
            length(gaps.maximum_mm)
        )?;
    }
    let verdict = if report.passes { "passes" } else { "fails" };
    write!(out, "  {verdict:<12} {} gaps exceed {}", gaps.above_tolerance, length(report.tolerance_mm))?;
    let naked = if report.naked_fails { "; naked edges fail too" } else { "" };
    writeln!(out, "{naked}")?;
    let worst: Vec<&Finding> = report.findings.iter().filter(|f| f.gap.is_some()).take(ROWS).collect();
    if !worst.is_empty() {
        writeln!(out, "\n  worst gaps        mean  kind      angle  faces            length  at (mm)")?;
    }
    worst.iter().try_for_each(|finding| row(finding, out))
}

fn row(finding: &Finding, out: &mut dyn Write) -> io::Result<()> {
    let Some(gap) = &finding.gap else { return Ok(()) };
    let p = gap.between[0].point_mm;
    writeln!(
        out,
        "  {:>10} {:>11}  {:<8} {:>6.2}  {:<12} {:>10}  {:.6} {:.6} {:.6}",
        Length { mm: gap.maximum_mm }.to_string(),
        Length { mm: gap.mean_mm }.to_string(),
        sense_word(gap.sense),
        gap.angle_degrees,
        faces(finding),
        Length { mm: finding.length_mm }.to_string(),
        p.x,
        p.y,
        p.z
    )
}

/// A gap's sense in a word.
pub fn sense_word(sense: GapSense) -> &'static str {
    match sense {
        GapSense::Closed => "closed",
        GapSense::Opening => "opening",
        GapSense::Overlap => "overlap",
        GapSense::Step => "step",
    }
}

/// An edge's kind in words.
pub fn kind_word(kind: EdgeKind) -> &'static str {
    edge_name(kind)
}

/// The faces of a finding, `3-17`; of many the first few.
pub fn faces(finding: &Finding) -> String {
    let mut numbers: Vec<usize> = finding.sides.iter().map(|s| s.face).collect();
    numbers.dedup();
    let more = if numbers.len() > 4 { "-..." } else { "" };
    let shown: Vec<String> = numbers.iter().take(4).map(usize::to_string).collect();
    shown.join("-") + more
}
