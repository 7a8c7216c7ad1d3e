//! The program as its users meet it: sub-commands, bad input, exit codes. Runs the built binary.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Exit codes as `hairline --help` documents them.
pub const DONE: i32 = 0;
pub const NOT_WRITTEN: i32 = 1;
pub const BAD_INPUT: i32 = 2;
const LACKING: i32 = 3;

fn hairline() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hairline"));
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    command
}

pub fn run(arguments: &[&str], input: &str) -> (i32, String, String) {
    let mut child = hairline()
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    // A command that fails early closes its input: that is its right.
    let _ = child.stdin.take().expect("piped").write_all(input.as_bytes());
    finished(child.wait_with_output().expect("it ends"))
}

fn finished(output: Output) -> (i32, String, String) {
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    let (stdout, stderr) = (text(output.stdout), text(output.stderr));
    let lower = stderr.to_lowercase();
    assert!(!lower.contains("panic") && !lower.contains("backtrace"), "{stderr}");
    (output.status.code().expect("no signal"), stdout, stderr)
}

pub fn fails(arguments: &[&str], code: i32, hint: &str) {
    let (found, stdout, stderr) = run(arguments, "");
    assert_eq!(found, code, "{arguments:?}: {stderr}");
    assert!(stderr.contains(hint), "{arguments:?}: {stderr}");
    assert!(stdout.is_empty(), "{arguments:?}: {stdout}");
}

/// A real file of the shared models, or `None` (said aloud) where they are not there.
fn real_file(name: &str) -> Option<PathBuf> {
    let mut folder = Some(Path::new(env!("CARGO_MANIFEST_DIR")));
    while let Some(here) = folder {
        let models = here.join("shared/models/files");
        if models.is_dir() {
            let file = models.join(name);
            assert!(file.is_file(), "{} is missing", file.display());
            return Some(file);
        }
        folder = here.parent();
    }
    eprintln!("not run: no shared/models in any folder above");
    None
}

#[test]
fn help_and_version_go_to_standard_output() {
    for arguments in
        [&["--help"][..], &["render", "--help"], &["info", "-h"], &["classify", "--help"], &["--version"]]
    {
        let (code, stdout, stderr) = run(arguments, "");
        assert_eq!((code, stderr.as_str()), (DONE, ""), "{arguments:?}");
        assert!(stdout.contains("hairline"), "{stdout}");
    }
    let (_, stdout, _) = run(&["--help"], "");
    for word in ["render", "info", "classify", "convert", "edit", "bench", "Examples", "Exit codes"] {
        assert!(stdout.contains(word), "{word}");
    }
}

#[test]
fn wrong_usage_is_refused_before_any_work() {
    fails(&["--no-such-flag"], BAD_INPUT, "--no-such-flag");
    fails(&["render", "demo"], BAD_INPUT, "--output");
    fails(&["render", "demo", "-o", "x.png", "--size", "0x10"], BAD_INPUT, "0x10");
    fails(&["render", "demo", "-o", "x.png", "--view", "up"], BAD_INPUT, "fit:FACE");
    fails(&["render", "demo", "-o", "x.png", "--samples", "0"], BAD_INPUT, "--samples");
    fails(&["render", "demo", "-o", "x.png", "--mode", "pretty"], BAD_INPUT, "untrimmed");
    fails(&["bench", "nonsense"], BAD_INPUT, "nonsense");
}

#[test]
fn files_that_are_no_models_are_named_with_what_is_wrong() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).expect("written");
        path.to_string_lossy().into_owned()
    };
    let noise: Vec<u8> = (0..100_000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    let cases = [
        (folder.path().join("none.igs").to_string_lossy().into_owned(), "no such file"),
        (folder.path().to_string_lossy().into_owned(), "directory"),
        (write("empty.igs", b""), "empty"),
        (write("noise.igs", &noise), "IGES"),
        (write("text.igs", b"just some words\n"), "IGES"),
        (write("part.stp", b"ISO-10303-21;\nHEADER;\n"), "STEP"),
    ];
    for (path, hint) in &cases {
        let picture = folder.path().join("x.png").to_string_lossy().into_owned();
        for arguments in [&["info", path][..], &["classify", path], &["render", path, "-o", &picture]] {
            fails(arguments, BAD_INPUT, hint);
            let (_, _, stderr) = run(arguments, "");
            assert!(stderr.contains(path.as_str()) && stderr.lines().count() == 1, "{stderr}");
        }
        assert!(!Path::new(&picture).exists());
    }
}

#[test]
fn truncated_files_give_their_faces_or_an_error_never_a_crash() {
    let Some(path) = real_file("pyiges_144-example-1.igs") else { return };
    let bytes = fs::read(path).expect("readable");
    let folder = tempfile::tempdir().expect("a temporary folder");
    for part in 0..40 {
        let path = folder.path().join("cut.igs");
        fs::write(&path, &bytes[..bytes.len() * part / 40]).expect("written");
        let (code, stdout, stderr) = run(&["info", &path.to_string_lossy(), "--json"], "");
        match code {
            DONE => assert!(stdout.contains("\"remarks\""), "{part}: {stderr}"),
            BAD_INPUT => assert!(stderr.contains("cut.igs"), "{part}: {stderr}"),
            other => panic!("{part}: exit code {other}: {stderr}"),
        }
    }
}

