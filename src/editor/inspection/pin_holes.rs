//! The pin holes of the picture: what was proved in it, how it is marked, and which mark a click meets.

use std::collections::BTreeMap;

use bevy::prelude::*;
use bevy::window::RequestRedraw;

use super::InspectRequest;
use crate::editor::camera::ViewCamera;
use crate::editor::camera::motion::project;
use crate::editor::picking::{Picker, ViewportClick};
use crate::editor::redraw::Waker;
use crate::editor::settings::{HoleMarks, Settings};
use crate::editor::viewport::Viewport;
use crate::inspect::{EdgeKey, HoleClass, PinHole};
use crate::kernel::view::Camera as ViewPoint;

/// How far from a mark a click still means it, logical pixels.
const CLICK_PX: f32 = 7.0;
/// Half a period of blinking.
const BLINK: std::time::Duration = std::time::Duration::from_millis(450);

/// Pin holes that were proved in the last picture looked at.
#[derive(Resource, Debug, Clone, Default)]
pub struct PinHoles {
    /// By rows of the picture.
    pub holes: Vec<PinHole>,
    /// Size of the picture, pixels.
    pub size: UVec2,
    /// The view it was of.
    pub camera: Option<ViewPoint>,
    /// Whether faces changed since.
    pub outdated: bool,
    /// Whether the marks are lit, when they blink.
    pub lit: bool,
    /// The holes by edge, most pixels first.
    pub groups: Vec<HoleGroup>,
}

/// The pin holes of one class between the sides of one edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoleGroup {
    /// The edge.
    pub edge: EdgeKey,
    /// The faces on both sides, by their numbers in the inspection.
    pub faces: [usize; 2],
    /// Why one sees through.
    pub class: HoleClass,
    /// How many pixels.
    pub pixels: usize,
    /// Largest distance of the sides at any of them, model units.
    pub gap: f64,
}

impl PinHoles {
    /// Takes the holes of a picture.
    pub fn set(&mut self, holes: Vec<PinHole>, size: UVec2, camera: ViewPoint) {
        let mut groups: BTreeMap<(EdgeKey, HoleClass, [usize; 2]), (usize, f64)> = BTreeMap::new();
        for hole in &holes {
            let group = groups.entry((hole.edge, hole.class, hole.faces)).or_default();
            *group = (group.0 + 1, group.1.max(hole.gap));
        }
        let group = |((edge, class, faces), (pixels, gap))| HoleGroup { edge, faces, class, pixels, gap };
        self.groups = groups.into_iter().map(group).collect();
        self.groups.sort_by_key(|group| std::cmp::Reverse(group.pixels));
        (self.holes, self.size, self.camera) = (holes, size, Some(camera));
        self.outdated = false;
    }

    /// The holes, if they are of this view of the faces as they are.
    pub fn of(&self, camera: &ViewPoint) -> Option<&[PinHole]> {
        (self.camera.as_ref() == Some(camera) && !self.outdated).then_some(self.holes.as_slice())
    }

    /// How many are of a class.
    pub fn count(&self, class: HoleClass) -> usize {
        self.holes.iter().filter(|h| h.class == class).count()
    }

    /// The holes with where they are in the window, logical pixels. In another view than theirs, when `moving`, they are
    /// where their edges are.
    pub fn places<'a>(
        &'a self,
        camera: &'a ViewPoint,
        viewport: &'a Viewport,
        moving: bool,
    ) -> impl Iterator<Item = (&'a PinHole, Vec2)> {
        let same = self.of(camera).is_some();
        let shown = if same || moving { self.holes.as_slice() } else { &[] };
        shown.iter().filter_map(move |hole| {
            if same {
                let at = (UVec2::from(hole.pixel).as_vec2() + 0.5) / self.size.max(UVec2::ONE).as_vec2();
                return Some((hole, viewport.min + at * viewport.size));
            }
            let (ndc, _) = project(camera, hole.point, viewport.aspect())?;
            (ndc.abs().max_element() <= 1.0).then(|| (hole, viewport.position(ndc)))
        })
    }
}

/// Whether holes are looked for and marked: not in pictures of triangles.
pub fn are_marked(settings: &Settings) -> bool {
    settings.pin_holes && settings.inspection && !settings.tessellation.replaces_surfaces()
}

/// A click on a mark chooses the edge, and not the face behind it.
pub(super) fn click(
    mut clicks: MessageReader<ViewportClick>,
    settings: Res<Settings>,
    holes: Res<PinHoles>,
    camera: Res<ViewCamera>,
    viewport: Res<Viewport>,
    mut picker: ResMut<Picker>,
    mut requests: MessageWriter<InspectRequest>,
) {
    for ViewportClick { position } in clicks.read() {
        if !are_marked(&settings) {
            continue;
        }
        let near = holes
            .places(&camera.now, &viewport, settings.holes_moving)
            .map(|(hole, at)| (hole, at.distance(*position)))
            .filter(|(_, distance)| *distance <= CLICK_PX)
            .min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((hole, _)) = near {
            picker.drop_click();
            requests.write(InspectRequest::Choose { edge: hole.edge, fly: false });
        }
    }
}

/// Switches the marks on and off where they are to blink. Draws nothing where there are none.
pub(super) fn blink(
    mut holes: ResMut<PinHoles>,
    settings: Res<Settings>,
    time: Res<Time<Real>>,
    waker: Res<Waker>,
    mut redraw: MessageWriter<RequestRedraw>,
) {
    let blinks =
        settings.hole_marks == HoleMarks::Blinking && are_marked(&settings) && !holes.holes.is_empty();
    let lit = !blinks || (time.elapsed().as_millis() / BLINK.as_millis()) % 2 == 0;
    if holes.lit != lit {
        holes.lit = lit;
        redraw.write(RequestRedraw);
    }
    if blinks {
        waker.wake_after(BLINK);
    }
}
