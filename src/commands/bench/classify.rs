//! `hairline bench classify`: nanoseconds per point of every structure, its rivals and the floor.
//!
//! Single thread, fastest of several runs, all rows of a block measured one after the other in one run: ratios hold,
//! absolute figures belong to the machine. Points: uniform (random order), coherent (scan lines), near (1e-6 from
//! a curve), clustered (within 1e-2 of 64 vertices).

use std::io::{self, Write};

use glam::{DVec2, Vec2};

use super::rivals::{self, Flattened, Floor};
use super::shapes::{Loops, Random, Shape};
use super::sheet::{Sheet, number, per_item};
use crate::kernel::face::Face;
use crate::kernel::trim::grid::GridOptions;
use crate::kernel::trim::pack::PackedSegments;
use crate::kernel::trim::{
    Counters, FillRule, IntervalLists, ParityGrid, PieceList, SegmentSet, SlabGrid, TrimStructure, oracle,
};
use crate::scene::records::ModelRecord;

/// Points of the fast structures in one run.
const POINTS: usize = 1 << 17;
/// Runs of which the fastest counts.
const RUNS: usize = 7;
/// Seconds that one cell of a slow rival may take.
const PATIENCE: f64 = 0.02;
/// P1's structure is not built beyond this many clipped curves.
const MOST_CLIPPED: usize = 2_000_000;

const COLUMNS: [&str; 12] = [
    "structure",
    "uniform",
    "coherent",
    "near",
    "clustered",
    "x flattened",
    "x P1",
    "eval/pt",
    "eval/test",
    "near eval",
    "no eval %",
    "B/segment",
];

/// Prints the tables of the shapes, then of `models`.
///
/// # Errors
/// `out` cannot be written.
pub fn run(models: &[ModelRecord], out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "Point classification, ns per point, one thread, fastest of {RUNS} runs, chunk by chunk\n\
         grid: the default of the shaders. slabs: that of many questions on the processor, as of `hairline classify`; all of\n\
         them made before, `hairline bench build` says what that takes.\n"
    )?;
    for shape in [Shape::Holes, Shape::RationalHoles, Shape::Blob, Shape::Hair] {
        for curves in [12, 100, 1000, 10_000] {
            writeln!(out, "{}", shape_sheet(shape, curves))?;
        }
    }
    for model in models {
        writeln!(out, "{}", model_sheet(model))?;
    }
    Ok(())
}

/// The four kinds of points.
struct Points {
    kinds: [Vec<Vec2>; 4],
}

impl Points {
    fn new(pieces: &PieceList) -> Self {
        let mut random = Random(1);
        let uniform = (0..POINTS).map(|_| random.point().as_vec2()).collect();
        let side = (POINTS as f64).sqrt() as usize;
        let at = |k: usize| Vec2::new((k % side) as f32 + 0.5, (k / side) as f32 + 0.5) / side as f32;
        let coherent = (0..POINTS).map(at).collect();
        let on_curve = |random: &mut Random| {
            let piece = pieces.pieces()[(random.bits() % pieces.pieces().len() as u64) as usize];
            oracle::point(pieces, &piece, random.unit())
        };
        let direction = |random: &mut Random| DVec2::from_angle(std::f64::consts::TAU * random.unit());
        let near =
            (0..POINTS).map(|_| (on_curve(&mut random) + direction(&mut random) * 1e-6).as_vec2()).collect();
        let centres: Vec<DVec2> = (0..64).map(|_| on_curve(&mut random)).collect();
        let clustered = (0..POINTS).map(|k| {
            let p = centres[k % 64] + direction(&mut random) * (1e-2 * random.unit());
            p.clamp(DVec2::ZERO, DVec2::splat(0.999_999)).as_vec2()
        });
        let clustered = clustered.collect();
        Self { kinds: [uniform, coherent, near, clustered] }
    }
}

/// ns per point for each kind of points.
fn measure(points: &Points, classify: impl Fn(Vec2) -> bool) -> [f64; 4] {
    std::array::from_fn(|kind| {
        let points = &points.kinds[kind];
        let probe = per_item(&points[..8], 1, |p| classify(*p)) * 1e-9;
        let count = ((PATIENCE / probe.max(1e-9)) as usize).clamp(32, points.len());
        per_item(&points[..count], if count < points.len() { 3 } else { RUNS }, |p| classify(*p))
    })
}

