//! Pin holes on the screen: pixels through which something farther shows between two faces that share an edge.
//!
//! Candidates come from the picture (a nearer surface on both sides, [`crate::reference::holes`]) and, where a gap is
//! wider than a few pixels, from the strip between the two exact curves. Each is proved in f64: its ray must pass the
//! edge within the measured gap and half a pixel, and between the two sides. If the exact surfaces are hit there, the
//! hole is our own solver's; else it is real, and the curves tell whether the sides stand apart or overlap.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::lifted::LiftedCurve;
use super::nearest::nearest;
use super::{Edge, EdgeKey, EdgeUse, Inspection};
use crate::encoding::View;
use crate::kernel::face::Face;
use crate::kernel::query::raycast::patch_hits;
use crate::kernel::trim::{FillRule, oracle};
use crate::kernel::view::{Camera, Projection, Ray};
use crate::reference::holes::{HoleCandidate, candidates, z_of};
use crate::reference::visibility::VisibilityBuffer;

/// Why a pixel shows through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum HoleClass {
    /// The sides stand apart: across the edge or, seen at a slant, along the normal.
    Gap,
    /// The sides overlap, one above the other, and one looks in between.
    Overlap,
    /// The exact surfaces have no hole there.
    Solver,
}

/// A proved pin hole.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PinHole {
    /// Column and row from the upper left.
    pub pixel: [u32; 2],
    /// The edge between whose sides one sees.
    pub edge: EdgeKey,
    /// The faces on both sides (positions in the model).
    pub faces: [usize; 2],
    /// The point of the edge nearest to the ray.
    pub point: DVec3,
    /// How far apart the sides are there (model units).
    pub gap: f64,
    /// Why one sees through.
    pub class: HoleClass,
}

/// The edges that two faces share.
#[derive(Debug, Clone, Default)]
pub struct EdgePairs {
    pairs: BTreeMap<(usize, usize), Vec<EdgeKey>>,
}

impl EdgePairs {
    /// Looks at all edges with two sides or more.
    pub fn of(inspection: &Inspection) -> Self {
        let mut pairs: BTreeMap<(usize, usize), Vec<EdgeKey>> = BTreeMap::new();
        for (key, edge) in inspection.edges() {
            for (k, a) in edge.uses.iter().enumerate() {
                for b in &edge.uses[k + 1..] {
                    let (a, b) = (a.curve.face, b.curve.face);
                    let list = pairs.entry((a.min(b), a.max(b))).or_default();
                    if list.last() != Some(key) {
                        list.push(*key);
                    }
                }
            }
        }
        Self { pairs }
    }

    /// The edges between two faces (positions in the model); of a face with itself, its seams.
    pub fn between(&self, a: usize, b: usize) -> &[EdgeKey] {
        self.pairs.get(&(a.min(b), a.max(b))).map_or(&[], Vec::as_slice)
    }
}

/// What holes are found in.
#[derive(Clone, Copy)]
pub struct HoleScene<'a> {
    /// Edges and gaps.
    pub inspection: &'a Inspection,
    /// Which faces share edges.
    pub pairs: &'a EdgePairs,
    /// The face at a position of the model, if it could be derived.
    pub face: &'a (dyn Fn(usize) -> Option<&'a Face> + Sync),
    /// The face (position in the model) in a slot of the packed scene.
    pub face_of_slot: &'a (dyn Fn(u32) -> Option<usize> + Sync),
}

/// All pin holes of a picture, by rows. `view` is what `buffer` was cast with, for `camera`.
pub fn pin_holes(scene: &HoleScene, buffer: &VisibilityBuffer, view: &View, camera: &Camera) -> Vec<PinHole> {
    let shares = |a: u32, b: u32| match ((scene.face_of_slot)(a), (scene.face_of_slot)(b)) {
        (Some(a), Some(b)) => !scene.pairs.between(a, b).is_empty(),
        _ => false,
    };
    let screen = Screen::new(camera, view);
    let mut found: BTreeMap<(u32, u32), HoleCandidate> = BTreeMap::new();
    for candidate in candidates(buffer, view, &shares) {
        if let (Some(a), Some(b)) =
            ((scene.face_of_slot)(candidate.faces[0]), (scene.face_of_slot)(candidate.faces[1]))
        {
            let faces = [a as u32, b as u32];
            found.insert((candidate.pixel[1], candidate.pixel[0]), HoleCandidate { faces, ..candidate });
        }
    }
    let edges: Vec<_> = scene.inspection.edges().filter(|(_, edge)| edge.uses.len() > 1).collect();
    let wide: Vec<HoleCandidate> =
        edges.par_iter().flat_map_iter(|(_, edge)| wide_holes(scene, buffer, view, &screen, edge)).collect();
    for candidate in wide {
        found.entry((candidate.pixel[1], candidate.pixel[0])).or_insert(candidate);
    }
    let all: Vec<HoleCandidate> = found.into_values().collect();
    let shown = |candidate: &HoleCandidate| {
        let here = buffer.at(candidate.pixel[0] as i32, candidate.pixel[1] as i32);
        if here.words[0] == 0 { f64::INFINITY } else { f64::from(z_of(view, &here)) }
    };
    all.par_iter().filter_map(|candidate| prove(scene, &screen, candidate, shown(candidate))).collect()
}

