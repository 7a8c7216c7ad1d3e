//! What of the face is under the pointer: control points first, then curves.
//!
//! Joined ends lie on each other; of points equally near, one that is selected wins, then the first. Curves are
//! looked through by their boxes, which is fast enough for ten thousand of them.

use std::collections::BTreeSet;

use glam::DVec2;

use super::geometry::UvGeometry;
use super::view::UvView;
use crate::editor::elements::{Element, ElementSelection, FaceInHand, PointAddress};
use crate::kernel::nurbs::NurbsCurve2;

/// Reach of control points, logical pixels.
pub const POINT_REACH_PX: f64 = 8.0;
/// Reach of curves, logical pixels.
pub const CURVE_REACH_PX: f64 = 6.0;
/// More control points on the canvas than this are shown only where something is selected.
const MOST_POINTS: usize = 400;

/// Something under the pointer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvHit {
    /// What it is.
    pub element: Element,
    /// The place on it, native parameters.
    pub uv: DVec2,
    /// Parameter of the curve there; `None` for control points.
    pub parameter: Option<f64>,
}

/// Which curves show their control points.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum ShownPoints {
    /// All of them.
    #[default]
    All,
    /// Those of these loops.
    Of(BTreeSet<usize>),
}

impl ShownPoints {
    /// All when there is room, else those of loops with something selected or hovered.
    pub fn choose(face: &FaceInHand, view: &UvView, selection: &ElementSelection) -> Self {
        let visible = view.visible(0.0);
        let all = face.loops.iter().flat_map(|l| &l.curves).flat_map(|c| c.points());
        if all.filter(|p| visible.contains(**p)).take(MOST_POINTS + 1).count() <= MOST_POINTS {
            return Self::All;
        }
        let hovered = selection.hovered.and_then(Element::trim_loop);
        Self::Of(selection.loops().into_iter().chain(hovered).collect())
    }

    /// Whether the control points of a loop are shown.
    pub fn includes(&self, trim_loop: usize) -> bool {
        match self {
            Self::All => true,
            Self::Of(loops) => loops.contains(&trim_loop),
        }
    }
}

/// Mean distance of neighbouring control points on the screen, logical pixels.
pub fn spacing_px(curve: &NurbsCurve2, view: &UvView) -> f64 {
    let legs = curve.points().windows(2);
    let count = legs.len().max(1) as f64;
    legs.map(|e| view.distance_px(e[0], e[1])).sum::<f64>() / count
}

/// What is at `position` (window, logical pixels).
pub fn at(
    position: DVec2,
    face: &FaceInHand,
    geometry: &UvGeometry,
    view: &UvView,
    selection: &ElementSelection,
    shown: &ShownPoints,
) -> Option<UvHit> {
    point_at(position, face, view, selection, shown).or_else(|| curve_at(position, geometry, view))
}

fn point_at(
    position: DVec2,
    face: &FaceInHand,
    view: &UvView,
    selection: &ElementSelection,
    shown: &ShownPoints,
) -> Option<UvHit> {
    let mut best: Option<(f64, bool, PointAddress, DVec2)> = None;
    for (l, record) in face.loops.iter().enumerate().filter(|(l, _)| shown.includes(*l)) {
        for (c, curve) in record.curves.iter().enumerate() {
            // Where points are crowded the curve is meant.
            let reach = POINT_REACH_PX.min(0.5 * spacing_px(curve, view));
            for (p, uv) in curve.points().iter().enumerate() {
                let distance = (view.to_screen(*uv) - position).length();
                if distance > reach {
                    continue;
                }
                let selected = selection.contains(Element::Point { trim_loop: l, curve: c, point: p });
                let better = best
                    .is_none_or(|(d, s, ..)| distance < d - 0.5 || (distance < d + 0.5 && selected && !s));
                if better {
                    best = Some((distance, selected, (l, c, p), *uv));
                }
            }
        }
    }
    best.map(|(_, _, (trim_loop, curve, point), uv)| UvHit {
        element: Element::Point { trim_loop, curve, point },
        uv,
        parameter: None,
    })
}

/// The curve at `position`.
pub fn curve_at(position: DVec2, geometry: &UvGeometry, view: &UvView) -> Option<UvHit> {
    let target = view.to_uv(position);
    let mut best: Option<(f64, UvHit)> = None;
    for (trim_loop, curves) in geometry.curves.iter().enumerate() {
        for (curve, flat) in curves.iter().enumerate() {
            let reach = best.map_or(CURVE_REACH_PX, |b| b.0);
            let Some(near) = flat.nearest(target, view, reach) else { continue };
            if best.is_none_or(|b| near.distance_px < b.0) {
                let element = Element::Curve { trim_loop, curve };
                let hit = UvHit { element, uv: near.uv, parameter: Some(near.parameter) };
                best = Some((near.distance_px, hit));
            }
        }
    }
    best.map(|b| b.1)
}

/// What a rectangle on the screen takes: control points inside it; without any, curves. Drawn from left to
/// right it takes curves that are all inside, from right to left also those it touches.
pub fn in_box(
    (from, to): (DVec2, DVec2),
    face: &FaceInHand,
    geometry: &UvGeometry,
    view: &UvView,
    shown: &ShownPoints,
) -> Vec<Element> {
    let (low, high) = (from.min(to), from.max(to));
    let inside = |uv: &DVec2| {
        let p = view.to_screen(*uv);
        p == p.clamp(low, high)
    };
    let mut points = Vec::new();
    for (l, record) in face.loops.iter().enumerate().filter(|(l, _)| shown.includes(*l)) {
        for (c, curve) in record.curves.iter().enumerate() {
            let found = curve.points().iter().enumerate().filter(|(_, uv)| inside(uv));
            points.extend(found.map(|(p, _)| Element::Point { trim_loop: l, curve: c, point: p }));
        }
    }
    if !points.is_empty() {
        return points;
    }
    let crossing = to.x < from.x;
    let mut curves = Vec::new();
    for (trim_loop, list) in geometry.curves.iter().enumerate() {
        for (curve, flat) in list.iter().enumerate() {
            let takes = if crossing {
                flat.points.windows(2).any(|e| touches(view.to_screen(e[0]), view.to_screen(e[1]), low, high))
            } else {
                flat.points.iter().all(inside)
            };
            if takes {
                curves.push(Element::Curve { trim_loop, curve });
            }
        }
    }
    curves
}

/// Whether a segment meets a rectangle (Liang & Barsky 1984).
fn touches(a: DVec2, b: DVec2, low: DVec2, high: DVec2) -> bool {
    let d = b - a;
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        if d[axis] == 0.0 {
            if a[axis] < low[axis] || a[axis] > high[axis] {
                return false;
            }
            continue;
        }
        let (t0, t1) = ((low[axis] - a[axis]) / d[axis], (high[axis] - a[axis]) / d[axis]);
        enter = enter.max(t0.min(t1));
        leave = leave.min(t0.max(t1));
    }
    enter <= leave
}
