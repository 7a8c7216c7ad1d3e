//! Parts of a face that have triangles of their own, so that what is near and in sight is fine and the rest is not made at all.
//!
//! A face that takes too many triangles at a level is cut in half across its longer direction, and so are its halves. Halves are
//! numbered like the nodes of a heap: those of node `n` are `2 n` and `2 n + 1`, the whole face is [`WHOLE`].

use glam::DVec2;

use super::coverage::{Coverage, coverage};
use crate::kernel::bezier::BezierPatch;
use crate::kernel::face::{Face, UvRect};
use crate::kernel::tessellate::Ground;
use crate::kernel::view::Bounds;

/// The node of a whole face.
pub const WHOLE: u32 = 1;
/// No node larger than this is divided.
const LAST_DIVIDED: u32 = u32::MAX / 4;
/// Parts thinner than this share of the face are not divided: its parameters are told apart no better where they are drawn.
const THINNEST: f64 = 1e-6;

/// A part of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Native parameters.
    pub rect: UvRect,
    /// Around all of it; empty where trims keep nothing.
    pub bounds: Bounds,
}

/// A piece cut in two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Halves {
    /// 0: cut at a value of u, 1: of v.
    pub axis: usize,
    /// That value.
    pub at: f64,
    /// The parts with smaller and with larger values.
    pub pieces: [Piece; 2],
}

/// Cuts a part `rect` of a face, its node `node`, in half; `None` where it is too thin.
pub fn halves(face: &Face, node: u32, rect: &UvRect) -> Option<Halves> {
    let share = rect.size() / face.domain.size();
    let wide = [share.x > THINNEST, share.y > THINNEST];
    if node > LAST_DIVIDED || !(wide[0] || wide[1]) {
        return None;
    }
    let ground = Ground::new(face);
    let longer = usize::from(extent(&ground, rect, 1) > extent(&ground, rect, 0));
    let axis = if wide[longer] { longer } else { 1 - longer };
    let at = 0.5 * (rect.min[axis] + rect.max[axis]);
    if !(rect.min[axis] < at && at < rect.max[axis]) {
        return None;
    }
    let (mut low, mut high) = (*rect, *rect);
    low.max[axis] = at;
    high.min[axis] = at;
    let pieces = [low, high].map(|rect| Piece { rect, bounds: bounds(face, &rect) });
    Some(Halves { axis, at, pieces })
}

/// Length of the surface along u (0) or v (1), the longest of three lines.
fn extent(ground: &Ground, rect: &UvRect, axis: usize) -> f64 {
    let point = |along: f64, across: f64| {
        let share = if axis == 0 { DVec2::new(along, across) } else { DVec2::new(across, along) };
        ground.point(rect.min + share * rect.size())
    };
    let length = |across: f64| {
        let step = |k: u32| point(f64::from(k) / 4.0, across).distance(point(f64::from(k + 1) / 4.0, across));
        (0..4).map(step).sum::<f64>()
    };
    [0.0, 0.5, 1.0].map(length).into_iter().fold(0.0, f64::max)
}

/// The box around the control points of a part of a face.
fn bounds(face: &Face, rect: &UvRect) -> Bounds {
    let [min, max] = [rect.min, rect.max].map(|p| face.domain.normalise(p));
    if coverage(&face.grid, min, max) == Coverage::Empty {
        return Bounds::EMPTY;
    }
    let meets = |p: &&BezierPatch| {
        let low = p.uv_min.max(rect.min);
        let high = p.uv_max.min(rect.max);
        low.x <= high.x && low.y <= high.y
    };
    let part = |p: &BezierPatch| {
        let [low, high] = [rect.min, rect.max].map(|at| p.local(at).clamp(DVec2::ZERO, DVec2::ONE));
        p.restrict(low, high).bounds()
    };
    face.patches.iter().filter(meets).map(part).fold(Bounds::EMPTY, Bounds::union)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::demo;

    #[test]
    fn halves_make_up_their_piece_and_lie_in_their_boxes() {
        let faces = demo::model().faces;
        for record in faces.iter().step_by(5) {
            let face = record.derive().expect("valid test data");
            let ground = Ground::new(&face);
            let mut rect = face.domain;
            for node in 1..12 {
                let halves = halves(&face, node, &rect).expect("wide enough");
                let [low, high] = halves.pieces;
                assert_eq!((low.rect.min, high.rect.max), (rect.min, rect.max));
                assert_eq!((low.rect.max[halves.axis], high.rect.min[halves.axis]), (halves.at, halves.at));
                for piece in halves.pieces.iter().filter(|p| !p.bounds.is_empty()) {
                    let slack = 1e-9 * (1.0 + piece.bounds.diagonal());
                    for k in 0..25 {
                        let share = DVec2::new(f64::from(k % 5), f64::from(k / 5)) / 4.0;
                        let p = ground.point(piece.rect.min + share * piece.rect.size());
                        assert!(p.distance(p.clamp(piece.bounds.min, piece.bounds.max)) <= slack, "{p}");
                    }
                }
                rect = if node % 2 == 0 { low.rect } else { high.rect };
            }
        }
    }

    #[test]
    fn what_is_too_thin_stays_whole() {
        let face = demo::model().faces[0].derive().expect("valid test data");
        let mut rect = face.domain;
        let mut count = 0;
        while let Some(halves) = halves(&face, 1, &rect) {
            rect = halves.pieces[0].rect;
            count += 1;
        }
        assert!((30..45).contains(&count), "{count}");
    }
}
