//! `hairline bench scene`: saving and loading scene files.
//!
//! The quilt has round numbers; the shaken quilt has four cubic trim curves to a face and no two numbers
//! alike, so that nothing but the digits themselves can be packed. Raw is 8 bytes for each number that is
//! not implied (weights of 1 are). A second table tells what the document's part of a drag costs.

use std::cell::RefCell;
use std::io::{self, Write};
use std::path::Path;
use std::time::Instant;

use glam::{DVec2, DVec3};

use super::sheet::{Sheet, number, process_seconds};
use crate::kernel::nurbs::{KnotVector, NurbsCurve2};
use crate::kernel::primitives::outline;
use crate::scene::file::{self, Packing, SaveOptions};
use crate::scene::operation::random::RandomOperations;
use crate::scene::operation::{Operation, PointId};
use crate::scene::records::{FaceRecord, LoopRecord, LoopRole, ModelRecord};
use crate::scene::{FaceId, FaceView, SceneRecord, demo};

/// Faces of the largest scene.
const FACES: usize = 50_000;

/// Prints the table.
///
/// # Errors
/// `out` cannot be written, or the temporary folder.
pub fn run(out: &mut impl Write) -> io::Result<()> {
    let folder = tempfile::tempdir()?;
    let mut sheet = Sheet::new(
        "Scene files: to disk and back, all threads, the slowest of two runs; MB are 10^6 bytes",
        &[
            "scene",
            "faces",
            "curves",
            "numbers",
            "raw MB",
            "file",
            "MB",
            "x raw",
            "save s",
            "load s",
            "save CPU s",
            "load CPU s",
        ],
    );
    for (name, scene) in [
        ("quilt", SceneRecord::of_model(demo::panels(FACES))),
        ("shaken", shaken(FACES / 10)),
        ("shaken", shaken(FACES)),
    ] {
        for (packing, kind) in [(Packing::Packed, "packed"), (Packing::Plain, "plain")] {
            sheet.row(row(name, &scene, packing, kind, folder.path())?);
        }
    }
    writeln!(out, "{sheet}")?;
    let mut sheet = Sheet::new(
        "One face while it is dragged, one thread, us: the edit of one control point, applying it, checking all loops",
        &["loops", "curves", "perform", "apply", "check", "problems"],
    );
    for (loops, curves) in [(1, 100), (1, 1000), (1, 10_000), (1000, 1)] {
        sheet.row(drag_row(loops, curves));
    }
    writeln!(out, "{sheet}")
}

/// A wavy loop of cubics, or many round holes.
fn drag_row(loops: usize, curves: usize) -> Vec<String> {
    let mut face = demo::holes(if loops > 1 { loops } else { 1 });
    if loops == 1 {
        let rosette = outline::rosette((curves / 10) as f64, 0.2, 0.0);
        let path = move |t: f64| DVec2::splat(0.5) + 0.35 * rosette(t);
        face.loops[1] = LoopRecord::new(LoopRole::Inner, outline::smooth(path, curves));
    }
    let mut scene = SceneRecord::of_model(ModelRecord { faces: vec![face], ..ModelRecord::default() });
    let points = vec![PointId { trim_loop: 1, curve: 0, point: 1 }];
    let mut by = DVec2::splat(1e-6);
    let mut times = [f64::INFINITY; 3];
    let mut problems = 0;
    for _ in 0..50 {
        by = -by;
        let operation =
            Operation::MovePoints { face: FaceId::default(), points: points.clone(), by, beyond: false };
        let begun = Instant::now();
        let edit = operation.perform(&scene);
        times[0] = times[0].min(begun.elapsed().as_secs_f64());
        let begun = Instant::now();
        let applied = edit.is_ok_and(|edit| edit.apply(&mut scene).is_ok());
        times[1] = times[1].min(begun.elapsed().as_secs_f64());
        let view = FaceView::of(&scene.models[0].faces[0]);
        let begun = Instant::now();
        problems = if applied { view.problems().len() } else { usize::MAX };
        times[2] = times[2].min(begun.elapsed().as_secs_f64());
    }
    let us = |k: usize| number(Some(1e6 * times[k]));
    let curves = scene.models[0].faces[0].loops.iter().map(|l| l.curves.len()).sum::<usize>();
    vec![(loops + 1).to_string(), curves.to_string(), us(0), us(1), us(2), problems.to_string()]
}

