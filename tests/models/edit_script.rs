//! `hairline edit` as its users meet it: the examples of the documentation, errors, and that nothing is
//! written when something is wrong.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use hairline::scene::operation::{Operation, script};
use hairline::scene::{SceneRecord, demo, file};

fn edit(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hairline"))
        .arg("edit")
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .expect("the binary starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn examples() -> Vec<String> {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/edit-script.md"));
    let page = page.expect("the page is part of the project");
    let blocks = page.split("```json\n").skip(1);
    blocks.map(|rest| rest.split("```").next().unwrap_or_default().to_owned()).collect()
}

#[test]
fn every_example_of_the_documentation_works_and_every_operation_has_one() {
    let mut names = Vec::new();
    for example in examples() {
        let mut scene = SceneRecord::of_model(demo::model());
        let operations = script::parse(&example).unwrap_or_else(|e| panic!("{example}: {e}"));
        for operation in &operations {
            let edit = operation.perform(&scene).unwrap_or_else(|e| panic!("{example}: {e}"));
            edit.apply(&mut scene).expect("the edit fits");
            assert!(!edit.is_empty() || example.contains("set_role"), "{example} changes nothing");
            names.push(script::name(operation));
        }
        assert_eq!(script::parse(&script::to_text(&operations)).expect("as written"), operations);
        assert!(scene.models[0].faces[0].derive().is_ok());
    }
    // serde's own list of the operations there are.
    let all = serde_json::from_str::<Operation>(r#"{"nonsense": {}}"#).expect_err("unknown").to_string();
    let all: Vec<&str> = all.split('`').skip(3).step_by(2).collect();
    assert!(all.len() > 30);
    for name in all {
        assert!(names.iter().any(|n| n == name), "docs/edit-script.md has no example of {name}");
    }
}

#[test]
fn the_program_writes_what_the_library_makes() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (script_file, out) = (at("edits.json"), at("out.hairline"));
    let source = r#"[{"op": "move_points", "face": 1, "points": [{"loop": 2, "curve": 1, "point": 3}], "by": [90, 0]},
        {"op": "set_name", "faces": [1], "name": "Ä \"plate\""}, {"op": "delete_faces", "faces": [3]}]"#;
    fs::write(&script_file, source).expect("written");
    let done = edit(&["demo", "--script", &script_file, "-o", &out, "--json"]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    let lines: Vec<serde_json::Value> =
        text(&done.stdout).lines().map(|l| serde_json::from_str(l).expect("a JSON line")).collect();
    assert_eq!((lines[0]["step"].as_u64(), lines[0]["faces"][0].as_u64()), (Some(1), Some(1)));
    assert_eq!(lines[2]["faces_removed"].as_u64(), Some(1));
    assert!(
        lines[3..].iter().any(|l| l["severity"] == "error" && l["loop"] == 2),
        "the loop now meets others"
    );
    let mut scene = SceneRecord::of_model(demo::model());
    for operation in script::parse(source).expect("a script") {
        operation.perform(&scene).expect("possible").apply(&mut scene).expect("fits");
    }
    assert_eq!(file::load(Path::new(&out)).expect("a scene").scene, scene);
    // The result is a file like any other, and may be written over itself.
    let again = edit(&[&out, "--script", &script_file, "-o", &out]);
    assert!(
        again.status.success() && text(&again.stdout).starts_with("step 1: Move control point: face 1\n")
    );
    let iges = at("out.igs");
    let done = edit(&[&out, "--script", &script_file, "-o", &iges]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert!(fs::metadata(&iges).is_ok_and(|m| m.len() > 1000));
}

#[test]
fn nothing_is_written_when_a_step_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (script_file, out) = (at("edits.json"), at("out.hairline"));
    let good = r#"{"op": "untrim", "face": 1}"#;
    for (script, hint) in [
        (
            format!("[{good}, {{\"op\": \"untrim\", \"face\": 1}}]"),
            "step 2 (untrim): face 1: it has no trim loops",
        ),
        (
            format!("[{good}, {{\"op\": \"untrim\", \"face\": 9999}}]"),
            "step 2 (untrim): there is no face 9999",
        ),
        (
            format!("[{good}, {{\"op\": \"untrim\", \"face\": \"x\"}}]"),
            "step 2 (untrim), line 1: face: invalid type",
        ),
        (format!("[{good}, {{\"op\": \"untrim\"}}"), "expected `,` or `]`"),
        ("{}".into(), "expected an array"),
    ] {
        fs::write(&script_file, &script).expect("written");
        fs::write(&out, "old").expect("written");
        let failed = edit(&["demo", "--script", &script_file, "-o", &out]);
        assert_eq!(failed.status.code(), Some(2), "{script}");
        assert!(text(&failed.stderr).contains(hint), "{hint}: {}", text(&failed.stderr));
        assert!(failed.stdout.is_empty());
        assert_eq!(fs::read_to_string(&out).expect("readable"), "old");
    }
    fs::write(&script_file, format!("[{good}]")).expect("written");
    let dry = edit(&["demo", "--script", &script_file, "--dry-run"]);
    assert!(dry.status.success() && text(&dry.stdout).starts_with("step 1: Untrim: face 1"));
    for (arguments, code) in [
        (&["demo", "--script", &script_file][..], 2),
        (&["demo", "--script", &script_file, "-o", &at("x.step")], 2),
        (&["demo", "--script", &script_file, "-o", &at("no/such/x.igs")], 1),
        (&["demo", "--script", "/no/such.json", "--dry-run"], 2),
    ] {
        assert_eq!(edit(arguments).status.code(), Some(code), "{arguments:?}");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("listable").count(), 2, "no leftovers");
}
