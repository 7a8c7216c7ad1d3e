//! What the enabling of commands depends on, looked at once per frame.

use bevy::prelude::*;

use crate::editor::editing::{Clipboard, Editing};
use crate::editor::elements::{ActiveFace, ElementSelection};
use crate::editor::files::Loading;
use crate::editor::inspection::{Chosen, Findings, can_close};
use crate::editor::object::{FaceChange, Scene, Shown};
use crate::editor::selection::Selection;
use crate::editor::settings::Settings;

/// What is open, selected and going on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Situation {
    /// A model is open.
    pub model: bool,
    /// At least one face is selected.
    pub selection: bool,
    /// At least one face is hidden.
    pub hidden: bool,
    /// There is a step to undo, or a drag to take back.
    pub undo: bool,
    /// There is a step to redo.
    pub redo: bool,
    /// A file is being read.
    pub loading: bool,
    /// Edges have been measured.
    pub inspection: bool,
    /// An edge with a gap between two sides is chosen.
    pub gap: bool,
    /// Triangles of a tessellation are shown.
    pub triangles: bool,
    /// There is something that no file holds.
    pub unsaved: bool,
    /// There is a face whose trims can be edited.
    pub face: bool,
    /// Loops of it of which something is selected.
    pub loops: usize,
    /// Curves of it of which something is selected.
    pub curves: usize,
    /// Selected control points of trim curves, those of selected curves and loops included.
    pub points: usize,
    /// Selected control points of the surface.
    pub surface_points: usize,
    /// Loops were copied.
    pub clipboard: bool,
}

impl Situation {
    /// A situation in which everything can be done.
    pub const ALL: Self = Self {
        model: true,
        selection: true,
        hidden: true,
        undo: true,
        redo: true,
        loading: true,
        inspection: true,
        gap: true,
        triangles: true,
        unsaved: true,
        face: true,
        loops: 1,
        curves: 1,
        points: 1,
        surface_points: 1,
        clipboard: true,
    };
}

/// The [`Situation`] of this frame.
#[derive(Resource, Debug, Default, Clone, Copy)]
pub struct CurrentSituation(pub Situation);

/// Looks at what is open, selected and hidden.
pub(super) fn observe(
    mut current: ResMut<CurrentSituation>,
    scene: Res<Scene>,
    selection: Res<Selection>,
    loading: Res<Loading>,
    findings: Res<Findings>,
    chosen: Res<Chosen>,
    settings: Res<Settings>,
    editing: Res<Editing>,
    active: Res<ActiveFace>,
    elements: Res<ElementSelection>,
    clipboard: Res<Clipboard>,
    shown: Query<&Shown>,
    mut changes: MessageReader<FaceChange>,
    mut seen: Local<u64>,
) {
    let switched = changes.read().any(|c| matches!(c, FaceChange::Shown(_)));
    let hidden = if *seen != scene.revision || switched {
        *seen = scene.revision;
        shown.iter().any(|s| !s.0)
    } else {
        current.0.hidden
    };
    let face = active.face.as_ref().filter(|f| elements.face == Some(f.entity));
    let loops = face.map_or(&[][..], |f| &f.record.loops);
    let elements = face.map(|_| &*elements);
    current.0 = Situation {
        model: !scene.is_empty(),
        selection: !selection.is_empty(),
        hidden,
        undo: editing.is_dragging() || editing.history().undo_count() > 0,
        redo: !editing.is_dragging() && editing.history().redo_count() > 0,
        loading: loading.is_active(),
        inspection: findings.inspection().is_some(),
        gap: chosen.edge.and_then(|key| findings.edge(&key)).is_some_and(can_close),
        triangles: settings.tessellation.replaces_surfaces(),
        unsaved: editing.is_unsaved(),
        face: face.is_some(),
        loops: elements.map_or(0, |e| e.loops().len()),
        curves: elements.map_or(0, |e| super::super::editing::curves_meant(e, loops).len()),
        points: elements.map_or(0, |e| e.points(loops).len()),
        surface_points: elements.map_or(0, |e| e.surface_points().len()),
        clipboard: !clipboard.0.is_empty(),
    };
}