fn row(
    name: &str,
    scene: &SceneRecord,
    packing: Packing,
    kind: &str,
    folder: &Path,
) -> io::Result<Vec<String>> {
    let path = folder.join("bench.hairline");
    let (mut save, mut load) = ([0.0f64; 2], [0.0f64; 2]);
    for _ in 0..2 {
        let options = SaveOptions { packing, expected: None };
        timed(&mut save, || file::save(&path, scene, &options)).map_err(io::Error::other)?;
        let loaded = timed(&mut load, || file::load(&path)).map_err(io::Error::other)?;
        if loaded.scene != *scene {
            return Err(io::Error::other("a scene came back from its file changed"));
        }
    }
    let bytes = path.metadata()?.len() as f64;
    let faces = scene.models.iter().flat_map(|m| &m.faces);
    let (count, curves) = faces.clone().fold((0, 0), |(faces, curves), face| {
        (faces + 1, curves + face.loops.iter().map(|l| l.curves.len()).sum::<usize>())
    });
    let numbers: usize = faces.map(numbers).sum();
    let raw = 8.0 * numbers as f64;
    Ok(vec![
        name.into(),
        count.to_string(),
        curves.to_string(),
        numbers.to_string(),
        number(Some(raw / 1e6)),
        kind.into(),
        number(Some(bytes / 1e6)),
        number(Some(bytes / raw)),
        number(Some(save[0])),
        number(Some(load[0])),
        number(Some(save[1])),
        number(Some(load[1])),
    ])
}

/// Does `work` and keeps the most seconds it took so far: on the clock, and of all threads' CPU time.
fn timed<T>(most: &mut [f64; 2], work: impl FnOnce() -> T) -> T {
    let (begun, before) = (Instant::now(), process_seconds());
    let result = work();
    let spent = before.zip(process_seconds()).map_or(f64::NAN, |(before, after)| after - before);
    *most = [most[0].max(begun.elapsed().as_secs_f64()), most[1].max(spent)];
    result
}

/// Numbers that a face's geometry needs.
fn numbers(face: &FaceRecord) -> usize {
    let weights = |w: &[f64]| if w.iter().all(|w| *w == 1.0) { 0 } else { w.len() };
    let surface = &face.surface;
    let knots = surface.knots_u().as_slice().len() + surface.knots_v().as_slice().len();
    let curves = face
        .loops
        .iter()
        .flat_map(|l| &l.curves)
        .map(|c| c.knots().as_slice().len() + 2 * c.points().len() + weights(c.weights()));
    knots + 3 * surface.points().len() + weights(surface.weights()) + curves.sum::<usize>()
}

/// Panels with every control point shaken, trimmed by four cubics each.
fn shaken(faces: usize) -> SceneRecord {
    let mut model = demo::panels(faces);
    let random = RefCell::new(RandomOperations::new(1, 0));
    let unit = || random.borrow_mut().unit();
    for face in &mut model.faces {
        face.surface = face.surface.map_points(|p| p + 0.01 * DVec3::new(unit(), unit(), unit()));
        let corners = [(0.2, 0.2), (0.8, 0.2), (0.8, 0.8), (0.2, 0.8)];
        let corners = corners.map(|(u, v)| DVec2::new(u, v) + 0.1 * DVec2::new(unit(), unit()));
        let curves = (0..4).map(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % 4]);
            let off = || 0.02 * DVec2::new(unit(), unit());
            let points = vec![a, a.lerp(b, 0.33) + off(), a.lerp(b, 0.66) + off(), b];
            let knots = KnotVector::bezier(3, 0.0, 1.0).expect("degree 3 is in range");
            NurbsCurve2::new(knots, points, vec![1.0; 4]).expect("finite")
        });
        face.loops = vec![LoopRecord::new(LoopRole::Outer, curves.collect())];
    }
    SceneRecord::of_model(model)
}
