//! Where a dragged point goes when something worth meeting is near.
//!
//! In order: ends of curves and their control points, curves, then knot lines, the border of the domain and the
//! grid, the latter for each axis by itself. Held Shift keeps to directions of 45 degrees on the
//! screen instead. What moves along is never snapped to.

use std::collections::BTreeSet;

use glam::DVec2;

use super::geometry::UvGeometry;
use super::ruler;
use super::view::UvView;
use crate::editor::elements::{FaceInHand, PointAddress};
use crate::kernel::trim::UvRect;

/// Reach of points, logical pixels.
const POINT_REACH_PX: f64 = 9.0;
/// Reach of curves and knot lines, logical pixels.
const LINE_REACH_PX: f64 = 6.0;
/// Reach of grid lines, logical pixels.
const GRID_REACH_PX: f64 = 5.0;

/// What to snap to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SnapSettings {
    /// Whether anything is.
    pub on: bool,
    /// Ends of curves and control points.
    pub points: bool,
    /// Curves.
    pub curves: bool,
    /// Knot lines and the border of the surface's domain.
    pub knots: bool,
    /// Lines of the grid.
    pub grid: bool,
}

impl Default for SnapSettings {
    fn default() -> Self {
        Self { on: true, points: true, curves: true, knots: true, grid: false }
    }
}

/// What a point was snapped to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum SnapKind {
    End,
    ControlPoint,
    Curve,
    Knot,
    Border,
    Grid,
    Direction,
}

impl SnapKind {
    /// What to show beside the point.
    pub fn label(self) -> &'static str {
        match self {
            Self::End => "End",
            Self::ControlPoint => "Control point",
            Self::Curve => "On curve",
            Self::Knot => "Knot line",
            Self::Border => "Border",
            Self::Grid => "Grid",
            Self::Direction => "45°",
        }
    }
}

/// A snapped point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snapped {
    /// Where it goes.
    pub uv: DVec2,
    /// To what, if to anything.
    pub kind: Option<SnapKind>,
    /// Whether u and v were each taken from a line: that line is shown.
    pub axes: [bool; 2],
}

/// Everything that snapping looks at.
pub struct SnapScene<'a> {
    /// The face.
    pub face: &'a FaceInHand,
    /// Its loops as polylines.
    pub geometry: &'a UvGeometry,
    /// The view.
    pub view: &'a UvView,
    /// Control points that move along.
    pub moving: &'a BTreeSet<PointAddress>,
    /// What to snap to.
    pub settings: SnapSettings,
}

impl SnapScene<'_> {
    /// Where `raw` goes. With `origin` it keeps to directions of 45 degrees from there.
    pub fn snap(&self, raw: DVec2, origin: Option<DVec2>) -> Snapped {
        if let Some(origin) = origin {
            let uv = self.in_direction(raw, origin);
            return Snapped { uv, kind: Some(SnapKind::Direction), axes: [false; 2] };
        }
        if !self.settings.on {
            return Snapped { uv: raw, kind: None, axes: [false; 2] };
        }
        let point = self.settings.points.then(|| self.to_point(raw)).flatten();
        point
            .or_else(|| self.settings.curves.then(|| self.to_curve(raw)).flatten())
            .unwrap_or_else(|| self.to_lines(raw))
    }

    fn in_direction(&self, raw: DVec2, origin: DVec2) -> DVec2 {
        let d = (raw - origin) * self.view.scale;
        let step = std::f64::consts::FRAC_PI_4;
        let along = DVec2::from_angle((d.to_angle() / step).round() * step);
        let moved = along * d.dot(along);
        // Exactly along an axis where it is one.
        let moved = DVec2::new(
            if along.x.abs() < 1e-9 { 0.0 } else { moved.x },
            if along.y.abs() < 1e-9 { 0.0 } else { moved.y },
        );
        origin + moved / self.view.scale
    }

    fn to_point(&self, raw: DVec2) -> Option<Snapped> {
        let mut best: Option<(f64, DVec2, SnapKind)> = None;
        for (l, record) in self.face.loops.iter().enumerate() {
            for (c, curve) in record.curves.iter().enumerate() {
                let last = curve.points().len() - 1;
                for (p, uv) in curve.points().iter().enumerate() {
                    let kind = if p == 0 || p == last { SnapKind::End } else { SnapKind::ControlPoint };
                    let distance = self.view.distance_px(*uv, raw);
                    if distance < best.map_or(POINT_REACH_PX, |b| b.0) && !self.moving.contains(&(l, c, p)) {
                        best = Some((distance, *uv, kind));
                    }
                }
            }
        }
        best.map(|(_, uv, kind)| Snapped { uv, kind: Some(kind), axes: [false; 2] })
    }

    fn to_curve(&self, raw: DVec2) -> Option<Snapped> {
        let mut best: Option<(f64, DVec2)> = None;
        for (l, curves) in self.geometry.curves.iter().enumerate() {
            for (c, flat) in curves.iter().enumerate() {
                let reach = best.map_or(LINE_REACH_PX, |b| b.0);
                let Some(near) = flat.nearest(raw, self.view, reach) else { continue };
                let Some(curve) = self.face.curve(l, c) else { continue };
                let moves = (0..curve.points().len()).any(|p| self.moving.contains(&(l, c, p)));
                if !moves {
                    best = Some((near.distance_px, curve.point(near.parameter)));
                }
            }
        }
        best.map(|(_, uv)| Snapped { uv, kind: Some(SnapKind::Curve), axes: [false; 2] })
    }

    fn to_lines(&self, raw: DVec2) -> Snapped {
        let domain = UvRect::of_surface(&self.face.surface);
        let steps = ruler::Steps::of(self.view);
        let mut snapped = Snapped { uv: raw, kind: None, axes: [false; 2] };
        for axis in 0..2 {
            let px = self.view.scale[axis];
            let knots = if axis == 0 { self.face.surface.knots_u() } else { self.face.surface.knots_v() };
            let mut best = LINE_REACH_PX;
            if self.settings.knots {
                for knot in knots.breaks() {
                    let distance = (knot - raw[axis]).abs() * px;
                    if distance < best {
                        best = distance;
                        snapped.uv[axis] = knot;
                        let border = knot == domain.min[axis] || knot == domain.max[axis];
                        snapped.kind = Some(if border { SnapKind::Border } else { SnapKind::Knot });
                        snapped.axes[axis] = true;
                    }
                }
            }
            if self.settings.grid && !snapped.axes[axis] {
                let step = steps.minor[axis];
                let line = (raw[axis] / step).round() * step;
                if (line - raw[axis]).abs() * px < GRID_REACH_PX {
                    snapped.uv[axis] = line;
                    snapped.kind = snapped.kind.or(Some(SnapKind::Grid));
                    snapped.axes[axis] = true;
                }
            }
        }
        snapped
    }
}