/// Evaluations of a structure over one kind of points: total counters, points that needed none.
fn count(points: &[Vec2], structure: &impl TrimStructure) -> (Counters, usize) {
    let mut total = Counters::default();
    let mut untouched = 0;
    for p in points {
        let before = total.evaluations;
        structure.classify_counted(*p, &mut total);
        untouched += usize::from(total.evaluations == before);
    }
    (total, untouched)
}

fn row(name: &str, times: [f64; 4], flattened: f64, lists: Option<f64>) -> Vec<String> {
    let mut cells = vec![name.to_owned()];
    cells.extend(times.map(|t| number(Some(t))));
    cells.push(number(Some(flattened / times[0])));
    cells.push(number(lists.map(|p| p / times[0])));
    cells
}

fn structure_row(
    name: &str,
    points: &Points,
    structure: &impl TrimStructure,
    (times, flattened, lists): ([f64; 4], f64, Option<f64>),
    segments: usize,
) -> Vec<String> {
    let mut cells = row(name, times, flattened, lists);
    let (uniform, untouched) = count(&points.kinds[0], structure);
    let (near, _) = count(&points.kinds[2], structure);
    let per = |a: u64, b: usize| (b > 0).then(|| a as f64 / b as f64);
    cells.push(number(per(uniform.evaluations, POINTS)));
    cells.push(number(per(uniform.evaluations, uniform.tests as usize)));
    cells.push(number(per(near.evaluations, near.tests as usize)));
    cells.push(number(Some(100.0 * untouched as f64 / POINTS as f64)));
    cells.push(number(Some(structure.memory_bytes() as f64 / segments as f64)));
    cells
}

fn shape_sheet(shape: Shape, curves: usize) -> Sheet {
    let loops: Loops = shape.loops(curves);
    let pieces = PieceList::from_loops(&loops, 1e-9);
    let set = SegmentSet::new(&pieces);
    let count = set.segments.len();
    let title = format!("{} {curves} ({count} segments)", shape.name());
    let mut sheet = Sheet::new(title, &COLUMNS);
    let Ok(packed) = PackedSegments::new(&pieces, &set) else { return sheet };
    let points = Points::new(&pieces);
    let grid = ParityGrid::new(&set, &packed, &GridOptions::default());
    let lists = IntervalLists::bounded(&pieces, &set, FillRule::EvenOdd, MOST_CLIPPED);
    let floor = Floor::new(grid.memory_bytes());
    let flattened = Flattened::new(&loops);
    let flattened_times = measure(&points, |p| flattened.classify(p));
    let lists_times = lists.as_ref().map(|l| measure(&points, |p| l.classify(p)));
    let bar = flattened_times[0];
    let lists_bar = lists_times.map(|t| t[0]);
    sheet.row(row("floor", measure(&points, |p| floor.classify(p)), bar, lists_bar));
    let grid_times = measure(&points, |p| grid.classify(p));
    sheet.row(structure_row("grid", &points, &grid, (grid_times, bar, lists_bar), count));
    let slabs = SlabGrid::new(&set, &packed, &GridOptions::default());
    slabs.complete();
    let slab_times = measure(&points, |p| slabs.classify(p));
    sheet.row(structure_row("slabs", &points, &slabs, (slab_times, bar, lists_bar), count));
    match (&lists, lists_times) {
        (Some(lists), Some(times)) => {
            sheet.row(structure_row("P1", &points, lists, (times, bar, lists_bar), count));
        }
        _ => sheet.row(["P1: not built, more than 2 M clipped curves".into()]),
    }
    sheet.row(row("flattened", flattened_times, bar, lists_bar));
    if let Some(path) = rivals::kurbo_path(&loops) {
        let times = measure(&points, |p| rivals::kurbo_inside(&path, p.as_dvec2()));
        sheet.row(row("kurbo", times, bar, lists_bar));
    }
    if let Some(path) = rivals::lyon_path(&loops) {
        sheet.row(row("lyon", measure(&points, |p| rivals::lyon_inside(&path, p)), bar, lists_bar));
    }
    sheet
}

