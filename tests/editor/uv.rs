//! Mouse and keys over the uv panel and on the handles in 3D, as messages: what they do to the document.

use std::sync::Arc;

use bevy::input::ButtonState;
use bevy::input::keyboard::{Key, KeyCode, KeyboardInput};
use bevy::input::mouse::{MouseButtonInput, MouseScrollUnit, MouseWheel};
use bevy::prelude::*;
use bevy::window::{CursorMoved, WindowEvent};
use glam::DVec2;
use hairline::editor::camera::ViewCamera;
use hairline::editor::editing::Editing;
use hairline::editor::elements::{ActiveFace, Element, ElementRequest, ElementSelection, FaceInHand};
use hairline::editor::handles::HandleShapes;
use hairline::editor::handles::aim::Lens;
use hairline::editor::object::Scene;
use hairline::editor::selection::{SelectMode, SelectRequest, Selection};
use hairline::editor::settings::{Handles, Settings};
use hairline::editor::tools::Action;
use hairline::editor::uv::{Tool, UvPanel};
use hairline::editor::viewport::{Pointer, Viewport};

use crate::world::{command, demo_app};

/// The demo scene with a face with holes active, and its panel at (300, 500) to (900, 850).
fn panel_app() -> App {
    let mut app = demo_app();
    let face = holed_face(&app);
    app.world_mut().write_message(SelectRequest { faces: vec![face], mode: SelectMode::Replace });
    app.world_mut().resource_mut::<UvPanel>().place(DVec2::new(300.0, 500.0), DVec2::new(600.0, 350.0));
    app.insert_resource(Pointer { in_uv: true, ..Pointer::default() });
    app.update();
    app.update();
    app
}

fn holed_face(app: &App) -> Entity {
    app.world().resource::<Scene>().faces().next().expect("the plate with its holes")
}

fn in_hand(app: &App) -> FaceInHand {
    app.world().resource::<ActiveFace>().face.clone().expect("an active face")
}

/// The face's loops and surface, to be compared bit for bit.
fn state(app: &App) -> (Vec<hairline::scene::records::LoopRecord>, hairline::kernel::nurbs::NurbsSurface) {
    let face = in_hand(app);
    (face.loops.iter().map(|l| (**l).clone()).collect(), (*face.surface).clone())
}

fn steps(app: &App) -> usize {
    app.world().resource::<Editing>().history().undo_count()
}

fn send(app: &mut App, event: WindowEvent) {
    app.world_mut().write_message(event);
}

fn move_to(app: &mut App, p: DVec2) {
    let moved = CursorMoved { window: Entity::PLACEHOLDER, position: p.as_vec2(), delta: None };
    send(app, WindowEvent::CursorMoved(moved));
}

fn button(app: &mut App, button: MouseButton, state: ButtonState) {
    let window = Entity::PLACEHOLDER;
    send(app, WindowEvent::MouseButtonInput(MouseButtonInput { button, state, window }));
}

fn left(app: &mut App, state: ButtonState) {
    button(app, MouseButton::Left, state);
}

fn key(app: &mut App, key_code: KeyCode, logical_key: Key, state: ButtonState) {
    let window = Entity::PLACEHOLDER;
    let input = KeyboardInput { key_code, logical_key, state, text: None, repeat: false, window };
    send(app, WindowEvent::KeyboardInput(input));
}

fn press_key(app: &mut App, code: KeyCode, logical: Key) {
    key(app, code, logical, ButtonState::Pressed);
    app.update();
}

/// Presses at `from`, moves to `to` in steps and lets go, a frame each; looks at what is shown before the end.
fn drag(app: &mut App, from: DVec2, to: DVec2, mut before_release: impl FnMut(&App)) {
    move_to(app, from);
    left(app, ButtonState::Pressed);
    app.update();
    for k in 1..=4 {
        move_to(app, from.lerp(to, f64::from(k) / 4.0));
        app.update();
    }
    before_release(app);
    left(app, ButtonState::Released);
    app.update();
    app.update();
}

