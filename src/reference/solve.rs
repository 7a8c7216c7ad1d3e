//! Newton's method on the exact rational patch. Twin of `shaders/lib/solve.wgsl`, which tells how.

use glam::{Vec2, Vec3, Vec4Swizzles};

use super::patch_jet::patch_jet;
use super::ray::Ray;
use super::seeds::{
    Conics, Seeds, conics_bilinear, conics_fold, conics_split, conics_value, seeds, select, solve_2x2,
};

/// Model axes seen from the viewer.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "named by direction")]
pub struct Axes {
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
}

/// A cell as the solver sees it: its quadratic model in view axes, relative to the reference point.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "described in the shader")]
pub struct Piece {
    pub first_point: u32,
    pub degrees: u32,
    pub residual: f32,
    pub size: f32,
    pub shift: Vec3,
    pub m00: Vec3,
    pub m10: Vec3,
    pub m01: Vec3,
    pub m20: Vec3,
    pub m11: Vec3,
    pub m02: Vec3,
}

/// What Newton's method found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Root {
    /// Whether the error left is known to be small.
    pub converged: bool,
    /// Surface evaluations made.
    pub evaluations: u32,
    /// Cell parameters.
    pub x: Vec2,
    /// View depth.
    pub z: f32,
    /// By how much `x` may be wrong.
    pub slack: f32,
    /// `du x dv` in view axes, unit.
    pub normal: Vec3,
}

/// Newton's own steps: to the only zero nearby.
pub const ANY: u32 = 0;
/// Steps to the nearer of two zeros.
pub const NEARER: u32 = 1;
/// Steps to the farther of two zeros.
pub const FARTHER: u32 = 2;

const MAX_STEPS: u32 = 8;
/// Rounding of cell parameters: cells overlap by this much so that no ray passes between them.
pub const HAIR: f32 = 4e-6;
/// The largest number below 1: trim tests are half open.
pub const BELOW_ONE: f32 = 0.999_999_94;
const PIXEL_TOLERANCE: f32 = 0.02;
const ROUNDING: f32 = 4e-7;

/// Coordinates of `p` along the axes.
pub fn axes_apply(axes: &Axes, p: Vec3) -> Vec3 {
    Vec3::new(axes.right.dot(p), axes.up.dot(p), axes.forward.dot(p))
}

fn project(ray: Ray, m: Vec3) -> Vec2 {
    m.truncate() - ray.slope * m.z
}

/// The model's two conics as the ray sees them.
pub fn piece_conics(ray: Ray, piece: &Piece) -> Conics {
    Conics {
        c00: project(ray, piece.m00) - ray.offset,
        c10: project(ray, piece.m10),
        c01: project(ray, piece.m01),
        c20: project(ray, piece.m20),
        c11: project(ray, piece.m11),
        c02: project(ray, piece.m02),
    }
}

fn model_z(piece: &Piece, x: Vec2) -> f32 {
    piece.m00.z
        + x.x * (piece.m10.z + x.x * piece.m20.z + x.y * piece.m11.z)
        + x.y * (piece.m01.z + x.y * piece.m02.z)
}

/// Where to start: the model's roots on or just beside the cell, nearest first. Where the model sees one
/// that may stand for two, both starts are that one.
pub fn piece_seeds(piece: &Piece, conics: &Conics) -> Seeds {
    let start = seeds(conics, piece.residual);
    let swap = start.count == 2 && model_z(piece, start.second) < model_z(piece, start.first);
    let first = select(start.first, start.second, swap);
    let second = select(start.second, start.first, swap);
    let twofold = start.count == 1 && conics_fold(conics, start.first);
    Seeds { count: select(start.count, 2, twofold), first, second: select(first, second, start.count == 2) }
}

/// What a step along the cell's curvature adds to the depth at a point whose derivatives are `slope`.
fn depth_step(piece: &Piece, slope: Vec2, d: Vec2) -> f32 {
    d.x * (slope.x + d.x * piece.m20.z + d.y * piece.m11.z) + d.y * (slope.y + d.y * piece.m02.z)
}

