//! Files written and read again: the same records, bit for bit where IGES can hold them.

use std::collections::BTreeMap;

use hairline::exchange::iges;
use hairline::exchange::iges::unit::Unit;
use hairline::exchange::iges::write::{ExportRemark, WriteError, WriteOptions, write};
use hairline::exchange::report::{ImportReport, Severity};
use hairline::kernel::query::face_area;
use hairline::scene::demo;
use hairline::scene::records::{FaceRecord, ModelRecord, PartRecord};

use crate::iges_truth::models;

fn round_trip(model: &ModelRecord) -> (ModelRecord, ImportReport, Vec<ExportRemark>) {
    let (bytes, remarks) = write(model, &WriteOptions::default()).unwrap();
    for line in bytes.split_inclusive(|c| *c == b'\n') {
        assert_eq!(line.len(), 81, "{}", String::from_utf8_lossy(line));
    }
    let (model, report) = iges::read_bytes(&bytes).unwrap();
    (model, report, remarks)
}

/// What IGES can hold of a face; sources, orientation and edges are not compared.
fn assert_same(place: &str, a: &FaceRecord, b: &FaceRecord) {
    assert_eq!(a.surface, b.surface, "{place}");
    assert_eq!(a.loops.len(), b.loops.len(), "{place}");
    for (a, b) in a.loops.iter().zip(&b.loops) {
        assert_eq!((a.role, &a.curves), (b.role, &b.curves), "{place}");
    }
    assert_eq!((&a.name, a.layer, a.part, a.colour), (&b.name, b.layer, b.part, b.colour), "{place}");
}

/// Areas of the faces of each name, added up.
fn areas(model: &ModelRecord) -> BTreeMap<String, f64> {
    let mut areas = BTreeMap::new();
    for face in &model.faces {
        let area = face_area(&face.derive().unwrap()).value;
        *areas.entry(face.name.clone().unwrap_or_default()).or_insert(0.0) += area;
    }
    areas
}

#[test]
fn the_demo_scene_comes_back() {
    let model = demo::model();
    let (again, report, _) = round_trip(&model);
    assert!(report.remarks.iter().all(|r| r.severity == Severity::Note), "{:?}", report.remarks);
    assert_eq!((&again.name, &again.parts), (&model.name, &model.parts));
    let (before, after) = (areas(&model), areas(&again));
    for (name, area) in &before {
        assert!((after[name] - area).abs() <= 1e-9 * area, "{name}: {} instead of {area}", after[name]);
    }
    assert_eq!(before.len(), after.len());
    // Islands become faces of their own, and the ring's seam moves; all else is the same bit for bit.
    let apart = ["Sail", "Medal", "Ring"];
    let whole = |m: &ModelRecord| -> Vec<FaceRecord> {
        let whole = |f: &&FaceRecord| !apart.contains(&f.name.as_deref().unwrap_or_default());
        m.faces.iter().filter(whole).cloned().collect()
    };
    let (before, after) = (whole(&model), whole(&again));
    assert_eq!(before.len(), after.len());
    for (a, b) in before.iter().zip(&after) {
        assert_same(a.name.as_deref().unwrap_or_default(), a, b);
    }
}

