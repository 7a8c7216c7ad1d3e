//! The one table of commands. Menus, keys, the toolbar and the help sheet are all made from it.

use std::sync::LazyLock;

use bevy::input::keyboard::KeyCode;
use bevy::prelude::Message;

use super::edit_action::EditAction;
use super::key::Shortcut;
use super::situation::Situation;
use crate::editor::settings::{DisplayMode, Handles, Settings, Surfaces};
use crate::encoding::Conceal;
use crate::kernel::view::StandardView;

/// What a command does. Each capability listens for its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the table below says it in words")]
pub enum Action {
    New,
    Open,
    Import,
    Save,
    SaveAs,
    Export,
    OpenDemo,
    Cancel,
    CloseAll,
    Quit,
    Undo,
    Redo,
    Edit(EditAction),
    Palette,
    SelectAll,
    InvertSelection,
    ClearSelection,
    Find,
    Hide,
    Isolate,
    ShowAll,
    Fit,
    FitSelection,
    View(StandardView),
    ToggleProjection,
    ToggleTree,
    ToggleProperties,
    ToggleReport,
    ToggleHistory,
    ToggleProblems,
    ToggleInspection,
    TogglePinHoles,
    NextDefect,
    PreviousDefect,
    ToggleUv,
    ToggleUvSide,
    Handles(Handles),
    Display(DisplayMode),
    Holes(Conceal),
    Surfaces(Surfaces),
    ToggleEdges,
    ToggleGrid,
    ToggleTheme,
    Shortcuts,
    About,
}

/// Asks for a command to be done. Written by keys, menus, toolbar and tests alike.
#[derive(Message, Debug, Clone, Copy, PartialEq, Eq)]
pub struct CommandRequest(pub Action);

/// The menus, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Menu {
    File,
    Edit,
    Loop,
    Curve,
    Surface,
    View,
    Display,
    Inspect,
    Help,
}

impl Menu {
    /// All menus from left to right.
    pub const ALL: [Self; 9] = [
        Self::File,
        Self::Edit,
        Self::Loop,
        Self::Curve,
        Self::Surface,
        Self::View,
        Self::Display,
        Self::Inspect,
        Self::Help,
    ];

    /// Name to show.
    pub fn label(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Edit => "Edit",
            Self::Loop => "Loop",
            Self::Curve => "Curve",
            Self::Surface => "Surface",
            Self::View => "View",
            Self::Display => "Display",
            Self::Inspect => "Inspect",
            Self::Help => "Help",
        }
    }
}

/// One command.
#[derive(Debug, Clone)]
pub struct Command {
    /// What it does.
    pub action: Action,
    /// Stable name, for tests and scripts.
    pub id: &'static str,
    /// Name to show.
    pub label: &'static str,
    /// The menu it is in.
    pub menu: Menu,
    /// Whether a line separates it from the one above.
    pub separated: bool,
    /// Keys; the first is the one shown in the menu.
    pub keys: &'static [Shortcut],
    /// When it can be used.
    pub enabled: fn(&Situation) -> bool,
    /// Its tick mark, for what can be on or off.
    pub checked: Option<fn(&Settings) -> bool>,
}

const fn always(_: &Situation) -> bool {
    true
}
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
const fn with_inspection(s: &Situation) -> bool {
    s.inspection
}
const fn while_loading(s: &Situation) -> bool {
    s.loading
}

pub(super) const fn command(
    menu: Menu,
    action: Action,
    id: &'static str,
    label: &'static str,
    keys: &'static [Shortcut],
) -> Command {
    Command { action, id, label, menu, separated: false, keys, enabled: always, checked: None }
}

impl Command {
    pub(super) const fn separated(self) -> Self {
        Self { separated: true, ..self }
    }
    pub(super) const fn when(self, enabled: fn(&Situation) -> bool) -> Self {
        Self { enabled, ..self }
    }
    const fn checked(self, checked: fn(&Settings) -> bool) -> Self {
        Self { checked: Some(checked), ..self }
    }
}

use Menu::{Display, Edit, File, Help, Inspect, View};
const fn key(c: char) -> Shortcut {
    Shortcut::char(c)
}
const fn code(code: KeyCode) -> Shortcut {
    Shortcut::code(code)
}

/// Every command, menu by menu in menu order.
pub static COMMANDS: LazyLock<Vec<Command>> = LazyLock::new(|| {
    let mut all = [PLAIN, &super::edit_table::ROWS].concat();
    // Stable: within its menu each row stays where its table has it.
    all.sort_by_key(|c| Menu::ALL.iter().position(|m| *m == c.menu));
    all
});

/// The commands that do not edit geometry.
const PLAIN: &[Command] = &[
    command(File, Action::New, "file.new", "New", &[key('n').ctrl()]),
    command(File, Action::Open, "file.open", "Open…", &[key('o').ctrl()]),
    command(File, Action::Import, "file.import", "Import into scene…", &[key('i').ctrl()]),
    command(File, Action::Save, "file.save", "Save", &[key('s').ctrl()]).separated().when(with_model),
    command(File, Action::SaveAs, "file.save_as", "Save as…", &[key('s').ctrl().shift()]).when(with_model),
    command(File, Action::Export, "file.export", "Export IGES…", &[key('e').ctrl()]).when(with_model),
    command(File, Action::OpenDemo, "file.demo", "Open demo scene", &[key('d').ctrl()]),
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
    command(Help, Action::Shortcuts, "help.keys", "Keys and mouse", &[code(KeyCode::F1), key('?')]),
    command(Help, Action::About, "help.about", "About Hairline", &[]),
];

impl Action {
    /// Its row of the table.
    pub fn command(self) -> Option<&'static Command> {
        COMMANDS.iter().find(|c| c.action == self)
    }
}

/// What the mouse does in the viewport, for the help sheet.
pub const MOUSE_HELP: &[(&str, &str)] = &[
    ("Left click", "Select the face under the pointer"),
    ("Ctrl / Shift + click", "Add to or take from the selection"),
    ("Double click", "Fit the face under the pointer"),
    ("Middle or right drag", "Orbit about the point under the pointer"),
    ("Alt + left drag", "Orbit, for trackpads"),
    ("Shift + drag", "Pan (with middle, right or Alt + left)"),
    ("Wheel", "Zoom to the pointer"),
    ("Cube", "Turn to the view of the face, edge or corner clicked"),
    ("Drag a handle", "Move a control point, curve or loop, in the UV editor or on the surface"),
    ("Shift / Ctrl while dragging", "Keep to 45° / turn snapping round"),
    ("X, Y, Z while dragging", "Keep a surface point to that axis"),
    ("Double click on a curve", "Select its loop"),
    ("Right click in the UV editor", "Menu of what is there"),
    ("Drop files", "Open them; with Shift add them to the scene"),
];
