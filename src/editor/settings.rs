//! What the user chose: display mode, theme, panels, projection. Kept between runs.

use std::path::PathBuf;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use super::EditorSystems;
use super::tessellation::TessellationChoices;
use super::tools::{Action, CommandRequest};
use crate::encoding::Conceal;

/// How surfaces are coloured.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DisplayMode {
    /// Lit, in the face's own colour.
    #[default]
    Shaded,
    /// Lit, each face in a colour of its own.
    Faces,
    /// By normalised parameters (P1, figure 10).
    Uv,
    /// By the number of curve evaluations (P1, figure 9).
    Heat,
    /// Lit, trimmed-away regions shown too.
    Untrimmed,
}

/// How surfaces become pixels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Surfaces {
    /// Rays; triangles while the view moves and rays would have to be coarse.
    #[default]
    Auto,
    /// Rays at the exact surfaces only.
    Rays,
    /// Triangles only, trimmed exactly.
    Triangles,
}

impl DisplayMode {
    /// All modes in the order of menu and toolbar.
    pub const ALL: [Self; 5] = [Self::Shaded, Self::Faces, Self::Uv, Self::Heat, Self::Untrimmed];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaded => "shaded",
            Self::Faces => "faces",
            Self::Uv => "uv",
            Self::Heat => "heat",
            Self::Untrimmed => "untrimmed",
        }
    }
}

/// What of the active face is shown as handles in the 3D view.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Handles {
    /// Nothing.
    #[default]
    None,
    /// Its trim curves with their control points.
    Curves,
    /// The control net of its surface.
    Surface,
}

/// How pin holes are marked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HoleMarks {
    /// Rings around them.
    #[default]
    Rings,
    /// Rings that blink.
    Blinking,
    /// Squares over them, larger than they are.
    Dilated,
}

/// How much the magnifier enlarges, one after the other.
pub const LENS_ZOOMS: [u32; 3] = [8, 16, 4];

/// The user's choices.
#[derive(Resource, Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// How surfaces are coloured. Not kept between runs: it is about the model, not the user.
    #[serde(skip)]
    pub mode: DisplayMode,
    /// What is done about pin holes. Not kept either.
    #[serde(skip)]
    pub holes: Conceal,
    /// Whether pin holes are marked while edges are inspected.
    pub pin_holes: bool,
    /// How they are marked.
    pub hole_marks: HoleMarks,
    /// Whether they are looked for while the view moves too, which takes rays. Not kept.
    #[serde(skip)]
    pub holes_moving: bool,
    /// Whether a magnifier follows the pointer. Not kept.
    #[serde(skip)]
    pub lens: bool,
    /// How much it enlarges.
    pub lens_zoom: u32,
    /// How surfaces become pixels.
    pub surfaces: Surfaces,
    /// Whether edges are drawn.
    pub edges: bool,
    /// Whether the ground grid is drawn.
    pub grid: bool,
    /// Light theme instead of the dark one.
    pub light: bool,
    /// Central instead of parallel projection.
    pub perspective: bool,
    /// Whether the model tree is shown.
    pub tree: bool,
    /// Whether the properties are shown.
    pub properties: bool,
    /// Whether the import report is shown.
    pub report: bool,
    /// Whether the history is shown.
    pub history: bool,
    /// Whether the list of problems is shown.
    pub problems: bool,
    /// Seconds after a change after which a copy is kept to recover from; 0 keeps none.
    pub autosave_s: u32,
    /// Whether edges are inspected. Not kept between runs: measuring a large model takes a while.
    #[serde(skip)]
    pub inspection: bool,
    /// Whether the uv panel is shown.
    pub uv: bool,
    /// Whether the uv panel is beside the viewport instead of below it.
    pub uv_beside: bool,
    /// What can be dragged in the 3D view.
    #[serde(skip)]
    pub handles: Handles,
    /// What is shown of the tessellation, and how it is made.
    pub tessellation: TessellationChoices,
    /// Files opened lately, latest first.
    pub recent: Vec<PathBuf>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            mode: DisplayMode::Shaded,
            holes: Conceal::Raw,
            pin_holes: true,
            hole_marks: HoleMarks::Rings,
            holes_moving: false,
            lens: false,
            lens_zoom: LENS_ZOOMS[0],
            surfaces: Surfaces::Auto,
            edges: true,
            grid: true,
            light: false,
            perspective: true,
            tree: true,
            properties: true,
            report: false,
            history: false,
            problems: false,
            autosave_s: 20,
            inspection: false,
            uv: false,
            uv_beside: false,
            handles: Handles::None,
            tessellation: TessellationChoices::default(),
            recent: Vec::new(),
        }
    }
}

/// Adds the settings and the commands that switch them.
pub struct SettingsPlugin;

impl Plugin for SettingsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Settings>().add_systems(Update, switch.in_set(EditorSystems::Tools));
    }
}

/// Switches from the command table. The projection follows the camera, see `camera`.
fn switch(mut requests: MessageReader<CommandRequest>, mut settings: ResMut<Settings>) {
    for CommandRequest(action) in requests.read() {
        let on = match action {
            Action::Display(mode) => {
                settings.mode = *mode;
                continue;
            }
            Action::Holes(holes) => {
                settings.holes = *holes;
                // Fat lines are as wide as the gaps that were measured.
                settings.inspection |= *holes != Conceal::Raw;
                continue;
            }
            Action::Surfaces(surfaces) => {
                settings.surfaces = *surfaces;
                continue;
            }
            Action::Autosave(seconds) => {
                settings.autosave_s = *seconds;
                continue;
            }
            Action::HoleMarks(marks) => {
                settings.hole_marks = *marks;
                settings.pin_holes = true;
                continue;
            }
            Action::LensZoom => {
                let at = LENS_ZOOMS.iter().position(|zoom| *zoom == settings.lens_zoom);
                settings.lens_zoom = LENS_ZOOMS[at.map_or(0, |k| (k + 1) % LENS_ZOOMS.len())];
                continue;
            }
            Action::ToggleLens => &mut settings.lens,
            Action::ToggleMovingHoles => &mut settings.holes_moving,
            Action::ToggleEdges => &mut settings.edges,
            Action::ToggleGrid => &mut settings.grid,
            Action::ToggleTheme => &mut settings.light,
            Action::ToggleTree => &mut settings.tree,
            Action::ToggleProperties => &mut settings.properties,
            Action::ToggleReport => &mut settings.report,
            Action::ToggleHistory => &mut settings.history,
            Action::ToggleProblems => &mut settings.problems,
            Action::TogglePinHoles => &mut settings.pin_holes,
            Action::ToggleInspection => &mut settings.inspection,
            Action::ToggleUv => &mut settings.uv,
            Action::ToggleUvSide => &mut settings.uv_beside,
            Action::Handles(handles) => {
                settings.handles = if settings.handles == *handles { Handles::None } else { *handles };
                continue;
            }
            Action::Find => {
                settings.tree = true;
                continue;
            }
            _ => continue,
        };
        *on = !*on;
    }
}
