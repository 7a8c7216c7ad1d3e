//! Edits on components: drags, undo, and the document they leave behind.

use bevy::ecs::system::RunSystemOnce;
use bevy::prelude::*;
use glam::DVec2;
use hairline::editor::derive::Derived;
use hairline::editor::editing::{EditRequest, Editing, apply_edit};
use hairline::editor::object::{AuthoredFace, DerivedFace, Records, Scene, TrimLoop};
use hairline::editor::panels::Notices;
use hairline::exchange::report::Severity;
use hairline::kernel::trim::UvRect;
use hairline::scene::operation::{CurveId, Operation, PointId, Shape};
use hairline::scene::records::ModelRecord;
use hairline::scene::{Change, Edit, FaceId};

use crate::world::{command, demo_app};
use hairline::editor::tools::Action;

pub fn send(app: &mut App, requests: impl IntoIterator<Item = EditRequest>) {
    for request in requests {
        app.world_mut().write_message(request);
    }
    app.update();
}

/// The records of everything open.
pub fn records(app: &mut App) -> Vec<ModelRecord> {
    fn read(records: Records, scene: Res<Scene>) -> Vec<ModelRecord> {
        scene.models.iter().map(|m| records.model(m).expect("a model")).collect()
    }
    app.world_mut().run_system_once(read).expect("readable")
}

fn steps(app: &App) -> usize {
    app.world().resource::<Editing>().history().undo_count()
}

/// The smallest face with a hole, by its address.
pub fn holed(app: &mut App) -> FaceId {
    let models = records(app);
    let holed = models[0].faces.iter().enumerate().filter(|(_, f)| f.loops.len() > 1);
    let (face, _) = holed.min_by_key(|(_, f)| f.loops.len()).expect("a face with a hole");
    FaceId { model: 0, face }
}

fn move_hole(face: FaceId, by: f64) -> Operation {
    let points = vec![PointId { trim_loop: 1, curve: 0, point: 0 }];
    Operation::MovePoints { face, points, by: DVec2::new(by, 0.5 * by), beyond: false }
}

fn derived(app: &App, id: FaceId) -> std::sync::Arc<Derived> {
    let entity = app.world().resource::<Scene>().face(id.model, id.face).expect("a face");
    app.world().get::<DerivedFace>(entity).expect("derived").0.clone()
}

/// What is derived is what the records derive to.
fn assert_derived(app: &mut App) {
    let models = records(app);
    for (model, record) in models.iter().enumerate() {
        for (face, record) in record.faces.iter().enumerate() {
            let kept = derived(app, FaceId { model, face });
            let fresh = Derived::of(record);
            assert_eq!(kept.failure, fresh.failure, "face {}", face + 1);
            assert!(kept.face.as_deref() == fresh.face.as_deref(), "face {} is stale", face + 1);
        }
    }
}

#[test]
fn a_drag_is_one_step_and_undo_is_exact() {
    let mut app = demo_app();
    let face = holed(&mut app);
    let before = records(&mut app);
    send(&mut app, [EditRequest::Begin]);
    for k in 1..=10 {
        send(&mut app, [EditRequest::Preview(move_hole(face, 1e-3 * f64::from(k)))]);
        assert_ne!(records(&mut app), before, "the drag is seen at once");
    }
    send(&mut app, [EditRequest::Commit]);
    assert_eq!(steps(&app), 1);
    assert!(app.world().resource::<Editing>().is_unsaved());
    let after = records(&mut app);
    assert_derived(&mut app);
    command(&mut app, Action::Undo);
    assert!(records(&mut app) == before);
    assert!(!app.world().resource::<Editing>().is_unsaved());
    command(&mut app, Action::Redo);
    assert!(records(&mut app) == after);
    // Relative to the beginning: the same as doing it once.
    send(&mut app, [EditRequest::Undo, EditRequest::Perform(move_hole(face, 1e-2))]);
    assert!(records(&mut app) == after);
}

#[test]
fn escape_and_undo_take_a_drag_back() {
    let mut app = demo_app();
    let face = holed(&mut app);
    let before = records(&mut app);
    for end in [EditRequest::Cancel, EditRequest::Undo, EditRequest::Begin] {
        send(&mut app, [EditRequest::Begin, EditRequest::Preview(move_hole(face, 1e-3)), end]);
        assert!(records(&mut app) == before);
        // What is still on its way from the mouse comes to nothing.
        send(
            &mut app,
            [EditRequest::Cancel, EditRequest::Preview(move_hole(face, 1e-3)), EditRequest::Commit],
        );
        assert!(records(&mut app) == before);
        assert_eq!(steps(&app), 0);
    }
    assert_derived(&mut app);
}

#[test]
fn deleting_what_is_being_dragged_is_safe() {
    let mut app = demo_app();
    let face = holed(&mut app);
    let before = records(&mut app);
    let delete = Operation::DeleteLoops { face, loops: vec![1] };
    send(&mut app, [EditRequest::Begin, EditRequest::Preview(move_hole(face, 1e-3))]);
    send(
        &mut app,
        [EditRequest::Perform(delete), EditRequest::Preview(move_hole(face, 2e-3)), EditRequest::Commit],
    );
    assert_eq!(records(&mut app)[0].faces[face.face].loops.len() + 1, before[0].faces[face.face].loops.len());
    assert_eq!(steps(&app), 1);
    assert_derived(&mut app);
    send(&mut app, [EditRequest::Undo]);
    assert!(records(&mut app) == before);
    assert_derived(&mut app);
}

