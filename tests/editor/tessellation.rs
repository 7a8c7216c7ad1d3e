//! The tessellation in the editor's world: made and measured in the background, followed edit by edit, called off,
//! wiped, exported.

use std::time::{Duration, Instant};

use bevy::input::ButtonState;
use bevy::input::mouse::MouseButtonInput;
use bevy::prelude::*;
use bevy::window::{CursorMoved, WindowEvent};
use glam::DVec2;
use hairline::editor::editing::{EditRequest, Editing};
use hairline::editor::files::{OpenFiles, Source};
use hairline::editor::object::{DerivedFace, Scene};
use hairline::editor::picking::Picker;
use hairline::editor::settings::Settings;
use hairline::editor::tessellation::{
    MeshFormat, Progress, Stop, Tessellation, TessellationChoices, TessellationRequest, TessellationView,
    Wipe,
};
use hairline::editor::tools::{Action, CurrentSituation};
use hairline::editor::viewport::{Pointer, Viewport};
use hairline::kernel::face::Face;
use hairline::meshing::{Work, mesh_faces};
use hairline::scene::SceneRecord;
use hairline::scene::file::{self, SaveOptions};
use hairline::scene::operation::{Operation, PointId};

use crate::editing::{holed, send};
use crate::world::{app, command, finish_loading};

fn wait(app: &mut App, what: &str, done: impl Fn(&Tessellation) -> bool) {
    let until = Instant::now() + Duration::from_secs(60);
    while !done(app.world().resource::<Tessellation>()) {
        let progress = app.world().resource::<Tessellation>().progress();
        assert!(Instant::now() < until, "{what}: {progress:?}");
        std::thread::sleep(Duration::from_millis(10));
        app.update();
    }
}

fn ready(app: &mut App) {
    wait(app, "a tessellation", |state| state.progress() == Progress::Ready && state.current().is_some());
}

fn ask(app: &mut App, request: TessellationRequest) {
    app.world_mut().write_message(request);
    app.update();
}

/// Some faces of the demo scene with their tessellation shown, coarse to be quick.
fn tessellated(view: TessellationView) -> App {
    let mut model = hairline::scene::demo::model();
    let kept = ["Foot", "Core", "Rim of the medal", "Ring"];
    model.faces.retain(|face| kept.iter().any(|name| face.name.as_deref() == Some(name)));
    assert_eq!(model.faces.len(), kept.len());
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("few.hairline");
    file::save(&path, &SceneRecord::of_model(model), &SaveOptions::default()).expect("writable");
    let mut app = app();
    app.world_mut().write_message(OpenFiles { sources: vec![Source::File(path)], replace: true });
    app.update();
    finish_loading(&mut app);
    let size = {
        command(&mut app, Action::Tessellation(view));
        app.world().resource::<Tessellation>().size_mm()
    };
    let choices = TessellationChoices { view, tolerance_mm: Some(6e-3 * size), ..Default::default() };
    ask(&mut app, TessellationRequest::Choose(choices));
    ready(&mut app);
    app
}

/// The meshes of the faces as they are, made from scratch.
fn from_scratch(app: &App) -> hairline::meshing::ModelMesh {
    let state = app.world().resource::<Tessellation>();
    let made = state.current().expect("there");
    let settings = app.world().resource::<Settings>();
    let options =
        settings.tessellation.options(state.size_mm(), made.unit_mm, state.limit()).expect("good options");
    let derived: Vec<_> =
        made.faces().iter().map(|f| app.world().get::<DerivedFace>(*f).expect("derived").0.clone()).collect();
    let faces: Vec<Option<&Face>> = derived.iter().map(|d| d.face.as_deref()).collect();
    mesh_faces(&faces, &options, &Work::QUIET).expect("a mesh")
}

