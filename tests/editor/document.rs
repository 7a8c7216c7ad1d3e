//! The document as a file: saving, asking before work is lost, copies to recover from.

use std::path::Path;
use std::time::{Duration, Instant};

use bevy::ecs::system::RunSystemOnce;
use bevy::prelude::*;
use bevy::window::WindowCloseRequested;
use hairline::editor::document::{
    Answer, Discarding, DocumentFile, Naming, Question, Questions, Recovery, SaveRequest, Saving, Target,
};
use hairline::editor::editing::{EditRequest, Editing};
use hairline::editor::files::{OpenFiles, Source};
use hairline::editor::object::{Scene, Shown};
use hairline::editor::panels::Notices;
use hairline::editor::settings::{DisplayMode, Settings};
use hairline::editor::tools::Action;
use hairline::exchange::report::Severity;
use hairline::scene::FaceId;
use hairline::scene::file::recovery::RecoveryFolder;
use hairline::scene::file::{self, SaveOptions};
use hairline::scene::operation::Operation;

use crate::editing::{records, send};
use crate::world::{app, command, demo_app, finish_loading};

/// Updates until `done`.
fn until(app: &mut App, what: &str, mut done: impl FnMut(&App) -> bool) {
    let started = Instant::now();
    while !done(app) {
        assert!(started.elapsed() < Duration::from_secs(60), "not within a minute: {what}");
        std::thread::sleep(Duration::from_millis(2));
        app.update();
    }
}

fn save(app: &mut App, target: Target, then: Option<Discarding>) {
    app.world_mut().write_message(SaveRequest { target, then });
    app.update();
    until(app, "saved", |app| !app.world().resource::<Saving>().is_active());
}

fn save_to(app: &mut App, path: &Path) {
    save(app, Target::File(path.to_owned()), None);
}

fn open(app: &mut App, path: &Path, replace: bool) {
    let sources = vec![Source::File(path.to_owned())];
    app.world_mut().write_message(OpenFiles { sources, replace });
    finish_loading(app);
}

fn rename(app: &mut App, name: &str) {
    let faces = vec![FaceId::default()];
    send(app, [EditRequest::Perform(Operation::SetName { faces, name: Some(name.into()) })]);
}

fn unsaved(app: &App) -> bool {
    app.world().resource::<Editing>().is_unsaved()
}

fn question(app: &App) -> Option<Question> {
    app.world().resource::<Questions>().open().cloned()
}

fn answer(app: &mut App, answer: Answer) {
    app.world_mut().write_message(answer);
    app.update();
}

fn last_notice(app: &App) -> (Severity, String) {
    let notice = app.world().resource::<Notices>().list().last().expect("something is said").clone();
    (notice.severity, notice.text)
}

fn has_exited(app: &App) -> bool {
    app.should_exit().is_some()
}

#[test]
fn saving_and_opening_give_the_same_document() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("part.hairline");
    let mut app = demo_app();
    rename(&mut app, "first");
    let hidden = app.world().resource::<Scene>().face(0, 2).expect("a face");
    app.world_mut().entity_mut(hidden).insert(Shown(false));
    app.world_mut().resource_mut::<Settings>().mode = DisplayMode::Uv;
    assert!(unsaved(&app));
    save_to(&mut app, &path);
    assert!(!unsaved(&app));
    let before = records(&mut app);
    let kept = file::load(&path).expect("readable").scene;
    assert!(kept.models == before);
    assert_eq!(kept.hidden, [FaceId { model: 0, face: 2 }]);

    let mut other = app_with(&path);
    assert!(records(&mut other) == before);
    assert!(!unsaved(&other));
    assert_eq!(other.world().resource::<Settings>().mode, DisplayMode::Uv);
    let face = other.world().resource::<Scene>().face(0, 2).expect("a face");
    assert!(!other.world().get::<Shown>(face).expect("a face").0);
    // Saving it again changes nothing in the file.
    let bytes = std::fs::read(&path).expect("readable");
    save(&mut other, Target::Own, None);
    assert!(std::fs::read(&path).expect("readable") == bytes);
}

fn app_with(path: &Path) -> App {
    let mut app = app();
    open(&mut app, path, true);
    app
}