#[test]
fn real_models_come_back_bit_for_bit() {
    let Some(models) = models() else { return };
    let mut names: Vec<_> = std::fs::read_dir(models.join("files"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .filter(|n| n.ends_with(".igs") || n.ends_with(".iges"))
        .collect();
    names.sort();
    assert!(names.len() > 10);
    for name in names {
        let (model, _) = iges::read(&models.join("files").join(&name)).unwrap();
        let (again, report, remarks) = round_trip(&model);
        let loud = |s: Severity| s != Severity::Note;
        assert!(!report.remarks.iter().any(|r| loud(r.severity)), "{name}: {:?}", report.remarks);
        assert!(!remarks.iter().any(|r| loud(r.severity)), "{name}: {remarks:?}");
        assert_eq!(model.faces.len(), again.faces.len(), "{name}");
        assert_eq!(model.parts, again.parts, "{name}");
        for (k, (a, b)) in model.faces.iter().zip(&again.faces).enumerate() {
            assert_same(&format!("{name}, face {}", k + 1), a, b);
        }
    }
}

#[test]
fn names_of_any_script_levels_and_nested_parts_survive() {
    let mut model = demo::model();
    model.faces.truncate(6);
    model.name = "Größe; 1,5".into();
    let part = |name: &str, parent| PartRecord { name: name.into(), parent };
    model.parts =
        vec![part("外", None), part("inner, \"1H;\"", Some(0)), part("deeper", Some(1)), part("b", None)];
    let names = [
        "é".repeat(100),
        "7H1234567".into(),
        "tab\tand\nline".into(),
        "a".into(),
        "日本".into(),
        "x;y".into(),
    ];
    for (k, (face, name)) in model.faces.iter_mut().zip(names).enumerate() {
        face.name = Some(name);
        face.layer = Some(k as i32 + 1);
        face.part = [Some(2), Some(0), Some(3), None, Some(1), Some(2)][k];
        face.colour = Some([k as f32 * 0.123, 1.0 / 3.0, 1.0]);
    }
    let (again, report, remarks) = round_trip(&model);
    assert!(report.remarks.is_empty(), "{:?}", report.remarks);
    assert!(remarks.iter().all(|r| r.severity == Severity::Note), "{remarks:?}");
    model.faces[2].name = Some("tab and line".into());
    assert_eq!((&again.name, &again.parts), (&model.name, &model.parts));
    for (k, (a, b)) in model.faces.iter().zip(&again.faces).enumerate() {
        assert_same(&format!("face {}", k + 1), a, b);
    }
}

#[test]
fn other_units_are_a_division_away() {
    let model = demo::panels(9);
    for name in ["in", "m", "um", "mi"] {
        let unit: Unit = name.parse().unwrap();
        let (bytes, _) = write(&model, &WriteOptions { unit, ..WriteOptions::default() }).unwrap();
        let (again, report) = iges::read_bytes(&bytes).unwrap();
        assert!(report.remarks.iter().all(|r| r.severity == Severity::Note), "{:?}", report.remarks);
        for (a, b) in model.faces.iter().zip(&again.faces) {
            let off = a.surface.points().iter().zip(b.surface.points()).map(|(p, q)| p.distance(*q));
            assert!(off.fold(0.0, f64::max) < 1e-12);
            assert_eq!(a.loops, b.loops);
        }
    }
    assert!("cubits".parse::<Unit>().unwrap_err().contains("mm"));
}

#[test]
fn extreme_open_and_empty_models_do_what_they_can() {
    assert_eq!(write(&ModelRecord::default(), &WriteOptions::default()).unwrap_err(), WriteError::Empty);
    let mut model = demo::panels(4);
    for (face, size) in model.faces.iter_mut().zip([1e15, 1e-300, 1.0, 1.0]) {
        face.surface = face.surface.map_points(|p| p * size);
    }
    // An open loop, a loop of nothing, a level that is none, a part that does not exist.
    model.faces[2].loops[0].curves.pop();
    model.faces[3].loops.push(hairline::scene::records::LoopRecord::default());
    model.faces[3].layer = Some(-5);
    model.faces[3].part = Some(99);
    let (again, _, remarks) = round_trip(&model);
    assert_eq!(again.faces.len(), 4);
    for (a, b) in model.faces.iter().zip(&again.faces) {
        assert_eq!(a.surface, b.surface);
    }
    assert_eq!((again.faces[3].loops.len(), again.faces[3].layer, again.faces[3].part), (2, None, None));
    let told: Vec<_> = remarks.iter().map(|r| (r.face, r.message.as_str())).collect();
    assert!(told.contains(&(4, "loops without curves are left out")), "{told:?}");
    assert!(told.iter().any(|(face, m)| *face == 3 && m.contains("loop 1 is open")), "{told:?}");
    assert!(told.iter().any(|(face, m)| *face == 4 && m.contains("level -5")), "{told:?}");
}
