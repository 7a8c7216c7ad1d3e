//! Saves that are killed, refused or raced leave the old file or the new one, whole.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use hairline::scene::file::{self, Packing, SaveOptions};
use hairline::scene::{SceneRecord, demo};

fn convert(input: &Path, output: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hairline"));
    command
        .arg("convert")
        .args([input, output])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
}

/// Two scenes of different size in files of a new folder, and a third file to save to.
fn scenes(folder: &Path) -> [(std::path::PathBuf, Vec<u8>); 2] {
    [("a.hairline", 3), ("b.hairline", 9)].map(|(name, faces)| {
        let mut scene = SceneRecord::of_model(demo::model());
        scene.models[0].faces.truncate(faces);
        scene.models[0].faces.iter_mut().for_each(|f| f.loops.truncate(60));
        let path = folder.join(name);
        let packing = Packing::Plain;
        file::save(&path, &scene, &SaveOptions { packing, expected: None }).expect("saved");
        // What `convert` makes of it.
        let bytes = file::to_bytes(&scene, Packing::Automatic).expect("finite");
        (path, bytes)
    })
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("listable").flatten();
    entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn a_save_killed_at_any_moment_leaves_the_old_file_or_the_new_one() {
    const KILLS: u32 = 40;
    let folder = tempfile::tempdir().expect("a folder");
    let [a, b] = scenes(folder.path());
    let output = folder.path().join("out.hairline");
    let begun = Instant::now();
    assert!(convert(&a.0, &output).status().expect("it runs").success());
    let whole = begun.elapsed();
    assert_eq!(fs::read(&output).expect("readable"), a.1);
    let mut killed = 0;
    for k in 0..KILLS {
        let mut child = convert(if k % 2 == 0 { &b.0 } else { &a.0 }, &output).spawn().expect("it starts");
        // Every moment of the run, the last third of it (the saving) more often.
        let part = f64::from(k * 37 % KILLS) / f64::from(KILLS);
        std::thread::sleep(Duration::from_secs_f64(whole.as_secs_f64() * 1.05 * part.sqrt()));
        let _ = child.kill();
        killed += u32::from(!child.wait().expect("it ends").success());
        let found = fs::read(&output).expect("there is always a file");
        assert!(
            found == a.1 || found == b.1,
            "kill {k}: {} bytes are neither the old nor the new file",
            found.len()
        );
    }
    assert!(killed > KILLS / 4, "only {killed} of {KILLS} were killed before they were done");
    assert!(convert(&b.0, &output).status().expect("it runs").success());
    assert_eq!(fs::read(&output).expect("readable"), b.1);
    assert_eq!(
        names(folder.path()).len(),
        3,
        "what the killed ones left is gone: {:?}",
        names(folder.path())
    );
}

#[cfg(unix)]
#[test]
fn a_save_that_runs_out_of_room_loses_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let [a, b] = scenes(folder.path());
    let output = folder.path().join("out.hairline");
    assert!(convert(&a.0, &output).status().expect("it runs").success());
    // Files of at most 4 KiB, and no signal when that is too little: as on a full disk.
    let script = "trap '' XFSZ; ulimit -f 8; exec \"$0\" convert \"$1\" \"$2\"";
    let full = Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_hairline")])
        .args([&b.0, &output])
        .output()
        .expect("it runs");
    assert_eq!(full.status.code(), Some(1));
    let message = String::from_utf8_lossy(&full.stderr).into_owned();
    assert!(message.contains("cannot write") && message.contains("too large"), "{message}");
    assert_eq!(fs::read(&output).expect("readable"), a.1);
    assert_eq!(names(folder.path()).len(), 3, "{:?}", names(folder.path()));
}

#[test]
fn scenes_open_in_every_command_by_their_content() {
    let folder = tempfile::tempdir().expect("a folder");
    let [a, _] = scenes(folder.path());
    let renamed = folder.path().join("scene.dat");
    fs::copy(&a.0, &renamed).expect("copied");
    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_hairline"))
            .args(arguments)
            .arg(&renamed)
            .stdin(Stdio::null())
            .output()
            .expect("it runs");
        (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let (code, told) = run(&["info", "--json"]);
    assert_eq!(code, Some(0));
    let told: serde_json::Value = serde_json::from_str(&told).expect("JSON");
    assert_eq!(told["faces"].as_array().map(Vec::len), Some(3));
    assert_eq!(run(&["classify"]).0, Some(0));
    let damaged = fs::read_to_string(&a.0).expect("text").replacen("\"points\":[[", "\"points\":[[null,", 1);
    fs::write(&renamed, damaged).expect("written");
    let output =
        Command::new(env!("CARGO_BIN_EXE_hairline")).arg("info").arg(&renamed).output().expect("it runs");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2));
    assert!(message.contains("(in models[1].faces[1].surface.points[1][1])"), "{message}");
}
