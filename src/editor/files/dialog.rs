//! The open dialog.

use bevy::prelude::*;
use egui_file_dialog::FileDialog;

use super::{OpenFiles, Source};
use crate::editor::tools::{Action, CommandRequest};

/// The dialog and what it was opened for.
#[derive(Resource)]
pub struct OpenDialog {
    /// The dialog; drawn by `panels`.
    pub dialog: FileDialog,
    replace: bool,
}

impl Default for OpenDialog {
    fn default() -> Self {
        let dialog = FileDialog::new()
            .title("Open IGES files")
            .add_file_filter_extensions("IGES", vec!["igs", "iges", "IGS", "IGES"])
            .default_file_filter("IGES")
            .default_size([760.0, 480.0])
            .anchor(bevy_egui::egui::Align2::CENTER_CENTER, [0.0, 0.0])
            // Its search field is black in every theme: in the light one nothing typed could be read.
            .show_search(false)
            .allow_file_overwrite(false);
        Self { dialog, replace: true }
    }
}

impl OpenDialog {
    /// The request for the files picked since the last call.
    pub fn take_request(&mut self) -> Option<OpenFiles> {
        let files = self.dialog.take_picked_multiple()?;
        let sources: Vec<Source> = files.into_iter().filter(|f| !f.is_dir()).map(Source::File).collect();
        (!sources.is_empty()).then_some(OpenFiles { sources, replace: self.replace })
    }
}

/// Shows the dialog for `Open` and `Import`.
pub(super) fn command_requests(mut requests: MessageReader<CommandRequest>, mut dialog: ResMut<OpenDialog>) {
    for CommandRequest(action) in requests.read() {
        dialog.replace = match action {
            Action::Open => true,
            Action::Import => false,
            _ => continue,
        };
        dialog.dialog.pick_multiple();
    }
}
