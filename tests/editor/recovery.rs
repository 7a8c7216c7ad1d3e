//! The built program: a scene is opened, edited by key, saved, edited again and killed; the next start recovers what was
//! not saved.

use std::path::Path;
use std::time::Duration;

use hairline::scene::file::recovery::RecoveryFolder;
use hairline::scene::file::{self, SaveOptions};
use hairline::scene::{SceneRecord, demo};

use super::window::{CONTROL, Editor};

// X keycodes of the keyboard that Xvfb has.
const ENTER: u8 = 36;
const S: u8 = 39;
const N: u8 = 57;
const ALT: u8 = 64;

fn reversed(path: &Path) -> Vec<bool> {
    let scene = file::load(path).expect("never half a file").scene;
    scene.models[0].faces.iter().map(|f| f.reversed).collect()
}

fn start(folder: &Path, scene: &Path) -> Editor {
    let mut editor = Editor::start_with(folder, &[scene]);
    editor.first_picture();
    editor
}

#[test]
fn killed_work_is_recovered() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let settings = folder.path().join("hairline");
    std::fs::create_dir_all(&settings).expect("writable");
    std::fs::write(settings.join("settings.json"), br#"{"autosave_s": 1}"#).expect("writable");
    let path = folder.path().join("part.hairline");
    let mut model = demo::model();
    model.faces.truncate(2);
    model.faces.iter_mut().for_each(|f| f.part = None);
    model.parts.clear();
    file::save(&path, &SceneRecord::of_model(model), &SaveOptions::default()).expect("writable");
    let before = reversed(&path);
    let flipped: Vec<bool> = before.iter().map(|r| !r).collect();
    let copies = RecoveryFolder::at(folder.path().join("hairline/recovery"));

    let mut editor = Editor::start_with(folder.path(), &[&path]);
    let shown = editor.first_picture();
    editor.select_all(&shown, 1000);
    editor.key_with(ALT, N);
    editor.key_with(CONTROL, S);
    editor.wait("saved", |_| (reversed(&path) == flipped).then_some(()));
    editor.key_with(ALT, N);
    editor.wait("a copy", |_| {
        let entries = std::fs::read_dir(copies.path()).ok()?.flatten();
        entries.map(|e| e.path()).find(|p| p.extension().is_some_and(|e| e == "json")).map(drop)
    });
    editor.kill();
    assert_eq!(reversed(&path), flipped, "the file is as it was saved");
    let found = copies.recoverable();
    assert_eq!(found.len(), 1);
    assert_eq!(reversed(&found[0].file), before, "the copy has the latest edit");

    let mut editor = start(folder.path(), &path);
    editor.screen.key(ENTER);
    editor.rest(Duration::from_secs(2));
    editor.key_with(CONTROL, S);
    editor.wait("saved", |_| (reversed(&path) == before).then_some(()));
    assert!(editor.end().success());
    assert!(copies.recoverable().is_empty());
}
