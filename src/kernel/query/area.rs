//! Area of a trimmed face.
//!
//! The region is cut into horizontal panels between critical heights (ends of monotone edges and
//! patch lines), in which its outline is a fixed set of smooth functions u(v). Both integrals use
//! Gauss-Legendre rules, doubled until they agree. Where an edge turns at a panel's end u is like a square
//! root of v there: the panel is then measured in a variable of which v is a square (or a cubic smooth step,
//! both ends), which makes the integrand smooth. Even-odd pairs the crossings of each row.
//!
//! The error estimate is the sum of the last differences, far above the error of converged panels. The work is
//! bounded whatever a file asks for: panels that do not converge, and boundaries too tangled for panels, end with a
//! larger error.

use super::boundary::{Boundary, Edge};
use super::quadrature::{ORDERS, rule};
use super::row::Row;
use super::sheet::{Sheet, interval};
use crate::kernel::face::Face;

/// The area of a face.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Area {
    /// Model units squared.
    pub value: f64,
    /// An upper estimate of the error, model units squared.
    pub error: f64,
}

/// Relative accuracy that [`trimmed_area`] works to; smooth faces end far below it.
const ACCURACY: f64 = 1e-10;
/// A boundary of n edges is measured in sqrt(n) / EDGES_ACROSS strips.
const EDGES_ACROSS: f64 = 6.0;
/// Points of the surface looked at before panels are no longer halved: folded surfaces, whose area element has
/// creases inside patches, do not converge.
const EFFORT: i64 = 2_000_000;
/// So many more, and panels get one try each: many panels that do not converge, which damaged files have.
const OVERTIME: i64 = 12_000_000;
/// Finding where an edge crosses a height, and an iso-curve of a patch, count as so many points.
const CROSSING: usize = 6;
/// Boundaries whose panels are crossed more often than this are sampled in rows.
const MOST_CROSSINGS: f64 = 2e6;
/// The same for tangled ones, which cross rows of a strip more than [`TANGLED`] times.
const MOST_TANGLED: f64 = 5e4;
/// See [`MOST_TANGLED`].
const TANGLED: f64 = 24.0;
/// Crossings in all rows of a sampled boundary.
const SAMPLED_CROSSINGS: f64 = 2e6;
/// Rows that [`Panel::rule_across`] looks at, with all rules up to the one it takes: as many again.
const THREE_ROWS: usize = 6;
/// Halvings of a panel.
const DEPTH: u32 = 14;
/// Mean v-speeds below this part of an edge's mean count as turning.
const TURNING: f64 = 0.3;

/// Area of a derived face.
pub fn face_area(face: &Face) -> Area {
    trimmed_area(&Sheet::new(&face.patches), &Boundary::new(&face.pieces, &face.domain))
}

/// Area of the part of `sheet` inside `boundary`, or of all of it when the boundary has no edges.
///
/// Boundaries of many edges are measured in strips of u, so that a row crosses few of them.
pub fn trimmed_area(sheet: &Sheet, boundary: &Boundary) -> Area {
    let (Some(&left), Some(&right)) = (sheet.u_lines().first(), sheet.u_lines().last()) else {
        return Area::default();
    };
    let count = ((boundary.edges().len() as f64).sqrt() / EDGES_ACROSS).max(1.0) as usize;
    let at = |k: usize| if k == count { right } else { left + (right - left) * (k as f64 / count as f64) };
    let strips: Vec<Strip> = (0..count).map(|k| Strip::new(boundary, at(k), at(k + 1), count > 1)).collect();
    let whole = boundary.edges().is_empty();
    if is_tangled(&strips) {
        return sampled(sheet, boundary, (left, right));
    }
    let panels: Vec<Panel> = strips.iter().flat_map(|strip| panels(sheet, strip, whole)).collect();
    let rough: f64 = panels.iter().map(|p| p.integrate(sheet, 1, (1, 1))).sum();
    if !rough.is_finite() {
        return Area { value: rough, error: f64::INFINITY };
    }
    let mut area = Area::default();
    let mut effort = EFFORT;
    for panel in &panels {
        let Area { value, error } = panel.measure(sheet, ACCURACY * rough, DEPTH, &mut effort);
        area.value += value;
        area.error += error;
    }
    area
}

/// A strip of u and the boundary seen from it.
struct Strip {
    from: f64,
    to: f64,
    boundary: Boundary,
}