fn on_panel(app: &App, uv: DVec2) -> DVec2 {
    app.world().resource::<UvPanel>().view.to_screen(uv)
}

/// An inner control point of a hole that no other one is close to on the screen.
fn lonely_point(app: &App) -> (Element, DVec2) {
    let (face, view) = (in_hand(app), app.world().resource::<UvPanel>().view);
    let all: Vec<DVec2> =
        face.loops.iter().flat_map(|l| &l.curves).flat_map(|c| c.points()).copied().collect();
    for (l, record) in face.loops.iter().enumerate().skip(1) {
        for (c, curve) in record.curves.iter().enumerate() {
            for (p, uv) in
                curve.points().iter().enumerate().skip(1).take(curve.points().len().saturating_sub(2))
            {
                if all.iter().filter(|o| view.distance_px(**o, *uv) < 12.0).count() == 1 {
                    return (Element::Point { trim_loop: l, curve: c, point: p }, *uv);
                }
            }
        }
    }
    panic!("every control point has neighbours");
}

/// Comes close to the first hole, so that its points are apart.
fn zoom_to_hole(app: &mut App) {
    let face = in_hand(app);
    let mut rect = hairline::kernel::trim::UvRect::EMPTY;
    face.loops[1].curves.iter().flat_map(|c| c.points()).for_each(|p| rect.include(*p));
    app.world_mut().resource_mut::<UvPanel>().view.look_at(&rect);
    app.update();
}

fn place_of(app: &App, element: Element) -> DVec2 {
    let Element::Point { trim_loop, curve, point } = element else { panic!("a point") };
    in_hand(app).point((trim_loop, curve, point)).expect("it is there")
}

#[test]
fn a_drag_follows_the_mouse_is_one_step_and_can_be_undone() {
    let mut app = panel_app();
    zoom_to_hole(&mut app);
    app.world_mut().resource_mut::<UvPanel>().snapping.on = false;
    let before = state(&app);
    let (element, uv) = lonely_point(&app);
    let from = on_panel(&app, uv);
    let to = from + DVec2::new(37.0, -21.0);
    drag(&mut app, from, to, |app| {
        assert!((on_panel(app, place_of(app, element)) - to).length() < 1.5, "shown while dragging");
        let derived = in_hand(app).derived.expect("derived in the same frame");
        assert!(derived.face.is_some());
    });
    assert_eq!(steps(&app), 1);
    assert_ne!(state(&app), before);
    assert!(app.world().resource::<ElementSelection>().contains(element));
    command(&mut app, Action::Undo);
    assert_eq!(state(&app), before, "bit for bit");
    command(&mut app, Action::Redo);
    assert_ne!(state(&app), before);
}

#[test]
fn escape_takes_a_drag_back_and_nothing_moved_is_no_step() {
    let mut app = panel_app();
    zoom_to_hole(&mut app);
    let before = state(&app);
    let (_, uv) = lonely_point(&app);
    let from = on_panel(&app, uv);
    move_to(&mut app, from);
    left(&mut app, ButtonState::Pressed);
    move_to(&mut app, from + 40.0);
    app.update();
    assert_ne!(state(&app), before);
    press_key(&mut app, KeyCode::Escape, Key::Escape);
    assert_eq!(state(&app), before);
    // The button is still down: the rest of the way does nothing.
    move_to(&mut app, from + 80.0);
    app.update();
    left(&mut app, ButtonState::Released);
    app.update();
    assert_eq!((state(&app), steps(&app)), (before.clone(), 0));
    // There and back again is no step either.
    move_to(&mut app, from);
    left(&mut app, ButtonState::Pressed);
    move_to(&mut app, from + 40.0);
    app.update();
    move_to(&mut app, from);
    left(&mut app, ButtonState::Released);
    app.update();
    assert_eq!((state(&app), steps(&app)), (before, 0));
}

