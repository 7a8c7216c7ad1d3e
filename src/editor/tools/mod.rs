//! What the user can do: the table of commands and the keys that reach it.
//!
//! Wiring: `Input` turns key presses into [`CommandRequest`]s (unless a text field has the keyboard), and
//! keeps [`Situation`] up to date; each capability reads the requests it serves in `Tools`.

mod command;
mod display_table;
mod edit_action;
mod edit_table;
mod file_table;
mod key;
mod keyboard;
mod mouse;
mod search;
mod situation;
mod tessellation_table;
mod view_table;

use bevy::prelude::*;

pub use command::{Action, COMMANDS, Command, CommandRequest, Menu};
pub use edit_action::{EditAction, Needs};
pub use key::{KeyCap, Modifiers, Shortcut};
pub use mouse::MOUSE_HELP;
pub use search::find;
pub use situation::{CurrentSituation, Situation};

/// Adds the command table.
pub struct ToolsPlugin;

impl Plugin for ToolsPlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<CommandRequest>().init_resource::<CurrentSituation>().add_systems(
            Update,
            (situation::observe, keyboard::press).chain().in_set(super::NavigationInput),
        );
    }
}