/// A window in f64.
struct Screen {
    camera: Camera,
    axes: (DVec3, DVec3, DVec3),
    size: DVec2,
    half: DVec2,
    jitter: DVec2,
    pixel: [f64; 2],
}

impl Screen {
    fn new(camera: &Camera, view: &View) -> Self {
        let size = DVec2::new(view.size[0].into(), view.size[1].into());
        let half = camera.half_extent(size.x / size.y);
        let height = 2.0 * half.y / size.y;
        let pixel = match camera.projection {
            Projection::Perspective { .. } => [0.0, height / camera.distance()],
            Projection::Orthographic { .. } => [height, 0.0],
        };
        let jitter = DVec2::new(view.jitter[0].into(), view.jitter[1].into());
        Self { camera: *camera, axes: camera.axes(), size, half, jitter, pixel }
    }

    fn ray(&self, pixel: [u32; 2]) -> Ray {
        let p = DVec2::new(pixel[0].into(), pixel[1].into()) + 0.5 + self.jitter;
        let ndc = (2.0 * p / self.size - 1.0) * DVec2::new(1.0, -1.0);
        self.camera.ray(ndc, self.size.x / self.size.y)
    }

    /// Depth along the line of sight, as in [`View`].
    fn depth(&self, p: DVec3) -> f64 {
        let reference = match self.camera.projection {
            Projection::Perspective { .. } => self.camera.eye,
            Projection::Orthographic { .. } => self.camera.target,
        };
        (reference - p).dot(self.axes.2)
    }

    /// Size of a pixel at depth `z`.
    fn width(&self, z: f64) -> f64 {
        self.pixel[0] + self.pixel[1] * z.abs()
    }

    /// Whether all within `reach` of a point is off the screen. In space, not in pixels: beside the eye, where depth is
    /// next to nothing, a pixel says nothing.
    fn is_off(&self, p: DVec3, reach: f64) -> bool {
        let z = self.depth(p);
        let scale = match self.camera.projection {
            Projection::Perspective { .. } if z + reach <= 0.0 => return true,
            Projection::Perspective { .. } => (z + reach) / self.camera.distance(),
            Projection::Orthographic { .. } => 1.0,
        };
        let from = p - self.camera.target;
        let across = DVec2::new(from.dot(self.axes.0), from.dot(self.axes.1)).abs();
        across.cmpgt(self.half * scale + reach + 2.0 * self.width(z.abs() + reach)).any()
    }

    /// Position in pixels from the upper left of the sample grid; `None` behind the eye.
    fn project(&self, p: DVec3) -> Option<DVec2> {
        let from = p - self.camera.target;
        let scale = match self.camera.projection {
            Projection::Perspective { .. } => self.camera.distance() / self.depth(p),
            Projection::Orthographic { .. } => 1.0,
        };
        let ndc = DVec2::new(from.dot(self.axes.0), from.dot(self.axes.1)) * scale / self.half;
        let seen = scale > 0.0 && ndc.is_finite();
        seen.then(|| (ndc * DVec2::new(1.0, -1.0) * 0.5 + 0.5) * self.size - self.jitter)
    }
}

/// Gaps of more pixels than this are walked through; narrower ones are found by neighbours.
const WIDE_PX: f64 = 1.5;
/// Halvings of an edge at most on the way to a pixel.
const MOST_HALVINGS: u32 = 30;

