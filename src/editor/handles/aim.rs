//! What handle is under the pointer in the 3D view.

use bevy::prelude::Vec2;
use glam::{DVec2, DVec3};

use super::shapes::{HandleShapes, MOST_POINTS};
use crate::editor::camera::clip::ClipView;
use crate::editor::elements::{Element, ElementSelection};
use crate::editor::viewport::Viewport;
use crate::kernel::view::Camera;

/// Reach of points, logical pixels.
const POINT_REACH_PX: f32 = 9.0;
/// Reach of curves, logical pixels.
const CURVE_REACH_PX: f32 = 6.0;
/// Of points within reach, one this much nearer to the pointer wins; else the one nearer to the eye.
const CLEARLY_PX: f32 = 2.5;

/// A handle under the pointer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aimed {
    /// What it is.
    pub element: Element,
    /// The place on it, in space.
    pub place: DVec3,
}

/// The window as seen by handles.
pub struct Lens<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// Its projection.
    pub clip: ClipView,
    /// The viewport.
    pub viewport: &'a Viewport,
}

impl<'a> Lens<'a> {
    /// The window of a camera.
    pub fn new(camera: &'a Camera, viewport: &'a Viewport) -> Self {
        let bounds = crate::kernel::view::Bounds::EMPTY;
        Self { camera, clip: ClipView::of(camera, viewport.aspect(), &bounds), viewport }
    }

    /// Window position of a point, logical pixels, and its distance along the line of sight.
    pub fn project(&self, point: DVec3) -> Option<(Vec2, f64)> {
        let ndc = self.clip.project(self.camera, point)?;
        let (_, _, back) = self.camera.axes();
        let position = self.viewport.position(DVec2::new(ndc.x, ndc.y));
        position.is_finite().then_some((position, (self.camera.eye - point).dot(back)))
    }
}

/// The handle at a window position: points before curves.
pub fn at(position: Vec2, shapes: &HandleShapes, lens: &Lens, selection: &ElementSelection) -> Option<Aimed> {
    let points = !shapes.passive;
    let point = points.then(|| point_at(position, shapes, lens, selection)).flatten();
    point.or_else(|| curve_at(position, shapes, lens))
}

fn point_at(
    position: Vec2,
    shapes: &HandleShapes,
    lens: &Lens,
    selection: &ElementSelection,
) -> Option<Aimed> {
    let total: usize = shapes.curves.iter().map(|c| c.points.len()).sum();
    let of_curves = shapes.curves.iter().flat_map(|curve| {
        let (trim_loop, number) = curve.address;
        let shown = total <= MOST_POINTS || selection.touches(trim_loop, number);
        let element = move |point| Element::Point { trim_loop, curve: number, point };
        curve.points.iter().enumerate().filter(move |_| shown).map(move |(p, at)| (element(p), *at))
    });
    let of_net = shapes.net.iter().enumerate().map(|(point, at)| (Element::SurfacePoint { point }, *at));
    let mut best: Option<(f32, f64, bool, Aimed)> = None;
    for (element, place) in of_curves.chain(of_net) {
        let Some((at, depth)) = lens.project(place) else { continue };
        let distance = at.distance(position);
        if distance > POINT_REACH_PX {
            continue;
        }
        let selected = selection.contains(element);
        let better = best.is_none_or(|(d, z, s, _)| {
            distance < d - CLEARLY_PX
                || (distance < d + CLEARLY_PX && (selected, -depth, -distance) > (s, -z, -d))
        });
        if better {
            best = Some((distance, depth, selected, Aimed { element, place }));
        }
    }
    best.map(|b| b.3)
}

fn curve_at(position: Vec2, shapes: &HandleShapes, lens: &Lens) -> Option<Aimed> {
    let mut best: Option<(f32, Aimed)> = None;
    for curve in &shapes.curves {
        let (trim_loop, number) = curve.address;
        let projected: Vec<Option<(Vec2, f64)>> = curve.line.iter().map(|p| lens.project(*p)).collect();
        for (k, ends) in projected.windows(2).enumerate() {
            let [Some((a, _)), Some((b, _))] = ends else { continue };
            let reach = best.map_or(CURVE_REACH_PX, |b| b.0);
            let (low, high) = (a.min(*b) - reach, a.max(*b) + reach);
            if position.cmplt(low).any() || position.cmpgt(high).any() {
                continue;
            }
            let along = *b - *a;
            let t = ((position - *a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
            let distance = (position - *a - along * t).length();
            if distance < reach {
                let place = curve.line[k].lerp(curve.line[k + 1], f64::from(t));
                best =
                    Some((distance, Aimed { element: Element::Curve { trim_loop, curve: number }, place }));
            }
        }
    }
    best.map(|b| b.1)
}
