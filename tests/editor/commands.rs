//! The command table: menus, keys and help sheet are made from it.

use std::collections::HashMap;

use bevy::input::keyboard::{Key, KeyCode};
use hairline::editor::settings::{DisplayMode, Settings};
use hairline::editor::tools::{Action, COMMANDS, KeyCap, Menu, Modifiers, Shortcut, Situation};
use hairline::kernel::view::StandardView;

#[test]
fn no_key_and_no_name_is_given_twice() {
    let mut keys: HashMap<Shortcut, &str> = HashMap::new();
    let mut ids = HashMap::new();
    for command in COMMANDS.iter() {
        assert!(ids.insert(command.id, command.label).is_none(), "{} twice", command.id);
        for key in command.keys {
            if let Some(other) = keys.insert(*key, command.id) {
                panic!("{key} is for {} and {other}", command.id);
            }
        }
    }
}

#[test]
fn every_menu_has_commands_and_menus_come_in_order() {
    for menu in Menu::ALL {
        assert!(COMMANDS.iter().any(|c| c.menu == menu), "{menu:?} is empty");
    }
    let order: Vec<usize> = COMMANDS
        .iter()
        .map(|c| Menu::ALL.iter().position(|m| *m == c.menu).expect("every menu is listed"))
        .collect();
    assert!(order.is_sorted());
}

#[test]
fn all_views_and_modes_can_be_reached() {
    use StandardView::*;
    for view in [Iso, Front, Back, Left, Right, Top, Bottom] {
        assert!(Action::View(view).command().is_some_and(|c| !c.keys.is_empty()), "{view:?}");
    }
    for mode in DisplayMode::ALL {
        let command = Action::Display(mode).command().expect("in the table");
        let settings = Settings { mode, ..Settings::default() };
        assert_eq!(command.checked.map(|checked| checked(&settings)), Some(true));
    }
}

#[test]
fn commands_that_need_something_are_off_without_it() {
    let nothing = Situation::default();
    for action in [Action::CloseAll, Action::SelectAll, Action::Hide, Action::ShowAll, Action::Cancel] {
        let command = action.command().expect("in the table");
        assert!(!(command.enabled)(&nothing), "{}", command.id);
    }
    assert!(COMMANDS.iter().all(|c| (c.enabled)(&Situation::ALL)));
}

#[test]
fn letters_follow_the_layout_and_signs_do_not_mind_shift() {
    let none = Modifiers::default();
    let shift = Modifiers { shift: true, ..none };
    let ctrl = Modifiers { ctrl: true, ..none };
    let logical = |text: &str| Key::Character(text.into());
    let fit = Shortcut::char('f');
    // On a Dvorak keyboard F sits where U is printed on others.
    assert!(fit.matches(&logical("f"), KeyCode::KeyY, none));
    assert!(!fit.matches(&logical("F"), KeyCode::KeyF, shift));
    assert!(fit.shift().matches(&logical("F"), KeyCode::KeyF, shift));
    assert!(!fit.matches(&logical("f"), KeyCode::KeyF, ctrl));
    let help = Shortcut::char('?');
    assert!(help.matches(&logical("?"), KeyCode::Slash, shift));
    let iso = Shortcut::code(KeyCode::Numpad0);
    assert!(iso.matches(&Key::Insert, KeyCode::Numpad0, none));
    assert!(matches!(iso.cap, KeyCap::Code(_)));
}

#[test]
fn keys_are_written_as_on_the_keyboard() {
    assert_eq!(Shortcut::char('a').ctrl().shift().to_string(), "Ctrl+Shift+A");
    assert_eq!(Shortcut::code(KeyCode::Numpad5).to_string(), "Num 5");
    assert_eq!(Shortcut::code(KeyCode::Digit1).to_string(), "1");
    assert_eq!(Shortcut::code(KeyCode::Escape).to_string(), "Esc");
    assert_eq!(Shortcut::char('?').to_string(), "?");
}
