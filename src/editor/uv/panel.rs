//! The state of the uv panel: what it shows, where, and what the mouse is doing in it.

use bevy::prelude::*;
use bevy_egui::egui;
use glam::DVec2;

use super::fields::FieldDrag;
use super::gesture::Gesture;
use super::hit::{ShownPoints, UvHit};
use super::snap::{SnapSettings, Snapped};
use super::tool::Tool;
use super::view::{UvView, natural_stretch};
use crate::editor::elements::{ElementSelection, FaceInHand};
use crate::kernel::trim::UvRect;

/// Which trimming structure is drawn over the face (P1, figures 7 to 9).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Overlay {
    /// None.
    #[default]
    None,
    /// P1's v- and u-intervals.
    Intervals,
    /// Cells of the parity grid with the number of curves in their lists.
    Grid,
}

/// The uv panel.
#[derive(Resource, Debug, Default)]
pub struct UvPanel {
    /// What the canvas shows.
    pub view: UvView,
    /// Whether the canvas is on the screen.
    pub open: bool,
    /// Position of the pointer in the window while it is over the canvas or drags in it.
    pub pointer: Option<DVec2>,
    /// What is under the pointer.
    pub hit: Option<UvHit>,
    /// The tool in hand.
    pub tool: Tool,
    /// What the mouse is doing.
    pub gesture: Gesture,
    /// What dragging snaps to.
    pub snapping: SnapSettings,
    /// What the point being dragged or placed is snapped to now.
    pub snapped: Option<Snapped>,
    /// The trimming structure to draw.
    pub overlay: Overlay,
    /// Whose control points are shown.
    pub shown: ShownPoints,
    /// Where a context menu is to be opened, window position.
    pub menu_at: Option<DVec2>,
    /// Where the open context menu is.
    pub(super) menu_place: egui::Pos2,
    /// What it was opened on.
    pub(super) menu_hit: Option<UvHit>,
    /// What a button wants the view to show.
    pub(super) wanted_fit: Fit,
    /// Whether a value is being dragged in a field.
    pub(super) field: FieldDrag,
    /// The face that the view was fitted to.
    fitted: Option<Entity>,
}

/// What the view is to show.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Fit {
    /// What it shows already.
    #[default]
    Stay,
    /// Everything.
    All,
    /// What is selected.
    Selection,
}

impl UvPanel {
    /// Takes over where the canvas is. Whether that is news.
    pub fn place(&mut self, min_px: DVec2, size_px: DVec2) -> bool {
        let news = !self.open || self.view.min_px != min_px || self.view.size_px != size_px;
        if self.open && news && self.view.size_px.min_element() > 1.0 {
            // What was in the middle stays there; growing shows more.
            let ratio = (size_px / self.view.size_px).min_element();
            if self.view.size_px != size_px && ratio.is_finite() && ratio > 0.0 {
                self.view.scale *= ratio;
            }
        } else if news {
            self.fitted = None;
        }
        (self.view.min_px, self.view.size_px, self.open) = (min_px, size_px, true);
        news
    }

    /// Fits the view to a face that it has not shown before.
    pub fn attend(&mut self, face: Option<&FaceInHand>) {
        let entity = face.map(|f| f.entity);
        if !self.open || self.fitted == entity {
            return;
        }
        self.fitted = entity;
        self.hit = None;
        if let Some(face) = face {
            self.fit(face);
        }
    }

    /// Shows the whole domain and all loops of `face`, in the proportions that it has in space.
    pub fn fit(&mut self, face: &FaceInHand) {
        let domain = UvRect::of_surface(&face.surface);
        let mut rect = domain;
        let points = face.loops.iter().flat_map(|l| &l.curves).flat_map(|c| c.points());
        points.for_each(|p| rect.include(*p));
        let own = face.derived.as_ref().and_then(|d| d.face.as_ref()).map(|f| f.domain);
        // A small face on a huge surface: the face, with some of what is around it.
        if let Some(own) = own.filter(|own| (own.size() / rect.size()).min_element() < 0.2) {
            let room = 0.15 * own.size().max_element();
            let rect = UvRect { min: own.min - room, max: own.max + room };
            return self.view.fit(&rect, natural_stretch(&face.surface, &own));
        }
        self.view.fit(&rect, natural_stretch(&face.surface, &domain));
    }

    /// Shows what is selected of `face`; everything when nothing is.
    pub fn fit_selection(&mut self, face: &FaceInHand, selection: &ElementSelection) {
        let mut rect = UvRect::EMPTY;
        let points = selection.points(&face.loops);
        points.iter().filter_map(|p| face.point(*p)).for_each(|p| rect.include(p));
        if points.is_empty() { self.fit(face) } else { self.view.look_at(&rect) }
    }

    /// Forgets a drag that has ended elsewhere.
    pub(super) fn drop_drag(&mut self) {
        self.field = FieldDrag::None;
        if matches!(self.gesture, Gesture::Drag(_)) {
            (self.gesture, self.snapped) = (Gesture::None, None);
        }
    }

    /// Parameters under the pointer.
    pub fn pointer_uv(&self) -> Option<DVec2> {
        self.pointer.map(|p| self.view.to_uv(p))
    }

    /// Whether a drag or a drawing is under way: Esc ends it before anything else.
    pub fn is_busy(&self) -> bool {
        !matches!(self.gesture, Gesture::None)
    }
}
