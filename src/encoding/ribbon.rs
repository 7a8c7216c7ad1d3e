//! Trim curves packed so that a GPU can evaluate them in space: pieces of pcurves, each with the part of the patch that
//! it runs on.
//!
//! A pcurve is cut where it leaves a patch. Each piece carries its own little patch, cut to the box of the piece in
//! parameters and measured from its own origin, so that points are right to f32 of the piece and not of the model.
//! How finely a piece is drawn depends on the view: `RibbonScene::spans` halves pieces until straight segments are
//! right to a tenth of a pixel, and leaves out what is out of sight.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};

use super::arena::Arena;
use super::cell::split_high_low;
use super::level::LevelView;
use super::scene::FaceSlot;
use crate::kernel::bezier::{BezierCurve2, BezierPatch, roots};
use crate::kernel::face::Face;
use crate::kernel::view::Bounds;

/// Mirror of `RibbonPiece` in `shaders/layout/ribbon.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[expect(missing_docs, reason = "described in the shader's layout")]
pub struct RibbonPiece {
    pub origin_high: [f32; 3],
    pub first_point: u32,
    pub origin_low: [f32; 3],
    pub degrees: u32,
    pub uv_min: [f32; 2],
    pub uv_max: [f32; 2],
    pub first_curve: u32,
    pub face: u32,
    pub other: u32,
    pub gap: f32,
}

/// Mirror of `RibbonSpan` in `shaders/layout/ribbon.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[expect(missing_docs, reason = "described in the shader's layout")]
pub struct RibbonSpan {
    pub piece: u32,
    pub start: f32,
    pub end: f32,
    pub pad0: u32,
}

/// Straight segments of a span. Mirror of `RIBBON_SEGMENTS`.
pub const SEGMENTS: u32 = 8;

/// A stretch of a trim curve to pack.
#[derive(Debug, Clone)]
pub struct RibbonShape<'a> {
    /// Face that the curve bounds.
    pub face: &'a Face,
    /// Its slot.
    pub slot: FaceSlot,
    /// Slot of the face across the edge; the same face at seams.
    pub other: FaceSlot,
    /// The stretch in native parameters.
    pub curve: BezierCurve2,
    /// How far the other side of the edge is away at most, model units.
    pub gap: f64,
}

/// What spans are found from.
#[derive(Debug, Clone)]
struct Extent {
    curve: BezierCurve2,
    patch: BezierPatch,
    /// Largest speed, model units per unit of the piece's parameter.
    speed: f64,
    /// Largest distance of the piece from its chord.
    bend: f64,
    gap: f64,
}

/// All ribbons of a scene.
#[derive(Debug, Clone, Default)]
pub struct RibbonScene {
    pub(crate) pieces: Arena<RibbonPiece>,
    pub(crate) points: Arena<[f32; 4]>,
    pub(crate) curves: Arena<[f32; 4]>,
    extents: Vec<Extent>,
}

impl RibbonScene {
    /// Packs stretches of edges that have two sides.
    pub fn new<'a>(shapes: impl IntoIterator<Item = RibbonShape<'a>>) -> Self {
        let (mut pieces, mut points, mut curves, mut extents) = (vec![], vec![], vec![], vec![]);
        for shape in shapes {
            for curve in at_patches(&shape.curve, shape.face) {
                let Some((piece, extent)) = pack(&shape, &curve, &mut points, &mut curves) else {
                    continue;
                };
                pieces.push(piece);
                extents.push(extent);
            }
        }
        let mut scene = Self { extents, ..Self::default() };
        scene.pieces.insert(&pieces);
        scene.points.insert(&points);
        scene.curves.insert(&curves);
        scene
    }

    /// Packed pieces.
    pub fn piece_data(&self) -> &[RibbonPiece] {
        self.pieces.data()
    }

    /// Homogeneous control points of their patches.
    pub fn point_data(&self) -> &[[f32; 4]] {
        self.points.data()
    }

    /// Homogeneous control points of their curves.
    pub fn curve_data(&self) -> &[[f32; 4]] {
        self.curves.data()
    }

    /// Marks everything as changed, so that the next upload sends it all.
    pub fn touch_all(&mut self) {
        self.pieces.touch_all();
        self.points.touch_all();
        self.curves.touch_all();
    }

    /// What to draw in a view to conceal gaps.
    pub fn concealing_spans(&self, view: &LevelView) -> Vec<RibbonSpan> {
        let mut spans = Vec::new();
        for (number, extent) in self.extents.iter().enumerate() {
            extent.divide(view, number as u32, (0.0, 1.0), MOST_HALVINGS, &mut spans);
        }
        spans
    }
}

