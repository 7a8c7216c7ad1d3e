//! Cells: pieces of a face that are nearly quadratic, the unit that rays are cast at.
//!
//! A cell carries its own control points relative to its own origin, so rounding to `f32` is relative to
//! the cell and not to the model; an oriented box drawn as its proxy; and a quadratic model that gives
//! Newton's method its starting points.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec2, DVec3};

use crate::kernel::bezier::BezierPatch;

/// Mirror of `Cell` in `shaders/layout/cell.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[expect(missing_docs, reason = "described in the shader's layout")]
pub struct Cell {
    pub box_centre: [f32; 3],
    pub face: u32,
    pub box_x: [f32; 4],
    pub box_y: [f32; 4],
    pub box_z: [f32; 4],
    pub origin_high: [f32; 3],
    pub first_point: u32,
    pub origin_low: [f32; 3],
    pub degrees: u32,
    pub uv_min: [f32; 2],
    pub uv_max: [f32; 2],
    pub m00: [f32; 3],
    pub residual: f32,
    pub m10: [f32; 3],
    pub size: f32,
    pub m01: [f32; 3],
    pub flags: u32,
    pub m20: [f32; 3],
    pub pad1: u32,
    pub m11: [f32; 3],
    pub pad2: u32,
    pub m02: [f32; 3],
    pub pad3: u32,
}

impl Cell {
    /// No trim curve passes through the cell: everything on it is kept.
    pub const WHOLE: u32 = 1;
}

/// The quadratic `m[0] + m[1] s + m[2] t + m[3] s^2 + m[4] s t + m[5] t^2` near a patch, for s, t in -1..1.
#[derive(Debug, Clone, Copy)]
pub struct QuadraticModel {
    /// Coefficients, model units.
    pub coefficients: [DVec3; 6],
    /// Largest distance from the patch found by sampling, with a margin.
    pub residual: f64,
}

impl QuadraticModel {
    /// Fits `patch` through a grid of 3 by 3 points and measures the error at 6 by 6 others.
    pub fn fit(patch: &BezierPatch) -> Self {
        let at = |s: f64, t: f64| patch.point(0.5 + 0.5 * s, 0.5 + 0.5 * t);
        let c = at(0.0, 0.0);
        let (e, w, n, s) = (at(1.0, 0.0), at(-1.0, 0.0), at(0.0, 1.0), at(0.0, -1.0));
        let twist = at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0);
        let coefficients =
            [c, 0.5 * (e - w), 0.5 * (n - s), 0.5 * (e + w) - c, 0.25 * twist, 0.5 * (n + s) - c];
        let mut model = Self { coefficients, residual: 0.0 };
        const SAMPLES: [f64; 6] = [-1.0, -0.75, -0.4, 0.4, 0.75, 1.0];
        for s in SAMPLES {
            for t in SAMPLES {
                model.residual = model.residual.max((at(s, t) - model.point(s, t)).length());
            }
        }
        // Sampling misses the peak by little: the error is a cubic at leading order.
        model.residual *= 1.25;
        model
    }

    /// Point of the model.
    pub fn point(&self, s: f64, t: f64) -> DVec3 {
        let m = &self.coefficients;
        m[0] + s * (m[1] + s * m[3] + t * m[4]) + t * (m[2] + t * m[5])
    }

    /// Derivatives in s and t.
    pub fn tangents(&self, s: f64, t: f64) -> (DVec3, DVec3) {
        let m = &self.coefficients;
        (m[1] + 2.0 * s * m[3] + t * m[4], m[2] + s * m[4] + 2.0 * t * m[5])
    }

    /// Smallest singular value of the derivative at the centre: how far a unit of (s, t) at least moves.
    pub fn least_stretch(&self) -> f64 {
        let (a, b) = (self.coefficients[1], self.coefficients[2]);
        let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
        let radius = (0.25 * (aa - bb) * (aa - bb) + ab * ab).sqrt();
        (0.5 * (aa + bb) - radius).max(0.0).sqrt()
    }
}

