//! `hairline bench edit`: from one moved control point of a trim curve to the ranges a GPU is sent.
//!
//! One face is edited again and again, alone and in a scene of 50,000 faces: deriving and packing must cost
//! the same, and the upload is at most the face's own data. The two scenes take turns, edit by edit, so that
//! other load meets both alike. Times are medians of single edits on one thread, which never waits: time on the
//! clock is CPU time. Edit, derive and pack are what the editor does between the pointer and the upload.

use std::f64::consts::TAU;
use std::io::{self, Write};
use std::time::Instant;

use glam::{DVec2, DVec3};

use super::sheet::{Sheet, number};
use crate::encoding::{FaceShape, FaceSlot, PackedScene};
use crate::kernel::bezier::BezierCurve2;
use crate::kernel::face::Face;
use crate::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
use crate::scene::records::{FaceRecord, LoopRecord, LoopRole};

use super::shapes::{Random, circle};

/// Edits of a row, of which the median counts.
const EDITS: usize = 301;

/// Prints the table.
///
/// # Errors
/// `out` cannot be written.
pub fn run(out: &mut impl Write) -> io::Result<()> {
    let mut sheet = Sheet::new(
        "One control point moved: us per edit, median of single edits, one thread",
        &[
            "face",
            "curves",
            "segments",
            "faces",
            "first",
            "edit",
            "derive",
            "pack",
            "total",
            "95 %",
            "x alone",
            "bytes sent",
            "face bytes",
            "sent/face",
        ],
    );
    for (name, holes, patches) in [
        ("plate", 24, 1),
        ("sheet", 24, 5),
        ("plate", 125, 1),
        ("sheet", 125, 5),
        ("sheet", 1250, 5),
        ("sheet", 12_500, 5),
    ] {
        let record = face(holes, patches);
        let sizes: &[usize] = if holes == 24 { &[1, 50_000] } else { &[1] };
        let mut runs: Vec<Run> = sizes.iter().map(|faces| Run::new(&record, *faces)).collect();
        let edits = if holes > 10_000 { 31 } else { EDITS };
        for _ in 0..edits {
            runs.iter_mut().for_each(Run::edit);
        }
        let mut alone = None;
        for run in &mut runs {
            let total = run.column(3).0;
            sheet.row(run.row(name, alone));
            alone = alone.or(Some(total));
        }
    }
    writeln!(out, "{sheet}")
}

/// A wavy bicubic sheet of `patches` by `patches` Bezier patches with `holes` round holes: `4 + 4 holes`
/// trim curves.
pub fn face(holes: usize, patches: usize) -> FaceRecord {
    let count = patches + 3;
    let mut knots = vec![0.0; 4];
    knots.extend((1..patches).map(|k| k as f64 / patches as f64));
    knots.extend([1.0; 4]);
    let knots = || KnotVector::new(3, knots.clone()).expect("invariant: made sorted");
    let at = |i: usize, j: usize| {
        let (x, y) = (i as f64 / (count - 1) as f64, j as f64 / (count - 1) as f64);
        DVec3::new(100.0 * x, 100.0 * y, 6.0 * (5.0 * x).sin() * (4.0 * y).cos())
    };
    let points: Vec<_> = (0..count * count).map(|k| at(k / count, k % count)).collect();
    let weights = vec![1.0; points.len()];
    let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    let outer = (0..4).map(|i| NurbsCurve2::line(corners[i], corners[(i + 1) % 4])).collect();
    let mut loops = vec![LoopRecord::new(LoopRole::Outer, outer)];
    let side = (holes as f64).sqrt().ceil();
    let mut random = Random(holes as u64);
    for k in 0..holes {
        let centre = DVec2::new((k as f64 % side).floor() + 0.5, (k as f64 / side).floor() + 0.5) / side;
        let ring = circle(centre, (0.25 + 0.15 * random.unit()) / side, TAU * random.unit(), false);
        let curves = ring.iter().map(spline).collect();
        loops.push(LoopRecord::new(LoopRole::Inner, curves));
    }
    let surface = NurbsSurface::new(knots(), knots(), points, weights).expect("invariant: counts fit");
    FaceRecord { name: Some(format!("{holes} holes")), ..FaceRecord::new(surface, loops) }
}

