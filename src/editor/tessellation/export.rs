//! The mesh that is shown as a file: glTF, STL, OBJ or PLY, written on a thread.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, mpsc};

use bevy::prelude::*;

use super::made::Made;
use super::{Progress, Stop, Tessellation, TessellationRequest};
use crate::editor::document::Naming;
use crate::editor::files::{FileDialogs, Purpose};
use crate::editor::object::{AuthoredFace, FacePlace, Model, Scene};
use crate::editor::panels::Notices;
use crate::editor::redraw::Waker;
use crate::editor::tools::{Action, CommandRequest};
use crate::exchange::mesh::{self, Group, PLAIN};
use crate::meshing::orientations;
use crate::scene::file::replace::replace;

/// A format that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum MeshFormat {
    Glb,
    Stl,
    Obj,
    Ply,
}

impl MeshFormat {
    /// Names and endings, the first the usual one.
    pub const ALL: [(Self, &'static str, &'static str); 4] = [
        (Self::Glb, "glTF binary", "glb"),
        (Self::Stl, "STL", "stl"),
        (Self::Obj, "Wavefront OBJ", "obj"),
        (Self::Ply, "PLY", "ply"),
    ];

    /// The format that the ending of a name asks for.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_lowercase();
        Self::ALL.iter().find(|(_, _, own)| *own == ending).map(|(format, ..)| *format)
    }
}

/// The file to be written when its triangles are made, and the one being written.
#[derive(Resource, Default)]
pub(super) struct Exporting {
    /// With the revision of the scene that it is of.
    waiting: Option<(PathBuf, MeshFormat, u64)>,
    writer: Option<Mutex<mpsc::Receiver<Result<String, String>>>>,
}

/// What a file says of a face beside its triangles.
struct Label {
    name: String,
    part: String,
    colour: [f32; 3],
    reversed: bool,
}

/// Asks for a name.
pub(super) fn command_requests(
    mut requests: MessageReader<CommandRequest>,
    mut dialogs: ResMut<FileDialogs>,
    naming: Naming,
) {
    if requests.read().any(|CommandRequest(action)| *action == Action::ExportMesh) {
        dialogs.open(Purpose::Mesh, naming.suggestion().as_deref());
    }
}

/// Starts the thread, and says how it went.
pub(super) fn serve(
    mut requests: MessageReader<TessellationRequest>,
    mut exporting: ResMut<Exporting>,
    mut notices: ResMut<Notices>,
    state: Res<Tessellation>,
    scene: Res<Scene>,
    faces: Query<(&AuthoredFace, &FacePlace)>,
    models: Query<&Model>,
    waker: Res<Waker>,
) {
    if let Some(receiver) = &exporting.writer {
        let result = receiver.lock().unwrap_or_else(|e| e.into_inner()).try_recv();
        let done = !matches!(result, Err(mpsc::TryRecvError::Empty));
        match result {
            Ok(Ok(text)) => notices.info(text),
            Ok(Err(text)) => notices.error(text),
            Err(mpsc::TryRecvError::Empty) => {}
            Err(mpsc::TryRecvError::Disconnected) => notices.error("the mesh was not written".into()),
        }
        if done {
            exporting.writer = None;
        }
    }
    for request in requests.read() {
        let TessellationRequest::Export(path) = request else { continue };
        let Some(format) = MeshFormat::of(path) else {
            notices.error(format!("{}: the name must end in .glb, .stl, .obj or .ply", path.display()));
            continue;
        };
        if exporting.waiting.is_some() || exporting.writer.is_some() {
            notices.info("Still writing the last mesh".into());
            continue;
        }
        exporting.waiting = Some((path.clone(), format, scene.revision));
        if state.current().is_none() {
            notices.info(format!("{} will be written when its triangles are made", path.display()));
        }
    }
    let Some((path, format, revision)) = exporting.waiting.clone() else { return };
    let made = state.current().filter(|_| scene.revision == revision).cloned();
    let Some(made) = made else {
        let reason = match state.progress() {
            _ if scene.revision != revision => "the scene is another by now".into(),
            // The question may be answered with yes.
            Progress::Meshing(_) | Progress::Measuring(_) | Progress::Ready => return,
            Progress::Stopped(Stop::TooMany(_)) => return,
            Progress::Stopped(Stop::Failed(reason)) => reason,
            Progress::Stopped(Stop::Cancelled) | Progress::Off => "no triangles were made".into(),
        };
        exporting.waiting = None;
        notices.error(format!("{} was not written: {reason}", path.display()));
        return;
    };
    exporting.waiting = None;
    let label = |face: &Entity| {
        let Ok((authored, place)) = faces.get(*face) else {
            return Label { name: "face".into(), part: String::new(), colour: PLAIN, reversed: false };
        };
        let own = &authored.attributes;
        let part = models.get(place.model).ok().and_then(|m| m.parts.get(own.part?));
        Label {
            name: own.name.clone().unwrap_or_else(|| format!("face {}", place.number)),
            part: part.map_or(String::new(), |p| p.name.clone()),
            colour: own.colour.unwrap_or(PLAIN),
            reversed: own.reversed,
        }
    };
    let labels: Vec<Label> = made.faces().iter().map(label).collect();
    let (sender, receiver) = mpsc::channel();
    let waker = waker.clone();
    let spawned = std::thread::Builder::new().name("hairline-export".into()).spawn(move || {
        let work = std::panic::AssertUnwindSafe(|| write(&path, format, &made, &labels));
        let result = std::panic::catch_unwind(work)
            .unwrap_or_else(|_| Err(format!("{}: internal error while writing", path.display())));
        // The receiver is gone only when the program ends.
        let _ = sender.send(result);
        waker.wake();
    });
    match spawned {
        Ok(_) => exporting.writer = Some(Mutex::new(receiver)),
        Err(error) => notices.error(format!("not written: cannot start a thread: {error}")),
    }
}

fn write(path: &Path, format: MeshFormat, made: &Arc<Made>, labels: &[Label]) -> Result<String, String> {
    let senses: Vec<bool> = labels.iter().map(|l| l.reversed).collect();
    let turned = orientations(&made.mesh, &senses);
    let groups: Vec<Group> = made
        .mesh
        .faces
        .iter()
        .zip(labels.iter().zip(turned))
        .filter_map(|(mesh, (label, reversed))| {
            let mesh = mesh.as_ref().ok()?;
            Some(Group { name: &label.name, part: &label.part, colour: label.colour, mesh, reversed })
        })
        .collect();
    let name = path.file_stem().map_or("mesh".into(), |s| s.to_string_lossy());
    let put = |path: &PathBuf, bytes: &[u8]| {
        replace(path, bytes).map_err(|error| format!("{} was not written: {error}", path.display()))
    };
    let too_much = |error: std::io::Error| format!("{} was not written: {error}", path.display());
    let bytes = match format {
        MeshFormat::Glb => mesh::glb(&groups, &name, 1e-3 * made.unit_mm).map_err(too_much)?,
        MeshFormat::Stl => mesh::stl(&groups, &name).map_err(too_much)?,
        MeshFormat::Ply => mesh::ply(&groups).map_err(too_much)?,
        MeshFormat::Obj => {
            let library = path.with_extension("mtl");
            put(&library, &mesh::materials(&groups))?;
            mesh::obj(&groups, library.file_name().map(|n| n.to_string_lossy()).as_deref())
        }
    };
    put(&path.to_owned(), &bytes)?;
    Ok(format!("{} triangles written to {}", made.figures.triangles, path.display()))
}
