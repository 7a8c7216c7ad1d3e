//! The inspection in the editor's world: measured in the background, followed edit by edit, toured.

use bevy::prelude::*;
use glam::DVec2;
use hairline::editor::camera::ViewCamera;
use hairline::editor::editing::EditRequest;
use hairline::editor::inspection::{Chosen, EdgeLines, Findings, InspectRequest, Progress, Rows};
use hairline::editor::object::{Records, Scene};
use hairline::editor::selection::Selection;
use hairline::editor::tools::Action;
use hairline::inspect::Inspection;
use hairline::scene::FaceId;
use hairline::scene::operation::{Operation, PointId};

use crate::world::{command, demo_app};

/// The demo scene with the inspection on and ready.
fn inspected() -> App {
    let mut app = demo_app();
    command(&mut app, Action::ToggleInspection);
    let until = std::time::Instant::now() + std::time::Duration::from_secs(60);
    while app.world().resource::<Findings>().progress() != Progress::Ready {
        assert!(std::time::Instant::now() < until, "the inspection never came to an end");
        std::thread::sleep(std::time::Duration::from_millis(5));
        app.update();
    }
    app.update();
    app
}

/// All edges as measured from scratch.
fn from_scratch(app: &mut App) -> Inspection {
    use bevy::ecs::system::RunSystemOnce;
    fn read(records: Records, scene: Res<Scene>) -> Inspection {
        let faces = scene.models.iter().flat_map(|m| &m.order);
        let records: Vec<_> = faces.map(|f| records.face(*f).expect("a face")).collect();
        Inspection::of(&records)
    }
    app.world_mut().run_system_once(read).expect("readable")
}

fn assert_true(app: &mut App) {
    let fresh = from_scratch(app);
    let findings = app.world().resource::<Findings>();
    let kept: Vec<_> = findings.inspection().expect("there").edges().collect();
    let fresh: Vec<_> = fresh.edges().collect();
    assert_eq!(kept.len(), fresh.len());
    for (kept, fresh) in kept.into_iter().zip(fresh) {
        assert_eq!(kept, fresh);
    }
}

fn face_with_hole(app: &App) -> (FaceId, Entity) {
    let scene = app.world().resource::<Scene>();
    let order = &scene.models[0].order;
    let loops = |f: &Entity| {
        app.world().get::<hairline::editor::object::AuthoredFace>(*f).expect("a face").loops.len()
    };
    let face = order.iter().position(|f| loops(f) > 1).expect("a face with a hole");
    (FaceId { model: 0, face }, order[face])
}

#[test]
fn findings_follow_drags_undo_and_switching_off() {
    let mut app = inspected();
    assert_true(&mut app);
    assert!(!app.world().resource::<EdgeLines>().lines.is_empty());
    let before = app.world().resource::<Findings>().statistics().clone();
    let (face, _) = face_with_hole(&app);
    let points = vec![PointId { trim_loop: 1, curve: 0, point: 1 }];
    let drag = |by: f64| {
        let by = DVec2::new(by, by);
        EditRequest::Preview(Operation::MovePoints { face, points: points.clone(), by, beyond: false })
    };
    app.world_mut().write_message(EditRequest::Begin);
    for k in 1..=3 {
        app.world_mut().write_message(drag(1e-4 * f64::from(k)));
        app.update();
        assert_true(&mut app);
    }
    assert_ne!(app.world().resource::<Findings>().statistics(), &before, "an edge became longer");
    app.world_mut().write_message(EditRequest::Cancel);
    app.update();
    assert_true(&mut app);
    assert_eq!(app.world().resource::<Findings>().statistics(), &before);
    command(&mut app, Action::ToggleInspection);
    app.update();
    assert_eq!(app.world().resource::<Findings>().progress(), Progress::Off);
    assert!(app.world().resource::<EdgeLines>().lines.is_empty());
}

#[test]
fn the_tour_selects_the_faces_of_the_worst_defect_and_flies_there() {
    let mut app = inspected();
    let rows = app.world().resource::<Rows>().rows.clone();
    let worst = rows.iter().find(|r| r.is_defect(0.01)).expect("the demo scene has naked edges").key;
    let before = app.world().resource::<ViewCamera>().destination();
    command(&mut app, Action::NextDefect);
    app.update();
    assert_eq!(app.world().resource::<Chosen>().edge, Some(worst));
    assert_ne!(app.world().resource::<ViewCamera>().destination(), before);
    let faces: Vec<Entity> = app.world().resource::<Selection>().faces().to_vec();
    let findings = app.world().resource::<Findings>();
    let expected: Vec<Entity> =
        findings.edge(&worst).expect("there").faces().into_iter().filter_map(|f| findings.face(f)).collect();
    assert_eq!(faces, expected);
    command(&mut app, Action::PreviousDefect);
    let last = rows.iter().rfind(|r| r.is_defect(0.01)).expect("one at least").key;
    assert_eq!(app.world().resource::<Chosen>().edge, Some(last), "round the end");
    app.world_mut().write_message(InspectRequest::Clear);
    app.update();
    assert_eq!(app.world().resource::<Chosen>().edge, None);
}
