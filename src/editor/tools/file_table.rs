//! The rows of the command table about files, steps and the selection.

use bevy::input::keyboard::KeyCode;

use super::command::Menu::{Edit, File};
use super::command::{Action, Command, command};
use super::key::Shortcut;
use super::situation::Situation;

const fn with_model(s: &Situation) -> bool {
    s.model
}
const fn with_selection(s: &Situation) -> bool {
    s.selection
}
const fn with_hidden(s: &Situation) -> bool {
    s.hidden
}
const fn with_undo(s: &Situation) -> bool {
    s.undo
}
const fn with_redo(s: &Situation) -> bool {
    s.redo
}
const fn while_loading(s: &Situation) -> bool {
    s.loading
}

const fn key(c: char) -> Shortcut {
    Shortcut::char(c)
}
const fn code(code: KeyCode) -> Shortcut {
    Shortcut::code(code)
}

/// The rows, in menu order.
pub(super) const ROWS: &[Command] = &[
    command(File, Action::New, "file.new", "New", &[key('n').ctrl()]),
    command(File, Action::Open, "file.open", "Open…", &[key('o').ctrl()]),
    command(File, Action::Import, "file.import", "Import into scene…", &[key('i').ctrl()]),
    command(File, Action::Save, "file.save", "Save", &[key('s').ctrl()]).separated().when(with_model),
    command(File, Action::SaveAs, "file.save_as", "Save as…", &[key('s').ctrl().shift()]).when(with_model),
    command(File, Action::Export, "file.export", "Export IGES…", &[key('e').ctrl()]).when(with_model),
    command(File, Action::OpenDemo, "file.demo", "Open demo scene", &[key('d').ctrl()]),
    command(File, Action::Autosave(20), "file.autosave", "Keep a copy after 20 s", &[])
        .separated()
        .checked(|s| s.autosave_s > 0 && s.autosave_s <= 20),
    command(File, Action::Autosave(120), "file.autosave_slow", "Keep a copy after 2 min", &[])
        .checked(|s| s.autosave_s > 20),
    command(File, Action::Autosave(0), "file.autosave_off", "Keep no copy of unsaved work", &[])
        .checked(|s| s.autosave_s == 0),
    command(File, Action::Cancel, "file.cancel", "Cancel loading", &[code(KeyCode::Backspace)])
        .separated()
        .when(while_loading),
    command(File, Action::CloseAll, "file.close", "Close all", &[key('w').ctrl()]).when(with_model),
    command(File, Action::Quit, "file.quit", "Quit", &[key('q').ctrl()]).separated(),
    command(Edit, Action::Undo, "edit.undo", "Undo", &[key('z').ctrl()]).when(with_undo),
    command(Edit, Action::Redo, "edit.redo", "Redo", &[key('z').ctrl().shift(), key('y').ctrl()])
        .when(with_redo),
    command(Edit, Action::Palette, "edit.palette", "Command palette…", &[key('p').ctrl()]),
    command(Edit, Action::SelectAll, "edit.select_all", "Select all", &[key('a').ctrl()])
        .separated()
        .when(with_model),
    command(Edit, Action::InvertSelection, "edit.invert", "Invert selection", &[key('a').ctrl().shift()])
        .when(with_model),
    command(Edit, Action::ClearSelection, "edit.clear", "Clear selection", &[code(KeyCode::Escape)])
        .when(with_selection),
    command(Edit, Action::Find, "edit.find", "Find face…", &[key('f').ctrl()]).when(with_model),
    command(Edit, Action::Hide, "edit.hide", "Hide", &[key('h')]).separated().when(with_selection),
    command(Edit, Action::Isolate, "edit.isolate", "Isolate", &[key('i')]).when(with_selection),
    command(Edit, Action::ShowAll, "edit.show_all", "Show all", &[key('h').shift()]).when(with_hidden),
];