fn spline(curve: &BezierCurve2) -> NurbsCurve2 {
    let knots = KnotVector::bezier(curve.degree(), 0.0, 1.0).expect("invariant: a Bezier curve's degree");
    NurbsCurve2::new(knots, curve.points.clone(), curve.weights.clone()).expect("invariant: counts fit")
}

/// `record` with an inner control point of some hole moved by a little.
fn moved(record: &mut FaceRecord, random: &mut Random) {
    let index = 1 + (random.bits() % (record.loops.len() - 1) as u64) as usize;
    let curves = &mut record.loops[index].curves;
    let at = (random.bits() % curves.len() as u64) as usize;
    let curve = &curves[at];
    let mut points = curve.points().to_vec();
    let size = points[0].distance(points[points.len() - 1]);
    points[1] += 0.02 * size * (random.point() - 0.5);
    let changed = NurbsCurve2::new(curve.knots().clone(), points, curve.weights().to_vec());
    curves[at] = changed.expect("invariant: finite points");
}

/// A scene of `count` faces, four-sided plates with one round hole for the most part, and `record` in its
/// middle.
fn scene(record: &FaceRecord, count: usize) -> (PackedScene, FaceSlot) {
    let mut packed = PackedScene::default();
    let edited = record.derive().expect("invariant: a plate with holes");
    let other = face(1, 1).derive().expect("invariant: a plate with a hole");
    let mut slot = FaceSlot(0);
    for k in 0..count {
        let shape = if k == count / 2 { &edited } else { &other };
        let added = packed.add(&FaceShape::of(shape, None, false));
        slot = if k == count / 2 { added } else { slot };
    }
    packed.take_changed_bytes();
    (packed, slot)
}

/// One face in its scene, edited again and again.
struct Run {
    faces: usize,
    packed: PackedScene,
    slot: FaceSlot,
    record: FaceRecord,
    derived: Face,
    random: Random,
    /// Microseconds of each edit: edit, derive, pack, all.
    times: Vec<[f64; 4]>,
    /// Bytes sent for each edit.
    sent: Vec<f64>,
    /// Bytes of the face.
    own: f64,
}

impl Run {
    fn new(record: &FaceRecord, faces: usize) -> Self {
        let (packed, slot) = scene(record, faces);
        let derived = record.derive().expect("invariant: a plate with holes");
        let own = PackedScene::from_faces([FaceShape::of(&derived, None, false)]).take_changed_bytes() as f64;
        let (times, sent) = (Vec::new(), Vec::new());
        Self { faces, packed, slot, record: record.clone(), derived, random: Random(7), times, sent, own }
    }

    fn edit(&mut self) {
        let start = Instant::now();
        moved(&mut self.record, &mut self.random);
        let edit = start.elapsed();
        self.derived = self.record.derive_after(&self.derived).expect("invariant: a plate with holes");
        let derive = start.elapsed();
        self.packed.replace(self.slot, &FaceShape::of(&self.derived, None, false));
        let pack = start.elapsed();
        self.times.push([edit, derive - edit, pack - derive, pack].map(|t| 1e6 * t.as_secs_f64()));
        self.sent.push(self.packed.take_changed_bytes() as f64);
    }

    /// Median and 95th percentile of a column of the times.
    fn column(&self, k: usize) -> (f64, f64) {
        let mut column: Vec<f64> = self.times.iter().map(|t| t[k]).collect();
        column.sort_by(f64::total_cmp);
        (column[column.len() / 2], column[column.len() * 95 / 100])
    }

    fn row(&mut self, name: &str, alone: Option<f64>) -> Vec<String> {
        let (total, late) = self.column(3);
        self.sent.sort_by(f64::total_cmp);
        let sent = self.sent[self.sent.len() / 2];
        let counts = [self.derived.counts.nurbs, self.derived.segments.segments.len(), self.faces]
            .map(|n| n.to_string());
        let mut row = vec![name.to_owned()];
        row.extend(counts);
        let phases = [self.column(0).0, self.column(1).0, self.column(2).0];
        row.extend([self.times[0][3], phases[0], phases[1], phases[2], total, late].map(|t| number(Some(t))));
        row.push(number(alone.map(|a| total / a)));
        row.extend([sent, self.own, sent / self.own].map(|t| number(Some(t))));
        row
    }
}
