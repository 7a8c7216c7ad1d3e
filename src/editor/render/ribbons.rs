//! The edges of the inspection as ribbons in the render world, for fat lines.

use bevy::prelude::*;
use bevy::render::Extract;

use super::faces::RenderFaces;
use crate::editor::inspection::Findings;
use crate::editor::settings::Settings;
use crate::encoding::{Conceal, RibbonScene};
use crate::inspect;

/// Packed edges.
#[derive(Resource, Default)]
pub(super) struct RenderRibbons {
    pub scene: RibbonScene,
    /// What they were made of: revision of the findings, and of the faces.
    made_of: Option<(u64, u64)>,
    /// Counts changes.
    pub revision: u64,
}

impl RenderRibbons {
    /// Whether there is anything to draw.
    pub fn is_ready(&self) -> bool {
        self.made_of.is_some()
    }
}

/// Packs the edges anew when they or the faces changed, while fat lines are wanted.
pub(super) fn extract(
    mut ribbons: ResMut<RenderRibbons>,
    faces: Res<RenderFaces>,
    findings: Extract<Res<Findings>>,
    settings: Extract<Res<Settings>>,
) {
    if settings.holes == Conceal::Raw || faces.is_waiting() {
        return;
    }
    let key = (findings.revision, faces.geometry);
    if ribbons.made_of == Some(key) {
        return;
    }
    let Some(inspection) = findings.inspection() else {
        ribbons.made_of = None;
        return;
    };
    let face = |number: usize| faces.packed_face(findings.face(number)?);
    ribbons.scene = inspect::ribbons(inspection, &face);
    ribbons.made_of = Some(key);
    ribbons.revision += 1;
}
