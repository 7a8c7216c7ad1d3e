//! `hairline bench tessellate`: P2's tables on our models, and meshes measured against the exact faces.
//!
//! Every ratio has both sides in the same run: kd-tree against quadtree with P2's conservative and approximate errors
//! (table 3), trim curves by P2's two errors, two divisions and simplification (table 2), evaluation row by row against
//! point by point (table 3, footnote 3). The last table measures whole meshes at as many points as asked for.

use std::io::{self, Write};
use std::time::Instant;

use super::sheet::{Sheet, fastest, number};
use crate::kernel::face::Face;
use crate::kernel::tessellate::chords::EdgeSample;
use crate::kernel::tessellate::simplify::simplify;
use crate::kernel::tessellate::{
    CoherentPoints, CurveDivision, CurveError, Ground, SurfaceDivision, TessellationOptions, Tessellator,
    untrimmed,
};
use crate::kernel::view::Bounds;
use crate::meshing::{Work, measure_each, mesh_faces};
use crate::scene::demo;
use crate::scene::records::ModelRecord;

/// Tolerance as a part of the model's diagonal.
const TOLERANCE: f64 = 1e-4;

/// A model ready to be divided.
struct Subject {
    name: String,
    faces: Vec<Face>,
    tolerance: f64,
}

impl Subject {
    fn new(model: &ModelRecord) -> Self {
        let faces: Vec<Face> = model.derive_all().into_iter().flatten().collect();
        let bounds = faces.iter().fold(Bounds::EMPTY, |b, f| b.union(f.bounds));
        let size = if bounds.is_empty() { 1.0 } else { bounds.diagonal() };
        Self { name: model.name.clone(), faces, tolerance: TOLERANCE * size }
    }

    fn options(&self) -> TessellationOptions {
        TessellationOptions::new(self.tolerance)
    }
}

/// Prints the tables, of the built-in scene where there are no `models`; meshes are measured at about `samples` points each.
///
/// # Errors
/// `out` cannot be written.
pub fn run(models: &[ModelRecord], samples: usize, out: &mut impl Write) -> io::Result<()> {
    let own = if models.is_empty() { vec![demo::model()] } else { Vec::new() };
    let subjects: Vec<Subject> = models.iter().chain(&own).map(Subject::new).collect();
    writeln!(out, "{}", surfaces(&subjects))?;
    writeln!(out, "{}", curves(&subjects))?;
    writeln!(out, "{}", coherence(&subjects))?;
    writeln!(out, "{}", meshes(&subjects, samples))
}

fn surfaces(subjects: &[Subject]) -> Sheet {
    let mut sheet = Sheet::new(
        format!(
            "Untrimmed surfaces, triangles at {TOLERANCE:e} of the size, one thread (P2: 1.90, 2.17, 1.72 times)"
        ),
        &[
            "model",
            "faces",
            "kd cons.",
            "quad cons.",
            "ratio",
            "kd approx.",
            "quad approx.",
            "ratio",
            "cons./approx.",
            "kd (s)",
            "quad (s)",
        ],
    );
    let mut sums = [0.0; 4];
    for subject in subjects {
        let triangles = |division, conservative| {
            let start = Instant::now();
            let options =
                TessellationOptions { surface_division: division, conservative, ..subject.options() };
            let count = |face| untrimmed(face, &options).map_or(0, |m| m.triangles.len());
            let all: usize = subject.faces.iter().map(count).sum();
            (all as f64, start.elapsed().as_secs_f64())
        };
        let (kd, kd_s) = triangles(SurfaceDivision::KdTree, true);
        let (quad, quad_s) = triangles(SurfaceDivision::QuadTree, true);
        let (kd_near, _) = triangles(SurfaceDivision::KdTree, false);
        let (quad_near, _) = triangles(SurfaceDivision::QuadTree, false);
        let found = [kd, quad, kd_near, quad_near];
        sums.iter_mut().zip(found).for_each(|(sum, x)| *sum += x);
        sheet.row(surface_row(&subject.name, subject.faces.len(), found, Some((kd_s, quad_s))));
    }
    if subjects.len() > 1 {
        sheet.row(surface_row("all", subjects.iter().map(|s| s.faces.len()).sum(), sums, None));
    }
    sheet
}

fn surface_row(name: &str, faces: usize, found: [f64; 4], seconds: Option<(f64, f64)>) -> Vec<String> {
    let [kd, quad, kd_near, quad_near] = found;
    let ratio = |a: f64, b: f64| number((b > 0.0).then(|| a / b));
    vec![
        name.to_owned(),
        faces.to_string(),
        format!("{kd:.0}"),
        format!("{quad:.0}"),
        ratio(quad, kd),
        format!("{kd_near:.0}"),
        format!("{quad_near:.0}"),
        ratio(quad_near, kd_near),
        ratio(kd, kd_near),
        number(seconds.map(|s| s.0)),
        number(seconds.map(|s| s.1)),
    ]
}

