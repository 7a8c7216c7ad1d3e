//! Points of trim curves in space, and fat lines along them. Twin of `shaders/lib/ribbon.wgsl` and
//! `shaders/pass/conceal.wgsl`.

use glam::{DVec2, DVec3, IVec2, Vec2, Vec3, Vec3Swizzles, Vec4Swizzles};

use super::cast::{Fragment, view_axes};
use super::holes::{Neighbourhood, REACH, z_of};
use super::pack::pack_normal;
use super::patch_jet::patch_jet;
use super::raster::{Triangle, depth_of, place};
use super::ray::{Ray, plane_depth, ray_point};
use super::solve::{Axes, BELOW_ONE, axes_apply};
use super::visibility::VisibilityBuffer;
use crate::encoding::ribbon::{RibbonPiece, RibbonScene, RibbonSpan, SEGMENTS};
use crate::encoding::{FaceHeader, PackedScene, View};

/// A point of a trim curve in view axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RibbonPoint {
    /// The point.
    pub p: Vec3,
    /// Derivative along the curve.
    pub tangent: Vec3,
    /// `du x dv`, unit.
    pub normal: Vec3,
    /// Face-normalised parameters.
    pub uv: Vec2,
}

/// Value and derivative of a homogeneous curve.
fn curve_jet(points: &[[f32; 4]], first: u32, degree: u32, t: f32) -> (Vec3, Vec3) {
    let load = |index: u32| {
        let [x, y, w, _] = points[index as usize];
        Vec3::new(x, y, w)
    };
    let s = 1.0 - t;
    let (mut low, mut high) = (load(first), load(first + 1));
    let mut power = 1.0f32;
    let mut previous = high;
    for i in 1..degree {
        power *= t * (degree - i) as f32 / i as f32;
        let next = load(first + i + 1);
        low = low * s + power * previous;
        high = high * s + power * next;
        previous = next;
    }
    (low * s + high * t, degree as f32 * (high - low))
}

/// The point at `t` of a piece.
pub fn ribbon_point(
    ribbons: &RibbonScene,
    piece: &RibbonPiece,
    axes: &Axes,
    reference: (Vec3, Vec3),
    t: f32,
) -> RibbonPoint {
    let (p, d) = curve_jet(ribbons.curve_data(), piece.first_curve, piece.degrees >> 16, t);
    let local = p.xy() / p.z;
    let along = (d.xy() - local * d.z) / p.z;
    let (degree_u, degree_v) = (piece.degrees & 0xff, piece.degrees >> 8 & 0xff);
    let jet = patch_jet(ribbons.point_data(), piece.first_point, degree_u, degree_v, local.x, local.y);
    let inverse = 1.0 / jet.s.w;
    let p = jet.s.xyz() * inverse;
    let du = inverse * (jet.du.xyz() - p * jet.du.w);
    let dv = inverse * (jet.dv.xyz() - p * jet.dv.w);
    let high = Vec3::from(piece.origin_high) - reference.0;
    let low = Vec3::from(piece.origin_low) - reference.1;
    // The view axes are left-handed, so the factors change places.
    let n = axes_apply(axes, dv).cross(axes_apply(axes, du));
    let length = n.length();
    let (uv_min, uv_max) = (Vec2::from(piece.uv_min), Vec2::from(piece.uv_max));
    RibbonPoint {
        p: axes_apply(axes, p) + axes_apply(axes, high + low),
        tangent: axes_apply(axes, along.x * du + along.y * dv),
        normal: if length > 1e-37 { n / length } else { Vec3::NEG_Z },
        uv: uv_min * (1.0 - local) + uv_max * local,
    }
}

/// Direction of a curve on the screen, unit, in pixels (y down).
fn screen_direction(view: &View, at: &RibbonPoint, w: f32) -> Vec2 {
    let d = (at.tangent.xy() * w - at.p.xy() * (view.depth[3] * at.tangent.z))
        * Vec2::from(view.clip_scale)
        * Vec2::from(view.size)
        * Vec2::new(1.0, -1.0);
    if d.length() > 1e-30 { d / d.length() } else { Vec2::X }
}

/// By how many pixels per pixel a strip may rise with the tangent plane that it lies in.
const STEEPEST: f32 = 4.0;
/// Of two strips in one plane the one whose curve is nearer is shown: strips are this much farther per pixel.
const FARTHER_PX: f32 = 0.02;
/// A third face shows through a wide hole only when it is farther behind than this many times the distance from the
/// curve: where three faces meet, the third bends away beside and beyond the ends of the strip.
const CLEAR: f32 = 3.0;
const MARGIN_PX: f32 = 1.0;
const MOST_PX: f32 = 512.0;

/// The picture with the holes between faces that share an edge filled along `spans`.
pub fn conceal(
    scene: &PackedScene,
    ribbons: &RibbonScene,
    spans: &[RibbonSpan],
    raw: &VisibilityBuffer,
    view: &View,
) -> VisibilityBuffer {
    let mut result = raw.clone();
    for _ in 0..ROUNDS {
        let before = result.clone();
        for span in spans {
            let piece = &ribbons.piece_data()[span.piece as usize];
            let flags = |slot: u32| scene.faces.data()[slot as usize].flags;
            if flags(piece.face) & flags(piece.other) & FaceHeader::VISIBLE != 0 {
                draw_span(ribbons, span, piece, &before, view, &mut result);
            }
        }
    }
    result
}

/// Where several faces meet, a pixel may lie between two of which one is seen only once the other gap is filled.
pub const ROUNDS: u32 = 2;

