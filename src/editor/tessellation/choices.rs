//! What the user chose about the tessellation, and the options that follow from it.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::editor::settings::Settings;
use crate::editor::tools::{Action, CommandRequest};
use crate::inspect::Length;
use crate::kernel::tessellate::TessellationOptions;

/// How the tessellation is shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum TessellationView {
    /// Not at all, and none is made.
    #[default]
    Off,
    /// Its triangles in place of the exact surfaces.
    Overlay,
    /// Its edges over the exact surfaces.
    Wireframe,
    /// The exact surfaces to the left of a divider, its triangles to the right.
    Wipe,
    /// Its triangles in the colours of their distance from the exact surfaces.
    Error,
}

impl TessellationView {
    /// All that show something, in the order of the menu.
    pub const SHOWN: [Self; 4] = [Self::Overlay, Self::Wireframe, Self::Wipe, Self::Error];
}

/// The user's choices. What is shown is not kept between runs: meshing a large model takes a while.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct TessellationChoices {
    /// How it is shown.
    #[serde(skip)]
    pub view: TessellationView,
    /// Largest distance from the exact surfaces, millimetres; none: by the size of the model.
    pub tolerance_mm: Option<f64>,
    /// Largest angle between normals within a triangle, degrees.
    pub angle_deg: Option<f64>,
    /// Whether the tolerance is guaranteed, not estimated.
    pub conservative: bool,
    /// Whether edges of triangles are drawn in the overlay and the heat map.
    pub edges: bool,
    /// Whether they are in the wipe.
    pub wipe_edges: bool,
    /// Whether triangles are flat, not lit with the normals of the surface.
    pub facets: bool,
    /// Where the divider is, as a share of the width of the viewport.
    pub wipe: f32,
}

impl Default for TessellationChoices {
    fn default() -> Self {
        Self {
            view: TessellationView::Off,
            tolerance_mm: None,
            angle_deg: None,
            conservative: true,
            edges: true,
            wipe_edges: false,
            facets: false,
            wipe: 0.5,
        }
    }
}

/// The automatic tolerance as a part of the model's size.
const AUTOMATIC: f64 = 1e-3;
/// Smaller tolerances than this part of the model's size drown in rounding.
const FINEST: f64 = 1e-9;
/// Larger ones than this part of it leave no shape.
const COARSEST: f64 = 0.1;
/// Angles that make sense, degrees.
const ANGLES: std::ops::RangeInclusive<f64> = 0.5..=90.0;

/// A tolerance that is no use for a model.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "{} is below what numbers can tell apart on a model of {}; use {} or more",
    Length { mm: *tolerance_mm }, Length { mm: *size_mm }, Length { mm: FINEST * size_mm }
)]
pub struct BadTolerance {
    /// What was asked for.
    pub tolerance_mm: f64,
    /// Diagonal of the model.
    pub size_mm: f64,
}

/// The tolerance of which a model of `size_mm` gets about a thousandth: a number with two digits.
pub fn automatic_tolerance(size_mm: f64) -> f64 {
    let wanted = AUTOMATIC * size_mm;
    if !(wanted.is_finite() && wanted > 0.0) {
        return AUTOMATIC;
    }
    let digit = 10f64.powf(wanted.log10().floor() - 1.0);
    (wanted / digit).round() * digit
}

impl TessellationChoices {
    /// The tolerance for a model of `size_mm`, millimetres: what was chosen, cut to what leaves a shape.
    pub fn tolerance(&self, size_mm: f64) -> f64 {
        let chosen = self.tolerance_mm.filter(|mm| mm.is_finite() && *mm > 0.0);
        let tolerance = chosen.unwrap_or_else(|| automatic_tolerance(size_mm));
        if size_mm > 0.0 { tolerance.min(COARSEST * size_mm) } else { tolerance }
    }

    /// The options for a model of `size_mm` whose unit is `unit_mm`, both in millimetres.
    ///
    /// # Errors
    /// The tolerance is below the precision of the model's numbers.
    pub fn options(
        &self,
        size_mm: f64,
        unit_mm: f64,
        triangle_limit: usize,
    ) -> Result<TessellationOptions, BadTolerance> {
        let tolerance_mm = self.tolerance(size_mm);
        if tolerance_mm < FINEST * size_mm {
            return Err(BadTolerance { tolerance_mm, size_mm });
        }
        let angle = self.angle_deg.filter(|a| a.is_finite());
        Ok(TessellationOptions {
            conservative: self.conservative,
            max_angle: angle.map(|a| a.clamp(*ANGLES.start(), *ANGLES.end()).to_radians()),
            triangle_limit,
            ..TessellationOptions::new(tolerance_mm / unit_mm)
        })
    }

    /// Whether triangles are in the place of exact surfaces, somewhere in the picture.
    pub fn replaces_surfaces(&self) -> bool {
        !matches!(self.view, TessellationView::Off | TessellationView::Wireframe)
    }

    /// Whether edges of triangles are drawn.
    pub fn shows_edges(&self) -> bool {
        match self.view {
            TessellationView::Off => false,
            TessellationView::Wireframe => true,
            TessellationView::Wipe => self.wipe_edges,
            TessellationView::Overlay | TessellationView::Error => self.edges,
        }
    }
}

/// Commands of the table that change the choices.
pub(super) fn command_requests(mut requests: MessageReader<CommandRequest>, mut settings: ResMut<Settings>) {
    for CommandRequest(action) in requests.read() {
        match action {
            Action::Tessellation(view) => {
                let now = settings.tessellation.view;
                // The same key again goes back to the exact picture.
                settings.tessellation.view = if now == *view { TessellationView::Off } else { *view };
            }
            Action::ToggleTriangleEdges => {
                let choices = &mut settings.tessellation;
                let edges = match choices.view {
                    TessellationView::Wipe => &mut choices.wipe_edges,
                    _ => &mut choices.edges,
                };
                *edges = !*edges;
            }
            // What is exported is seen first: how many triangles, and how far off.
            Action::ExportMesh if settings.tessellation.view == TessellationView::Off => {
                settings.tessellation.view = TessellationView::Overlay;
            }
            Action::ToggleFacets => settings.tessellation.facets = !settings.tessellation.facets,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_fit_the_model() {
        assert_eq!(automatic_tolerance(100.0), 0.1);
        assert!((automatic_tolerance(1234.5) - 1.2).abs() < 1e-12);
        let automatic = TessellationChoices::default();
        assert!((automatic.tolerance(987.0) - 0.99).abs() < 1e-12);
        for nothing in [0.0, f64::NAN, f64::INFINITY] {
            assert!(automatic.tolerance(nothing) > 0.0);
        }
        let chosen = |mm| TessellationChoices { tolerance_mm: Some(mm), ..TessellationChoices::default() };
        assert_eq!(chosen(0.02).tolerance(100.0), 0.02);
        assert_eq!(chosen(1e9).tolerance(100.0), 10.0, "no shape is left of a larger one");
        assert_eq!(chosen(-1.0).tolerance(100.0), 0.1, "from a spoiled file");
        let bad = chosen(1e-9).options(100.0, 1.0, 1000).expect_err("too fine");
        assert!(bad.to_string().contains("below what numbers can tell apart"), "{bad}");
        let inches = chosen(2.54).options(1000.0, 25.4, 1000).expect("fine");
        assert!((inches.tolerance - 0.1).abs() < 1e-12 && inches.check().is_ok());
    }
}
