//! The rows of the command table that say how the model is drawn and inspected, and the help.

use bevy::input::keyboard::KeyCode;

use super::command::Menu::{Display, Help, Inspect};
use super::command::{Action, Command, command};
use super::key::Shortcut;
use super::situation::Situation;
use crate::editor::settings::{DisplayMode, HoleMarks, Surfaces};
use crate::encoding::Conceal;

const fn with_inspection(s: &Situation) -> bool {
    s.inspection
}
const fn with_model(s: &Situation) -> bool {
    s.model
}
const fn with_gap(s: &Situation) -> bool {
    s.gap
}

const fn key(c: char) -> Shortcut {
    Shortcut::char(c)
}
const fn code(code: KeyCode) -> Shortcut {
    Shortcut::code(code)
}

/// The rows, in menu order.
pub(super) const ROWS: &[Command] = &[
    command(
        Display,
        Action::Display(DisplayMode::Shaded),
        "display.shaded",
        "Shaded",
        &[code(KeyCode::F5), key('s')],
    )
    .checked(|s| s.mode == DisplayMode::Shaded),
    command(
        Display,
        Action::Display(DisplayMode::Faces),
        "display.faces",
        "Colour by face",
        &[code(KeyCode::F6), key('c')],
    )
    .checked(|s| s.mode == DisplayMode::Faces),
    command(
        Display,
        Action::Display(DisplayMode::Uv),
        "display.uv",
        "Colour by u, v",
        &[code(KeyCode::F7), key('u')],
    )
    .checked(|s| s.mode == DisplayMode::Uv),
    command(
        Display,
        Action::Display(DisplayMode::Heat),
        "display.heat",
        "Evaluation heat map",
        &[code(KeyCode::F8), key('m')],
    )
    .checked(|s| s.mode == DisplayMode::Heat),
    command(
        Display,
        Action::Display(DisplayMode::Untrimmed),
        "display.untrimmed",
        "Untrimmed",
        &[code(KeyCode::F9), key('x')],
    )
    .checked(|s| s.mode == DisplayMode::Untrimmed),
    command(Display, Action::Surfaces(Surfaces::Auto), "display.auto", "Triangles while moving", &[])
        .separated()
        .checked(|s| s.surfaces == Surfaces::Auto),
    command(Display, Action::Surfaces(Surfaces::Rays), "display.rays", "Rays only", &[])
        .checked(|s| s.surfaces == Surfaces::Rays),
    command(Display, Action::Surfaces(Surfaces::Triangles), "display.triangles", "Triangles only", &[])
        .checked(|s| s.surfaces == Surfaces::Triangles),
    command(
        Display,
        Action::Holes(Conceal::Raw),
        "display.raw",
        "Pin holes as they are",
        &[code(KeyCode::F12).ctrl()],
    )
    .separated()
    .checked(|s| s.holes == Conceal::Raw),
    command(
        Display,
        Action::Holes(Conceal::Concealed),
        "display.concealed",
        "Pin holes concealed",
        &[code(KeyCode::F12)],
    )
    .checked(|s| s.holes == Conceal::Concealed),
    command(
        Display,
        Action::Holes(Conceal::Difference),
        "display.difference",
        "What is concealed",
        &[code(KeyCode::F12).shift()],
    )
    .checked(|s| s.holes == Conceal::Difference),
    command(Display, Action::ToggleEdges, "display.edges", "Edges", &[key('e')])
        .separated()
        .checked(|s| s.edges),
    command(Display, Action::ToggleGrid, "display.grid", "Grid", &[key('g')]).checked(|s| s.grid),
    command(Display, Action::ToggleTheme, "display.theme", "Light theme", &[key('l')])
        .separated()
        .checked(|s| s.light),
    command(
        Inspect,
        Action::ToggleInspection,
        "inspect.edges",
        "Gaps and naked edges",
        &[code(KeyCode::F10), key('k')],
    )
    .checked(|s| s.inspection),
    command(
        Inspect,
        Action::TogglePinHoles,
        "inspect.holes",
        "Mark pin holes",
        &[code(KeyCode::F10).shift()],
    )
    .checked(|s| s.pin_holes)
    .when(with_inspection),
    command(Inspect, Action::HoleMarks(HoleMarks::Rings), "inspect.rings", "Marks are rings", &[])
        .checked(|s| s.hole_marks == HoleMarks::Rings)
        .when(with_inspection),
    command(Inspect, Action::HoleMarks(HoleMarks::Blinking), "inspect.blinking", "Marks blink", &[])
        .checked(|s| s.hole_marks == HoleMarks::Blinking)
        .when(with_inspection),
    command(Inspect, Action::HoleMarks(HoleMarks::Dilated), "inspect.dilated", "Marks cover the holes", &[])
        .checked(|s| s.hole_marks == HoleMarks::Dilated)
        .when(with_inspection),
    command(
        Inspect,
        Action::ToggleMovingHoles,
        "inspect.moving",
        "Find pin holes while moving",
        &[code(KeyCode::F10).ctrl()],
    )
    .checked(|s| s.holes_moving)
    .when(with_inspection),
    command(Inspect, Action::ToggleLens, "inspect.lens", "Magnifier", &[code(KeyCode::F4), key('o')])
        .separated()
        .checked(|s| s.lens)
        .when(with_model),
    command(
        Inspect,
        Action::LensZoom,
        "inspect.zoom",
        "Magnifier: 8, 16 or 4 times",
        &[code(KeyCode::F4).shift()],
    )
    .when(with_model),
    command(Inspect, Action::NextDefect, "inspect.next", "Next defect", &[code(KeyCode::F11), key('.')])
        .separated()
        .when(with_inspection),
    command(
        Inspect,
        Action::PreviousDefect,
        "inspect.previous",
        "Previous defect",
        &[code(KeyCode::F11).shift(), key(',')],
    )
    .when(with_inspection),
    command(Inspect, Action::CloseGap, "inspect.close", "Close gap", &[key('g').shift()])
        .separated()
        .when(with_gap),
    command(Help, Action::Shortcuts, "help.keys", "Keys and mouse", &[code(KeyCode::F1), key('?')]),
    command(Help, Action::About, "help.about", "About Hairline", &[]),
];