#[test]
fn only_the_edited_face_is_derived_again() {
    let mut app = demo_app();
    let face = holed(&mut app);
    let all = |app: &App| -> Vec<_> {
        let count = app.world().resource::<Scene>().face_count();
        (0..count).map(|face| derived(app, FaceId { model: 0, face })).collect()
    };
    let before = all(&app);
    send(&mut app, [EditRequest::Perform(move_hole(face, 1e-3))]);
    for (index, (a, b)) in before.iter().zip(all(&app)).enumerate() {
        assert_eq!(std::sync::Arc::ptr_eq(a, &b), index != face.face, "face {}", index + 1);
    }
}

#[test]
fn refused_operations_change_nothing_and_say_why() {
    let mut app = demo_app();
    let face = holed(&mut app);
    let before = records(&mut app);
    let points = vec![PointId { trim_loop: 1, curve: 0, point: 0 }];
    let bad = [
        Operation::SetWeight { face, points: points.clone(), weight: 0.0 },
        Operation::SetWeight { face, points, weight: f64::NAN },
        Operation::DeleteLoops { face, loops: vec![99_999] },
        Operation::DeleteLoops { face: FaceId { model: 7, face: 0 }, loops: vec![0] },
        move_hole(face, f64::INFINITY),
    ];
    for operation in bad {
        send(&mut app, [EditRequest::Perform(operation.clone())]);
        assert!(records(&mut app) == before, "{operation:?}");
        let notices = app.world().resource::<Notices>();
        assert!(
            notices.list().last().is_some_and(|n| n.severity == Severity::Error),
            "{operation:?} {notices:?}"
        );
        // In a drag the last preview that was possible stays.
        send(&mut app, [EditRequest::Begin, EditRequest::Preview(move_hole(face, 1e-3))]);
        let shown = records(&mut app);
        send(&mut app, [EditRequest::Preview(operation)]);
        assert!(records(&mut app) == shown);
        assert!(app.world().resource::<Editing>().refused().is_some());
        send(&mut app, [EditRequest::Cancel]);
        assert!(records(&mut app) == before);
    }
    assert_eq!(steps(&app), 0);
}

#[test]
fn loops_are_entities_and_their_changes_are_seen() {
    let mut app = demo_app();
    let id = holed(&mut app);
    let entity = app.world().resource::<Scene>().face(id.model, id.face).expect("a face");
    let loops = app.world().get::<AuthoredFace>(entity).expect("a face").loops.clone();
    let hole = app.world().get::<TrimLoop>(loops[1]).expect("a loop").clone();
    // Changed by hand, without the history: found all the same.
    let mut record = (*hole.record).clone();
    record.curves.iter_mut().for_each(|c| *c = c.map_points(|p| p + DVec2::splat(1e-3)));
    let moved = TrimLoop { face: entity, record: std::sync::Arc::new(record) };
    app.world_mut().entity_mut(loops[1]).insert(moved);
    app.update();
    assert_derived(&mut app);
    app.world_mut().despawn(loops[1]);
    app.update();
    assert_derived(&mut app);
    assert_eq!(derived(&app, id).loops, loops.len() - 1);
}

#[test]
fn random_edits_undos_and_redos_leave_what_the_records_say() {
    // A few small faces: a thousand edits in no time.
    let mut model = hairline::scene::demo::model();
    model.faces.retain(|f| f.loops.len() < 8);
    model.faces.truncate(6);
    let scene = Edit::new("Add", vec![Change::Models { at: 0, before: Vec::new(), after: vec![model] }]);
    let mut app = crate::world::app();
    app.update();
    apply_edit(app.world_mut(), &scene).expect("possible");
    app.update();
    let faces = records(&mut app)[0].faces.len();
    let mut seed = 7u64;
    let mut random = move |below: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((seed >> 33) as usize) % below
    };
    let start = records(&mut app);
    let mut states = vec![start.clone()];
    for _ in 0..1000 {
        let face = FaceId { model: 0, face: random(faces) };
        let record = &states.last().expect("a state")[0].faces[face.face];
        let domain = UvRect::of_surface(&record.surface);
        let (min, size) = (domain.min, domain.size());
        let operation = match random(4) {
            0 if !record.loops.is_empty() => {
                let trim_loop = random(record.loops.len());
                let curve = random(record.loops[trim_loop].curves.len());
                let curves = vec![CurveId { trim_loop, curve }];
                Operation::MoveCurves { face, curves, by: 1e-3 * size, beyond: false }
            }
            1 => {
                let centre = min + size * DVec2::new(0.3 + 0.01 * random(40) as f64, 0.5);
                let shape = Shape::Circle { centre, radius: 1e-2 * size.min_element() };
                Operation::AddLoop { face, shape, role: Default::default() }
            }
            2 if record.loops.len() > 2 => {
                Operation::DeleteLoops { face, loops: vec![random(record.loops.len())] }
            }
            _ => Operation::ReverseLoops { face, loops: vec![0] },
        };
        send(&mut app, [EditRequest::Perform(operation)]);
        let now = records(&mut app);
        if steps(&app) == states.len() {
            states.push(now);
        }
        if random(5) == 0 && steps(&app) > 0 {
            send(&mut app, [EditRequest::Undo]);
            states.pop();
        }
        assert!(records(&mut app) == *states.last().expect("a state"));
    }
    assert!(states.len() > 100, "{}", states.len());
    assert_derived(&mut app);
    send(&mut app, [EditRequest::GoTo(0)]);
    assert!(records(&mut app) == start);
    let last = states.len() - 1;
    send(&mut app, [EditRequest::GoTo(last)]);
    assert!(records(&mut app) == states[last]);
    assert_derived(&mut app);
    let loops = app.world_mut().query::<&TrimLoop>().iter(app.world()).count();
    assert_eq!(
        loops,
        states[last][0].faces.iter().map(|f| f.loops.len()).sum::<usize>(),
        "entities are left"
    );
}