#[test]
fn undo_and_a_lost_face_end_a_drag() {
    let mut app = panel_app();
    zoom_to_hole(&mut app);
    let before = state(&app);
    let (_, uv) = lonely_point(&app);
    let from = on_panel(&app, uv);
    move_to(&mut app, from);
    left(&mut app, ButtonState::Pressed);
    move_to(&mut app, from + 30.0);
    app.update();
    command(&mut app, Action::Undo);
    assert_eq!(state(&app), before);
    move_to(&mut app, from + 60.0);
    app.update();
    assert_eq!(state(&app), before, "the mouse goes on with nothing");
    left(&mut app, ButtonState::Released);
    // Another face becomes active while something is dragged.
    move_to(&mut app, from);
    left(&mut app, ButtonState::Pressed);
    move_to(&mut app, from + 30.0);
    app.update();
    app.world_mut().write_message(SelectRequest { faces: Vec::new(), mode: SelectMode::Replace });
    app.update();
    app.update();
    move_to(&mut app, from + 50.0);
    left(&mut app, ButtonState::Released);
    app.update();
    assert!(!app.world().resource::<Editing>().is_dragging());
    let face = holed_face(&app);
    app.world_mut().write_message(SelectRequest { faces: vec![face], mode: SelectMode::Replace });
    app.update();
    assert_eq!((state(&app), steps(&app)), (before, 0));
}

#[test]
fn clicks_and_boxes_select() {
    let mut app = panel_app();
    zoom_to_hole(&mut app);
    let (element, uv) = lonely_point(&app);
    let at = on_panel(&app, uv);
    drag(&mut app, at, at, |_| {});
    let selected = |app: &App| app.world().resource::<ElementSelection>().elements().collect::<Vec<_>>();
    assert_eq!(selected(&app), [element]);
    assert_eq!(steps(&app), 0, "a click moves nothing");
    // A box around everything on the canvas takes that point and others.
    drag(&mut app, DVec2::new(303.0, 503.0), DVec2::new(897.0, 847.0), |_| {});
    let all = selected(&app);
    assert!(all.len() > 3 && all.contains(&element), "{}", all.len());
    // With Ctrl a click takes it out again.
    key(&mut app, KeyCode::ControlLeft, Key::Control, ButtonState::Pressed);
    drag(&mut app, at, at, |_| {});
    key(&mut app, KeyCode::ControlLeft, Key::Control, ButtonState::Released);
    assert_eq!(selected(&app).len(), all.len() - 1);
    // Escape clears.
    press_key(&mut app, KeyCode::Escape, Key::Escape);
    assert!(selected(&app).is_empty());
}

#[test]
fn dragged_ends_snap_and_joined_ends_stay_joined() {
    let mut app = panel_app();
    let face = in_hand(&app);
    // Two loops with ends to bring together.
    let ends = |l: usize| face.loops[l].curves[0].points()[0];
    let (a, b) = (ends(1), ends(2));
    let mut rect = hairline::kernel::trim::UvRect::EMPTY;
    [a, b].iter().for_each(|p| rect.include(*p));
    let room = 0.3 * rect.size().max_element();
    rect = hairline::kernel::trim::UvRect { min: rect.min - room, max: rect.max + room };
    app.world_mut().resource_mut::<UvPanel>().view.look_at(&rect);
    app.update();
    let (from, to) = (on_panel(&app, a), on_panel(&app, b));
    drag(&mut app, from, to + DVec2::new(0.5, 0.3), |app| {
        let snapped = app.world().resource::<UvPanel>().snapped.expect("something is near");
        assert_eq!(snapped.uv, b);
    });
    let face = in_hand(&app);
    let moved: Vec<&[DVec2]> = face.loops[1].curves.iter().map(|c| c.points()).collect();
    // Where points are crowded the curve is gripped beside its end, by less than a pixel.
    let view = app.world().resource::<UvPanel>().view;
    let there = |p: DVec2| view.distance_px(p, b) < 0.5;
    assert!(moved.iter().any(|p| there(p[0]) || there(p[p.len() - 1])), "an end went there");
    for (k, points) in moved.iter().enumerate() {
        let next = moved[(k + 1) % moved.len()];
        assert!((points[points.len() - 1] - next[0]).length() < 1e-9, "joint {k} opened");
    }
}

