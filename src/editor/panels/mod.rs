//! Everything drawn with egui. Panels read state and write messages, nothing else.
//!
//! Wiring: one system, `show`, in the egui pass, after the theme. It builds bars, side panels and overlays
//! around and above the viewport, whose rectangle it leaves in [`Viewport`].

mod about;
mod command_palette;
pub(super) mod format;
mod help;
mod history;
pub(super) mod icon;
mod inspection;
mod lens;
mod menu;
mod notice;
mod problems;
mod progress;
mod prompt;
mod properties;
mod question;
mod report;
mod status;
mod tessellation;
mod toolbar;
mod tree;
mod tree_look;
mod tree_rows;
mod typing;
mod view_cube;

use bevy::ecs::query::QueryData;
use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::window::{PrimaryWindow, RequestRedraw};
use bevy_egui::{
    EguiContexts, EguiPostUpdateSet, EguiPreUpdateSet, EguiPrimaryContextPass, EguiRenderOutput, egui,
};

pub use notice::{Notice, Notices};

use super::camera::{CameraRequest, ViewCamera};
use super::derive::SceneBounds;
use super::diagnostics::{ProcessMemory, RenderFigures};
use super::document::{Answer, DocumentFile, Questions, SaveRequest, Saving, document_name};
use super::editing::{EditRequest, Editing, Prompt, RunEdit};
use super::elements::ElementRequest;
use super::files::{FileDialogs, Loading, OpenFiles, Picked};
use super::handles;
use super::object::{AuthoredFace, DerivedFace, FacePlace, Model, Part, Records, Scene, Shown};
use super::picking::{LeftButton, Picker};
use super::problems::ProblemList;
use super::selection::{SelectRequest, Selection, VisibilityRequest};
use super::settings::Settings;
use super::tessellation::TessellationRequest;
use super::theme::{self, Palette};
use super::tools::{Action, CommandRequest, CurrentSituation};
use super::uv::{self, UvParams};
use super::viewport::{Pointer, Viewport};

/// Adds the panels.
pub struct PanelsPlugin;

impl Plugin for PanelsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Notices>()
            .init_resource::<Palette>()
            .init_resource::<PanelState>()
            .add_systems(Update, (sheets, notice::expire).in_set(super::EditorSystems::Present))
            .add_systems(
                PreUpdate,
                typing::correct.after(EguiPreUpdateSet::ProcessInput).before(EguiPreUpdateSet::BeginPass),
            )
            .add_systems(EguiPrimaryContextPass, (theme::install, show).chain())
            .add_systems(
                PostUpdate,
                redraw_for_new_glyphs
                    .after(EguiPostUpdateSet::ProcessOutput)
                    .before(EguiPostUpdateSet::PostProcessOutput),
            );
    }
}

/// What panels remember from frame to frame.
#[derive(Resource, Default)]
pub struct PanelState {
    /// Whether the help sheet is open.
    pub help: bool,
    /// Whether the about box is open.
    pub about: bool,
    /// The model tree.
    pub(super) tree: tree::TreeState,
    /// The import report.
    pub(super) report: report::ReportState,
    /// The list of problems.
    pub(super) problems: problems::ProblemsState,
    /// The command palette.
    pub palette: command_palette::PaletteState,
}

/// What panels read of a face.
#[derive(QueryData)]
pub(super) struct FaceView {
    pub authored: &'static AuthoredFace,
    pub place: &'static FacePlace,
    pub shown: &'static Shown,
    pub derived: Option<&'static DerivedFace>,
}

/// State that panels read.
#[derive(SystemParam)]
pub(super) struct Reads<'w, 's> {
    pub settings: Res<'w, Settings>,
    pub palette: Res<'w, Palette>,
    pub scene: Res<'w, Scene>,
    pub situation: Res<'w, CurrentSituation>,
    pub loading: Res<'w, Loading>,
    pub editing: Res<'w, Editing>,
    pub file: Res<'w, DocumentFile>,
    pub saving: Res<'w, Saving>,
    pub problems: Res<'w, ProblemList>,
    pub bounds: Res<'w, SceneBounds>,
    pub picker: Res<'w, Picker>,
    pub pointer: Res<'w, Pointer>,
    pub left: Res<'w, LeftButton>,
    pub camera: Res<'w, ViewCamera>,
    pub figures: Res<'w, RenderFigures>,
    pub memory: Res<'w, ProcessMemory>,
    pub faces: Query<'w, 's, FaceView>,
    pub records: Records<'w, 's>,
    pub models: Query<'w, 's, &'static Model>,
    pub parts: Query<'w, 's, &'static Part>,
}

impl Reads<'_, '_> {
    /// The name of the document.
    pub fn document_name(&self) -> String {
        document_name(&self.file, &self.scene, |e| self.models.get(e).ok().map(|m| m.name.clone()))
    }
}

/// Messages that panels write.
#[derive(SystemParam)]
pub(super) struct Writes<'w> {
    pub commands: MessageWriter<'w, CommandRequest>,
    pub select: MessageWriter<'w, SelectRequest>,
    pub visibility: MessageWriter<'w, VisibilityRequest>,
    pub camera: MessageWriter<'w, CameraRequest>,
    pub open: MessageWriter<'w, OpenFiles>,
    pub save: MessageWriter<'w, SaveRequest>,
    pub edits: MessageWriter<'w, EditRequest>,
    pub elements: MessageWriter<'w, ElementRequest>,
    pub run: MessageWriter<'w, RunEdit>,
    pub answers: MessageWriter<'w, Answer>,
    pub redraw: MessageWriter<'w, RequestRedraw>,
}

