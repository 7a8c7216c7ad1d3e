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
use crate::kernel::tessellate::simplify::{simplify, simplify_along};
use crate::kernel::tessellate::tessellator::CHORD_SHARE;
use crate::kernel::tessellate::{
    CoherentPoints, CurveDivision, CurveError, Ground, Run, SurfaceDivision, TessellationOptions,
    Tessellator, untrimmed,
};
use crate::kernel::view::Bounds;
use crate::meshing::{Work, measure_each, mesh_faces};
use crate::scene::demo;
use crate::scene::records::ModelRecord;

/// Tolerance as a part of the model's diagonal.
const TOLERANCE: f64 = 1e-4;

/// Points along a side of a triangle at most.
const DENSEST: usize = 2000;

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
        "Trim curves, edges of all loops by themselves; ratios to line error and midpoint (P2: point error 1.05, simplified \
         0.89 in 1.34 times the time, control point 1.01). P2 divides for 3/4 of the tolerance and simplifies by the rest, we \
         divide for all of it and hold simplified chords against the curves",
        &[
            "model",
            "line error",
            "point error",
            "ratio",
            "simplified",
            "ratio",
            "time",
            "as P2",
            "ratio",
            "control point",
            "ratio",
            "even",
            "ratio",
            "simplified",
            "ratio",
        ],
    );
    let mut sums = [0.0; 7];
    for subject in subjects {
        let edges = |division, error, simplified: Simplified| {
            let share = if simplified == Simplified::AsP2 { TessellationOptions::GAMMA } else { 1.0 };
            let options = TessellationOptions {
                curve_division: division,
                curve_error: error,
                // Joins the curves of each loop.
                simplify: true,
                ..TessellationOptions::new(share * subject.tolerance)
            };
            let prepared: Vec<Tessellator> =
                subject.faces.iter().filter_map(|f| Tessellator::new(f, &options).ok()).collect();
            let mut count = 0usize;
            let seconds = fastest(3, || {
                count = 0;
                for face in &prepared {
                    for (samples, (_, _, run)) in
                        face.own_boundary().iter().flatten().zip(face.outline().runs())
                    {
                        count += simplified.edges(run, samples, subject.tolerance);
                    }
                }
            });
            (count as f64, seconds)
        };
        let (line, plain_s) = edges(CurveDivision::Midpoint, CurveError::Line, Simplified::Not);
        let (simplified, simplified_s) = edges(CurveDivision::Midpoint, CurveError::Line, Simplified::Along);
        let found = [
            line,
            edges(CurveDivision::Midpoint, CurveError::Point, Simplified::Not).0,
            simplified,
            edges(CurveDivision::Midpoint, CurveError::Line, Simplified::AsP2).0,
            edges(CurveDivision::ControlPoint, CurveError::Line, Simplified::Not).0,
            edges(CurveDivision::Even, CurveError::Line, Simplified::Not).0,
            edges(CurveDivision::Even, CurveError::Line, Simplified::Along).0,
        ];
        sums.iter_mut().zip(found).for_each(|(sum, x)| *sum += x);
        sheet.row(curve_row(&subject.name, found, Some(simplified_s / plain_s)));
    }
    if subjects.len() > 1 {
        sheet.row(curve_row("all", sums, None));
    }
    sheet
}

/// How the chords of a loop are made fewer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Simplified {
    Not,
    /// By what P2 leaves of the tolerance.
    AsP2,
    /// By the curves themselves.
    Along,
}

impl Simplified {
    /// Chords that are left of those of a loop.
    fn edges(self, run: &Run, samples: &[EdgeSample], tolerance: f64) -> usize {
        let left = match self {
            Self::Not => samples.len(),
            Self::AsP2 => {
                let rest = (1.0 - TessellationOptions::GAMMA) * tolerance;
                simplify(samples, rest, f64::INFINITY).len()
            }
            Self::Along => simplify_along(run, samples, CHORD_SHARE * tolerance, f64::INFINITY).len(),
        };
        left.saturating_sub(1)
    }
}

fn curve_row(name: &str, found: [f64; 7], time: Option<f64>) -> Vec<String> {
    let line = found[0];
    let mut cells = vec![name.to_owned(), format!("{line:.0}")];
    for (k, x) in found.iter().enumerate().skip(1) {
        cells.push(format!("{x:.0}"));
        cells.push(number((line > 0.0).then(|| x / line)));
        if k == 2 {
            cells.push(number(time));
        }
    }
    cells
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
            // Triangles alone take as many points as asked for; those of the surface come on top.
            let wanted = samples as f64 / triangles.max(1) as f64;
            let density = ((2.0 * wanted).sqrt().ceil() as usize).clamp(2, DENSEST);
            let each = measure_each(&faces, &mesh, density, samples);
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
