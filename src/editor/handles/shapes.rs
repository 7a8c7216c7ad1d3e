//! The handles of the active face in space: its trim curves or the net of its surface, kept until face,
//! zoom or selection change.

use std::sync::Arc;

use bevy::prelude::*;
use glam::{DVec2, DVec3};

use super::surface_map::SurfaceMap;
use super::trace::{Fineness, trace, trace_line};
use crate::editor::camera::ViewCamera;
use crate::editor::camera::clip::ClipView;
use crate::editor::elements::{Element, FaceInHand};
use crate::editor::settings::Handles;
use crate::editor::viewport::Viewport;
use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::trim::UvRect;
use crate::kernel::view::{Camera, Projection};
use crate::scene::records::LoopRecord;

/// Farthest a polyline may be from its curve, logical pixels.
const TOLERANCE_PX: f64 = 0.25;
/// With a face larger on the screen than this many views only what can be seen is refined.
const LARGE: f64 = 4.0;
/// More control points than this are not all shown: only those of curves under the pointer or selected.
pub const MOST_POINTS: usize = 600;

/// A trim curve in space.
#[derive(Debug, Clone)]
pub struct SpaceCurve {
    /// Position of its loop, and in it.
    pub address: (usize, usize),
    /// The curve.
    pub line: Vec<DVec3>,
    /// The legs of its control polygon, laid on the surface; none for straight lines.
    pub polygon: Vec<Vec<DVec3>>,
    /// Its control points, laid on the surface.
    pub points: Vec<DVec3>,
}

/// Handles in space.
#[derive(Resource, Debug, Default)]
pub struct HandleShapes {
    /// Which kind is shown.
    pub kind: Handles,
    /// Whether they are only there to show what is selected or under the pointer in the uv panel.
    pub passive: bool,
    /// The active face's surface.
    pub map: Option<Arc<SurfaceMap>>,
    /// Trim curves, loop by loop.
    pub curves: Vec<Arc<SpaceCurve>>,
    /// Control points of the surface, u-major, and their number along u and v.
    pub net: Vec<DVec3>,
    /// Number of control points along u and v.
    pub counts: (usize, usize),
    /// Counts changes.
    pub revision: u64,
    made_of: Option<MadeOf>,
}

#[derive(Debug, Clone)]
struct MadeOf {
    kind: Handles,
    surface: Arc<NurbsSurface>,
    loops: Vec<Arc<LoopRecord>>,
    tolerance: f64,
    /// The camera, when what is off the screen was left coarse.
    camera: Option<Camera>,
}

/// Model units that a pixel covers at the nearest place of the face.
fn pixel_size(camera: &Camera, viewport: &Viewport, surface: &NurbsSurface) -> (f64, f64) {
    let bounds = surface.bounds();
    let height_px = f64::from(viewport.size.y.max(1.0));
    let per_pixel = match camera.projection {
        Projection::Orthographic { height } => height / height_px,
        Projection::Perspective { fov_y } => {
            let near = camera.eye.clamp(bounds.min, bounds.max);
            let distance = (camera.eye - near).length().max(1e-3 * camera.distance());
            2.0 * (0.5 * fov_y).tan() * distance / height_px
        }
    };
    (per_pixel.max(1e-300), bounds.diagonal() / (per_pixel * height_px))
}