#[test]
fn places_that_cannot_be_written_are_named_and_nothing_is_left_there() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inside = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    fails(&["render", "demo", "-o", &inside("no/such/x.png")], NOT_WRITTEN, "there is no folder");
    fails(&["render", "demo", "-o", &folder.path().to_string_lossy()], NOT_WRITTEN, "directory");
    fs::write(inside("file"), "").expect("written");
    fails(&["render", "demo", "-o", &inside("file/x.png")], NOT_WRITTEN, "there is no folder");
    assert_eq!(fs::read_dir(folder.path()).expect("listable").count(), 1);
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let mut child = hairline()
        .args(["info", "demo", "--json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    drop(child.stdout.take());
    let (code, _, stderr) = finished(child.wait_with_output().expect("it ends"));
    assert_eq!((code, stderr.as_str()), (DONE, ""));
}

#[test]
fn info_gives_every_face_of_the_demo_scene() {
    let (code, stdout, stderr) = run(&["info", "demo", "--json"], "");
    assert_eq!(code, DONE, "{stderr}");
    let info: serde_json::Value = serde_json::from_str(&stdout).expect("valid JSON");
    let faces = info["faces"].as_array().expect("faces");
    assert_eq!(faces.len(), info["counts"]["faces"]);
    for (i, face) in faces.iter().enumerate() {
        assert_eq!(face["index"], i + 1);
        for field in ["degree_u", "degree_v", "loops", "curves"] {
            assert!(face[field].is_u64(), "{field} of {face}");
        }
        assert_eq!(face["bbox"].as_array().map(Vec::len), Some(6));
        assert_eq!(face["uv_box"].as_array().map(Vec::len), Some(4));
    }
    let (code, text, _) = run(&["info", "demo"], "");
    assert_eq!(code, DONE);
    assert!(text.contains("Sail") && text.contains("after Bezier conversion"), "{text}");
}

#[test]
fn the_editor_says_what_it_lacks() {
    let hint = if cfg!(feature = "editor") { "display" } else { "without the editor" };
    fails(&[], LACKING, hint);
    fails(&["--demo"], LACKING, hint);
    fails(&["no-such-file.igs"], BAD_INPUT, "no such file");
}

#[test]
fn classify_answers_in_order_and_names_the_first_bad_line() {
    // The medal's nested rings: metal, opening, island, opening in it, island in that one.
    let (_, json, _) = run(&["info", "demo", "--json"], "");
    let info: serde_json::Value = serde_json::from_str(&json).expect("valid JSON");
    let medal =
        info["faces"].as_array().expect("faces").iter().find(|f| f["name"] == "Medal").expect("a medal");
    let face = &medal["index"];
    let points = [(-16.0, "in"), (-9.3, "out"), (-8.2, "in"), (-3.3, "out"), (0.0, "in"), (17.5, "out")];
    let lines: String = points.iter().map(|(u, _)| format!("{face} {u} 0.01\n")).collect();
    let expected: String = points.iter().map(|(_, side)| format!("{side}\n")).collect();
    let (code, stdout, stderr) = run(&["classify", "demo"], &format!("# five rings\n\n{lines}"));
    assert_eq!((code, stdout.as_str()), (DONE, expected.as_str()), "{stderr}");
    let (code, stdout, stderr) = run(&["classify", "demo"], &format!("{lines}9999 0 0\n"));
    assert_eq!((code, stdout.as_str()), (BAD_INPUT, expected.as_str()));
    assert!(stderr.contains("line 7") && stderr.contains("9999"), "{stderr}");
}

#[test]
fn a_missing_driver_is_an_error_only_when_asked_for() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let picture = folder.path().join("x.png");
    let render = |backend: &[&str]| {
        let output = hairline()
            .args(["render", "demo", "--size", "64x48", "--samples", "1", "-o"])
            .arg(&picture)
            .args(backend)
            .env("VK_DRIVER_FILES", "/nowhere/driver.json")
            .env("VK_ICD_FILENAMES", "/nowhere/driver.json")
            .output();
        finished(output.expect("the binary starts"))
    };
    let (code, _, stderr) = render(&["--backend", "gpu"]);
    assert_eq!(code, LACKING, "{stderr}");
    assert!(!picture.exists());
    let (code, _, stderr) = render(&[]);
    assert_eq!(code, DONE, "{stderr}");
    assert!(fs::read(&picture).expect("a picture").starts_with(b"\x89PNG"));
    assert_eq!(fs::read_dir(folder.path()).expect("listable").count(), 1);
}
