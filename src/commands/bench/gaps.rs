//! `hairline bench gaps`: pairing and measuring a quilt of curved faces, and once more after one face changed.

use std::io::{self, Write};

use glam::DVec3;

use super::sheet::{Sheet, cpu_per_run, fastest, number};
use crate::inspect::{EdgeKind, Inspection, Statistics};
use crate::kernel::nurbs::{Direction, KnotVector, NurbsSurface};
use crate::scene::records::{FaceRecord, ModelRecord};

/// Faces along a side of the quilts.
const SIDES: [usize; 4] = [10, 32, 100, 224];

/// Prints the table.
///
/// # Errors
/// `out` cannot be written.
pub fn run(models: &[ModelRecord], out: &mut impl Write) -> io::Result<()> {
    let mut sheet = Sheet::new(
        "Pairing trim curves and measuring every gap, all threads, fastest of three below 5,000 faces; CPU: all threads together; update: one face changed",
        &[
            "model",
            "faces",
            "edges",
            "shared",
            "all (s)",
            "CPU s",
            "us per face",
            "update (ms)",
            "largest gap",
        ],
    );
    for side in SIDES {
        let quilt = ModelRecord {
            name: format!("quilt {side} x {side}"),
            faces: quilt(side),
            ..ModelRecord::default()
        };
        sheet.row(row(&quilt));
    }
    for model in models {
        sheet.row(row(model));
    }
    writeln!(out, "{sheet}")
}

fn row(model: &ModelRecord) -> Vec<String> {
    let faces = &model.faces;
    let runs = if faces.len() > 5_000 { 1 } else { 3 };
    let mut inspection = Inspection::of(&[]);
    let mut seconds = f64::INFINITY;
    let cpu = cpu_per_run(runs, || {
        let once = fastest(1, || inspection = Inspection::in_unit(faces, model.unit.millimetres));
        seconds = seconds.min(once);
    });
    let statistics = Statistics::of(&inspection);
    let shared = inspection.edges().filter(|e| e.1.kind == EdgeKind::Shared).count();
    let edges = inspection.edges().len();
    let mut number_of = faces.len() / 2;
    let update = fastest(20, || {
        if let Some(face) = faces.get(number_of) {
            inspection.update(number_of, face);
        }
        number_of = (number_of + 7) % faces.len().max(1);
    });
    vec![
        model.name.clone(),
        faces.len().to_string(),
        edges.to_string(),
        shared.to_string(),
        number(Some(seconds)),
        number(Some(cpu)),
        number(Some(1e6 * seconds / faces.len().max(1) as f64)),
        number(Some(1e3 * update)),
        format!("{:.1e}", statistics.quantile(1.0)),
    ]
}

/// One wavy rational surface cut into `side` times `side` biquadratic faces, every other one with u and v exchanged
/// and every third of higher degree, a tenth of them shifted by up to 1 um.
fn quilt(side: usize) -> Vec<FaceRecord> {
    let face = |k: usize| {
        let (i, j) = ((k / side) as f64, (k % side) as f64);
        let knots = || KnotVector::bezier(2, 0.0, 1.0);
        // Control points at thirds of a wave that neighbours continue: the edges' points depend on their
        // ends only.
        let wave = |x: f64, y: f64| 2.0 * (0.7 * x).sin() * (0.9 * y).cos();
        let points = (0..9).map(|p| {
            let (x, y) = (i + 0.5 * f64::from(p / 3), j + 0.5 * f64::from(p % 3));
            DVec3::new(10.0 * x, 10.0 * y, wave(x, y))
        });
        let weights = (0..9).map(|p| {
            let middle = |k: i32| if k == 1 { 0.8 } else { 1.0 };
            middle(p / 3) * middle(p % 3)
        });
        let surface =
            NurbsSurface::new(knots().ok()?, knots().ok()?, points.collect(), weights.collect()).ok()?;
        let mut surface = if k % 2 == 0 { surface.transposed() } else { surface };
        if k % 3 == 0 {
            surface = surface.elevated(Direction::U, 1).ok()?;
        }
        if k % 10 == 0 {
            let by = DVec3::Z * 1e-3 * (k as f64 * 0.37).sin();
            surface = surface.map_points(|p| p + by);
        }
        Some(FaceRecord::new(surface, Vec::new()))
    };
    (0..side * side).filter_map(face).collect()
}
