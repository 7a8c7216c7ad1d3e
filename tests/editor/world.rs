//! The editor without a window: loading, selecting, hiding, closing.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use bevy::input::InputPlugin;
use bevy::prelude::*;
use bevy::window::{FileDragAndDrop, RequestRedraw};
use hairline::editor::EditorPlugin;
use hairline::editor::camera::{CameraRequest, ViewCamera, motion};
use hairline::editor::derive::SceneBounds;
use hairline::editor::document::{Answer, Recovery};
use hairline::editor::files::{LoadError, Loading, OpenFiles, Source, read_source};
use hairline::editor::object::{AuthoredFace, DerivedFace, FacePlace, Model, Scene, Shown, TrimLoop};
use hairline::editor::panels::Notices;
use hairline::editor::selection::{SelectMode, SelectRequest, Selection};
use hairline::editor::settings::Settings;
use hairline::editor::tools::{Action, CommandRequest};
use hairline::exchange::report::Severity;
use hairline::kernel::view::{Projection, StandardView};

pub fn app() -> App {
    app_with(Recovery::default())
}

/// With copies to recover from.
pub fn app_with(recovery: Recovery) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, InputPlugin))
        .add_message::<FileDragAndDrop>()
        .add_message::<RequestRedraw>()
        .insert_resource(recovery)
        .add_plugins(EditorPlugin { windowed: false });
    app
}

/// Updates until nothing is being read any more.
pub fn finish_loading(app: &mut App) {
    let started = Instant::now();
    app.update();
    while app.world().resource::<Loading>().is_active() {
        assert!(started.elapsed() < Duration::from_secs(120), "still loading");
        std::thread::sleep(Duration::from_millis(2));
        app.update();
    }
    app.update();
}

fn open(app: &mut App, sources: Vec<Source>, replace: bool) {
    app.world_mut().write_message(OpenFiles { sources, replace });
    app.update();
    app.world_mut().write_message(Answer::Discard);
    finish_loading(app);
}

pub fn command(app: &mut App, action: Action) {
    app.world_mut().write_message(CommandRequest(action));
    app.update();
    app.update();
}

pub fn demo_app() -> App {
    let mut app = app();
    open(&mut app, vec![Source::Demo], true);
    app
}

fn faces(app: &App) -> Vec<Entity> {
    app.world().resource::<Scene>().faces().collect()
}

fn select(app: &mut App, faces: Vec<Entity>, mode: SelectMode) {
    app.world_mut().write_message(SelectRequest { faces, mode });
    app.update();
}

fn selected(app: &App) -> Vec<Entity> {
    app.world().resource::<Selection>().faces().to_vec()
}

fn shown(app: &App) -> Vec<bool> {
    faces(app).iter().map(|f| app.world().get::<Shown>(*f).expect("a face").0).collect()
}

#[test]
fn the_demo_scene_becomes_entities() {
    let mut app = demo_app();
    let record = hairline::scene::demo::model();
    assert_eq!(faces(&app).len(), record.faces.len());
    let loops: usize = record.faces.iter().map(|f| f.loops.len()).sum();
    assert_eq!(app.world_mut().query::<&TrimLoop>().iter(app.world()).count(), loops);
    let derived = app.world_mut().query::<&DerivedFace>().iter(app.world()).count();
    assert_eq!(derived, record.faces.len());
    let failures: Vec<_> = app
        .world_mut()
        .query::<(&FacePlace, &DerivedFace)>()
        .iter(app.world())
        .filter_map(|(a, d)| d.0.failure.clone().map(|f| (a.number, f)))
        .collect();
    assert_eq!(failures, []);
    assert!(app.world().resource::<SceneBounds>().all.diagonal() > 0.0);
}

#[test]
fn selecting_replaces_adds_and_toggles() {
    let mut app = demo_app();
    let all = faces(&app);
    select(&mut app, vec![all[0]], SelectMode::Replace);
    select(&mut app, vec![all[1]], SelectMode::Add);
    assert_eq!(selected(&app), [all[0], all[1]]);
    select(&mut app, vec![all[0], all[2]], SelectMode::Toggle);
    assert_eq!(selected(&app), [all[1], all[2]]);
    command(&mut app, Action::ClearSelection);
    assert!(selected(&app).is_empty());
    command(&mut app, Action::SelectAll);
    assert_eq!(selected(&app).len(), all.len());
    select(&mut app, vec![all[3]], SelectMode::Replace);
    command(&mut app, Action::InvertSelection);
    assert_eq!(selected(&app).len(), all.len() - 1);
    assert!(!selected(&app).contains(&all[3]));
}

#[test]
fn things_that_are_no_faces_cannot_be_selected() {
    let mut app = demo_app();
    let model = app.world().resource::<Scene>().models[0].entity;
    let stranger = app.world_mut().spawn_empty().id();
    select(&mut app, vec![model, stranger], SelectMode::Replace);
    assert!(selected(&app).is_empty());
}

#[test]
fn hiding_isolating_and_showing() {
    let mut app = demo_app();
    let all = faces(&app);
    select(&mut app, vec![all[1]], SelectMode::Replace);
    command(&mut app, Action::Hide);
    assert!(!shown(&app)[1] && shown(&app)[0]);
    command(&mut app, Action::Isolate);
    assert_eq!(shown(&app).iter().filter(|s| **s).count(), 1);
    assert!(shown(&app)[1]);
    command(&mut app, Action::ShowAll);
    assert!(shown(&app).iter().all(|s| *s));
    // Isolating nothing would hide everything: nothing happens.
    command(&mut app, Action::ClearSelection);
    command(&mut app, Action::Isolate);
    assert!(shown(&app).iter().all(|s| *s));
}