#[test]
fn shapes_are_drawn_and_keys_nudge() {
    let mut app = panel_app();
    let loops = in_hand(&app).loops.len();
    app.world_mut().resource_mut::<UvPanel>().tool = Tool::Rectangle;
    app.world_mut().resource_mut::<UvPanel>().snapping.on = false;
    drag(&mut app, DVec2::new(560.0, 640.0), DVec2::new(590.0, 660.0), |_| {});
    let face = in_hand(&app);
    assert_eq!(face.loops.len(), loops + 1);
    assert_eq!(app.world().resource::<UvPanel>().tool, Tool::Select);
    let corner = face.loops[loops].curves[0].points()[0];
    let at = on_panel(&app, corner);
    assert!((at.x - 560.0).abs() < 1e-3 || (at.x - 590.0).abs() < 1e-3, "{at}");
    // A polyline by clicks, closed with Enter.
    app.world_mut().resource_mut::<UvPanel>().tool = Tool::Polyline;
    for p in [(610.0, 640.0), (640.0, 640.0), (625.0, 660.0)] {
        let p = DVec2::new(p.0, p.1);
        drag(&mut app, p, p, |_| {});
        // Not a double click.
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    press_key(&mut app, KeyCode::Enter, Key::Enter);
    assert_eq!(in_hand(&app).loops.len(), loops + 2);
    // Select the new loop's first curve and push it to the right.
    let before = in_hand(&app).loops[loops + 1].clone();
    let middle = before.curves[0].point(0.5);
    let at = on_panel(&app, middle);
    drag(&mut app, at, at, |_| {});
    press_key(&mut app, KeyCode::ArrowRight, Key::ArrowRight);
    let after = in_hand(&app).loops[loops + 1].clone();
    assert!(after.curves[0].point(0.5).x > middle.x && !Arc::ptr_eq(&before, &after));
}

#[test]
fn the_wheel_zooms_at_the_pointer_and_the_middle_button_pans() {
    let mut app = panel_app();
    let at = DVec2::new(480.0, 600.0);
    let uv = app.world().resource::<UvPanel>().view.to_uv(at);
    let scale = app.world().resource::<UvPanel>().view.scale;
    move_to(&mut app, at);
    let (unit, phase) = (MouseScrollUnit::Line, bevy::input::touch::TouchPhase::Moved);
    send(
        &mut app,
        WindowEvent::MouseWheel(MouseWheel { unit, x: 0.0, y: 3.0, window: Entity::PLACEHOLDER, phase }),
    );
    app.update();
    let view = app.world().resource::<UvPanel>().view;
    assert!(view.scale.x > 1.5 * scale.x);
    assert!((view.to_screen(uv) - at).length() < 1e-6);
    button(&mut app, MouseButton::Middle, ButtonState::Pressed);
    move_to(&mut app, at + DVec2::new(50.0, 10.0));
    button(&mut app, MouseButton::Middle, ButtonState::Released);
    app.update();
    let view = app.world().resource::<UvPanel>().view;
    assert!((view.to_screen(uv) - at - DVec2::new(50.0, 10.0)).length() < 1e-6);
    assert_eq!(steps(&app), 0);
}

#[test]
fn handles_in_space_follow_the_pointer_on_the_surface() {
    for perspective in [true, false] {
        let mut app = panel_app();
        let viewport =
            Viewport { min: Vec2::new(300.0, 80.0), size: Vec2::new(600.0, 400.0), scale_factor: 1.0 };
        app.insert_resource(viewport);
        app.insert_resource(Pointer { in_viewport: true, ..Pointer::default() });
        app.world_mut().resource_mut::<Settings>().handles = Handles::Curves;
        if !perspective {
            command(&mut app, Action::ToggleProjection);
        }
        let faces_before = app.world().resource::<Selection>().faces().to_vec();
        // So many control points are there that only those of selected loops are shown.
        let elements = vec![Element::Loop { trim_loop: 1 }];
        app.world_mut().write_message(ElementRequest { elements, mode: SelectMode::Replace });
        for _ in 0..3 {
            app.update();
        }
        let before = state(&app);
        let camera = app.world().resource::<ViewCamera>().destination();
        app.world_mut().resource_mut::<ViewCamera>().now = camera;
        app.world_mut().resource_mut::<ViewCamera>().flight = None;
        app.update();
        let lens = Lens::new(&camera, &viewport);
        let shapes = app.world().resource::<HandleShapes>();
        let map = shapes.map.clone().expect("handles are shown");
        // The control point farthest from all others on the screen.
        let all: Vec<(Element, Vec2)> = shapes
            .curves
            .iter()
            .filter(|c| c.address.0 == 1)
            .flat_map(|c| c.points.iter().enumerate().map(move |(p, at)| (c.address, p, *at)))
            .filter_map(|((l, c), point, at)| {
                let element = Element::Point { trim_loop: l, curve: c, point };
                Some((element, lens.project(at)?.0))
            })
            .collect();
        let apart = |(_, p): &(Element, Vec2)| {
            let others = all.iter().map(|o| o.1.distance(*p)).filter(|d| *d > 0.0);
            others.fold(f32::INFINITY, f32::min)
        };
        let (element, at) = *all.iter().max_by(|a, b| apart(a).total_cmp(&apart(b))).expect("points");
        let to = at.as_dvec2() + DVec2::new(-14.0, 9.0);
        key(&mut app, KeyCode::ControlLeft, Key::Control, ButtonState::Pressed);
        key(&mut app, KeyCode::ControlLeft, Key::Control, ButtonState::Released);
        drag(&mut app, at.as_dvec2(), to, |_| {});
        assert_ne!(state(&app), before);
        assert_eq!(steps(&app), 1);
        let now = lens.project(map.point(place_of(&app, element))).expect("in view").0;
        assert!((now.as_dvec2() - to).length() < 12.0, "{now} instead of {to}");
        assert_eq!(app.world().resource::<Selection>().faces(), faces_before, "the press was the handle's");
        command(&mut app, Action::Undo);
        assert_eq!(state(&app), before);
    }
}

#[test]
fn surface_points_move_in_the_plane_of_the_view() {
    let mut app = panel_app();
    let viewport = Viewport { min: Vec2::new(300.0, 80.0), size: Vec2::new(600.0, 400.0), scale_factor: 1.0 };
    app.insert_resource(viewport);
    app.insert_resource(Pointer { in_viewport: true, ..Pointer::default() });
    app.world_mut().resource_mut::<Settings>().handles = Handles::Surface;
    app.update();
    let camera = app.world().resource::<ViewCamera>().destination();
    app.world_mut().resource_mut::<ViewCamera>().now = camera;
    app.world_mut().resource_mut::<ViewCamera>().flight = None;
    app.update();
    app.update();
    let before = state(&app);
    let lens = Lens::new(&camera, &viewport);
    let point = before.1.points()[0];
    let at = lens.project(point).expect("in view").0.as_dvec2();
    let to = at + DVec2::new(25.0, -30.0);
    drag(&mut app, at, to, |_| {});
    let moved = in_hand(&app).surface.points().to_vec();
    let changed: Vec<usize> = (0..moved.len()).filter(|k| moved[*k] != before.1.points()[*k]).collect();
    assert!(!changed.is_empty() && changed.len() <= 2, "{changed:?}");
    let now = lens.project(moved[changed[0]]).expect("in view").0.as_dvec2();
    assert!((now - to).length() < 1.0, "{now} instead of {to}");
    command(&mut app, Action::Undo);
    assert_eq!(state(&app), before);
}
