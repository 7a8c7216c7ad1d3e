//! Pixels that may be pin holes: something farther shows where a nearer surface lies on both sides.
//!
//! Twin of `shaders/lib/holes.wgsl`. For every pixel the neighbours in four directions and their opposites are looked
//! at, up to a few pixels away. A pixel is a candidate when a neighbour and one opposite to it belong to faces that share
//! an edge, their tangent planes are about as deep at the pixel, and what the pixel shows lies behind both. Claux (2014)
//! finds holes to fill by the same opposite neighbours; here they are only candidates, for [`crate::inspect`] to prove
//! against the exact geometry.

use glam::{IVec2, Vec2};
use rayon::prelude::*;

use super::cast::{Fragment, view_ray};
use super::pack::unpack_normal;
use super::ray::{plane_depth, ray_point};
use super::visibility::VisibilityBuffer;
use crate::encoding::View;

/// A pixel behind a nearer surface on both sides of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoleCandidate {
    /// Column and row from the upper left.
    pub pixel: [u32; 2],
    /// Slots of the faces on both sides; the same twice where a face meets itself.
    pub faces: [u32; 2],
    /// View depth of the nearer of the two sides.
    pub z: f32,
}

/// How far neighbours are looked for, pixels: wider holes are found from their edges.
pub const REACH: i32 = 3;
/// Steps of a search grow slowly beyond this many pixels: the sides of a wide slit are wider than the steps.
const EXACT: i32 = 16;
const DIRECTIONS: [IVec2; 4] = [IVec2::X, IVec2::Y, IVec2::ONE, IVec2::new(1, -1)];

/// All candidates in `buffer`, by rows. `shares` tells whether two faces (slots) have an edge in common.
pub fn candidates(
    buffer: &VisibilityBuffer,
    view: &View,
    shares: &(dyn Fn(u32, u32) -> bool + Sync),
) -> Vec<HoleCandidate> {
    let look = Neighbourhood { buffer, view, shares };
    let row = |y: u32| (0..buffer.width).filter_map(move |x| look.candidate(x as i32, y as i32));
    (0..buffer.height).into_par_iter().flat_map_iter(row).collect()
}

/// View depth of a fragment that shows a surface.
pub fn z_of(view: &View, fragment: &Fragment) -> f32 {
    let [a, b, c, d] = view.depth;
    (fragment.depth * c - a) / (b - fragment.depth * d).min(-1e-30)
}

/// The pixels around one.
#[derive(Clone, Copy)]
pub(super) struct Neighbourhood<'a> {
    pub buffer: &'a VisibilityBuffer,
    pub view: &'a View,
    pub shares: &'a (dyn Fn(u32, u32) -> bool + Sync),
}

/// A nearer surface beside a pixel.
#[derive(Clone, Copy)]
struct Side {
    face: u32,
    z: f32,
    /// Depth of its tangent plane at the pixel.
    plane_z: f32,
    steps: i32,
}