#[test]
fn closing_leaves_nothing_behind() {
    let mut app = demo_app();
    let all = faces(&app);
    select(&mut app, vec![all[0]], SelectMode::Replace);
    command(&mut app, Action::CloseAll);
    assert!(app.world().resource::<Scene>().is_empty());
    assert!(selected(&app).is_empty());
    let mut left =
        app.world_mut().query_filtered::<(), Or<(With<AuthoredFace>, With<TrimLoop>, With<Model>)>>();
    assert_eq!(left.iter(app.world()).count(), 0, "entities are left");
    assert!(app.world().resource::<SceneBounds>().all.is_empty());
}

#[test]
fn opening_replaces_and_importing_adds() {
    let mut app = demo_app();
    let one = faces(&app).len();
    open(&mut app, vec![Source::Demo], false);
    assert_eq!(faces(&app).len(), 2 * one);
    open(&mut app, vec![Source::Demo], true);
    assert_eq!(faces(&app).len(), one);
    assert_eq!(app.world().resource::<Scene>().models.len(), 1);
}

#[test]
fn importing_is_a_step() {
    use hairline::editor::editing::Editing;
    let mut app = demo_app();
    let one = faces(&app).len();
    open(&mut app, vec![Source::Demo], false);
    let imported = crate::editing::records(&mut app);
    assert_eq!(app.world().resource::<Editing>().history().undo_label(), Some("Import Demo scene"));
    assert!(app.world().resource::<Editing>().is_unsaved());
    command(&mut app, Action::Undo);
    assert_eq!(faces(&app).len(), one);
    assert!(!app.world().resource::<Editing>().is_unsaved(), "as it was opened");
    command(&mut app, Action::Redo);
    assert_eq!(crate::editing::records(&mut app), imported);
}

#[test]
fn a_bad_file_is_named_and_what_is_open_stays() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let empty = folder.path().join("empty.igs");
    let garbage = folder.path().join("garbage.igs");
    std::fs::write(&empty, b"").expect("writable");
    std::fs::write(&garbage, [0u8, 159, 146, 150].repeat(500)).expect("writable");
    let missing = folder.path().join("missing.igs");
    let mut app = demo_app();
    let before = faces(&app);
    for (path, name) in [
        (empty, "empty.igs"),
        (garbage, "garbage.igs"),
        (missing, "missing.igs"),
        (folder.path().to_owned(), ""),
    ] {
        open(&mut app, vec![Source::File(path)], true);
        let notices = app.world().resource::<Notices>();
        let last = notices.list().last().expect("an error is shown");
        assert_eq!(last.severity, Severity::Error, "{last:?}");
        assert!(last.text.contains(name), "{last:?}");
        assert_eq!(faces(&app), before, "what was open is still open");
    }
}

#[test]
fn reading_stops_when_it_is_cancelled() {
    let result = read_source(&Source::Demo, &|_, _| false);
    assert!(matches!(result, Err(LoadError::Cancelled)), "{:?}", result.map(|m| m.models.len()));
}

#[test]
fn cancelling_keeps_what_is_open() {
    let mut app = demo_app();
    let before = faces(&app);
    app.world_mut().write_message(OpenFiles { sources: vec![Source::Demo; 3], replace: true });
    app.world_mut().write_message(CommandRequest(Action::Cancel));
    finish_loading(&mut app);
    let now = faces(&app);
    // Cancelled in time, or the first was already through: never a half-read model.
    assert!(now == before || now.len() % before.len() == 0);
}

#[test]
fn dropped_files_are_opened() {
    let mut app = demo_app();
    let window = app.world_mut().spawn_empty().id();
    let path_buf = PathBuf::from("/nowhere/dropped.igs");
    app.world_mut().write_message(FileDragAndDrop::DroppedFile { window, path_buf });
    finish_loading(&mut app);
    let notices = app.world().resource::<Notices>();
    assert!(notices.list().iter().any(|n| n.text.contains("dropped.igs")), "{notices:?}");
}

#[test]
fn views_follow_the_commands() {
    let mut app = demo_app();
    command(&mut app, Action::View(StandardView::Top));
    let to = app.world().resource::<ViewCamera>().destination();
    let (_, _, back) = to.axes();
    assert!((back - glam::DVec3::Z).length() < 1e-9);
    command(&mut app, Action::ToggleProjection);
    assert!(!app.world().resource::<Settings>().perspective);
    let to = app.world().resource::<ViewCamera>().destination();
    assert!(matches!(to.projection, Projection::Orthographic { .. }));
    // Fitting one face looks closer than fitting all.
    command(&mut app, Action::Fit);
    let all = motion::view_size(&app.world().resource::<ViewCamera>().destination());
    let smallest = faces(&app)
        .into_iter()
        .min_by_key(|f| app.world().get::<DerivedFace>(*f).map(|d| (1e6 * d.0.bounds.diagonal()) as u64))
        .expect("faces");
    select(&mut app, vec![smallest], SelectMode::Replace);
    command(&mut app, Action::FitSelection);
    let one = motion::view_size(&app.world().resource::<ViewCamera>().destination());
    assert!(one < 0.9 * all, "{one} {all}");
    app.world_mut().write_message(CameraRequest::FitBounds(hairline::kernel::view::Bounds::EMPTY));
    app.update();
    assert!(app.world().resource::<ViewCamera>().now.eye.is_finite());
}

#[test]
fn areas_arrive_after_the_faces() {
    let app = demo_app();
    let face = faces(&app)[0];
    let derived = app.world().get::<DerivedFace>(face).expect("derived").0.clone();
    derived.measure();
    let measures = *derived.measures().expect("measured");
    assert!(measures.area > 0.0);
    assert!(derived.best_bounds().diagonal() <= derived.bounds.diagonal() * (1.0 + 1e-9));
}
