//! Small IGES files of our own, one for each way of writing a face, a boundary, a structure or a line.
//! What they hold is known by hand: squares of side 8 from (1, 1) to (9, 9), holes of 3 by 2, shapes of
//! revolution and extrusion; parameters are those OpenCASCADE gives the same files.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use glam::DVec3;
use hairline::exchange::iges::{self, ReadError};
use hairline::exchange::report::{ImportReport, Remark, Severity};
use hairline::kernel::face::Side;
use hairline::kernel::query::{face_area, face_bounds};
use hairline::scene::records::{FaceRecord, LoopRole, ModelRecord};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models/data").join(name).with_extension("igs")
}

fn read(name: &str) -> (ModelRecord, ImportReport) {
    iges::read(&path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// The only face of a file without warnings.
fn only_face(name: &str) -> FaceRecord {
    let (mut model, report) = read(name);
    assert!(report.remarks.iter().all(|r| r.severity == Severity::Note), "{name}: {:?}", report.remarks);
    assert_eq!(model.faces.len(), 1, "{name}");
    model.faces.swap_remove(0)
}

fn area(face: &FaceRecord) -> f64 {
    face_area(&face.derive().unwrap()).value
}

fn assert_area(name: &str, face: &FaceRecord, expected: f64) {
    let found = area(face);
    assert!((found - expected).abs() <= 2e-6 * expected, "{name}: area {found}, expected {expected}");
}

fn assert_box(name: &str, face: &FaceRecord, min: [f64; 3], max: [f64; 3]) {
    let found = face_bounds(&face.derive().unwrap());
    let off = (found.min - DVec3::from(min)).abs().max((found.max - DVec3::from(max)).abs());
    assert!(off.max_element() < 1e-5, "{name}: {found:?}, expected {min:?} {max:?}");
}

fn assert_sides(name: &str, face: &FaceRecord, scale: f64, points: &[(f64, f64, Side)]) {
    let face = face.derive().unwrap();
    for (u, v, side) in points {
        assert_eq!(face.classify_native(u * scale, v * scale), *side, "{name} at {u}, {v}");
    }
}

const SQUARE: [(f64, f64, Side); 5] = [
    (1.1, 1.1, Side::In),
    (8.9, 8.9, Side::In),
    (4.5, 4.0, Side::In),
    (0.9, 4.0, Side::Out),
    (5.0, 9.1, Side::Out),
];

#[test]
fn squares_come_out_of_every_kind_of_trimmed_face() {
    for (name, height, scale) in [
        ("bounded_143_space_only", 0.0, 1.0),
        ("bounded_143_senses", 0.0, 1.0),
        ("bounded_143_senses_uv", 0.0, 1.0),
        ("plane_190_trimmed", 3.0, 1.0),
        ("spline_114_trimmed", 0.0, 0.1),
        ("offset_140_trimmed", 3.0, 1.0),
        ("delimiters", 0.0, 1.0),
        ("line_ends_cr", 0.0, 1.0),
        ("line_ends_none", 0.0, 1.0),
        ("unknown_types", 0.0, 1.0),
    ] {
        let face = only_face(name);
        assert_area(name, &face, 64.0);
        assert_box(name, &face, [1.0, 1.0, height], [9.0, 9.0, height]);
        assert_sides(name, &face, scale, &SQUARE);
    }
}

#[test]
fn holes_are_cut_out() {
    let name = "bounded_143_hole";
    let face = only_face(name);
    assert_area(name, &face, 58.0);
    assert_sides(name, &face, 1.0, &[(4.0, 4.0, Side::Out), (2.0, 4.0, Side::In), (7.0, 4.0, Side::In)]);
}

#[test]
fn planes_are_bounded_by_their_own_curve() {
    let name = "plane_108_bounded";
    let face = only_face(name);
    assert_area(name, &face, 64.0);
    assert_box(name, &face, [1.0, 1.0, 2.0], [9.0, 9.0, 2.0]);
}

#[test]
fn planes_have_holes_by_association() {
    let name = "plane_108_hole";
    let face = only_face(name);
    assert_area(name, &face, 58.0);
    let roles: Vec<_> = face.loops.iter().map(|l| l.role).collect();
    assert_eq!(roles, [LoopRole::Outer, LoopRole::Inner]);
}

#[test]
fn parametric_splines_bound_faces() {
    // The upper side sags by 4 t (1 - t) over its width of 8: two thirds of 8 are missing.
    let name = "pcurve_112";
    let face = only_face(name);
    assert_area(name, &face, 64.0 - 16.0 / 3.0);
    assert_sides(name, &face, 1.0, &[(5.0, 7.9, Side::In), (5.0, 8.1, Side::Out), (1.2, 8.95, Side::Out)]);
}

#[test]
fn swept_and_ruled_surfaces_run_over_known_parameters() {
    let parabola = 7.0 * 2.0 * (2.0 * 5.0_f64.sqrt() + 2.0_f64.asinh());
    let part = 7.0 * (2.0 * 5.0_f64.sqrt() + 2.0_f64.asinh() + 2.0_f64.sqrt() + 1.0_f64.asinh());
    for (name, domain, size) in [
        ("sweep_118_lines", [0.0, 1.0, 0.0, 1.0], None),
        ("sweep_118_arcs", [0.0, 1.0, 0.0, 1.0], None),
        ("sweep_120_106", [0.0, 2.0, 0.0, 9.0], Some(91.0)),
        ("sweep_122_106", [0.0, 17.0, 0.0, 7.0], Some(119.0)),
        ("sweep_122_ellipse", [0.0, 0.5 * TAU, 0.0, 7.0], None),
        ("sweep_122_ellipse_p", [0.5, 2.5, 0.0, 7.0], None),
        ("sweep_122_parab", [-4.0, 4.0, 0.0, 7.0], Some(parabola)),
        ("sweep_122_parab2", [-4.0, 2.0, 0.0, 7.0], Some(part)),
        ("sweep_120_torus_s", [0.0, TAU, 0.25 * TAU, 1.25 * TAU], Some(30.0 * TAU * TAU)),
    ] {
        let face = only_face(name);
        let ((u0, u1), (v0, v1)) = (face.surface.knots_u().domain(), face.surface.knots_v().domain());
        let off = [u0, u1, v0, v1].iter().zip(domain).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9, "{name}: {:?}", (u0, u1, v0, v1));
        if let Some(size) = size {
            assert_area(name, &face, size);
        }
    }
}

#[test]
fn instances_stand_where_they_are_put() {
    let (model, report) = read("instances_408");
    assert!(report.remarks.is_empty(), "{:?}", report.remarks);
    let [first, second] = &model.faces[..] else { panic!("{} faces", model.faces.len()) };
    assert_area("first", first, 64.0);
    assert_box("first", first, [101.0, 1.0, 0.0], [109.0, 9.0, 0.0]);
    // Twice as large, turned by a right angle, lifted by 50 and by 5.
    assert_area("second", second, 256.0);
    assert_box("second", second, [-18.0, 2.0, 55.0], [-2.0, 18.0, 55.0]);
    assert_eq!(model.parts.len(), 2);
    assert!(model.parts.iter().all(|p| p.name == "Plate; a,b"), "{:?}", model.parts);
}

#[test]
fn groups_names_colours_and_levels_are_kept() {
    let (model, _) = read("group_names_colours");
    assert_eq!(model.parts.len(), 1);
    assert_eq!(model.parts[0].name, "Both lids");
    let names: Vec<_> = model.faces.iter().map(|f| f.name.as_deref()).collect();
    assert_eq!(names, [Some("Lid 1"), Some("Lid 2")]);
    assert!(model.faces.iter().all(|f| f.part == Some(0) && f.layer == Some(7)));
    // 100, 50 and 0 percent in linear light, and number 4 of the standard's table: blue.
    assert_eq!(model.faces[0].colour, Some([1.0, 0.214_041_14, 0.0]));
    assert_eq!(model.faces[1].colour, Some([0.0, 0.0, 1.0]));
    assert_eq!(only_face("delimiters").name.as_deref(), Some("a/b!c;d,e"));
}

#[test]
fn mirrors_and_inches_apply() {
    let name = "mirrored_inches";
    let face = only_face(name);
    assert_area(name, &face, 64.0 * 25.4 * 25.4);
    // x becomes 5 - x.
    assert_box(name, &face, [-4.0 * 25.4, 25.4, 0.0], [4.0 * 25.4, 9.0 * 25.4, 0.0]);
}

#[test]
fn what_is_not_read_is_noted_once_for_each_type() {
    let (_, report) = read("unknown_types");
    let notes: Vec<&Remark> = report.remarks.iter().filter(|r| r.message.contains("not read")).collect();
    assert_eq!(notes.len(), 1, "{:?}", report.remarks);
    assert_eq!((notes[0].entity.as_str(), notes[0].severity), ("5001", Severity::Note));
    assert!(notes[0].message.contains("2 in the file"), "{}", notes[0].message);
}

#[test]
fn other_forms_of_iges_are_refused_by_name() {
    for (name, form) in [("compressed", "compressed"), ("binary", "binary")] {
        let error: ReadError = iges::read(&path(name)).unwrap_err();
        assert!(error.to_string().contains(form), "{error}");
    }
    let (model, report) = read("no_terminate");
    assert_eq!(model.faces.len(), 1);
    assert!(report.remarks[0].message.contains("terminate section is missing"));
}

#[test]
fn bad_entities_are_named_and_the_rest_loads() {
    let (model, report) = read("bad_entities");
    let kept: Vec<u64> = model.faces.iter().map(|f| f.source.as_ref().unwrap().id).collect();
    // 17 lost its boundary, which runs in a circle.
    assert_eq!(kept, [9, 17]);
    let expected = [
        (11, "refers to itself"),
        (17, "refers to itself"),
        (19, "weight 0 is 0"),
        (21, "weight 0 is -1"),
        (23, "beyond"),
        (25, "smaller than the knot before"),
        (27, "2147483647 more parameters"),
    ];
    for (id, words) in expected {
        let remark = report.remarks.iter().find(|r| r.id == id && r.message.contains(words));
        // Two directory lines for each entity, after one line of S and three of G.
        let remark = remark.unwrap_or_else(|| panic!("{id} {words}: {:?}", report.remarks));
        assert_eq!(remark.line as u64, id + 4, "{remark:?}");
    }
}