#[test]
fn the_unsaved_mark_follows_undo_redo_and_saving() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("part.hairline");
    let mut app = demo_app();
    rename(&mut app, "one");
    save_to(&mut app, &path);
    rename(&mut app, "two");
    assert!(unsaved(&app));
    command(&mut app, Action::Undo);
    assert!(!unsaved(&app));
    command(&mut app, Action::Undo);
    assert!(unsaved(&app));
    command(&mut app, Action::Redo);
    assert!(!unsaved(&app));
    // Importing is no step, but there is something to save.
    open(&mut app, &path, false);
    assert!(unsaved(&app));
    assert_eq!(app.world().resource::<Scene>().models.len(), 2);
    save(&mut app, Target::Own, None);
    assert!(!unsaved(&app));
    assert_eq!(file::load(&path).expect("readable").scene.models.len(), 2);
}

#[test]
fn work_is_not_lost_without_being_asked() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("part.hairline");
    let mut app = demo_app();
    rename(&mut app, "kept");
    let before = records(&mut app);
    let window = app.world_mut().spawn_empty().id();
    let other = OpenFiles { sources: vec![Source::Demo], replace: true };
    for what in [Discarding::Close, Discarding::Open(other.clone()), Discarding::Quit, Discarding::Quit] {
        match &what {
            Discarding::Close => command(&mut app, Action::New),
            Discarding::Open(files) => drop(app.world_mut().write_message(files.clone())),
            Discarding::Quit => drop(app.world_mut().write_message(WindowCloseRequested { window })),
        }
        finish_loading(&mut app);
        assert_eq!(question(&app), Some(Question::Unsaved(what)));
        assert!(records(&mut app) == before && !has_exited(&app));
        answer(&mut app, Answer::Cancel);
        assert_eq!(question(&app), None);
        assert!(records(&mut app) == before && !has_exited(&app));
    }
    // Saving first, then going on.
    save_to(&mut app, &path);
    rename(&mut app, "later");
    app.world_mut().write_message(other.clone());
    app.update();
    answer(&mut app, Answer::Save);
    until(&mut app, "saved", |app| !app.world().resource::<Saving>().is_active());
    finish_loading(&mut app);
    assert_eq!(file::load(&path).expect("readable").scene.models[0].faces[0].name.as_deref(), Some("later"));
    assert_eq!(app.world().resource::<DocumentFile>().path, None, "the demo is open now");
    // And without saving.
    rename(&mut app, "lost");
    command(&mut app, Action::Quit);
    answer(&mut app, Answer::Discard);
    app.update();
    assert!(has_exited(&app));
}

#[test]
fn a_save_that_fails_loses_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut app = demo_app();
    rename(&mut app, "precious");
    let before = records(&mut app);
    let blocked = folder.path().join("blocked.hairline");
    std::fs::create_dir(&blocked).expect("writable");
    for path in [folder.path().join("no/such/folder/a.hairline"), blocked] {
        save(&mut app, Target::File(path.clone()), Some(Discarding::Quit));
        app.update();
        let (severity, text) = last_notice(&app);
        assert_eq!(severity, Severity::Error);
        assert!(text.contains(&*path.to_string_lossy()), "{text}");
        assert!(unsaved(&app) && !has_exited(&app));
        assert!(records(&mut app) == before);
        assert_eq!(app.world().resource::<DocumentFile>().path, None);
    }
}

#[test]
fn somebody_elses_version_is_not_overwritten_unasked() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("shared.hairline");
    let mut first = demo_app();
    save_to(&mut first, &path);
    let mut second = app_with(&path);
    rename(&mut second, "from the second window");
    save(&mut second, Target::Own, None);
    let theirs = std::fs::read(&path).expect("readable");

    rename(&mut first, "from the first window");
    save(&mut first, Target::Own, None);
    assert!(matches!(question(&first), Some(Question::Changed { .. })), "{:?}", question(&first));
    assert!(std::fs::read(&path).expect("readable") == theirs);
    assert!(unsaved(&first));
    answer(&mut first, Answer::Cancel);
    assert!(std::fs::read(&path).expect("readable") == theirs);
    save(&mut first, Target::Own, None);
    answer(&mut first, Answer::Overwrite);
    until(&mut first, "saved", |app| !app.world().resource::<Saving>().is_active());
    assert!(!unsaved(&first));
    let name = file::load(&path).expect("readable").scene.models[0].faces[0].name.clone();
    assert_eq!(name.as_deref(), Some("from the first window"));
}