/// An oriented box.
#[derive(Debug, Clone, Copy)]
pub struct OrientedBox {
    /// Centre.
    pub centre: DVec3,
    /// Unit axes (columns), right-handed.
    pub axes: DMat3,
    /// Half lengths along them.
    pub half: DVec3,
}

impl OrientedBox {
    /// The box around the control points of `patch` along the tangents and the normal of `model`.
    pub fn around(patch: &BezierPatch, model: &QuadraticModel) -> Self {
        let axes = frame(model.coefficients[1], model.coefficients[2], patch);
        let local = axes.transpose();
        let (low, high) = patch
            .points
            .iter()
            .map(|p| local * *p)
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        Self { centre: axes * (0.5 * (low + high)), axes, half: 0.5 * (high - low) }
    }
}

/// An orthonormal frame: first axis along the longer tangent, third along the normal.
fn frame(ds: DVec3, dt: DVec3, patch: &BezierPatch) -> DMat3 {
    let (long, short) = if ds.length_squared() >= dt.length_squared() { (ds, dt) } else { (dt, ds) };
    let diagonal = patch.points[patch.points.len() - 1] - patch.points[0];
    let x = long.try_normalize().or(diagonal.try_normalize()).unwrap_or(DVec3::X);
    let across = short - x * x.dot(short);
    let y = match across.try_normalize() {
        Some(y) if across.length() > 1e-9 * long.length() => y,
        _ => x.any_orthonormal_vector(),
    };
    DMat3::from_cols(x, y, x.cross(y))
}

/// Splits a coordinate into a rounded part and the rest, both `f32`.
pub fn split_high_low(p: DVec3) -> ([f32; 3], [f32; 3]) {
    let high = p.as_vec3();
    (high.to_array(), (p - high.as_dvec3()).as_vec3().to_array())
}

/// Packs one nearly quadratic `patch`; `uv` are the face-normalised parameters of its corners. The
/// control points are appended to `points`, and `first_point` counts from there.
pub fn pack(patch: &BezierPatch, uv: (DVec2, DVec2), face: u32, points: &mut Vec<[f32; 4]>) -> Cell {
    let origin = patch.bounds().centre();
    // What f32 pairs can express of the origin.
    let (origin_high, origin_low) = split_high_low(origin);
    let origin = DVec3::from(origin_high.map(f64::from)) + DVec3::from(origin_low.map(f64::from));
    let mut patch = patch.clone();
    patch.points.iter_mut().for_each(|p| *p -= origin);
    let model = QuadraticModel::fit(&patch);
    let bound = OrientedBox::around(&patch, &model);
    let size = bound.half.length();
    // Far above the rounding of centre, axes and corners in f32.
    let margin = 4e-6 * (size + bound.centre.length());
    let axis = |k: usize| {
        let a = bound.axes.col(k).as_vec3();
        [a.x, a.y, a.z, (bound.half[k] + margin) as f32]
    };
    let first_point = points.len() as u32;
    let scale = 1.0 / patch.weights.iter().copied().fold(0.0, f64::max);
    points.extend(patch.points.iter().zip(&patch.weights).map(|(p, w)| {
        let w = w * scale;
        let h = (*p * w).as_vec3();
        [h.x, h.y, h.z, w as f32]
    }));
    let m = model.coefficients.map(|c| c.as_vec3().to_array());
    Cell {
        box_centre: bound.centre.as_vec3().to_array(),
        face,
        box_x: axis(0),
        box_y: axis(1),
        box_z: axis(2),
        origin_high,
        first_point,
        origin_low,
        degrees: patch.degree_u as u32 | (patch.degree_v as u32) << 8,
        uv_min: uv.0.as_vec2().to_array(),
        uv_max: uv.1.as_vec2().to_array(),
        m00: m[0],
        residual: model.residual as f32,
        m10: m[1],
        size: (size + 2.0 * margin) as f32,
        m01: m[2],
        flags: 0,
        m20: m[3],
        pad1: 0,
        m11: m[4],
        pad2: 0,
        m02: m[5],
        pad3: 0,
    }
}
