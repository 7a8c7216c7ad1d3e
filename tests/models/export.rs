//! Files written and read again: the same records, bit for bit where IGES can hold them.

use glam::DVec2;
use hairline::exchange::iges::read_bytes;
use hairline::exchange::iges::write::{WriteOptions, write};
use hairline::exchange::report::{ImportReport, Severity};
use hairline::scene::demo;
use hairline::scene::records::{FaceRecord, LoopRecord, ModelRecord};

fn round_trip(model: &ModelRecord) -> (ModelRecord, ImportReport) {
    let (bytes, _) = write(model, &WriteOptions::default()).unwrap();
    for line in bytes.split_inclusive(|c| *c == b'\n') {
        assert_eq!(line.len(), 81, "{}", String::from_utf8_lossy(line));
    }
    read_bytes(&bytes).unwrap()
}

/// Whether all that IGES can hold is the same. Sources and orientation are not compared.
fn assert_same(name: &str, before: &ModelRecord, after: &ModelRecord) {
    assert_eq!(before.faces.len(), after.faces.len(), "{name}");
    assert_eq!(before.parts, after.parts, "{name}");
    for (k, (a, b)) in before.faces.iter().zip(&after.faces).enumerate() {
        let number = k + 1;
        assert_eq!(a.surface, b.surface, "{name}, face {number}");
        assert_eq!(moved_home(a, b), b.loops, "{name}, face {number}");
        assert_eq!(
            (&a.name, a.layer, a.part, a.colour),
            (&b.name, b.layer, b.part, b.colour),
            "{name}, face {number}"
        );
    }
}

/// The loops of `a`, moved by a whole period where those of `b` are: readers move loops on closed surfaces
/// to where the surface begins.
fn moved_home(a: &FaceRecord, b: &FaceRecord) -> Vec<LoopRecord> {
    let ((u0, u1), (v0, v1)) = (a.surface.knots_u().domain(), a.surface.knots_v().domain());
    let period = DVec2::new(u1 - u0, v1 - v0);
    let first = |f: &FaceRecord| f.loops.first().map(|l| l.curves[0].points()[0]);
    let turns = match (first(a), first(b)) {
        (Some(a), Some(b)) => ((b - a) / period).round(),
        _ => DVec2::ZERO,
    };
    let moved = |l: &LoopRecord| {
        LoopRecord::new(l.role, l.curves.iter().map(|c| c.map_points(|p| p + turns * period)).collect())
    };
    if turns == DVec2::ZERO { a.loops.clone() } else { a.loops.iter().map(moved).collect() }
}

#[test]
fn the_demo_scene_comes_back_bit_for_bit() {
    let model = demo::model();
    let (again, report) = round_trip(&model);
    assert!(report.remarks.iter().all(|r| r.severity == Severity::Note), "{:?}", report.remarks);
    assert_eq!(again.name, model.name);
    assert_same("demo", &model, &again);
}