/// The step to the nearer or farther of the two zeros that the exact tangents and the model's curvature
/// show from here.
fn branch_step(local: &Conics, piece: &Piece, slope: Vec2, branch: u32, slack: f32) -> Vec2 {
    let both = conics_split(local, Vec2::ZERO, slack);
    let in_order = depth_step(piece, slope, both.first) <= depth_step(piece, slope, both.second);
    select(both.second, both.first, both.count == 1 || in_order == (branch == NEARER))
}

fn root_normal(piece: &Piece, ds: Vec3, dt: Vec3, x: Vec2) -> Vec3 {
    // The view axes are left-handed (z forward), so the factors change places.
    let n = dt.cross(ds);
    let c = 0.9 * x;
    let model_ds = piece.m10 + 2.0 * c.x * piece.m20 + c.y * piece.m11;
    let model_dt = piece.m01 + c.x * piece.m11 + 2.0 * c.y * piece.m02;
    let model_n = model_dt.cross(model_ds);
    let lost = n.dot(n) < 1e-8 * model_n.dot(model_n);
    let chosen = if lost { model_n } else { n };
    chosen / chosen.length().max(1e-37)
}

/// `pixel`: a pixel is `pixel.x + pixel.y z` wide at depth z. `branch`: [`ANY`], [`NEARER`] or [`FARTHER`].
#[expect(clippy::too_many_arguments, reason = "as in the shader, plus the array that it binds")]
pub fn newton(
    points: &[[f32; 4]],
    ray: Ray,
    axes: &Axes,
    piece: &Piece,
    conics: &Conics,
    pixel: Vec2,
    start: Vec2,
    branch: u32,
) -> Root {
    let mut root =
        Root { converged: false, evaluations: 0, x: start, z: 0.0, slack: 0.0, normal: Vec3::NEG_Z };
    for _ in 0..MAX_STEPS {
        let p01 = 0.5 + 0.5 * root.x;
        let jet =
            patch_jet(points, piece.first_point, piece.degrees & 0xff, piece.degrees >> 8, p01.x, p01.y);
        root.evaluations += 1;
        let inverse = 1.0 / jet.s.w;
        let p = axes_apply(axes, jet.s.xyz() * inverse);
        let ps = 0.5 * inverse * (axes_apply(axes, jet.du.xyz()) - p * jet.du.w);
        let pt = 0.5 * inverse * (axes_apply(axes, jet.dv.xyz()) - p * jet.dv.w);
        let at = p + piece.shift;
        let f = project(ray, at) - ray.offset;
        let fs = project(ray, ps);
        let ft = project(ray, pt);
        let tolerance = PIXEL_TOLERANCE * (pixel.x + pixel.y * at.z.abs()) + ROUNDING * piece.size;
        let slope = Vec2::new(ps.z, pt.z);
        let local = Conics { c00: f, c10: fs, c01: ft, ..*conics };
        let full = if branch == ANY {
            solve_2x2(fs, ft, -f)
        } else {
            branch_step(&local, piece, slope, branch, tolerance)
        };
        let delta = full.clamp(Vec2::splat(-0.5), Vec2::splat(0.5));
        let miss =
            if branch == ANY { conics_bilinear(conics, delta, delta) } else { conics_value(&local, delta) };
        let reach = delta.x.abs() + delta.y.abs();
        let predicted = miss.x.abs() + miss.y.abs() + 12.0 * piece.residual * reach * reach;
        root.x += delta;
        if root.x.x.abs().max(root.x.y.abs()) > 2.0 {
            break;
        }
        if predicted <= tolerance && delta == full {
            let ds = ps + 2.0 * delta.x * piece.m20 + delta.y * piece.m11;
            let dt = pt + delta.x * piece.m11 + 2.0 * delta.y * piece.m02;
            let det = (fs.x * ft.y - fs.y * ft.x).abs().max(1e-37);
            root.converged = true;
            root.z = at.z + depth_step(piece, slope, delta);
            root.slack = (2.0 * predicted * (fs.length() + ft.length()) / det).min(0.02);
            root.normal = root_normal(piece, ds, dt, root.x);
            break;
        }
    }
    root
}
