//! `hairline info` for people: a few short tables.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::summary::{FaceInfo, Info};
use crate::exchange::report::{Remark, Severity};

/// Writes `info` as aligned text.
///
/// # Errors
/// As `out`.
pub fn write_text(info: &Info, out: &mut dyn Write) -> io::Result<()> {
    let unit = &info.unit.name;
    writeln!(out, "{}  ({})", info.name, info.report.origin)?;
    writeln!(out, "unit          {unit} ({} mm)", info.unit.millimetres)?;
    if let Some([x0, y0, z0, x1, y1, z1]) = info.bbox {
        writeln!(out, "box           {:.6} x {:.6} x {:.6} {unit}", x1 - x0, y1 - y0, z1 - z0)?;
        writeln!(out, "              from ({x0:.6}, {y0:.6}, {z0:.6}) to ({x1:.6}, {y1:.6}, {z1:.6})")?;
    }
    writeln!(out, "area          {:.6} {unit}2", info.area)?;
    let c = &info.counts;
    writeln!(out, "parts         {}", c.parts)?;
    writeln!(out, "faces         {} ({} trimmed, {} loops)", c.faces, c.trimmed_faces, c.loops)?;
    let bytes = info.memory;
    writeln!(
        out,
        "memory        {} of patches, {} of trimming",
        in_bytes(bytes.patch_bytes),
        in_bytes(bytes.trim_bytes)
    )?;
    writeln!(out, "\nTrim curves along the pipeline")?;
    for (stage, count) in [
        ("original NURBS", c.nurbs_curves),
        ("after Bezier conversion", c.bezier_curves),
        ("after splitting at the extrema", c.monotone_segments),
        ("after removing redundancies", c.kept_segments),
        ("in the interval lists (P1)", c.interval_segments),
        ("in the parity grid (default)", c.grid_entries),
    ] {
        writeln!(out, "  {stage:<32}{count:>10}")?;
    }
    histogram(out, "Bezier trim curves by degree", &info.curve_degrees)?;
    histogram(out, "Bezier patches by larger degree", &info.patch_degrees)?;
    faces(out, &info.faces)?;
    report(out, info)
}

fn histogram(out: &mut dyn Write, title: &str, counts: &BTreeMap<usize, usize>) -> io::Result<()> {
    let total: usize = counts.values().sum();
    if total == 0 {
        return Ok(());
    }
    let mean = counts.iter().map(|(degree, n)| degree * n).sum::<usize>() as f64 / total as f64;
    writeln!(out, "\n{title} (mean {mean:.1})")?;
    write!(out, "  degree")?;
    counts.keys().try_for_each(|degree| write!(out, "{degree:>8}"))?;
    write!(out, "\n  number")?;
    counts.values().try_for_each(|n| write!(out, "{n:>8}"))?;
    writeln!(out)
}

fn faces(out: &mut dyn Write, faces: &[FaceInfo]) -> io::Result<()> {
    writeln!(out, "\n  face  source        degree  loops curves            area  name")?;
    for face in faces {
        let source = face.source.as_ref().map_or("-".into(), |s| format!("{} D{}", s.entity, s.id));
        let degree = format!("{}x{}", face.degree_u, face.degree_v);
        let area = face.area.map_or("?".into(), |a| format!("{a:.6}"));
        let name = face.name.as_deref().unwrap_or("");
        let line = format!(
            "{:>6}  {source:<12}{degree:>8}{:>7}{:>7}{area:>16}  {name}",
            face.index, face.loops, face.curves
        );
        writeln!(out, "{}", line.trim_end())?;
    }
    Ok(())
}

fn report(out: &mut dyn Write, info: &Info) -> io::Result<()> {
    let remarks = &info.report.remarks;
    let count = |severity, one: &str| {
        let n = remarks.iter().filter(|r| r.severity == severity).count();
        format!("{n} {one}{}", if n == 1 { "" } else { "s" })
    };
    writeln!(
        out,
        "\nImport report: {}, {}, {}",
        count(Severity::Error, "error"),
        count(Severity::Warning, "warning"),
        count(Severity::Note, "note")
    )?;
    if !info.report.entities.is_empty() {
        let kinds: Vec<String> =
            info.report.entities.iter().map(|(kind, n)| format!("{kind}: {n}")).collect();
        writeln!(out, "  entities  {}", kinds.join(", "))?;
    }
    remarks.iter().try_for_each(|remark| writeln!(out, "  {}", remark_line(remark)))
}

/// One remark: `warning: entity 144 D17, line 93: ...`.
pub fn remark_line(remark: &Remark) -> String {
    let severity = match remark.severity {
        Severity::Note => "note",
        Severity::Warning => "warning",
        Severity::Error => "error",
    };
    let mut place = Vec::new();
    if !remark.entity.is_empty() {
        place.push(format!("entity {} D{}", remark.entity, remark.id));
    }
    if remark.line > 0 {
        place.push(format!("line {}", remark.line));
    }
    if place.is_empty() {
        return format!("{severity}: {}", remark.message);
    }
    format!("{severity}: {}: {}", place.join(", "), remark.message)
}

fn in_bytes(bytes: usize) -> String {
    match bytes {
        0..10_000 => format!("{bytes} B"),
        10_000..10_000_000 => format!("{:.1} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}