/// Halvings of a piece at most.
const MOST_HALVINGS: u32 = 16;
/// Longest span, pixels where it is nearest: a strip that reached far out of the picture, or behind the eye, would
/// take its width and depth from corners that f32 places many pixels wrong.
const LONGEST_PX: f64 = 512.0;
/// Allowed distance of a segment from its curve, pixels.
const CHORD_PX: f64 = 0.1;

impl Extent {
    fn divide(
        &self,
        view: &LevelView,
        piece: u32,
        (from, to): (f64, f64),
        halvings: u32,
        spans: &mut Vec<RibbonSpan>,
    ) {
        let uv = self.curve.point(0.5 * (from + to));
        let middle = self.patch.point(uv.x, uv.y);
        let length = to - from;
        let reach = DVec3::splat(0.5 * length * self.speed + self.gap);
        let Some(pixel) = view.pixel_size(&Bounds { min: middle - reach, max: middle + reach }) else {
            return;
        };
        let error = self.bend * length * length / f64::from(SEGMENTS * SEGMENTS);
        let coarse = error > CHORD_PX * pixel || length * self.speed > LONGEST_PX * pixel;
        if coarse && halvings > 0 {
            let half = 0.5 * (from + to);
            self.divide(view, piece, (from, half), halvings - 1, spans);
            self.divide(view, piece, (half, to), halvings - 1, spans);
        } else {
            spans.push(RibbonSpan { piece, start: from as f32, end: to as f32, pad0: 0 });
        }
    }
}

