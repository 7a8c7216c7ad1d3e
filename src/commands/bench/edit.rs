//! `hairline bench edit`: from one moved control point of a trim curve to the ranges a GPU is sent.
//!
//! One face is edited again and again, alone and in a scene of 50,000 faces: deriving and packing must cost
//! the same, and the upload is at most the face's own data. Times are medians of single edits on one
//! thread; edit, derive and pack are what the editor does between the pointer and the upload.

use std::f64::consts::TAU;
use std::io::{self, Write};
use std::time::Instant;

use glam::{DVec2, DVec3};

use super::sheet::{Sheet, number};
use crate::encoding::{FaceShape, FaceSlot, PackedScene};
use crate::kernel::bezier::BezierCurve2;
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
        let mut alone = None;
        let sizes: &[usize] = if holes == 24 && patches == 5 { &[1, 50_000] } else { &[1] };
        for faces in sizes {
            let (row, total) = measure(name, &record, *faces, alone);
            alone = alone.or(Some(total));
            sheet.row(row);
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
    FaceRecord {
        name: Some(format!("{holes} holes")),
        source: None,
        colour: None,
        layer: None,
        part: None,
        surface: NurbsSurface::new(knots(), knots(), points, weights).expect("invariant: counts fit"),
        loops,
        reversed: false,
    }
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

fn measure(name: &str, record: &FaceRecord, count: usize, alone: Option<f64>) -> (Vec<String>, f64) {
    let (mut packed, slot) = scene(record, count);
    let own = {
        let mut single = PackedScene::from_faces([FaceShape::of(
            &record.derive().expect("invariant: a plate with holes"),
            None,
            false,
        )]);
        single.take_changed_bytes()
    };
    let mut random = Random(7);
    let mut record = record.clone();
    let mut derived = record.derive().expect("invariant: a plate with holes");
    let mut times: Vec<[f64; 4]> = Vec::new();
    let mut sent: Vec<f64> = Vec::new();
    let edits = if derived.segments.segments.len() > 20_000 { 31 } else { EDITS };
    for _ in 0..edits {
        let start = Instant::now();
        moved(&mut record, &mut random);
        let edit = start.elapsed();
        derived = record.derive_after(&derived).expect("invariant: a plate with holes");
        let derive = start.elapsed();
        packed.replace(slot, &FaceShape::of(&derived, None, false));
        let pack = start.elapsed();
        times.push([edit, derive - edit, pack - derive, pack].map(|t| 1e6 * t.as_secs_f64()));
        sent.push(packed.take_changed_bytes() as f64);
    }
    let first = times[0][3];
    let mut column = |k: usize| {
        times.sort_by(|a, b| a[k].total_cmp(&b[k]));
        (times[times.len() / 2][k], times[times.len() * 95 / 100][k])
    };
    let phases = [column(0).0, column(1).0, column(2).0];
    let (total, late) = column(3);
    sent.sort_by(f64::total_cmp);
    let sent = sent[sent.len() / 2];
    let mut row = vec![
        name.to_owned(),
        derived.counts.nurbs.to_string(),
        derived.segments.segments.len().to_string(),
        count.to_string(),
    ];
    row.extend([first, phases[0], phases[1], phases[2], total, late].map(|t| number(Some(t))));
    row.push(number(alone.map(|a| total / a)));
    row.extend([sent, own as f64, sent / own as f64].map(|t| number(Some(t))));
    (row, total)
}