/// A corner of a strip.
struct Corner {
    /// In pixels times w, and w.
    placed: DVec3,
    /// View depth.
    z: f32,
    uv: Vec2,
    normal: Vec3,
    sideways: Vec2,
    /// Beside the curve and beyond its end, pixels.
    off: Vec2,
}

fn draw_span(
    ribbons: &RibbonScene,
    span: &RibbonSpan,
    piece: &RibbonPiece,
    raw: &VisibilityBuffer,
    view: &View,
    result: &mut VisibilityBuffer,
) {
    let axes = view_axes(view);
    let xyz = |v: [f32; 4]| Vec3::new(v[0], v[1], v[2]);
    let reference = (xyz(view.reference_high), xyz(view.reference_low));
    let rung = |k: u32| {
        // The first and the last pair run on beyond the ends, so that no corner stays open.
        let part = (k.clamp(1, SEGMENTS + 1) - 1) as f32 / SEGMENTS as f32;
        let t = span.start * (1.0 - part) + span.end * part;
        let at = ribbon_point(ribbons, piece, &axes, reference, t);
        let w = view.depth[2] + view.depth[3] * at.p.z;
        let direction = screen_direction(view, &at, w);
        let pixel = view.pixel[0] + view.pixel[1] * at.p.z.abs();
        let reach = (piece.gap / pixel).min(MOST_PX) + MARGIN_PX;
        let sideways = Vec2::new(-direction.y, direction.x);
        let end = match k {
            0 => -reach,
            k if k == SEGMENTS + 2 => reach,
            _ => 0.0,
        };
        [-reach, reach].map(|side| {
            let shift_px = sideways * side + direction * end;
            let shift = shift_px * Vec2::new(2.0, -2.0) / Vec2::from(view.size);
            let w = if w == 0.0 { 1e-30 } else { w };
            let ndc = at.p.xy() * Vec2::from(view.clip_scale) / w + shift;
            let ray = Ray {
                slope: ndc * Vec2::from(view.slope_scale),
                offset: ndc * Vec2::from(view.offset_scale),
            };
            // In perspective no corner leaves its side of the eye.
            let most = if view.depth[3] == 0.0 { 1e30 } else { 0.5 * at.p.z.abs() };
            let limit = (STEEPEST * shift_px.length() * pixel).min(most);
            let z = plane_depth(at.normal, at.p, ray).max(at.p.z - limit).min(at.p.z + limit);
            let placed = place(view, ray_point(ray, z), DVec2::ZERO);
            Corner { placed, z, uv: at.uv, normal: at.normal, sideways, off: Vec2::new(side, end.abs()) }
        })
    };
    let mut last = rung(0);
    for k in 1..=SEGMENTS + 2 {
        let next = rung(k);
        for corners in [[&last[0], &last[1], &next[0]], [&next[0], &last[1], &next[1]]] {
            if let Some(triangle) = Triangle::new(corners.map(|corner| corner.placed), view) {
                fill(piece, corners, &triangle, raw, view, result);
            }
        }
        last = next;
    }
}

fn fill(
    piece: &RibbonPiece,
    corners: [&Corner; 3],
    triangle: &Triangle,
    raw: &VisibilityBuffer,
    view: &View,
    result: &mut VisibilityBuffer,
) {
    let shares = |a: u32, b: u32| (a, b) == (piece.face, piece.other) || (b, a) == (piece.face, piece.other);
    let look = Neighbourhood { buffer: raw, view, shares: &shares };
    for y in triangle.rows.0..triangle.rows.1 {
        for x in triangle.columns.0..triangle.columns.1 {
            let Some(part) = triangle.weights([x, y]) else { continue };
            let mix =
                |pick: &dyn Fn(&Corner) -> Vec3| (0..3).map(|k| part[k] * pick(corners[k])).sum::<Vec3>();
            let z_line: f32 = (0..3).map(|k| part[k] * corners[k].z).sum();
            let here = raw.at(x as i32, y as i32);
            let best = &mut result.fragments[(y * raw.width + x) as usize];
            let z_here = if here.words[0] == 0 { f32::INFINITY } else { z_of(view, &here) };
            if z_here <= z_line {
                continue;
            }
            let off: Vec2 = (0..3).map(|k| part[k] * corners[k].off).sum();
            let width = view.pixel[0] + view.pixel[1] * z_line.abs();
            let depth = depth_of(view, z_line + FARTHER_PX * off.x.abs() * width);
            if depth <= best.depth || depth > 1.0 {
                continue;
            }
            let reach = corners[0].off.x.abs().ceil() as i32;
            let across = mix(&|c| c.sideways.extend(0.0)).xy().normalize_or(Vec2::X);
            let pixel = IVec2::new(x as i32, y as i32);
            let third = here.words[0] != piece.face + 1 && here.words[0] != piece.other + 1;
            let clear = if third { CLEAR * (off.x.abs() + off.y) * width } else { 0.0 };
            let sides = [piece.face, piece.other];
            let hole = look.candidate(pixel.x, pixel.y).is_some()
                || look.is_speck(pixel, sides)
                || (reach >= REACH
                    && z_here > z_line + clear
                    && (look.wide_candidate(pixel, across, 2 * reach)
                        || (off.y <= 1.0 && look.candidate_along(pixel, across, 2 * reach, sides))));
            if !hole {
                continue;
            }
            let uv = mix(&|c| c.uv.extend(0.0)).xy().clamp(Vec2::ZERO, Vec2::splat(BELOW_ONE));
            let normal = mix(&|c| c.normal);
            let word = pack_normal(normal / normal.length().max(1e-37));
            *best = Fragment { words: [piece.face + 1, uv.x.to_bits(), uv.y.to_bits(), word], depth };
        }
    }
}