#[test]
fn a_model_is_meshed_measured_and_made_again_where_it_is_edited() {
    let mut app = tessellated(TessellationView::Error);
    let state = app.world().resource::<Tessellation>();
    let made = state.current().expect("there").clone();
    let figures = &made.figures;
    let faces = app.world().resource::<Scene>().face_count();
    assert_eq!((figures.faces + figures.left_out.len(), figures.remade), (faces, faces));
    assert_eq!(figures.triangles, made.mesh.triangle_count());
    assert_eq!(figures.edges, made.edges.len());
    assert_eq!(figures.open_edges, made.edges.iter().filter(|e| e.is_open()).count());
    let largest = figures.largest.expect("measured");
    assert!(largest.mm > 0.0 && largest.mm <= figures.tolerance_mm, "{largest:?} {}", figures.tolerance_mm);

    // Only what the edit touched is made again, and the result is what all of it made anew would be.
    let face = holed(&mut app);
    let points = vec![PointId { trim_loop: 1, curve: 0, point: 0 }];
    let by = DVec2::new(1e-3, 5e-4);
    let operation = Operation::MovePoints { face, points, by, beyond: false };
    send(&mut app, [EditRequest::Perform(operation)]);
    assert!(app.world().resource::<Tessellation>().current().is_none(), "not of the model as it is");
    ready(&mut app);
    let again = app.world().resource::<Tessellation>().current().expect("there").clone();
    assert_eq!(again.figures.remade, 1);
    assert_eq!(again.mesh.faces, from_scratch(&app).faces);
    assert_ne!(again.mesh.faces[face.face], made.mesh.faces[face.face]);
    assert!(again.figures.measure_time.is_some() && again.figures.largest.is_some());

    // Undone, it is as before; views change nothing of the document.
    command(&mut app, Action::Undo);
    ready(&mut app);
    let undone = app.world().resource::<Tessellation>().current().expect("there").clone();
    assert_eq!(undone.mesh.faces, made.mesh.faces);
    let steps = app.world().resource::<Editing>().history().redo_count();
    command(&mut app, Action::Tessellation(TessellationView::Wipe));
    let editing = app.world().resource::<Editing>();
    assert_eq!((editing.history().undo_count(), editing.history().redo_count()), (0, steps));

    // Off and on again costs nothing.
    command(&mut app, Action::Tessellation(TessellationView::Off));
    assert_eq!(app.world().resource::<Tessellation>().progress(), Progress::Off);
    command(&mut app, Action::Tessellation(TessellationView::Overlay));
    assert_eq!(app.world().resource::<Tessellation>().progress(), Progress::Ready);
    command(&mut app, Action::CloseAll);
    app.update();
    assert!(app.world().resource::<Tessellation>().made().is_none(), "nothing is left of a closed model");
}

#[test]
fn work_is_called_off_limited_and_refused() {
    let mut app = tessellated(TessellationView::Overlay);
    let coarse = app.world().resource::<Tessellation>().made().expect("there").figures.triangles;
    let size = app.world().resource::<Tessellation>().size_mm();
    let choose = |app: &mut App, part: f64| {
        let before = app.world().resource::<Settings>().tessellation.clone();
        let choices = TessellationChoices { tolerance_mm: Some(part * size), ..before };
        ask(app, TessellationRequest::Choose(choices));
    };
    let stopped = |app: &App| match app.world().resource::<Tessellation>().progress() {
        Progress::Stopped(stop) => Some(stop),
        _ => None,
    };
    choose(&mut app, 2e-6);
    ask(&mut app, TessellationRequest::Cancel);
    assert_eq!(stopped(&app), Some(Stop::Cancelled));
    app.update();
    assert_eq!(stopped(&app), Some(Stop::Cancelled), "it does not start again by itself");
    // What was there is still shown, but is not what was asked for.
    let state = app.world().resource::<Tessellation>();
    assert_eq!(state.made().expect("there").figures.triangles, coarse);
    assert!(state.current().is_none());
    // Too many triangles are a question, by what is expected before the work: more than come out in the end.
    let most = 10 * coarse;
    ask(&mut app, TessellationRequest::Allow(most));
    wait(&mut app, "the limit", |state| matches!(state.progress(), Progress::Stopped(_)));
    assert_eq!(stopped(&app), Some(Stop::TooMany(most)));
    // Nonsense is refused with words, and the way back works.
    choose(&mut app, 1e-12);
    let Some(Stop::Failed(text)) = stopped(&app) else { panic!("{:?}", stopped(&app)) };
    assert!(text.contains("below what numbers can tell apart"), "{text}");
    choose(&mut app, 6e-3);
    ready(&mut app);
    assert_eq!(app.world().resource::<Tessellation>().current().expect("there").figures.triangles, coarse);
}

