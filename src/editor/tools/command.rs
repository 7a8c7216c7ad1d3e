//! The one table of commands. Menus, keys, the toolbar and the help sheet are all made from it.

use std::sync::LazyLock;

use bevy::prelude::Message;

use super::edit_action::EditAction;
use super::key::Shortcut;
use super::situation::Situation;
use super::{display_table, edit_table, file_table, tessellation_table, view_table};
use crate::editor::settings::{DisplayMode, Handles, HoleMarks, Settings, Surfaces};
use crate::editor::tessellation::TessellationView;
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
    Autosave(u32),
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
    HoleMarks(HoleMarks),
    ToggleMovingHoles,
    ToggleLens,
    LensZoom,
    NextDefect,
    PreviousDefect,
    CloseGap,
    ToggleUv,
    ToggleUvSide,
    Handles(Handles),
    Display(DisplayMode),
    Holes(Conceal),
    Surfaces(Surfaces),
    Tessellation(TessellationView),
    ToggleTriangleEdges,
    ToggleFacets,
    ExportMesh,
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
    Tessellation,
    Inspect,
    Help,
}

impl Menu {
    /// All menus from left to right.
    pub const ALL: [Self; 10] = [
        Self::File,
        Self::Edit,
        Self::Loop,
        Self::Curve,
        Self::Surface,
        Self::View,
        Self::Display,
        Self::Tessellation,
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
            Self::Tessellation => "Tessellation",
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
    pub(super) const fn checked(self, checked: fn(&Settings) -> bool) -> Self {
        Self { checked: Some(checked), ..self }
    }
}

/// Every command, menu by menu in menu order.
pub static COMMANDS: LazyLock<Vec<Command>> = LazyLock::new(|| {
    let tables = [
        file_table::ROWS,
        &edit_table::ROWS,
        view_table::ROWS,
        display_table::ROWS,
        tessellation_table::ROWS,
    ];
    let mut all = tables.concat();
    // Stable: within its menu each row stays where its table has it.
    all.sort_by_key(|c| Menu::ALL.iter().position(|m| *m == c.menu));
    all
});

impl Action {
    /// Its row of the table.
    pub fn command(self) -> Option<&'static Command> {
        COMMANDS.iter().find(|c| c.action == self)
    }
}