/// State that panels own or share: their own memory, the hovered face, notices, the dialog.
#[derive(SystemParam)]
pub(super) struct Owned<'w> {
    pub state: ResMut<'w, PanelState>,
    pub selection: ResMut<'w, Selection>,
    pub notices: ResMut<'w, Notices>,
    pub dialogs: ResMut<'w, FileDialogs>,
    pub prompt: ResMut<'w, Prompt>,
    pub questions: Res<'w, Questions>,
    pub viewport: ResMut<'w, Viewport>,
}

/// Opens and closes sheets by command; Esc closes them before it clears the selection.
fn sheets(mut requests: MessageReader<CommandRequest>, mut state: ResMut<PanelState>) {
    for CommandRequest(action) in requests.read() {
        match action {
            Action::Shortcuts => state.help = !state.help,
            Action::About => state.about = !state.about,
            Action::Palette => state.palette.toggle(),
            Action::Find => state.tree.focus_search = true,
            _ => {}
        }
    }
}

/// Builds all panels.
fn show(
    mut contexts: EguiContexts,
    windows: Query<&Window, With<PrimaryWindow>>,
    reads: Reads,
    mut writes: Writes,
    mut owned: Owned,
    mut inspection: inspection::InspectionState,
    mut tessellation: tessellation::TessellationPanel,
    mut uv: UvParams,
) -> Result {
    let ctx = contexts.ctx_mut()?.clone();
    if !theme::is_ready(&ctx) {
        // Fonts set in this frame are there in the next.
        writes.redraw.write(RequestRedraw);
        return Ok(());
    }
    let mut root = egui::Ui::new(
        ctx.clone(),
        egui::Id::new("hairline"),
        egui::UiBuilder::new().layer_id(egui::LayerId::background()).max_rect(ctx.viewport_rect()),
    );
    menu::show(&mut root, &reads, &mut writes);
    toolbar::show(&mut root, &reads, &mut writes);
    status::show(&mut root, &reads, &owned.selection);
    if reads.settings.report {
        report::show(&mut root, &reads, &mut writes, &mut owned);
    }
    tessellation::show(&mut root, &reads, &mut writes, &mut tessellation);
    if reads.settings.inspection {
        inspection::show(&mut root, &reads, &mut writes, &mut inspection);
    }
    if reads.settings.problems {
        problems::show(&mut root, &reads, &mut writes, &mut owned);
    }
    if reads.settings.tree {
        tree::show(&mut root, &reads, &mut writes, &mut owned);
    }
    if reads.settings.properties {
        properties::show(&mut root, &reads, &owned.selection);
    }
    if reads.settings.history {
        history::show(&mut root, &reads, &mut writes);
    }
    uv::show(&mut root, &mut uv);
    let rect = root.available_rect_before_wrap();
    set_viewport(&mut owned.viewport, rect, windows.single().map_or(1.0, Window::scale_factor), &mut writes);
    handles::overlay::show(&root, rect, &reads.camera.now, &owned.viewport, uv.active(), &reads.palette);
    inspection::overlay(&root, rect, &reads, &owned.viewport, &inspection);
    tessellation::overlay(&root, rect, &reads, &owned.viewport, &tessellation, &inspection);
    view_cube::show(&root, rect, &reads, &mut writes);
    let read_back = (&*inspection.picture, &*inspection.holes);
    lens::show(&root, rect, &reads, (&owned.viewport, &reads.pointer), read_back);
    progress::show(&ctx, rect, &reads, &mut writes);
    let beside_legend = inspection::beside_legend(rect, &reads, &inspection);
    let beside_legend = tessellation::beside_legend(beside_legend, &reads, &tessellation);
    notice::show(&ctx, beside_legend, &reads.palette, &mut owned.notices);
    help::show(&ctx, &reads.palette, &mut owned.state.help);
    about::show(&ctx, &reads.palette, &mut owned.state.about);
    command_palette::show(&ctx, &reads, &mut owned.state.palette, &mut writes);
    prompt::show(&ctx, &reads.palette, &mut owned.prompt, &mut writes);
    question::show(&ctx, &reads, &owned.questions, &mut writes);
    owned.dialogs.dialog.update(&ctx);
    if let Some(picked) = owned.dialogs.take_picked() {
        match picked {
            Picked::Open(files) => drop(writes.open.write(files)),
            Picked::Save(request) => drop(writes.save.write(request)),
            Picked::Mesh(path) => drop(tessellation.requests.write(TessellationRequest::Export(path))),
        }
        writes.redraw.write(RequestRedraw);
    }
    Ok(())
}

fn set_viewport(viewport: &mut ResMut<Viewport>, rect: egui::Rect, scale_factor: f32, writes: &mut Writes) {
    let now = Viewport {
        min: Vec2::new(rect.min.x, rect.min.y),
        size: Vec2::new(rect.width().max(1.0), rect.height().max(1.0)),
        scale_factor,
    };
    if viewport.set_if_neq(now) {
        // The picture follows in the next frame.
        writes.redraw.write(RequestRedraw);
    }
}

/// The frame of sheets above everything.
fn sheet_frame(palette: &Palette) -> egui::Frame {
    egui::Frame::new()
        .fill(palette.raised)
        .stroke(egui::Stroke::new(1.0, palette.line))
        .corner_radius(10)
        .inner_margin(egui::Margin::symmetric(24, 20))
}

/// Glyphs drawn for the first time reach the screen one frame late: draw that frame.
fn redraw_for_new_glyphs(outputs: Query<&EguiRenderOutput>, mut redraw: MessageWriter<RequestRedraw>) {
    if outputs.iter().any(|output| !output.textures_delta.set.is_empty()) {
        redraw.write(RequestRedraw);
    }
}
