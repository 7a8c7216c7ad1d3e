//! The dialogs in which files are named.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use egui_file_dialog::FileDialog;

use super::{OpenFiles, Source};
use crate::editor::document::{Discarding, SaveRequest, Target};
use crate::editor::tessellation::MeshFormat;
use crate::editor::tools::{Action, CommandRequest};
use crate::scene::file::EXTENSION;

/// What a file is named for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Purpose {
    /// To be opened instead of what is open.
    Open,
    /// To be added to what is open.
    Import,
    /// To be saved to; then goes on with this.
    Save(Option<Discarding>),
    /// To be written as IGES.
    Export,
    /// To be written as triangles.
    Mesh,
}

/// The dialog and what it was opened for.
#[derive(Resource)]
pub struct FileDialogs {
    /// The dialog; drawn by `panels`.
    pub dialog: FileDialog,
    purpose: Purpose,
}

/// What was picked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Picked {
    /// Files to open.
    Open(OpenFiles),
    /// A file to write.
    Save(SaveRequest),
    /// A mesh to write.
    Mesh(PathBuf),
}

impl Default for FileDialogs {
    fn default() -> Self {
        Self { dialog: plain("Open"), purpose: Purpose::Open }
    }
}

fn plain(title: &str) -> FileDialog {
    FileDialog::new()
        .title(title)
        .default_size([760.0, 480.0])
        .anchor(bevy_egui::egui::Align2::CENTER_CENTER, [0.0, 0.0])
        // Its search field is black in every theme: in the light one nothing typed could be read.
        .show_search(false)
}

fn to_open(title: &str) -> FileDialog {
    let iges = ["igs", "iges", "IGS", "IGES"];
    let all = iges.into_iter().chain([EXTENSION]).collect();
    plain(title)
        .add_file_filter_extensions("Scenes and IGES", all)
        .add_file_filter_extensions("Scenes", vec![EXTENSION])
        .add_file_filter_extensions("IGES", iges.to_vec())
        .default_file_filter("Scenes and IGES")
        .allow_file_overwrite(false)
}

fn to_save(title: &str, name: &str, what: &str, extension: &str, beside: Option<&Path>) -> FileDialog {
    let dialog = plain(title)
        .add_save_extension(what, extension)
        .default_save_extension(what)
        .default_file_name(name)
        .allow_file_overwrite(true);
    match beside.and_then(Path::parent).filter(|folder| folder.is_dir()) {
        Some(folder) => dialog.initial_directory(folder.to_owned()),
        None => dialog,
    }
}

impl FileDialogs {
    /// Opens the dialog. `own` is a file whose folder and name, but for the ending, are offered.
    pub fn open(&mut self, purpose: Purpose, own: Option<&Path>) {
        let stem = own.and_then(Path::file_stem).map_or("Untitled".into(), |s| s.to_string_lossy());
        self.dialog = match &purpose {
            Purpose::Open => to_open("Open"),
            Purpose::Import => to_open("Import into the scene"),
            Purpose::Save(_) => {
                to_save("Save scene", &format!("{stem}.{EXTENSION}"), "Scene", EXTENSION, own)
            }
            Purpose::Export => to_save("Export IGES", &format!("{stem}.igs"), "IGES", "igs", own),
            Purpose::Mesh => {
                let [(_, usual, ending), others @ ..] = MeshFormat::ALL;
                let dialog = to_save("Export mesh", &format!("{stem}.{ending}"), usual, ending, own);
                others
                    .iter()
                    .fold(dialog, |dialog, (_, name, ending)| dialog.add_save_extension(name, ending))
            }
        };
        match &purpose {
            Purpose::Open | Purpose::Import => self.dialog.pick_multiple(),
            Purpose::Save(_) | Purpose::Export | Purpose::Mesh => self.dialog.save_file(),
        }
        self.purpose = purpose;
    }

    /// What was picked since the last call.
    pub fn take_picked(&mut self) -> Option<Picked> {
        match &self.purpose {
            Purpose::Open | Purpose::Import => {
                let files = self.dialog.take_picked_multiple()?;
                let sources: Vec<Source> =
                    files.into_iter().filter(|f| !f.is_dir()).map(Source::File).collect();
                let replace = self.purpose == Purpose::Open;
                (!sources.is_empty()).then_some(Picked::Open(OpenFiles { sources, replace }))
            }
            Purpose::Save(then) => {
                let then = then.clone();
                let target = Target::File(self.dialog.take_picked()?);
                Some(Picked::Save(SaveRequest { target, then }))
            }
            Purpose::Mesh => Some(Picked::Mesh(self.dialog.take_picked()?)),
            Purpose::Export => {
                let target = Target::Export(self.dialog.take_picked()?);
                Some(Picked::Save(SaveRequest { target, then: None }))
            }
        }
    }
}

/// Shows the dialog for `Open` and `Import`.
pub(super) fn command_requests(
    mut requests: MessageReader<CommandRequest>,
    mut dialogs: ResMut<FileDialogs>,
) {
    for CommandRequest(action) in requests.read() {
        match action {
            Action::Open => dialogs.open(Purpose::Open, None),
            Action::Import => dialogs.open(Purpose::Import, None),
            _ => {}
        }
    }
}