impl HandleShapes {
    /// Brings the shapes up to date.
    pub fn update(
        &mut self,
        kind: Handles,
        face: Option<&FaceInHand>,
        camera: &ViewCamera,
        viewport: &Viewport,
    ) {
        let Some(face) = face.filter(|_| kind != Handles::None) else {
            if self.made_of.is_some() || self.kind != kind {
                *self = Self { revision: self.revision + 1, kind, passive: self.passive, ..Self::default() };
            }
            return;
        };
        let (per_pixel, views) = pixel_size(&camera.now, viewport, &face.surface);
        let tolerance = (TOLERANCE_PX * per_pixel).log2().floor().exp2();
        let seen_from = (views > LARGE).then_some(camera.now);
        let before = self.made_of.take();
        let same_surface = before.as_ref().is_some_and(|b| Arc::ptr_eq(&b.surface, &face.surface));
        let same_loops = before.as_ref().is_some_and(|b| {
            b.loops.len() == face.loops.len()
                && b.loops.iter().zip(&face.loops).all(|(a, b)| Arc::ptr_eq(a, b))
        });
        let same_view = before.as_ref().is_some_and(|b| b.tolerance == tolerance && b.camera == seen_from);
        let same_kind = before.as_ref().is_some_and(|b| b.kind == kind);
        let now = MadeOf {
            kind,
            surface: Arc::clone(&face.surface),
            loops: face.loops.clone(),
            tolerance,
            camera: seen_from,
        };
        if same_surface && same_loops && same_view && same_kind {
            self.made_of = Some(now);
            return;
        }
        if !same_surface || self.map.is_none() {
            self.map = Some(Arc::new(SurfaceMap::new(Arc::clone(&face.surface))));
        }
        self.kind = kind;
        self.counts = face.surface.counts();
        self.net = if kind == Handles::Surface { face.surface.points().to_vec() } else { Vec::new() };
        let keeps = same_surface && same_view && same_kind;
        self.trace_curves(&now, before.as_ref().filter(|_| keeps), &camera.now, viewport);
        self.revision += 1;
        self.made_of = Some(now);
    }

    fn trace_curves(&mut self, now: &MadeOf, before: Option<&MadeOf>, camera: &Camera, viewport: &Viewport) {
        let old = std::mem::take(&mut self.curves);
        if now.kind != Handles::Curves {
            return;
        }
        let Some(map) = self.map.clone() else { return };
        let aspect = viewport.aspect();
        let clip = ClipView::of(camera, aspect, &map.surface().bounds());
        let culls = now.camera.is_some();
        let visible = |a: DVec3, b: DVec3, c: DVec3| !culls || may_be_seen(camera, &clip, [a, b, c]);
        let fineness = Fineness { tolerance: now.tolerance, visible: &visible };
        let total: usize = now.loops.iter().flat_map(|l| &l.curves).map(|c| c.points().len()).sum();
        let mut kept = old.into_iter().map(|c| (c.address, c)).collect::<std::collections::BTreeMap<_, _>>();
        for (l, record) in now.loops.iter().enumerate() {
            for (c, curve) in record.curves.iter().enumerate() {
                let same = before.and_then(|b| b.loops.get(l)?.curves.get(c)).is_some_and(|b| b == curve);
                if let Some(curve) = kept.remove(&(l, c)).filter(|_| same) {
                    self.curves.push(curve);
                    continue;
                }
                let legs: Vec<[DVec2; 2]> = curve.points().windows(2).map(|e| [e[0], e[1]]).collect();
                let shows_polygon = curve.degree() > 1 && total <= MOST_POINTS;
                self.curves.push(Arc::new(SpaceCurve {
                    address: (l, c),
                    line: trace(curve, &map, &fineness),
                    polygon: legs
                        .iter()
                        .filter(|_| shows_polygon)
                        .map(|e| trace_line(e[0], e[1], &map, &fineness))
                        .collect(),
                    points: curve.points().iter().map(|p| map.point(*p)).collect(),
                }));
            }
        }
    }

    /// Where an element's point is in space: a control point of a trim curve or of the surface.
    pub fn place(&self, element: Element) -> Option<DVec3> {
        match element {
            Element::Point { trim_loop, curve, point } => {
                let curve = self.curves.iter().find(|c| c.address == (trim_loop, curve))?;
                curve.points.get(point).copied()
            }
            Element::SurfacePoint { point } => self.net.get(point).copied(),
            _ => None,
        }
    }

    /// The domain of the surface.
    pub fn domain(&self) -> Option<UvRect> {
        self.map.as_ref().map(|m| UvRect::of_surface(m.surface()))
    }
}

/// Whether a stretch through three points may cross the screen: not when all are beyond the same side of a
/// window somewhat larger than it.
fn may_be_seen(camera: &Camera, clip: &ClipView, points: [DVec3; 3]) -> bool {
    const BEYOND: f64 = 1.5;
    let projected = points.map(|p| clip.project(camera, p));
    let [Some(a), Some(b), Some(c)] = projected else { return true };
    (0..2).all(|axis| {
        let values = [a[axis], b[axis], c[axis]];
        !(values.iter().all(|v| *v > BEYOND) || values.iter().all(|v| *v < -BEYOND))
    })
}