fn curves(subjects: &[Subject]) -> Sheet {
    let mut sheet = Sheet::new(
        "Trim curves, edges of all loops by themselves; ratios to the paper's choice (line error, midpoint)",
        &[
            "model",
            "point error",
            "ratio",
            "line error",
            "simplified",
            "ratio",
            "time",
            "control point",
            "ratio",
            "even (ours)",
            "ratio",
        ],
    );
    let mut sums = [0.0; 5];
    for subject in subjects {
        let edges = |division, error, simplified| {
            let options = TessellationOptions {
                curve_division: division,
                curve_error: error,
                simplify: simplified,
                ..subject.options()
            };
            let rest = (1.0 - options.gamma) * options.tolerance;
            let prepared: Vec<Tessellator> =
                subject.faces.iter().filter_map(|f| Tessellator::new(f, &options).ok()).collect();
            let mut count = 0usize;
            let seconds = fastest(3, || {
                count = 0;
                for samples in prepared.iter().flat_map(Tessellator::own_boundary).flatten() {
                    let samples: Vec<EdgeSample> =
                        if simplified { simplify(&samples, rest, f64::INFINITY) } else { samples };
                    count += samples.len().saturating_sub(1);
                }
            });
            (count as f64, seconds)
        };
        let point = edges(CurveDivision::Midpoint, CurveError::Point, false).0;
        let (line, plain_s) = edges(CurveDivision::Midpoint, CurveError::Line, false);
        let (simplified, simplified_s) = edges(CurveDivision::Midpoint, CurveError::Line, true);
        let control = edges(CurveDivision::ControlPoint, CurveError::Line, false).0;
        let even = edges(CurveDivision::Even, CurveError::Line, false).0;
        let found = [point, line, simplified, control, even];
        sums.iter_mut().zip(found).for_each(|(sum, x)| *sum += x);
        sheet.row(curve_row(&subject.name, found, Some(simplified_s / plain_s)));
    }
    if subjects.len() > 1 {
        sheet.row(curve_row("all", sums, None));
    }
    sheet
}

fn curve_row(
    name: &str,
    [point, line, simplified, control, even]: [f64; 5],
    time: Option<f64>,
) -> Vec<String> {
    let ratio = |x: f64| number((line > 0.0).then(|| x / line));
    let count = |x: f64| format!("{x:.0}");
    vec![
        name.to_owned(),
        count(point),
        ratio(point),
        count(line),
        count(simplified),
        ratio(simplified),
        number(time),
        count(control),
        ratio(control),
        count(even),
        ratio(even),
    ]
}

fn coherence(subjects: &[Subject]) -> Sheet {
    let mut sheet = Sheet::new(
        "Evaluating the corners of kd-trees (sorted by v): row by row against one by one (P2 saves 3 to 5 % of the whole)",
        &[
            "model",
            "points",
            "one by one (us)",
            "by rows (us)",
            "ratio",
            "points per row",
            "saved of the whole (%)",
        ],
    );
    for subject in subjects {
        let options = subject.options();
        let grounds: Vec<(Ground, Vec<glam::DVec2>)> = subject
            .faces
            .iter()
            .filter_map(|face| Some((Ground::new(face), untrimmed(face, &options).ok()?.uvs)))
            .collect();
        let points: usize = grounds.iter().map(|g| g.1.len()).sum();
        let single = fastest(5, || {
            let all =
                grounds.iter().flat_map(|(ground, uvs)| uvs.iter().map(|uv| ground.tangents(*uv).point.x));
            all.sum::<f64>()
        });
        let mut rows = 0usize;
        let shared = fastest(5, || {
            rows = 0;
            let mut sum = 0.0;
            for (ground, uvs) in &grounds {
                let mut points = CoherentPoints::new(ground);
                sum += uvs.iter().map(|uv| points.tangents(*uv).point.x).sum::<f64>();
                rows += points.rows;
            }
            sum
        });
        let whole = fastest(2, || {
            subject
                .faces
                .iter()
                .filter_map(|face| untrimmed(face, &options).ok())
                .map(|m| m.cells)
                .sum::<usize>()
        });
        sheet.row([
            subject.name.clone(),
            points.to_string(),
            number(Some(1e6 * single)),
            number(Some(1e6 * shared)),
            number((single > 0.0).then(|| shared / single)),
            number((rows > 0).then(|| points as f64 / rows as f64)),
            number(Some(100.0 * (single - shared) / (whole - shared + single))),
        ]);
    }
    sheet
}

fn meshes(subjects: &[Subject], samples: usize) -> Sheet {
    let mut sheet = Sheet::new(
        "Meshes measured against the exact faces, all threads; violations: faces measured beyond the tolerance",
        &["model", "mode", "triangles", "unproved", "samples", "error/tol.", "violations", "mesh (s)"],
    );
    let mut total = (0usize, 0usize);
    for subject in subjects {
        let faces: Vec<Option<&Face>> = subject.faces.iter().map(Some).collect();
        for conservative in [true, false] {
            let options = TessellationOptions { conservative, ..subject.options() };
            let start = Instant::now();
            let Ok(mesh) = mesh_faces(&faces, &options, &Work::QUIET) else { continue };
            let seconds = start.elapsed().as_secs_f64();
            let triangles = mesh.triangle_count();
            // The two sides take about as many points each.
            let wanted = samples as f64 / 2.0 / triangles.max(1) as f64;
            let density = ((2.0 * wanted).sqrt().ceil() as usize).clamp(2, 200);
            let most = samples / 2;
            let each = measure_each(&faces, &mesh, density, most);
            let taken: usize = each.iter().flatten().map(|d| d.samples).sum();
            let errors = each.iter().flatten().map(|d| d.largest() / options.tolerance);
            let over = errors.clone().filter(|e| *e > 1.0 + 1e-9).count();
            if conservative {
                total = (total.0 + taken, total.1 + over);
            }
            sheet.row([
                subject.name.clone(),
                if conservative { "conservative".into() } else { "approximate".into() },
                triangles.to_string(),
                mesh.faces.iter().flatten().map(|m| m.quality.over_tolerance).sum::<usize>().to_string(),
                taken.to_string(),
                number(Some(errors.fold(0.0, f64::max))),
                over.to_string(),
                number(Some(seconds)),
            ]);
        }
    }
    if subjects.len() > 1 {
        let cells = ["all", "conservative", "", "", &total.0.to_string(), "", &total.1.to_string(), ""];
        sheet.row(cells.map(str::to_owned));
    }
    sheet
}
