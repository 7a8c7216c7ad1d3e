//! What `hairline check` says of a model, as plain data: version 1 of the JSON described in
//! `docs/check-schema.md`. Lengths and points are in millimetres, whatever the unit of the file.

use glam::{DVec2, DVec3};
use serde::Serialize;

use super::edge::{Edge, EdgeKind};
use super::gap::GapSense;
use super::inspection::Inspection;
use super::statistics::{Statistics, Tally};
use crate::scene::records::{LengthUnit, ModelRecord, SourceRecord};

/// Name of the format in each report.
pub const FORMAT: &str = "hairline-check";
/// Its version; it rises when a field changes its meaning or goes.
pub const VERSION: u32 = 1;
/// The worst gaps are listed even when they pass, this many.
pub const WORST: usize = 10;

/// The report of one model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// [`FORMAT`].
    pub format: &'static str,
    /// [`VERSION`].
    pub version: u32,
    /// The file as it was named.
    pub file: String,
    /// Whether nothing exceeds the tolerance.
    pub passes: bool,
    /// Name of the model.
    pub model: String,
    /// Unit of the file.
    pub unit: LengthUnit,
    /// Largest gap that passes.
    pub tolerance_mm: f64,
    /// Whether naked edges fail the model.
    pub naked_fails: bool,
    /// Number of faces.
    pub faces: usize,
    /// Entities of the file that could not be read.
    pub skipped: usize,
    /// Diagonal of the box around all trim curves.
    pub size_mm: f64,
    /// Edges by kind.
    pub edges: EdgeCounts,
    /// Gaps of all edges.
    pub gaps: GapCounts,
    /// Gaps that exceed the tolerance (at least the worst ten, largest first), then non-manifold edges within
    /// it, then naked ones (longest first).
    pub findings: Vec<Finding>,
}

/// Edges by kind; lengths in mm.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct EdgeCounts {
    pub shared: Tally,
    pub naked: Tally,
    pub non_manifold: Tally,
    pub seam: Tally,
    pub degenerate: Tally,
}

/// How the gaps are spread.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct GapCounts {
    /// Number of edges with a gap figure: all that have two sides or more.
    pub count: usize,
    /// Those above the tolerance.
    pub above_tolerance: usize,
    /// Half of the gaps are no larger.
    pub median_mm: f64,
    /// Nine tenths of the gaps are no larger.
    pub p90_mm: f64,
    /// The largest.
    pub maximum_mm: f64,
    /// Numbers of gaps below, between and above [`bins`].
    pub histogram: Vec<Bin>,
}

/// A bar of the histogram.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Bin {
    /// Gaps from here (0 for the first bin) ...
    pub from_mm: f64,
    /// ... to less than this; none for the last bin.
    pub to_mm: Option<f64>,
    /// Number of gaps.
    pub count: usize,
}

/// Limits of the bins, mm: 1 nm to 10 mm in steps of half a decade.
pub fn bins() -> Vec<f64> {
    (-12..=2).map(|k| 10f64.powf(0.5 * f64::from(k))).collect()
}

/// An edge to look at.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// What it is.
    pub kind: EdgeKind,
    /// Whether it fails the model.
    pub exceeds: bool,
    /// Length of the edge.
    pub length_mm: f64,
    /// The trim curves on it.
    pub sides: Vec<Side>,
    /// The gap, where there are two sides or more.
    pub gap: Option<GapFigures>,
}

/// A stretch of a trim curve; numbers from 1.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Side {
    /// Number of the face.
    pub face: usize,
    /// Name of the face, if it has one.
    pub name: Option<String>,
    /// Entity that the face was made from.
    pub source: Option<SourceRecord>,
    /// Number of the loop in the face; one more than there are for the sides of its surface.
    #[serde(rename = "loop")]
    pub trim_loop: usize,
    /// Number of the curve in the loop.
    pub curve: usize,
    /// First parameter of the stretch.
    pub from: f64,
    /// Last parameter of the stretch.
    pub to: f64,
    /// Whether it runs along with the first side.
    pub forward: bool,
}

/// Figures of a gap.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GapFigures {
    /// Largest distance.
    pub maximum_mm: f64,
    /// It is expected to be no larger than `maximum_mm` and this; an estimate.
    pub error_bound_mm: f64,
    /// Mean distance along the edge.
    pub mean_mm: f64,
    /// How the sides lie to each other there.
    pub sense: GapSense,
    /// Distance across the edge there: positive overlaps, negative stands open.
    pub across_mm: f64,
    /// Distance along the normal there.
    pub step_mm: f64,
    /// Distance along the edge there: not zero only where one side ends before the other.
    pub along_mm: f64,
    /// Largest angle between the tangent planes.
    pub angle_degrees: f64,
    /// The two points where it is largest.
    pub between: [Place; 2],
}

/// A point on a side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Place {
    /// Number of the side in the finding, from 1.
    pub side: usize,
    /// Parameter of its trim curve.
    pub t: f64,
    /// Parameters of its surface.
    pub uv: DVec2,
    /// The point, in millimetres.
    pub point_mm: DVec3,
}