#[test]
fn the_divider_is_dragged_and_does_not_select() {
    let mut app = tessellated(TessellationView::Wipe);
    let (min, size) = (Vec2::splat(100.0), Vec2::new(800.0, 600.0));
    app.insert_resource(Viewport { min, size, scale_factor: 1.0 });
    let position = Some(Vec2::splat(400.0));
    app.insert_resource(Pointer { position, in_viewport: true, ..Pointer::default() });
    let move_to = |app: &mut App, x: f32| {
        let moved = CursorMoved { window: Entity::PLACEHOLDER, position: Vec2::new(x, 300.0), delta: None };
        app.world_mut().write_message(WindowEvent::CursorMoved(moved));
    };
    let press = |app: &mut App, state: ButtonState| {
        let input = MouseButtonInput { button: MouseButton::Left, state, window: Entity::PLACEHOLDER };
        app.world_mut().write_message(WindowEvent::MouseButtonInput(input));
    };
    // Beside it a click is a click.
    move_to(&mut app, 460.0);
    press(&mut app, ButtonState::Pressed);
    press(&mut app, ButtonState::Released);
    app.update();
    assert_eq!(app.world().resource::<Wipe>().share, 0.5);
    assert_eq!(app.world().resource::<Picker>().wanted, Some(UVec2::new(360, 200)));
    app.world_mut().resource_mut::<Picker>().drop_click();
    app.world_mut().resource_mut::<Picker>().wanted = None;
    // On it, all of it within one frame.
    move_to(&mut app, 503.0);
    app.update();
    assert!(app.world().resource::<Wipe>().hovered);
    press(&mut app, ButtonState::Pressed);
    move_to(&mut app, 303.0);
    app.update();
    assert_eq!(app.world().resource::<Wipe>().share, 0.25);
    assert_eq!(app.world().resource::<Settings>().tessellation.wipe, 0.5, "kept when it is let go");
    move_to(&mut app, -5000.0);
    press(&mut app, ButtonState::Released);
    app.update();
    let share = app.world().resource::<Wipe>().share;
    assert!((0.001..0.05).contains(&share), "it stays in sight: {share}");
    assert_eq!(app.world().resource::<Settings>().tessellation.wipe, share);
    assert_eq!(app.world().resource::<Picker>().wanted, None, "no face was clicked");
    // Not there in other views.
    command(&mut app, Action::Tessellation(TessellationView::Overlay));
    move_to(&mut app, 100.0 + 800.0 * share);
    app.update();
    assert!(!app.world().resource::<Wipe>().hovered);
}

#[test]
fn meshes_are_written_in_every_format() {
    let mut app = tessellated(TessellationView::Wireframe);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let notices = |app: &App| -> Vec<String> {
        let notices = app.world().resource::<hairline::editor::panels::Notices>();
        notices.list().iter().map(|n| n.text.clone()).collect()
    };
    for (_, _, ending) in MeshFormat::ALL {
        let path = folder.path().join(format!("mesh.{ending}"));
        ask(&mut app, TessellationRequest::Export(path.clone()));
        let until = Instant::now() + Duration::from_secs(30);
        while !notices(&app).iter().any(|n| n.contains(&path.display().to_string())) {
            assert!(Instant::now() < until, "{:?}", notices(&app));
            std::thread::sleep(Duration::from_millis(10));
            app.update();
        }
        assert!(std::fs::metadata(&path).expect("written").len() > 10_000, "{ending}");
    }
    assert!(folder.path().join("mesh.mtl").exists());
    ask(&mut app, TessellationRequest::Export(folder.path().join("mesh.doc")));
    assert!(notices(&app).iter().any(|n| n.contains("must end in")), "{:?}", notices(&app));
    ask(&mut app, TessellationRequest::Export(folder.path().join("no/such/mesh.stl")));
    let until = Instant::now() + Duration::from_secs(30);
    while !notices(&app).iter().any(|n| n.contains("was not written")) {
        assert!(Instant::now() < until, "{:?}", notices(&app));
        std::thread::sleep(Duration::from_millis(10));
        app.update();
    }
}

#[test]
fn a_mesh_is_made_for_an_export_when_there_is_none() {
    let mut app = tessellated(TessellationView::Overlay);
    let mut choices = app.world().resource::<Settings>().tessellation.clone();
    choices.view = TessellationView::Off;
    // Another tolerance, so that nothing made before will do.
    choices.tolerance_mm = choices.tolerance_mm.map(|t| 1.5 * t);
    ask(&mut app, TessellationRequest::Choose(choices));
    assert!(app.world().resource::<Tessellation>().current().is_none());
    let situation = &app.world().resource::<CurrentSituation>().0;
    let row = Action::ExportMesh.command().expect("it has a row");
    assert!((row.enabled)(situation), "without triangles as well");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("mesh.stl");
    command(&mut app, Action::ExportMesh);
    assert_eq!(app.world().resource::<Settings>().tessellation.view, TessellationView::Overlay);
    ask(&mut app, TessellationRequest::Export(path.clone()));
    wait(&mut app, "the file", |_| path.exists());

    // While the question of too many triangles waits for its answer so does the file, but not for another scene.
    ask(&mut app, TessellationRequest::Allow(10));
    wait(&mut app, "the question", |state| matches!(state.progress(), Progress::Stopped(Stop::TooMany(_))));
    let late = folder.path().join("late.stl");
    ask(&mut app, TessellationRequest::Export(late.clone()));
    app.world_mut().write_message(OpenFiles { sources: vec![Source::Demo], replace: true });
    app.update();
    finish_loading(&mut app);
    app.update();
    let notices = app.world().resource::<hairline::editor::panels::Notices>();
    assert!(notices.list().iter().any(|n| n.text.contains("late.stl was not written")));
    assert!(!late.exists());
}