/// Uniform points on every face of a model, face after face.
fn model_sheet(model: &ModelRecord) -> Sheet {
    const PER_FACE: usize = 4096;
    let faces: Vec<Face> = model.derive_all().into_iter().flatten().collect();
    let segments: usize = faces.iter().map(|f| f.segments.segments.len()).sum();
    let title = format!("{}: {} faces, {segments} segments, uniform points, ns", model.name, faces.len());
    let columns =
        ["structure", "ns/pt", "x flattened", "eval/pt", "eval/test", "no eval %", "B/curve", "wrong"];
    let mut sheet = Sheet::new(title, &columns);
    let mut random = Random(3);
    let points: Vec<Vec2> = (0..PER_FACE).map(|_| random.point().as_vec2()).collect();
    let lists: Vec<IntervalLists> = faces.iter().map(Face::interval_lists).collect();
    let slabs: Vec<SlabGrid> = faces.iter().map(Face::slab_grid).collect();
    slabs.iter().for_each(SlabGrid::complete);
    let flattened: Vec<Flattened> = faces.iter().map(|f| Flattened::new(&normalised_loops(f))).collect();
    let total = faces.len() * PER_FACE;
    let curves: usize = faces.iter().map(|f| f.counts.bezier).sum();
    // Face after face; the mean over faces of ns per point.
    let mean = |of: &dyn Fn(usize) -> f64| (0..faces.len()).map(of).sum::<f64>() / faces.len().max(1) as f64;
    let bar = mean(&|i| per_item(&points, RUNS, |p| flattened[i].classify(*p)));
    let mut add = |name: &str, ns: f64, structures: Vec<&dyn Counted>| {
        let (mut counters, mut untouched, mut bytes, mut wrong) = (Counters::default(), 0, 0, 0);
        for (structure, face) in structures.iter().zip(&faces) {
            for p in &points {
                let before = counters.evaluations;
                let inside = structure.count(*p, &mut counters);
                untouched += usize::from(counters.evaluations == before);
                let q = p.as_dvec2();
                let differs = inside != oracle::inside(&face.pieces, q, FillRule::EvenOdd);
                wrong += usize::from(differs && !oracle::is_on(&face.pieces, q, 1e-7));
            }
            bytes += structure.bytes();
        }
        let per = |a: f64, b: f64| number((b > 0.0).then_some(a / b));
        sheet.row([
            name.to_owned(),
            number(Some(ns)),
            number(Some(bar / ns)),
            per(counters.evaluations as f64, total as f64),
            per(counters.evaluations as f64, counters.tests as f64),
            number(Some(100.0 * untouched as f64 / total as f64)),
            per(bytes as f64, curves as f64),
            wrong.to_string(),
        ]);
    };
    let grid_ns = mean(&|i| per_item(&points, RUNS, |p| faces[i].grid.classify(*p)));
    let lists_ns = mean(&|i| per_item(&points, RUNS, |p| lists[i].classify(*p)));
    add("grid", grid_ns, faces.iter().map(|f| &f.grid as &dyn Counted).collect());
    let slabs_ns = mean(&|i| per_item(&points, RUNS, |p| slabs[i].classify(*p)));
    add("slabs", slabs_ns, slabs.iter().map(|s| s as &dyn Counted).collect());
    add("P1", lists_ns, lists.iter().map(|l| l as &dyn Counted).collect());
    sheet.row(["flattened".to_owned(), number(Some(bar))]);
    sheet
}

/// [`TrimStructure`] as an object.
trait Counted {
    fn count(&self, p: Vec2, counters: &mut Counters) -> bool;
    fn bytes(&self) -> usize;
}

impl<T: TrimStructure> Counted for T {
    fn count(&self, p: Vec2, counters: &mut Counters) -> bool {
        self.classify_counted(p, counters)
    }
    fn bytes(&self) -> usize {
        self.memory_bytes()
    }
}

/// The monotone pieces of a face as loops of curves.
fn normalised_loops(face: &Face) -> Loops {
    let list = &face.pieces;
    let curve = |i: usize| {
        let piece = &list.pieces()[i];
        crate::kernel::bezier::BezierCurve2 {
            points: list.points(piece).to_vec(),
            weights: list.weights(piece).to_vec(),
        }
    };
    (0..list.chain_count()).map(|c| list.chain(c).map(curve).collect()).collect()
}
