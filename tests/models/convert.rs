//! `hairline convert` as its users meet it.

use std::fs;
use std::path::Path;

use crate::cli::{BAD_INPUT, DONE, NOT_WRITTEN, fails, run};

fn data(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models/data").join(name).to_string_lossy().into_owned()
}

fn faces(path: &str) -> Vec<serde_json::Value> {
    let (code, stdout, stderr) = run(&["info", path, "--json"], "");
    assert_eq!(code, DONE, "{stderr}");
    let info: serde_json::Value = serde_json::from_str(&stdout).expect("valid JSON");
    info["faces"].as_array().expect("faces").clone()
}

#[test]
fn files_go_to_iges_and_to_scenes_and_back_unchanged() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inside = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (iges, scene, again) = (inside("a.igs"), inside("a.hairline"), inside("b.IGES"));
    for (from, to) in
        [(data("group_names_colours.igs"), &iges), (iges.clone(), &scene), (scene.clone(), &again)]
    {
        assert_eq!(run(&["convert", &from, to], ""), (DONE, String::new(), String::new()), "{from}");
    }
    let facts = |path: &str| -> Vec<serde_json::Value> {
        faces(path)
            .into_iter()
            .map(|f| serde_json::json!([f["name"], f["area"], f["bbox"], f["uv_box"]]))
            .collect()
    };
    let expected = facts(&data("group_names_colours.igs"));
    assert_eq!(expected.len(), 2);
    for path in [&iges, &scene, &again] {
        assert_eq!(facts(path), expected, "{path}");
    }
    // The same model gives the same bytes, but for the name of the file.
    let text =
        |path: &str| fs::read_to_string(path).expect("text").replace("a.igs", "").replace("b.IGES", "");
    let body = |path: &str| text(path).split_once("D      1\n").map(|t| t.1.to_owned());
    assert_eq!(body(&iges), body(&again));
}

#[test]
fn units_change_numbers_not_sizes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inches = folder.path().join("inches.igs").to_string_lossy().into_owned();
    let (code, _, stderr) = run(&["convert", "demo:5", &inches, "--unit", "in"], "");
    assert_eq!((code, stderr.as_str()), (DONE, ""));
    assert!(fs::read_to_string(&inches).expect("text").contains(",1,2HIN,"));
    let (before, after) = (faces("demo:5"), faces(&inches));
    for (a, b) in before.iter().zip(&after) {
        let (a, b) = (a["area"].as_f64().expect("a number"), b["area"].as_f64().expect("a number"));
        assert!((a - b).abs() < 1e-9 * a, "{a} {b}");
    }
}

#[test]
fn damaged_files_are_converted_as_far_as_they_go_and_told_about() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out.igs").to_string_lossy().into_owned();
    let (code, _, stderr) = run(&["convert", &data("bad_entities.igs"), &out], "");
    assert_eq!(code, DONE, "{stderr}");
    assert!(stderr.contains("skipped") && stderr.contains("bad_entities.igs"), "{stderr}");
    assert_eq!(faces(&out).len(), 2);
}

#[test]
fn what_cannot_be_converted_is_refused_with_a_reason() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inside = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    fs::write(inside("in.igs"), fs::read(data("plane_108_bounded.igs")).expect("readable")).expect("written");
    let input = inside("in.igs");
    fails(&["convert", &input, &input], BAD_INPUT, "both input and output");
    fails(&["convert", &input, &inside("./in.igs")], BAD_INPUT, "both input and output");
    fails(&["convert", &input, &inside("out.dwg")], BAD_INPUT, ".igs or .iges");
    fails(&["convert", &input, &inside("out")], BAD_INPUT, "no extension");
    fails(&["convert", &input, &inside("out.igs"), "--unit", "cubits"], BAD_INPUT, "mm");
    fails(&["convert", &inside("none.igs"), &inside("out.igs")], BAD_INPUT, "no such file");
    fails(&["convert", &input, &inside("no/such/out.igs")], NOT_WRITTEN, "there is no folder");
    fs::create_dir(inside("folder.igs")).expect("a folder");
    fails(&["convert", &input, &inside("folder.igs")], NOT_WRITTEN, "directory");
    // A file of curves alone has nothing that a file of faces could hold.
    let text = fs::read_to_string(&input).expect("text").replace("     108 ", "     110 ");
    fs::write(inside("curves.igs"), text).expect("written");
    fails(&["convert", &inside("curves.igs"), &inside("out.igs")], NOT_WRITTEN, "no faces");
    assert!(!Path::new(&inside("out.igs")).exists());
    assert_eq!(fs::read_dir(folder.path()).expect("listable").count(), 3);
}