/// Pixels in the strip between the first two sides of an edge that show something behind it.
fn wide_holes(
    scene: &HoleScene,
    buffer: &VisibilityBuffer,
    view: &View,
    screen: &Screen,
    edge: &Edge,
) -> Vec<HoleCandidate> {
    let (Some(gap), [first, rest @ ..]) = (edge.gap, edge.uses.as_slice()) else { return Vec::new() };
    let mut found = Vec::new();
    for second in rest {
        let (Some(a), Some(b)) =
            (scene.inspection.curve(&first.curve), scene.inspection.curve(&second.curve))
        else {
            continue;
        };
        let walk = Walk { buffer, view, screen, a, b, uses: [first, second], gap: gap.maximum };
        walk.along(first.interval, MOST_HALVINGS, &mut found);
    }
    found
}

struct Walk<'a> {
    buffer: &'a VisibilityBuffer,
    view: &'a View,
    screen: &'a Screen,
    a: &'a LiftedCurve,
    b: &'a LiftedCurve,
    uses: [&'a EdgeUse; 2],
    gap: f64,
}

impl Walk<'_> {
    fn along(&self, (from, to): (f64, f64), halvings: u32, found: &mut Vec<HoleCandidate>) {
        let middle = self.a.at(0.5 * (from + to)).point;
        let reach = 0.6 * (self.a.length_to(to) - self.a.length_to(from)) + self.gap;
        let z = self.screen.depth(middle);
        let width = self.screen.width((z - reach).max(1e-3 * z.abs()));
        if self.gap < WIDE_PX * width || self.screen.is_off(middle, reach) {
            return;
        }
        // With the eye in the gap itself there is nothing to tell pixels by.
        let length = reach - self.gap;
        let width = self.screen.width((z - length).max(0.25 * z.abs()).max(0.05 * self.gap));
        if length > 0.5 * width && halvings > 0 {
            let half = 0.5 * (from + to);
            self.along((from, half), halvings - 1, found);
            self.along((half, to), halvings - 1, found);
            return;
        }
        let other = nearest(self.b, middle, self.uses[1].interval).at.point;
        let (Some(p), Some(q)) = (self.screen.project(middle), self.screen.project(other)) else { return };
        let steps = (2.0 * (q - p).length()).ceil().clamp(1.0, 1e4) as u32;
        for k in 0..=steps {
            let s = f64::from(k) / f64::from(steps);
            let at = p.lerp(q, s);
            let inside = at.min_element() >= 0.0 && (at - self.screen.size).max_element() < 0.0;
            if !inside {
                continue;
            }
            let z = self.screen.depth(middle.lerp(other, s));
            let here = self.buffer.at(at.x as i32, at.y as i32);
            let behind = here.words[0] == 0 || f64::from(z_of(self.view, &here)) > z + self.screen.width(z);
            if behind {
                let faces = self.uses.map(|u| u.curve.face as u32);
                found.push(HoleCandidate { pixel: [at.x as u32, at.y as u32], faces, z: z as f32 });
            }
        }
    }
}

/// Where a line passes a curve.
struct Approach {
    t: f64,
    point: DVec3,
    /// From the line to the point, across the line.
    off: DVec3,
}

fn approach(curve: &LiftedCurve, range: (f64, f64), ray: &Ray) -> Approach {
    let off = |p: DVec3| {
        let d = p - ray.origin;
        d - ray.direction * d.dot(ray.direction)
    };
    let at = |t: f64| {
        let point = curve.at(t).point;
        Approach { t, point, off: off(point) }
    };
    let distance = |t: f64| off(curve.at(t).point).length_squared();
    let mut stations: Vec<f64> =
        curve.nodes().iter().map(|n| n.t).filter(|t| *t > range.0 && *t < range.1).collect();
    stations.insert(0, range.0);
    stations.push(range.1);
    // Distance of the line from each chord finds the piece; golden sections the point on it.
    let chord = |k: usize| {
        let (p, q) = (off(curve.at(stations[k]).point), off(curve.at(stations[k + 1]).point));
        let along = q - p;
        let s = (-p.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (p + along * s).length_squared()
    };
    let best = (0..stations.len() - 1).min_by(|a, b| chord(*a).total_cmp(&chord(*b))).unwrap_or(0);
    let (mut low, mut high) =
        (stations[best.saturating_sub(1)], stations[(best + 2).min(stations.len() - 1)]);
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut c, mut d) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut fc, mut fd) = (distance(c), distance(d));
    for _ in 0..48 {
        if fc <= fd {
            (high, d, fd) = (d, c, fc);
            c = high - GOLDEN * (high - low);
            fc = distance(c);
        } else {
            (low, c, fc) = (c, d, fd);
            d = low + GOLDEN * (high - low);
            fd = distance(d);
        }
    }
    at(0.5 * (low + high))
}

