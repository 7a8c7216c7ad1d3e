//! The tools of the uv panel.

use bevy::prelude::KeyCode;

use crate::editor::tools::Shortcut;

/// What the left button does on the canvas.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Tool {
    /// Selects and drags.
    #[default]
    Select,
    /// Draws a rectangle from corner to corner.
    Rectangle,
    /// Draws a circle from its centre.
    Circle,
    /// Draws a closed line through points.
    Polyline,
    /// Draws a closed smooth curve along the hand.
    Freehand,
    /// Puts a knot into the curve under the pointer.
    InsertKnot,
    /// Splits the curve under the pointer.
    Split,
}

impl Tool {
    /// All tools in the order of the toolbar.
    pub const ALL: [Self; 7] = [
        Self::Select,
        Self::Rectangle,
        Self::Circle,
        Self::Polyline,
        Self::Freehand,
        Self::InsertKnot,
        Self::Split,
    ];

    /// Name to show.
    pub fn label(self) -> &'static str {
        match self {
            Self::Select => "Select and drag",
            Self::Rectangle => "Rectangle",
            Self::Circle => "Circle",
            Self::Polyline => "Polyline",
            Self::Freehand => "Freehand",
            Self::InsertKnot => "Insert knot",
            Self::Split => "Split curve",
        }
    }

    /// How it is used.
    pub fn hint(self) -> &'static str {
        match self {
            Self::Select => {
                "Drag points, curves, loops. Shift adds, Ctrl toggles, double click takes the loop"
            }
            Self::Rectangle => "Drag from corner to corner. Shift makes a square",
            Self::Circle => "Drag from the centre",
            Self::Polyline => "Click corners. Enter or the first corner closes, Backspace takes one back",
            Self::Freehand => "Draw with the button held; the loop closes when it is let go",
            Self::InsertKnot => "Click on a curve to put a knot there; its shape stays",
            Self::Split => "Click on a curve to split it there",
        }
    }

    /// Its key while the pointer is over the panel.
    pub fn key(self) -> Shortcut {
        match self {
            Self::Select => Shortcut::char('v'),
            Self::Rectangle => Shortcut::char('r'),
            Self::Circle => Shortcut::char('c'),
            Self::Polyline => Shortcut::char('p'),
            Self::Freehand => Shortcut::char('g'),
            Self::InsertKnot => Shortcut::char('k'),
            Self::Split => Shortcut::char('s'),
        }
    }

    /// Whether it draws a new loop.
    pub fn draws(self) -> bool {
        matches!(self, Self::Rectangle | Self::Circle | Self::Polyline | Self::Freehand)
    }

    /// Whether it works on a place of a curve.
    pub fn takes_place(self) -> bool {
        matches!(self, Self::InsertKnot | Self::Split)
    }
}

/// A key that does something while the pointer is over the panel, beside those of the tools.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PanelKey {
    /// Takes a tool.
    Tool(Tool),
    /// Shows everything.
    Fit,
    /// Shows what is selected.
    FitSelection,
    /// Selects everything.
    SelectAll,
    /// Ends what is under way, drops the tool, clears the selection: the first that applies.
    Escape,
    /// Ends a drawing.
    Enter,
    /// Takes the last corner back.
    Back,
    /// Moves what is selected by a step: u, v in steps.
    Nudge(i8, i8),
    /// Switches snapping.
    Snap,
    /// Goes on to the next structure overlay.
    Overlay,
}

/// What a key press means to the panel.
pub const PANEL_KEYS: &[(Shortcut, PanelKey, &str)] = &[
    (Shortcut::char('f'), PanelKey::Fit, "Fit"),
    (Shortcut::code(KeyCode::Home), PanelKey::Fit, "Fit"),
    (Shortcut::char('f').shift(), PanelKey::FitSelection, "Fit selection"),
    (Shortcut::char('z'), PanelKey::FitSelection, "Fit selection"),
    (Shortcut::char('a').ctrl(), PanelKey::SelectAll, "Select all"),
    (Shortcut::code(KeyCode::Escape), PanelKey::Escape, "Cancel"),
    (Shortcut::code(KeyCode::Enter), PanelKey::Enter, "Close polyline"),
    (Shortcut::code(KeyCode::NumpadEnter), PanelKey::Enter, "Close polyline"),
    (Shortcut::code(KeyCode::Backspace), PanelKey::Back, "Take back corner"),
    (Shortcut::code(KeyCode::ArrowLeft), PanelKey::Nudge(-1, 0), "Nudge"),
    (Shortcut::code(KeyCode::ArrowRight), PanelKey::Nudge(1, 0), "Nudge"),
    (Shortcut::code(KeyCode::ArrowDown), PanelKey::Nudge(0, -1), "Nudge"),
    (Shortcut::code(KeyCode::ArrowUp), PanelKey::Nudge(0, 1), "Nudge"),
    (Shortcut::code(KeyCode::ArrowLeft).shift(), PanelKey::Nudge(-10, 0), "Nudge far"),
    (Shortcut::code(KeyCode::ArrowRight).shift(), PanelKey::Nudge(10, 0), "Nudge far"),
    (Shortcut::code(KeyCode::ArrowDown).shift(), PanelKey::Nudge(0, -10), "Nudge far"),
    (Shortcut::code(KeyCode::ArrowUp).shift(), PanelKey::Nudge(0, 10), "Nudge far"),
    (Shortcut::char('n'), PanelKey::Snap, "Snapping"),
    (Shortcut::char('m'), PanelKey::Overlay, "Structure"),
];
