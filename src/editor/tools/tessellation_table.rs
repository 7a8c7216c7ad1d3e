//! The rows of the command table about the tessellation.

use bevy::input::keyboard::KeyCode;

use super::command::Menu::Tessellation;
use super::command::{Action, Command, command};
use super::key::Shortcut;
use super::situation::Situation;
use crate::editor::tessellation::TessellationView;

const fn with_model(s: &Situation) -> bool {
    s.model
}
const fn with_triangles(s: &Situation) -> bool {
    s.triangles
}

const fn code(code: KeyCode) -> Shortcut {
    Shortcut::code(code)
}
const fn key(c: char) -> Shortcut {
    Shortcut::char(c)
}

/// The rows, in menu order.
pub(super) const ROWS: &[Command] = &[
    command(
        Tessellation,
        Action::Tessellation(TessellationView::Overlay),
        "tessellation.overlay",
        "Triangles",
        &[code(KeyCode::F5).shift()],
    )
    .checked(|s| s.tessellation.view == TessellationView::Overlay)
    .when(with_model),
    command(
        Tessellation,
        Action::Tessellation(TessellationView::Wireframe),
        "tessellation.wireframe",
        "Wireframe over exact surfaces",
        &[code(KeyCode::F6).shift()],
    )
    .checked(|s| s.tessellation.view == TessellationView::Wireframe)
    .when(with_model),
    command(
        Tessellation,
        Action::Tessellation(TessellationView::Wipe),
        "tessellation.wipe",
        "Wipe between exact and triangles",
        &[code(KeyCode::F7).shift()],
    )
    .checked(|s| s.tessellation.view == TessellationView::Wipe)
    .when(with_model),
    command(
        Tessellation,
        Action::Tessellation(TessellationView::Error),
        "tessellation.error",
        "Error heat map",
        &[code(KeyCode::F8).shift()],
    )
    .checked(|s| s.tessellation.view == TessellationView::Error)
    .when(with_model),
    command(
        Tessellation,
        Action::Tessellation(TessellationView::Off),
        "tessellation.off",
        "Off",
        &[code(KeyCode::F9).shift()],
    )
    .checked(|s| s.tessellation.view == TessellationView::Off),
    command(
        Tessellation,
        Action::ToggleTriangleEdges,
        "tessellation.edges",
        "Edges of triangles",
        &[key('e').alt()],
    )
    .separated()
    .checked(|s| s.tessellation.shows_edges())
    .when(with_triangles),
    command(Tessellation, Action::ToggleFacets, "tessellation.facets", "Flat triangles", &[key('f').alt()])
        .checked(|s| s.tessellation.facets)
        .when(with_triangles),
    command(
        Tessellation,
        Action::ExportMesh,
        "tessellation.export",
        "Export mesh\u{2026}",
        &[key('e').ctrl().shift()],
    )
    .separated()
    .when(with_model),
];
