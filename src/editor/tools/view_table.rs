//! The rows of the command table that turn the view and open panels.

use bevy::input::keyboard::KeyCode;

use super::command::Menu::View;
use super::command::{Action, Command, command};
use super::key::Shortcut;
use super::situation::Situation;
use crate::editor::settings::Handles;
use crate::kernel::view::StandardView;

const fn with_selection(s: &Situation) -> bool {
    s.selection
}

const fn key(c: char) -> Shortcut {
    Shortcut::char(c)
}
const fn code(code: KeyCode) -> Shortcut {
    Shortcut::code(code)
}

/// The rows, in menu order.
pub(super) const ROWS: &[Command] = &[
    command(View, Action::Fit, "view.fit", "Fit all", &[key('f'), code(KeyCode::Home)]),
    command(View, Action::FitSelection, "view.fit_selection", "Fit selection", &[key('z'), key('f').shift()])
        .when(with_selection),
    command(
        View,
        Action::View(StandardView::Iso),
        "view.iso",
        "Isometric",
        &[code(KeyCode::Digit0), code(KeyCode::Numpad0)],
    )
    .separated(),
    command(
        View,
        Action::View(StandardView::Front),
        "view.front",
        "Front",
        &[code(KeyCode::Digit1), code(KeyCode::Numpad1)],
    ),
    command(
        View,
        Action::View(StandardView::Back),
        "view.back",
        "Back",
        &[code(KeyCode::Digit2), code(KeyCode::Numpad9)],
    ),
    command(
        View,
        Action::View(StandardView::Left),
        "view.left",
        "Left",
        &[code(KeyCode::Digit3), code(KeyCode::Numpad4)],
    ),
    command(
        View,
        Action::View(StandardView::Right),
        "view.right",
        "Right",
        &[code(KeyCode::Digit4), code(KeyCode::Numpad3), code(KeyCode::Numpad6)],
    ),
    command(
        View,
        Action::View(StandardView::Top),
        "view.top",
        "Top",
        &[code(KeyCode::Digit5), code(KeyCode::Numpad7), code(KeyCode::Numpad8)],
    ),
    command(
        View,
        Action::View(StandardView::Bottom),
        "view.bottom",
        "Bottom",
        &[code(KeyCode::Digit6), code(KeyCode::Numpad2)],
    ),
    command(
        View,
        Action::ToggleProjection,
        "view.projection",
        "Perspective",
        &[key('p'), code(KeyCode::Numpad5)],
    )
    .separated()
    .checked(|s| s.perspective),
    command(View, Action::ToggleTree, "view.tree", "Model tree", &[key('t')]).separated().checked(|s| s.tree),
    command(View, Action::ToggleProperties, "view.properties", "Properties", &[key('n')])
        .checked(|s| s.properties),
    command(View, Action::ToggleUv, "view.uv", "UV editor", &[code(KeyCode::Tab), key('u').shift()])
        .checked(|s| s.uv),
    command(View, Action::ToggleUvSide, "view.uv_beside", "UV editor beside the view", &[])
        .checked(|s| s.uv_beside),
    command(View, Action::Handles(Handles::Curves), "view.handles_curves", "Trim curves in 3D", &[key('q')])
        .checked(|s| s.handles == Handles::Curves),
    command(
        View,
        Action::Handles(Handles::Surface),
        "view.handles_surface",
        "Surface points in 3D",
        &[key('v')],
    )
    .checked(|s| s.handles == Handles::Surface),
    command(View, Action::ToggleReport, "view.report", "Import report", &[key('r')]).checked(|s| s.report),
    command(View, Action::ToggleHistory, "view.history", "History", &[key('y')]).checked(|s| s.history),
    command(View, Action::ToggleProblems, "view.problems", "Problems", &[code(KeyCode::F3)])
        .checked(|s| s.problems),
];