/// What a report is made with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Terms {
    /// Largest gap that passes, mm.
    pub tolerance_mm: f64,
    /// Whether naked edges fail.
    pub naked_fails: bool,
}

impl Report {
    /// The report of `model`, inspected in its own unit, read from `file` with `skipped` entities lost.
    pub fn new(
        file: String,
        model: &ModelRecord,
        skipped: usize,
        inspection: &Inspection,
        terms: Terms,
    ) -> Self {
        let mm = model.unit.millimetres;
        let statistics = Statistics::of(inspection);
        let scaled = |t: Tally| Tally { length: t.length * mm, ..t };
        let edges = EdgeCounts {
            shared: scaled(statistics.shared),
            naked: scaled(statistics.naked),
            non_manifold: scaled(statistics.non_manifold),
            seam: scaled(statistics.seam),
            degenerate: scaled(statistics.degenerate),
        };
        let above_tolerance = statistics.above(terms.tolerance_mm / mm);
        Self {
            format: FORMAT,
            version: VERSION,
            file,
            passes: above_tolerance == 0 && !(terms.naked_fails && edges.naked.count > 0),
            model: model.name.clone(),
            unit: model.unit.clone(),
            tolerance_mm: terms.tolerance_mm,
            naked_fails: terms.naked_fails,
            faces: model.faces.len(),
            skipped,
            size_mm: inspection.scale().size * mm,
            edges,
            gaps: gap_counts(&statistics, above_tolerance, mm),
            findings: findings(model, inspection, terms),
        }
    }
}

fn gap_counts(statistics: &Statistics, above_tolerance: usize, mm: f64) -> GapCounts {
    let limits = bins();
    let counts = statistics.histogram(&limits.iter().map(|l| l / mm).collect::<Vec<_>>());
    let from = std::iter::once(0.0).chain(limits.iter().copied());
    let to = limits.iter().copied().map(Some).chain(std::iter::once(None));
    let bin = |((from_mm, to_mm), count)| Bin { from_mm, to_mm, count };
    GapCounts {
        count: statistics.gaps.len(),
        above_tolerance,
        median_mm: statistics.quantile(0.5) * mm,
        p90_mm: statistics.quantile(0.9) * mm,
        maximum_mm: statistics.quantile(1.0) * mm,
        histogram: from.zip(to).zip(counts).map(bin).collect(),
    }
}

fn findings(model: &ModelRecord, inspection: &Inspection, terms: Terms) -> Vec<Finding> {
    let mm = model.unit.millimetres;
    let gap = |e: &Edge| e.gap.map_or(0.0, |g| g.maximum) * mm;
    let exceeds = |e: &Edge| gap(e) > terms.tolerance_mm;
    let all: Vec<&Edge> = inspection.edges().map(|e| e.1).collect();
    let mut gaps: Vec<&Edge> = all.iter().copied().filter(|e| e.gap.is_some()).collect();
    gaps.sort_by(|a, b| gap(b).total_cmp(&gap(a)));
    let listed = gaps.iter().filter(|e| exceeds(e)).count().max(WORST).min(gaps.len());
    let (listed, rest) = gaps.split_at(listed);
    let mut naked: Vec<&Edge> = all.iter().copied().filter(|e| e.kind == EdgeKind::Naked).collect();
    naked.sort_by(|a, b| b.length().total_cmp(&a.length()));
    let others = rest.iter().filter(|e| e.kind == EdgeKind::NonManifold);
    let finding = |e: &&Edge| Finding {
        kind: e.kind,
        exceeds: exceeds(e) || (terms.naked_fails && e.kind == EdgeKind::Naked),
        length_mm: e.length() * mm,
        sides: e.uses.iter().map(|u| side(model, u)).collect(),
        gap: e.gap.as_ref().map(|g| figures(g, mm)),
    };
    listed.iter().chain(others).chain(&naked).map(finding).collect()
}

fn side(model: &ModelRecord, one: &super::edge::EdgeUse) -> Side {
    let face = model.faces.get(one.curve.face);
    Side {
        face: one.curve.face + 1,
        name: face.and_then(|f| f.name.clone()),
        source: face.and_then(|f| f.source.clone()),
        trim_loop: one.curve.trim_loop + 1,
        curve: one.curve.curve + 1,
        from: one.interval.0,
        to: one.interval.1,
        forward: one.forward,
    }
}

fn figures(gap: &super::gap::Gap, mm: f64) -> GapFigures {
    let place = |end: &super::gap::GapEnd| Place {
        side: end.side + 1,
        t: end.t,
        uv: end.uv,
        point_mm: end.point * mm,
    };
    GapFigures {
        maximum_mm: gap.maximum * mm,
        error_bound_mm: gap.error_bound * mm,
        mean_mm: gap.mean * mm,
        sense: gap.sense,
        across_mm: gap.across * mm,
        step_mm: gap.step * mm,
        along_mm: gap.along * mm,
        angle_degrees: gap.angle.to_degrees(),
        between: [place(&gap.between[0]), place(&gap.between[1])],
    }
}