#[test]
fn copies_are_kept_offered_and_removed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let keep = |app: &mut App| {
        app.world_mut().resource_mut::<Recovery>().folder = Some(RecoveryFolder::at(folder.path()));
        app.world_mut().resource_mut::<Settings>().autosave_s = 1;
    };
    let copies = || {
        let all = std::fs::read_dir(folder.path()).expect("readable").flatten();
        all.filter(|e| e.path().extension().is_some_and(|e| e == "hairline")).count()
    };
    let mut app = demo_app();
    keep(&mut app);
    app.update();
    assert_eq!(copies(), 0, "nothing to keep yet");
    rename(&mut app, "precious");
    // The note comes last.
    let notes = || {
        let all = std::fs::read_dir(folder.path()).expect("readable").flatten();
        all.filter(|e| e.path().extension().is_some_and(|e| e == "json")).count()
    };
    until(&mut app, "a copy", |_| notes() == 1);
    assert_eq!(copies(), 1);
    let before = records(&mut app);
    // As after a crash: the copy of a process that is gone.
    let copy = std::fs::read_dir(folder.path()).expect("readable").flatten().map(|e| e.path());
    for path in copy.collect::<Vec<_>>() {
        let name = path.file_name().expect("a name").to_string_lossy().replace("Untitled", "crashed");
        std::fs::copy(&path, folder.path().join(format!("x{name}"))).expect("writable");
    }
    for entry in std::fs::read_dir(folder.path()).expect("readable").flatten() {
        let path = entry.path();
        if path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('x'))
            && path.extension().is_some_and(|e| e == "json")
        {
            let text = std::fs::read_to_string(&path).expect("readable");
            let own = std::process::id().to_string();
            std::fs::write(&path, text.replace(&own, "4194303")).expect("writable");
        }
    }
    // Closing in order removes the own copy; the other stays.
    command(&mut app, Action::CloseAll);
    answer(&mut app, Answer::Discard);
    app.update();
    assert_eq!(copies(), 1);

    let mut next = crate::world::app_with(Recovery::at(RecoveryFolder::at(folder.path())));
    next.update();
    let Some(Question::Recover(list)) = question(&next) else { panic!("{:?}", question(&next)) };
    assert_eq!(list.len(), 1);
    answer(&mut next, Answer::Recover(list[0].file.clone()));
    finish_loading(&mut next);
    assert!(records(&mut next) == before);
    assert!(unsaved(&next), "it is only in the copy");
    // Saved: nothing is left to recover.
    save_to(&mut next, &folder.path().join("saved.hairline"));
    std::fs::remove_file(folder.path().join("saved.hairline")).expect("it is there");
    assert_eq!(copies(), 0, "not even one that was being written");
}

#[test]
fn exported_files_come_back() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("out.igs");
    let mut app = demo_app();
    rename(&mut app, "exported");
    let before = records(&mut app);
    save(&mut app, Target::Export(path.clone()), None);
    assert!(unsaved(&app), "an export is no save");
    let mut other = app_with(&path);
    let naming = |app: &mut App| {
        app.world_mut().run_system_once(|naming: Naming| naming.suggestion()).expect("readable")
    };
    assert_eq!(naming(&mut other), Some(path), "named after what was opened");
    let built_in = naming(&mut app).expect("a name");
    assert_eq!(built_in.file_stem(), Some("Demo scene".as_ref()));
    let after = records(&mut other);
    // Islands become faces of their own there.
    assert!(after[0].faces.len() >= before[0].faces.len());
    assert_eq!(after[0].faces[0].name.as_deref(), Some("exported"));
}

#[test]
fn damaged_and_newer_scene_files_are_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("part.hairline");
    let mut app = demo_app();
    let scene = hairline::scene::SceneRecord::of_model(records(&mut app).remove(0));
    file::save(&path, &scene, &SaveOptions::default()).expect("writable");
    let good = std::fs::read(&path).expect("readable");
    let before = records(&mut app);
    for bad in [good[..good.len() / 2].to_vec(), b"{\"hairline\": 99, \"models\": []}".to_vec(), Vec::new()] {
        std::fs::write(&path, &bad).expect("writable");
        open(&mut app, &path, true);
        let (severity, text) = last_notice(&app);
        assert!(severity == Severity::Error && text.contains("part.hairline"), "{text}");
        assert!(records(&mut app) == before);
        assert!(std::fs::read(&path).expect("readable") == bad, "the file is untouched");
    }
}
