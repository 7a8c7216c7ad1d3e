//! The visibility buffer as colours. Twin of `shaders/pass/resolve.wgsl`.

use glam::{IVec2, Vec2, Vec3, Vec4};

use super::cast::Fragment;
use super::pack::{unpack_heat_normal, unpack_normal};
use super::ray::{Ray, ray_point};
use super::shade::{
    deviation_colour, difference_colour, face_palette, heat_colour, inside_tint, lit, mix, uv_board,
};
use super::visibility::VisibilityBuffer;
use crate::encoding::{FaceHeader, Look};

const MODE_SHADED: u32 = 0;
const MODE_FACES: u32 = 1;
const MODE_UV: u32 = 2;
const MODE_HEAT: u32 = 3;
const MODE_DEVIATION: u32 = 4;
/// Wider lines are cut to this.
const MOST_EDGE_PIXELS: i32 = 4;

fn z_of(look: &Look, fragment: Fragment) -> f32 {
    let d = fragment.depth;
    (d * look.depth[2] - look.depth[0]) / (look.depth[1] - d * look.depth[3]).min(-1e-30)
}

fn ray_at(look: &Look, pixel: Vec2) -> Ray {
    let ndc = (2.0 * pixel / Vec2::from(look.size) - 1.0) * Vec2::new(1.0, -1.0);
    Ray { slope: ndc * Vec2::from(look.slope_scale), offset: ndc * Vec2::from(look.offset_scale) }
}

/// Where a pixel's surface is.
struct Place {
    pixel: IVec2,
    here: Fragment,
    z: f32,
    p: Vec3,
    n: Vec3,
}

fn edge_to(look: &Look, buffer: &VisibilityBuffer, place: &Place, step: IVec2) -> bool {
    let beside = place.pixel + step;
    let within =
        beside.x >= 0 && beside.y >= 0 && beside.x < buffer.width as i32 && beside.y < buffer.height as i32;
    let there = buffer.at(beside.x, beside.y);
    if there.words[0] == 0 {
        return within;
    }
    let (z, z_there) = (place.z, z_of(look, there));
    let width = look.pixel[0] + look.pixel[1] * z.abs();
    if there.words[0] != place.here.words[0] {
        let tie = (z_there - z).abs() < 2.0 * width;
        return if tie { place.here.words[0] < there.words[0] } else { z < z_there };
    }
    let ray = ray_at(look, beside.as_vec2() + 0.5 + Vec2::from(look.jitter));
    let along = ray.slope.extend(1.0);
    let down = place.n.dot(along);
    let safe = if down.abs() < 1e-6 { -1e-6 } else { down };
    let plane_z = place.n.dot(place.p - ray.offset.extend(0.0)) / safe;
    let width = (step.x.abs() + step.y.abs()) as f32 * width;
    z_there - plane_z.max(z) > 12.0 * width && down.abs() > 1e-6 && z_there - z > 12.0 * width
}

/// How much of the pixel a line covers that runs along an edge, on the side that draws it.
fn edge_cover(look: &Look, buffer: &VisibilityBuffer, place: &Place) -> f32 {
    for k in 1..=MOST_EDGE_PIXELS {
        let cover = (look.edge_width - (k - 1) as f32).clamp(0.0, 1.0);
        if cover <= 0.0 {
            break;
        }
        let steps = [IVec2::X, IVec2::NEG_X, IVec2::Y, IVec2::NEG_Y];
        if steps.into_iter().any(|step| edge_to(look, buffer, place, k * step)) {
            return cover;
        }
    }
    0.0
}

/// The colour of one pixel in a picture of what fat lines changed in `raw`.
pub fn resolve_difference(
    look: &Look,
    faces: &[FaceHeader],
    (buffer, raw): (&VisibilityBuffer, &VisibilityBuffer),
    x: i32,
    y: i32,
) -> Vec4 {
    let colour = resolve(look, faces, buffer, x, y);
    let here = buffer.at(x, y).words;
    if here[0] == 0 {
        return colour;
    }
    difference_colour(colour.truncate(), raw.at(x, y).words != here).extend(colour.w)
}

/// The premultiplied linear colour of one pixel; transparent where there is no surface.
pub fn resolve(look: &Look, faces: &[FaceHeader], buffer: &VisibilityBuffer, x: i32, y: i32) -> Vec4 {
    let here = buffer.at(x, y);
    if here.words[0] == 0 {
        return Vec4::ZERO;
    }
    let face = &faces[here.words[0] as usize - 1];
    let z = z_of(look, here);
    let ray = ray_at(look, Vec2::new(x as f32 + 0.5, y as f32 + 0.5) + Vec2::from(look.jitter));
    let p = ray_point(ray, z);
    let eye = -ray.slope.extend(1.0).normalize();
    let heat = matches!(look.mode, MODE_HEAT | MODE_DEVIATION);
    let mut n = if heat { unpack_heat_normal(here.words[3]) } else { unpack_normal(here.words[3]) };
    let outside = (n.dot(eye) >= 0.0) != (face.flags & FaceHeader::REVERSED != 0);
    if n.dot(eye) < 0.0 {
        n = -n;
    }
    let mut base = Vec3::from(face.colour);
    match look.mode {
        MODE_SHADED if !outside => base = inside_tint(base),
        MODE_FACES => base = face_palette(face.number),
        MODE_UV => base = uv_board(Vec2::new(f32::from_bits(here.words[1]), f32::from_bits(here.words[2]))),
        MODE_HEAT => base = heat_colour(here.words[3]),
        MODE_DEVIATION => base = deviation_colour(here.words[3] & 255),
        _ => {}
    }
    let tint = |base: Vec3, by: [f32; 4]| mix(base, Vec3::new(by[0], by[1], by[2]), by[3]);
    if face.flags & FaceHeader::SELECTED != 0 {
        base = tint(base, look.selected);
    }
    if face.flags & FaceHeader::HOVERED != 0 {
        base = tint(base, look.hovered);
    }
    let mut colour = lit(base, n, eye);
    if look.edges != 0 {
        let place = Place { pixel: IVec2::new(x, y), here, z, p, n };
        let [red, green, blue, strength] = look.edge;
        colour = tint(colour, [red, green, blue, strength * edge_cover(look, buffer, &place)]);
    }
    colour.extend(1.0)
}