/// The parts of `curve` (native parameters) between the borders of patches, moved by whole periods onto the
/// face's patches.
fn at_patches(curve: &BezierCurve2, face: &Face) -> Vec<BezierCurve2> {
    let middle = curve.point(0.5);
    let centre = 0.5 * (face.domain.min + face.domain.max);
    let shift = |axis: usize| match face.period[axis] {
        0.0 => 0.0,
        period => ((centre[axis] - middle[axis]) / period).round() * period,
    };
    let outside = !face.domain.contains(middle);
    let by = if outside { DVec2::new(shift(0), shift(1)) } else { DVec2::ZERO };
    let curve = curve.map_points(|p| p + by);
    let (low, high) = curve.hull();
    let mut cuts = vec![0.0, 1.0];
    let mut lines = [Vec::new(), Vec::new()];
    for patch in &face.patches {
        for axis in 0..2 {
            lines[axis].extend([patch.uv_min[axis], patch.uv_max[axis]]);
        }
    }
    for (axis, lines) in lines.iter_mut().enumerate() {
        lines.sort_by(f64::total_cmp);
        lines.dedup();
        for line in lines.iter().filter(|x| **x > low[axis] && **x < high[axis]) {
            let off = curve.points.iter().zip(&curve.weights).map(|(p, w)| (p[axis] - line) * w);
            cuts.extend(roots::in_unit_interval(&off.collect::<Vec<_>>()));
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|a, b| *a - *b < 1e-9);
    cuts.windows(2)
        .map(|w| if w == [0.0, 1.0] { curve.clone() } else { curve.restrict(w[0], w[1]) })
        .collect()
}

/// The patch that holds a native point, or comes next to it.
fn patch_at(face: &Face, p: DVec2) -> Option<&BezierPatch> {
    let off = |patch: &&BezierPatch| {
        let beyond = (patch.uv_min - p).max(p - patch.uv_max).max(DVec2::ZERO);
        (beyond / face.domain.size()).length()
    };
    let nearest = face.patches.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
    (off(&nearest) < 1e-6).then_some(nearest)
}

/// The least width of a piece's patch, as a part of the whole patch: a curve along a line of constant parameter still
/// needs the surface beside it for its normal.
const LEAST_WIDTH: f64 = 1e-3;

fn pack(
    shape: &RibbonShape,
    native: &BezierCurve2,
    points: &mut Vec<[f32; 4]>,
    curves: &mut Vec<[f32; 4]>,
) -> Option<(RibbonPiece, Extent)> {
    let whole = patch_at(shape.face, native.point(0.5))?;
    let on_whole = native.map_points(|p| whole.local(p));
    let (low, high) = on_whole.hull();
    let wide = DVec2::splat(LEAST_WIDTH).max(0.1 * (high - low).max_element() * DVec2::ONE);
    let beside = 0.5 * (wide - (high - low)).max(DVec2::ZERO);
    let min = (low - beside).clamp(DVec2::ZERO, DVec2::ONE - 0.5 * LEAST_WIDTH);
    let max = (high + beside).clamp(min + 0.5 * LEAST_WIDTH, DVec2::ONE);
    let mut patch = whole.restrict(min, max);
    let curve = on_whole.map_points(|p| (p - min) / (max - min));
    if !patch.points.iter().all(|p| p.is_finite()) || !curve.points.iter().all(|p| p.is_finite()) {
        return None;
    }
    let (speed, bend) = measure(&curve, &patch);
    let extent = Extent { curve: curve.clone(), patch: patch.clone(), speed, bend, gap: shape.gap };
    let (origin_high, origin_low) = split_high_low(patch.bounds().centre());
    let origin = DVec3::from(origin_high.map(f64::from)) + DVec3::from(origin_low.map(f64::from));
    patch.points.iter_mut().for_each(|p| *p -= origin);
    let (first_point, first_curve) = (points.len() as u32, curves.len() as u32);
    let heaviest = |weights: &[f64]| 1.0 / weights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let scale = heaviest(&patch.weights);
    points.extend(patch.points.iter().zip(&patch.weights).map(|(p, w)| {
        let h = (*p * (w * scale)).as_vec3();
        [h.x, h.y, h.z, (w * scale) as f32]
    }));
    // Scaled binomials stay in the shader's recurrence; degree 0 does not occur.
    let scale = heaviest(&curve.weights);
    curves.extend(curve.points.iter().zip(&curve.weights).map(|(p, w)| {
        let h = (*p * (w * scale)).as_vec2();
        [h.x, h.y, (w * scale) as f32, 0.0]
    }));
    let normalised = |p: DVec2| shape.face.domain.normalise(whole.native(p)).as_vec2().to_array();
    let piece = RibbonPiece {
        origin_high,
        first_point,
        origin_low,
        degrees: patch.degree_u as u32 | (patch.degree_v as u32) << 8 | (curve.degree() as u32) << 16,
        uv_min: normalised(min),
        uv_max: normalised(max),
        first_curve,
        face: shape.slot.0,
        other: shape.other.0,
        gap: shape.gap as f32,
    };
    Some((piece, extent))
}

/// Largest speed, and distance from the chord, by samples with a margin.
fn measure(curve: &BezierCurve2, patch: &BezierPatch) -> (f64, f64) {
    const STEPS: usize = 16;
    let at = |k: usize| {
        let uv = curve.point(k as f64 / STEPS as f64);
        patch.point(uv.x, uv.y)
    };
    let points: Vec<DVec3> = (0..=STEPS).map(at).collect();
    let speed = points.windows(2).map(|p| (p[1] - p[0]).length()).fold(0.0, f64::max) * STEPS as f64;
    // |C''| / 8 from second differences.
    let second = points.windows(3).map(|p| (p[0] - 2.0 * p[1] + p[2]).length()).fold(0.0, f64::max);
    (1.3 * speed, 1.5 * second * (STEPS * STEPS) as f64 / 8.0)
}