/// Proves a candidate, whose faces are positions in the model. `shown`: depth of what its pixel shows.
fn prove(scene: &HoleScene, screen: &Screen, candidate: &HoleCandidate, shown: f64) -> Option<PinHole> {
    let ray = screen.ray(candidate.pixel);
    let [a, b] = candidate.faces.map(|f| f as usize);
    let sides = scene.pairs.between(a, b).iter().filter_map(|key| {
        let edge = scene.inspection.edge(key)?;
        let (i, j) = sides_of(edge, a, b)?;
        let side = |k: usize| {
            let used = &edge.uses[k];
            Some((
                scene.inspection.curve(&used.curve)?,
                approach(scene.inspection.curve(&used.curve)?, used.interval, &ray),
            ))
        };
        Some((*key, edge, j, side(i)?, side(j)?))
    });
    let nearest_side = sides.min_by(|p, q| {
        let off = |s: &(EdgeKey, &Edge, usize, (&LiftedCurve, Approach), (&LiftedCurve, Approach))| {
            s.3.1.off.length().min(s.4.1.off.length())
        };
        off(p).total_cmp(&off(q))
    })?;
    let (key, edge, j, (curve, first), (other, second)) = nearest_side;
    let width = screen.width(screen.depth(first.point));
    let gap = edge.gap.map_or(0.0, |g| g.maximum + g.error_bound);
    let off = first.off.length().min(second.off.length());
    // Half the diagonal of a pixel.
    if off > gap + 0.75 * width {
        return None;
    }
    let foot = nearest(other, first.point, edge.uses[j].interval);
    let mut hits = [a, b].into_iter().filter_map(|face| {
        let depths = hits_near((scene.face)(face)?, &ray, first.point, gap + 4.0 * width);
        depths.into_iter().map(|t| screen.depth(ray.origin + ray.direction * t)).reduce(f64::min)
    });
    let hit = hits.next().map(|z| hits.fold(z, f64::min));
    if hit.is_some_and(|z| shown <= z + 8.0 * width + 1e-5 * z.abs()) {
        // The picture shows it.
        return None;
    }
    // On both sides of the ray, within a small part of a pixel.
    let between = first.off.dot(second.off) <= (0.05 * width).powi(2);
    let class = if hit.is_some() {
        HoleClass::Solver
    } else if !between {
        return None;
    } else {
        let apart = foot.at.point - first.point;
        let inward = curve.inward(first.t).unwrap_or(DVec3::ZERO);
        if apart.dot(inward) > OVERLAP_RATIO * apart.length() { HoleClass::Overlap } else { HoleClass::Gap }
    };
    Some(PinHole {
        pixel: candidate.pixel,
        edge: key,
        faces: [a, b],
        point: first.point,
        gap: foot.distance,
        class,
    })
}

/// Sides overlap when at least this part of their distance lies across the edge.
const OVERLAP_RATIO: f64 = 0.3;

/// Uses of an edge by two faces.
fn sides_of(edge: &Edge, a: usize, b: usize) -> Option<(usize, usize)> {
    let i = edge.uses.iter().position(|u| u.curve.face == a)?;
    let j = edge.uses.iter().enumerate().position(|(k, u)| k != i && u.curve.face == b)?;
    Some((i, j))
}

/// Parameters nearer than this to a trim curve are on it, for exact surfaces.
const EXACT: f64 = 1e-12;

/// Where a line meets the kept part of a face near `point`: within `reach` of it, or more at a slant.
fn hits_near(face: &Face, ray: &Ray, point: DVec3, reach: f64) -> Vec<f64> {
    let along = (point - ray.origin).dot(ray.direction);
    let near = |patch: &&crate::kernel::bezier::BezierPatch| {
        let bounds = patch.bounds();
        let margin = DVec3::splat(reach);
        (point.cmpge(bounds.min - margin) & point.cmple(bounds.max + margin)).all()
    };
    let hits = face.patches.iter().filter(near).flat_map(|patch| patch_hits(patch, ray).hits);
    let kept = hits.filter(|hit| {
        let slant = hit.normal.normalize_or_zero().dot(ray.direction).abs().max(0.02);
        (hit.t - along).abs() <= reach / slant && is_kept(face, hit.uv)
    });
    kept.map(|hit| hit.t).collect()
}

fn is_kept(face: &Face, native: DVec2) -> bool {
    let p = face.domain.normalise(native);
    if p.min_element() < -EXACT || p.max_element() > 1.0 + EXACT {
        return false;
    }
    oracle::inside(&face.pieces, p, FillRule::EvenOdd) || oracle::is_on(&face.pieces, p, EXACT)
}
