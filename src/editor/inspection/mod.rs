//! Inspection live: gaps and naked edges of everything open, measured again as faces change.
//!
//! Wiring: while the inspection is on, `follow` measures in the background after something was opened, and in the
//! same frame after an edit (only edges of changed faces); `choose` serves the tour (next and previous defect) and
//! flies to the edge chosen; `mend` closes its gap; `probe` measures at the pointer. Panels show [`Findings`] through [`Rows`];
//! `render` draws [`EdgeLines`] in the colours of [`ramp`].
//!
//! Faces are numbered here through all models, in the order of the scene: [`Findings::face`] finds the entity.

mod choose;
mod findings;
mod follow;
mod lines;
mod mend;
mod picture;
mod pin_holes;
mod probe;
pub mod ramp;
mod rows;

use bevy::prelude::*;

pub use choose::{Chosen, InspectRequest};
pub use findings::{Findings, Progress};
pub use lines::{EdgeLine, EdgeLines};
pub use mend::{CloseGap, MendChoices, MendOutcome, can_close};
pub use picture::{LatestPicture, Picture};
pub use pin_holes::{HoleGroup, PinHoles, are_marked};
pub use probe::{Probe, local_gap};
pub use rows::{Column, Filter, Order, Row, Rows};

use super::EditorSystems;
use super::picking::ClickTargets;

/// The user's choices about the inspection.
#[derive(Resource, Debug, Clone, PartialEq)]
pub struct InspectionChoices {
    /// Gaps above this are defects, millimetres.
    pub tolerance: f64,
    /// Which edges the table shows.
    pub filter: Filter,
    /// How it is sorted.
    pub order: Order,
    /// Whether edges are drawn in the colours of their gaps.
    pub colours: bool,
}

impl Default for InspectionChoices {
    fn default() -> Self {
        Self { tolerance: 0.01, filter: Filter::default(), order: Order::default(), colours: true }
    }
}

/// Adds the inspection.
pub struct InspectionPlugin;

impl Plugin for InspectionPlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<InspectRequest>()
            .add_message::<CloseGap>()
            .init_resource::<MendChoices>()
            .init_resource::<MendOutcome>()
            .init_resource::<InspectionChoices>()
            .init_resource::<Findings>()
            .init_resource::<Rows>()
            .init_resource::<PinHoles>()
            .init_resource::<LatestPicture>()
            .init_resource::<EdgeLines>()
            .init_resource::<Chosen>()
            .init_resource::<Probe>()
            .add_systems(Update, (choose::command_requests, mend::serve).in_set(EditorSystems::Tools))
            .add_systems(
                Update,
                (pin_holes::click.in_set(ClickTargets), pin_holes::blink).in_set(EditorSystems::Tools),
            )
            .add_systems(
                Update,
                (
                    follow::measure,
                    mend::report,
                    rows::update,
                    choose::serve,
                    lines::update,
                    probe::at_pointer,
                )
                    .chain()
                    .after(EditorSystems::Derive)
                    .before(EditorSystems::Present),
            );
    }
}