impl Neighbourhood<'_> {
    /// Whether surfaces lie nearer right beside a pixel, on both sides, each of face `a` or `b` (slots).
    pub fn is_speck(&self, pixel: IVec2, [a, b]: [u32; 2]) -> bool {
        let here = self.buffer.at(pixel.x, pixel.y);
        let z = if here.words[0] == 0 { f32::INFINITY } else { z_of(self.view, &here) };
        DIRECTIONS.into_iter().any(|direction| {
            let side = |step: IVec2| {
                self.side(pixel, step, &here, z).filter(|side| side.face == a || side.face == b)
            };
            matches!((side(-direction), side(direction)), (Some(a), Some(b)) if self.one_depth(&a, &b, 0))
        })
    }

    pub fn candidate(&self, x: i32, y: i32) -> Option<HoleCandidate> {
        let pixel = IVec2::new(x, y);
        let here = self.buffer.at(x, y);
        let z = if here.words[0] == 0 { f32::INFINITY } else { z_of(self.view, &here) };
        for direction in DIRECTIONS {
            for near in 1..=REACH {
                let Some(a) = self.side(pixel, -near * direction, &here, z) else { continue };
                for far in 1..=REACH {
                    let Some(b) = self.side(pixel, far * direction, &here, z) else { continue };
                    if self.one_depth(&a, &b, 0) && (self.shares)(a.face, b.face) {
                        let faces = [a.face.min(b.face), a.face.max(b.face)];
                        return Some(HoleCandidate { pixel: [x as u32, y as u32], faces, z: a.z.min(b.z) });
                    }
                }
            }
        }
        None
    }

    /// The first nearer surface along `direction` (unit, pixels), up to `most` pixels away.
    fn search(&self, pixel: IVec2, direction: Vec2, most: i32) -> Option<Side> {
        let here = self.buffer.at(pixel.x, pixel.y);
        let z = if here.words[0] == 0 { f32::INFINITY } else { z_of(self.view, &here) };
        let mut k = 1;
        while k <= most {
            let step = (k as f32 * direction).round().as_ivec2();
            if let Some(side) = self.side(pixel, step, &here, z) {
                return Some(side);
            }
            k += 1 + k / EXACT;
        }
        None
    }

    /// Whether a slit across `direction` (unit, pixels) that is up to `most` pixels wide on either side holds a pixel.
    pub fn wide_candidate(&self, pixel: IVec2, direction: Vec2, most: i32) -> bool {
        let find = |direction: Vec2| self.search(pixel, direction, most);
        matches!((find(-direction), find(direction)), (Some(a), Some(b))
            if self.one_depth(&a, &b, most / 2) && (self.shares)(a.face, b.face))
    }

    /// Where a side of the slit lies outside of the picture or behind another face than `a` and `b` (slots): whether the
    /// slit is one farther along, where both can be seen.
    pub fn candidate_along(&self, pixel: IVec2, direction: Vec2, most: i32, [a, b]: [u32; 2]) -> bool {
        let size = Vec2::new(self.buffer.width as f32, self.buffer.height as f32);
        let inside = |p: Vec2| p.cmpge(Vec2::ZERO).all() && p.cmplt(size).all();
        let (centre, across) = (pixel.as_vec2() + 0.5, most as f32 * direction);
        if inside(centre + across) && inside(centre - across) {
            let find = |direction: Vec2| self.search(pixel, direction, most);
            let (Some(first), Some(second)) = (find(-direction), find(direction)) else { return false };
            let is_of = |side: Side| side.face == a || side.face == b;
            if is_of(first) == is_of(second) {
                return false;
            }
        }
        let along = Vec2::new(-direction.y, direction.x);
        let mut k = 1;
        while k <= 2 * most {
            for sign in [-1, 1] {
                let at = pixel + ((sign * k) as f32 * along).round().as_ivec2();
                if inside(at.as_vec2()) && self.wide_candidate(at, direction, most) {
                    return true;
                }
            }
            k *= 2;
        }
        false
    }

    fn width(&self, z: f32) -> f32 {
        self.view.pixel[0] + self.view.pixel[1] * z.abs()
    }

    /// The surface `step` beside the pixel if it is nearer and the pixel lies behind its tangent plane.
    fn side(&self, pixel: IVec2, step: IVec2, here: &Fragment, z: f32) -> Option<Side> {
        let at = pixel + step;
        if at.x < 0 || at.y < 0 || at.x >= self.buffer.width as i32 || at.y >= self.buffer.height as i32 {
            return None;
        }
        let there = self.buffer.at(at.x, at.y);
        if there.words[0] == 0 {
            return None;
        }
        let z_there = z_of(self.view, &there);
        // Rounding of depth; a surface of its own may lie right behind.
        let width = self.width(z_there);
        let own = here.words[0] == there.words[0];
        let least = if own { width } else { 0.02 * width + 4e-6 * z_there.abs() };
        if z - z_there <= least {
            return None;
        }
        let steps = step.abs().max_element();
        let plane_z = self.plane_z(at, pixel, z_there, there.words[3]);
        if z - plane_z <= least {
            return None;
        }
        // A surface that bends away lies behind its own tangent planes, seen from either place.
        if own && self.plane_z(pixel, at, z, here.words[3]) - z_there <= least {
            return None;
        }
        Some(Side { face: there.words[0] - 1, z: z_there, plane_z, steps })
    }

    /// Depth that the tangent plane of the surface at pixel `at` has at `pixel`; where the plane is seen from
    /// its edge, no more than a slope of 30 is believed.
    fn plane_z(&self, at: IVec2, pixel: IVec2, z: f32, normal: u32) -> f32 {
        let position = |p: IVec2| p.as_vec2() + 0.5 + Vec2::from(self.view.jitter);
        let (from, to) = (view_ray(self.view, position(at)), view_ray(self.view, position(pixel)));
        let limit = 30.0 * self.width(z) * (pixel - at).abs().max_element() as f32;
        plane_depth(unpack_normal(normal), ray_point(from, z), to).max(z - limit).min(z + limit)
    }

    /// Whether two sides may be the two sides of one slit: at the pixel their planes are about as deep.
    /// `step`: by how many pixels one may lie above the other.
    fn one_depth(&self, a: &Side, b: &Side, step: i32) -> bool {
        let apart = (a.plane_z - b.plane_z).abs() - self.width(a.z) * step as f32;
        let slope = (a.plane_z - a.z).abs() + (b.plane_z - b.z).abs();
        let slack = self.width(a.z) * (2.0 + 2.0 * (a.steps + b.steps) as f32);
        apart <= slack + 0.5 * slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encoding::DepthRange;
    use crate::kernel::view::{Camera, Projection};
    use crate::reference::pack::pack_normal;
    use glam::{DVec3, Vec3};

    /// Face 1 left of column 8, face 2 right of it, column 8 empty or showing what `behind` is.
    fn slit(behind: Fragment, z: impl Fn(u32) -> f32) -> (VisibilityBuffer, View) {
        let camera = Camera {
            eye: DVec3::new(0.0, 0.0, 10.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 16.0 },
        };
        let view = View::new(&camera, [16, 16], [0.0; 2], DepthRange { near: 0.0, far: 200.0 }, 0);
        let [a, b, ..] = view.depth;
        let fragment = |x: u32| {
            let face = if x < 8 { 1 } else { 2 };
            Fragment { words: [face, 0, 0, pack_normal(Vec3::NEG_Z)], depth: a + b * z(x) }
        };
        let at = |k: u32| if k % 16 == 8 { behind } else { fragment(k % 16) };
        (
            VisibilityBuffer {
                width: 16,
                height: 16,
                fragments: (0..256).map(at).collect(),
                counts: Default::default(),
            },
            view,
        )
    }

    #[test]
    fn a_slit_between_neighbours_is_found_and_nothing_else() {
        let both = |a: u32, b: u32| (a, b) == (0, 1) || (a, b) == (1, 0);
        let (buffer, view) = slit(Fragment::NONE, |_| 0.0);
        let found = candidates(&buffer, &view, &both);
        assert_eq!(found.len(), 16);
        assert!(found.iter().all(|c| c.pixel[0] == 8 && c.faces == [0, 1]));
        assert!(candidates(&buffer, &view, &|_, _| false).is_empty(), "no edge in common");
        // A face right behind it shows.
        let [a, b, ..] = view.depth;
        let behind = Fragment { words: [3, 0, 0, pack_normal(Vec3::NEG_Z)], depth: a + b * 0.5 };
        let (buffer, view) = slit(behind, |_| 0.0);
        assert_eq!(candidates(&buffer, &view, &both).len(), 16);
        // A face in front of both.
        let front = Fragment { depth: a - b * 0.5, ..behind };
        let (buffer, view) = slit(front, |_| 0.0);
        assert!(candidates(&buffer, &view, &both).is_empty());
    }

    #[test]
    fn steps_in_depth_and_valleys_are_no_slits() {
        let both = |a: u32, b: u32| a != b;
        // The right side lies far behind: what shows between is the background beside a silhouette.
        let (buffer, view) = slit(Fragment::NONE, |x| if x < 8 { 0.0 } else { 150.0 });
        let found = candidates(&buffer, &view, &both);
        assert!(found.is_empty(), "{found:?}");
        // Nothing is missing in a surface without a slit.
        let (mut buffer, view) = slit(Fragment::NONE, |_| 0.0);
        for y in 0..16 {
            buffer.fragments[y * 16 + 8] = buffer.fragments[y * 16 + 7];
        }
        assert!(candidates(&buffer, &view, &both).is_empty());
    }
}
