//! Mouse and keys of slow frames: many messages at once, taken in the order in which they came.

use bevy::input::keyboard::{Key, KeyCode, KeyboardInput};
use bevy::input::mouse::MouseButtonInput;
use bevy::input::{ButtonState, InputPlugin};
use bevy::prelude::*;
use bevy::window::{CursorMoved, FileDragAndDrop, RequestRedraw, WindowEvent};
use hairline::editor::EditorPlugin;
use hairline::editor::camera::ViewCamera;
use hairline::editor::picking::{LeftButton, Picker};
use hairline::editor::settings::Settings;
use hairline::editor::viewport::{Pointer, Viewport};

/// An app whose viewport is (100, 100) to (900, 700), with the pointer in it.
fn app() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, InputPlugin))
        .add_message::<FileDragAndDrop>()
        .add_message::<RequestRedraw>()
        .add_plugins(EditorPlugin { windowed: false });
    app.update();
    let (min, size) = (Vec2::splat(100.0), Vec2::new(800.0, 600.0));
    app.insert_resource(Viewport { min, size, scale_factor: 1.0 });
    app.insert_resource(Pointer {
        position: Some(Vec2::splat(400.0)),
        in_viewport: true,
        ..Pointer::default()
    });
    app
}

fn move_to(app: &mut App, x: f32, y: f32) {
    let moved = CursorMoved { window: Entity::PLACEHOLDER, position: Vec2::new(x, y), delta: None };
    app.world_mut().write_message(WindowEvent::CursorMoved(moved));
}

fn button(app: &mut App, button: MouseButton, state: ButtonState) {
    let input = MouseButtonInput { button, state, window: Entity::PLACEHOLDER };
    app.world_mut().write_message(WindowEvent::MouseButtonInput(input));
}

fn key(app: &mut App, key_code: KeyCode, logical_key: Key, state: ButtonState) {
    let window = Entity::PLACEHOLDER;
    let input = KeyboardInput { key_code, logical_key, state, text: None, repeat: false, window };
    app.world_mut().write_message(WindowEvent::KeyboardInput(input));
}

#[test]
fn a_drag_within_one_frame_turns_the_view() {
    for (gripping, turns) in
        [(MouseButton::Middle, true), (MouseButton::Right, true), (MouseButton::Left, false)]
    {
        let mut app = app();
        let before = app.world().resource::<ViewCamera>().now;
        move_to(&mut app, 400.0, 400.0);
        button(&mut app, gripping, ButtonState::Pressed);
        move_to(&mut app, 460.0, 420.0);
        button(&mut app, gripping, ButtonState::Released);
        move_to(&mut app, 600.0, 600.0);
        app.update();
        let after = app.world().resource::<ViewCamera>().now;
        assert_eq!(after != before, turns, "{gripping:?}");
        app.update();
        assert_eq!(app.world().resource::<ViewCamera>().now, after, "{gripping:?} was let go");
    }
}

#[test]
fn drags_that_begin_on_a_panel_are_not_for_the_view() {
    let mut app = app();
    let before = app.world().resource::<ViewCamera>().now;
    move_to(&mut app, 50.0, 400.0);
    button(&mut app, MouseButton::Middle, ButtonState::Pressed);
    move_to(&mut app, 460.0, 420.0);
    app.update();
    assert_eq!(app.world().resource::<ViewCamera>().now, before);
}

#[test]
fn shift_pans_even_if_it_is_let_go_before_the_frame_ends() {
    let mut app = app();
    let before = app.world().resource::<ViewCamera>().now;
    move_to(&mut app, 400.0, 400.0);
    key(&mut app, KeyCode::ShiftLeft, Key::Shift, ButtonState::Pressed);
    button(&mut app, MouseButton::Middle, ButtonState::Pressed);
    move_to(&mut app, 460.0, 420.0);
    button(&mut app, MouseButton::Middle, ButtonState::Released);
    key(&mut app, KeyCode::ShiftLeft, Key::Shift, ButtonState::Released);
    app.update();
    let after = app.world().resource::<ViewCamera>().now;
    let directions = |camera: hairline::kernel::view::Camera| camera.axes().2;
    assert!((directions(after) - directions(before)).length() < 1e-12 && after != before);
}

#[test]
fn a_click_is_where_the_button_went_down_with_the_keys_held_then() {
    let mut app = app();
    move_to(&mut app, 400.0, 400.0);
    key(&mut app, KeyCode::ControlLeft, Key::Control, ButtonState::Pressed);
    button(&mut app, MouseButton::Left, ButtonState::Pressed);
    button(&mut app, MouseButton::Left, ButtonState::Released);
    key(&mut app, KeyCode::ControlLeft, Key::Control, ButtonState::Released);
    move_to(&mut app, 800.0, 600.0);
    app.update();
    assert!(app.world().resource::<LeftButton>().held.ctrl);
    assert_eq!(app.world().resource::<Picker>().wanted, Some(UVec2::new(300, 300)));
}

#[test]
fn of_two_keys_in_one_frame_the_second_sees_what_the_first_did() {
    let mut app = app();
    let shown = |app: &App| app.world().resource::<Settings>().properties;
    let before = shown(&app);
    for state in [ButtonState::Pressed, ButtonState::Released, ButtonState::Pressed, ButtonState::Released] {
        key(&mut app, KeyCode::KeyN, Key::Character("n".into()), state);
    }
    app.update();
    assert_ne!(shown(&app), before, "the first one only");
    app.update();
    assert_eq!(shown(&app), before, "then the second");
    app.update();
    assert_eq!(shown(&app), before, "and no more");
}

#[test]
fn keys_after_a_click_on_a_panel_wait_until_it_is_known_who_has_the_keyboard() {
    for typing in [false, true] {
        let mut app = app();
        let shown = |app: &App| app.world().resource::<Settings>().properties;
        let before = shown(&app);
        move_to(&mut app, 50.0, 400.0);
        button(&mut app, MouseButton::Left, ButtonState::Pressed);
        button(&mut app, MouseButton::Left, ButtonState::Released);
        key(&mut app, KeyCode::KeyN, Key::Character("n".into()), ButtonState::Pressed);
        app.update();
        assert_eq!(shown(&app), before, "perhaps for a text field");
        // As panels find out in that frame.
        app.world_mut().resource_mut::<Pointer>().keyboard_taken = typing;
        (0..3).for_each(|_| app.update());
        assert_eq!(shown(&app) != before, !typing);
    }
}