/// Whether edges cross the panels of `strips` too often: evenly spread ones do so some ten times a row.
fn is_tangled(strips: &[Strip]) -> bool {
    let rows: Vec<f64> = strips.iter().map(|s| mean_crossings(&s.boundary)).collect();
    let panels = strips.iter().map(|s| 2.0 * s.boundary.edges().len() as f64);
    let crossings: f64 = panels.zip(&rows).map(|(panels, row)| panels * row).sum();
    let row = rows.iter().sum::<f64>() / rows.len().max(1) as f64;
    crossings > if row > TANGLED { MOST_TANGLED } else { MOST_CROSSINGS }
}

impl Strip {
    fn new(boundary: &Boundary, from: f64, to: f64, cut: bool) -> Self {
        let boundary = if cut { boundary.strip(from, to) } else { boundary.clone() };
        Self { from, to, boundary }
    }
}

/// How many edges a row crosses on average.
fn mean_crossings(boundary: &Boundary) -> f64 {
    let edges = boundary.edges();
    let low = edges.iter().fold(f64::INFINITY, |a, e| a.min(e.low));
    let high = edges.iter().fold(f64::NEG_INFINITY, |a, e| a.max(e.high));
    let sum: f64 = edges.iter().map(|e| e.high - e.low).sum();
    if high > low { sum / (high - low) } else { 0.0 }
}

/// The area from evenly spread rows, without panels: for boundaries like hair, which damaged files have, and for
/// more holes than anyone counts. The error is estimated from every other row.
fn sampled(sheet: &Sheet, boundary: &Boundary, limits: (f64, f64)) -> Area {
    let lines = sheet.v_lines();
    let (Some(&bottom), Some(&top)) = (lines.first(), lines.last()) else { return Area::default() };
    let rows = (SAMPLED_CROSSINGS / mean_crossings(boundary).max(1.0)).clamp(200.0, 20_000.0) as usize;
    let mut edges: Vec<&Edge> = boundary.edges().iter().filter(|e| e.high > e.low).collect();
    edges.sort_by(|a, b| a.low.total_cmp(&b.low));
    let (mut active, mut next) = (Vec::<&Edge>::new(), 0);
    let mut sums = [0.0; 2];
    for k in 0..rows {
        let v = bottom + (top - bottom) * ((k as f64 + 0.5) / rows as f64);
        active.retain(|e| e.high > v);
        while let Some(edge) = edges.get(next).filter(|e| e.low <= v) {
            active.extend(Some(*edge).filter(|e| e.high > v));
            next += 1;
        }
        let mut crossings: Vec<f64> = active.iter().map(|e| e.u_at(v)).collect();
        crossings.sort_unstable_by(f64::total_cmp);
        sums[k % 2] += Row::new(sheet, interval(lines, v), v, limits, &crossings).integrate((0, 1));
    }
    let height = (top - bottom) / rows as f64;
    Area { value: height * (sums[0] + sums[1]), error: 2.0 * height * (sums[0] - sums[1]).abs() }
}

/// The part of a strip between two heights that edges cross from bottom to top.
struct Panel<'b> {
    low: f64,
    high: f64,
    /// Row of patches.
    cell: usize,
    /// Whether some edge turns at the lower and at the upper end.
    turning: (bool, bool),
    edges: Vec<&'b Edge>,
    strip: &'b Strip,
}

/// The panels of a strip; `whole` when nothing bounds the sheet.
fn panels<'b>(sheet: &Sheet, strip: &'b Strip, whole: bool) -> Vec<Panel<'b>> {
    let lines = sheet.v_lines();
    let (Some(&bottom), Some(&top)) = (lines.first(), lines.last()) else { return Vec::new() };
    let boundary = &strip.boundary;
    let mut edges: Vec<(&Edge, (f64, f64))> =
        boundary.edges().iter().filter(|e| e.high > e.low).map(|e| (e, e.end_speeds())).collect();
    edges.sort_by(|a, b| a.0.low.total_cmp(&b.0.low));
    let mut heights: Vec<f64> = edges.iter().flat_map(|(e, _)| [e.low, e.high]).collect();
    heights.extend(lines);
    heights.extend(edges.iter().flat_map(|(e, _)| [e.v_at(strip.from), e.v_at(strip.to)]).flatten());
    heights.retain(|v| *v >= bottom && *v <= top);
    heights.sort_unstable_by(f64::total_cmp);
    heights.dedup();
    // Thinner panels than this hold nothing that counts.
    let thinnest = 1e-14 * (top - bottom);
    let mut panels = Vec::new();
    let (mut active, mut next) = (Vec::<(&Edge, (f64, f64))>::new(), 0);
    for pair in heights.windows(2) {
        let (low, high) = (pair[0], pair[1]);
        active.retain(|(e, _)| e.high > low);
        while next < edges.len() && edges[next].0.low <= low {
            if edges[next].0.high > low {
                active.push(edges[next]);
            }
            next += 1;
        }
        if high - low <= thinnest || (active.is_empty() && !whole) {
            continue;
        }
        let at_low = active.iter().any(|(e, speed)| e.low == low && speed.0 < TURNING);
        let at_high = active.iter().any(|(e, speed)| e.high == high && speed.1 < TURNING);
        panels.push(Panel {
            low,
            high,
            cell: interval(lines, 0.5 * (low + high)),
            turning: (at_low, at_high),
            edges: active.iter().map(|(e, _)| *e).collect(),
            strip,
        });
    }
    panels
}

impl Panel<'_> {
    /// The panel's area to `tolerance`.
    fn measure(&self, sheet: &Sheet, tolerance: f64, depth: u32, effort: &mut i64) -> Area {
        if *effort < -OVERTIME {
            let [rough, value] = [0, 1].map(|order| self.integrate(sheet, order, (order, 1)));
            return Area { value, error: (value - rough).abs() };
        }
        let across = self.rule_across(sheet, tolerance);
        let mut spent = self.cost(THREE_ROWS, sheet, across) + self.cost(ORDERS[1], sheet, across);
        let mut before = self.integrate(sheet, 1, across);
        let mut error = f64::INFINITY;
        for (order, rows) in ORDERS.into_iter().enumerate().skip(2) {
            let value = self.integrate(sheet, order, across);
            spent += self.cost(rows, sheet, across);
            error = (value - before).abs();
            before = value;
            if error <= tolerance {
                break;
            }
        }
        *effort = effort.saturating_sub(i64::try_from(spent).unwrap_or(i64::MAX));
        if error <= tolerance {
            return Area { value: before, error };
        }
        if depth == 0 || *effort <= 0 || error.is_nan() {
            return Area { value: before, error };
        }
        let middle = 0.5 * (self.low + self.high);
        let part = |low, high, turning| Panel { low, high, turning, edges: self.edges.clone(), ..*self };
        let lower =
            part(self.low, middle, (self.turning.0, false)).measure(sheet, tolerance, depth - 1, effort);
        let upper =
            part(middle, self.high, (false, self.turning.1)).measure(sheet, tolerance, depth - 1, effort);
        Area { value: lower.value + upper.value, error: lower.error + upper.error }
    }

    /// What `rows` rows cost in points, with the rule `across`: each patch that a row passes through is an iso-curve to
    /// make and an interval to integrate over.
    fn cost(&self, rows: usize, sheet: &Sheet, (order, parts): (usize, usize)) -> usize {
        let patches = sheet.columns(self.strip.from, self.strip.to);
        let intervals = self.edges.len().max(2) / 2 + patches;
        rows * (self.edges.len() * CROSSING + patches * CROSSING + intervals * ORDERS[order] * parts)
    }

    /// A rule in u (order index and number of equal parts) that suffices at three heights.
    fn rule_across(&self, sheet: &Sheet, tolerance: f64) -> (usize, usize) {
        const RULES: [(usize, usize); 8] = [(0, 1), (1, 1), (2, 1), (3, 1), (3, 2), (3, 4), (3, 8), (3, 16)];
        let size = self.high - self.low;
        let mut needed = 0;
        for part in [0.03, 0.5, 0.97] {
            let row = self.row(sheet, self.low + part * size);
            let mut before = row.integrate(RULES[needed]);
            while needed + 1 < RULES.len() {
                let value = row.integrate(RULES[needed + 1]);
                if (value - before).abs() * size <= 0.1 * tolerance {
                    break;
                }
                before = value;
                needed += 1;
            }
        }
        RULES[needed]
    }

    fn row(&self, sheet: &Sheet, v: f64) -> Row {
        let mut crossings: Vec<f64> = self.edges.iter().map(|e| e.u_at(v)).collect();
        if self.edges.is_empty() {
            crossings.extend([self.strip.from, self.strip.to]);
        }
        crossings.sort_unstable_by(f64::total_cmp);
        Row::new(sheet, self.cell, v, (self.strip.from, self.strip.to), &crossings)
    }

    fn integrate(&self, sheet: &Sheet, order: usize, across: (usize, usize)) -> f64 {
        let size = self.high - self.low;
        let sum = rule(order).iter().map(|(x, w)| {
            // Height in 0..1 and its derivative.
            let (y, slope) = match self.turning {
                (false, false) => (*x, 1.0),
                (true, false) => (x * x, 2.0 * x),
                (false, true) => (x * (2.0 - x), 2.0 - 2.0 * x),
                (true, true) => (x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x)),
            };
            w * slope * self.row(sheet, self.low + size * y).integrate(across)
        });
        size * sum.sum::<f64>()
    }
}
