//! The f64 oracle: even-odd or winding number by crossing a ray with the exact monotone pieces, and the
//! distance to the nearest trim curve for points that are on one.
//!
//! Shares the split into monotone pieces with the structures, but neither f32 vertices nor records nor any
//! cell: crossings are found by bisection in f64 on the curves themselves.

use glam::DVec2;

use super::FillRule;
use super::pieces::{Piece, PieceList};

/// Winding number of `p` (a ray in +u, half-open in v).
pub fn winding(list: &PieceList, p: DVec2) -> i32 {
    let mut winding = 0;
    for piece in list.pieces() {
        let (a, b) = (list.start(piece), list.end(piece));
        let (low, high) = (a.y.min(b.y), a.y.max(b.y));
        if p.y < low || p.y >= high {
            continue;
        }
        let right = if p.x < a.x.min(b.x) {
            true
        } else if p.x >= a.x.max(b.x) {
            false
        } else {
            u_at(list, piece, p.y) > p.x
        };
        if right {
            winding += if b.y > a.y { 1 } else { -1 };
        }
    }
    winding
}

/// Whether `p` is inside.
pub fn inside(list: &PieceList, p: DVec2, rule: FillRule) -> bool {
    let winding = winding(list, p);
    match rule {
        FillRule::EvenOdd => winding & 1 != 0,
        FillRule::NonZero => winding != 0,
    }
}

/// The piece's u where it has height `v`.
fn u_at(list: &PieceList, piece: &Piece, v: f64) -> f64 {
    let (a, b) = (list.start(piece), list.end(piece));
    let upward = b.y > a.y;
    if piece.degree == 1 {
        return a.x + (b.x - a.x) * ((v - a.y) / (b.y - a.y));
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..64 {
        let t = 0.5 * (low + high);
        if t == low || t == high {
            break;
        }
        if (point(list, piece, t).y <= v) == upward {
            low = t;
        } else {
            high = t;
        }
    }
    point(list, piece, 0.5 * (low + high)).x.clamp(a.x.min(b.x), a.x.max(b.x))
}

/// Point of a piece at `t`, Horner's scheme in Bernstein form.
pub fn point(list: &PieceList, piece: &Piece, t: f64) -> DVec2 {
    let (points, weights) = (list.points(piece), list.weights(piece));
    let n = points.len() - 1;
    let s = 1.0 - t;
    let origin = points[0];
    let (mut power, mut binomial) = (1.0, 1.0);
    let (mut x, mut w) = (DVec2::ZERO, weights[0]);
    for i in 1..=n {
        power *= t;
        binomial *= (n - i + 1) as f64 / i as f64;
        let factor = binomial * power * weights[i];
        x = x * s + (points[i] - origin) * factor;
        w = w * s + factor;
    }
    origin + x / w
}

/// Whether some trim curve passes within `tolerance` of `p`.
pub fn is_on(list: &PieceList, p: DVec2, tolerance: f64) -> bool {
    list.pieces().iter().any(|piece| is_on_piece(list, piece, p, tolerance))
}

/// Whether one piece passes within `tolerance` of `p`.
pub fn is_on_piece(list: &PieceList, piece: &Piece, p: DVec2, tolerance: f64) -> bool {
    let (a, b) = (list.start(piece), list.end(piece));
    let reach = DVec2::splat(tolerance);
    let near = (p - (a.min(b) - reach)).min_element() >= 0.0 && (a.max(b) + reach - p).min_element() >= 0.0;
    near && reaches(list, piece, p, tolerance, (0.0, a), (1.0, b), 0)
}

/// Whether the part of a monotone piece between two of its points comes within `tolerance` of `p`.
fn reaches(
    list: &PieceList,
    piece: &Piece,
    p: DVec2,
    tolerance: f64,
    (ta, a): (f64, DVec2),
    (tb, b): (f64, DVec2),
    depth: u32,
) -> bool {
    if piece.degree == 1 {
        return distance_to_segment(p, a, b) <= tolerance;
    }
    // The part lies in the box of its ends.
    let nearest = p.clamp(a.min(b), a.max(b));
    if nearest.distance(p) > tolerance {
        return false;
    }
    if p.distance(a) <= tolerance || p.distance(b) <= tolerance {
        return true;
    }
    if depth >= 60 || a.distance(b) <= 0.25 * tolerance {
        return distance_to_segment(p, a, b) <= tolerance;
    }
    let t = 0.5 * (ta + tb);
    let m = point(list, piece, t).clamp(a.min(b), a.max(b));
    reaches(list, piece, p, tolerance, (ta, a), (t, m), depth + 1)
        || reaches(list, piece, p, tolerance, (t, m), (tb, b), depth + 1)
}

fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let chord = b - a;
    let squared = chord.length_squared();
    let t = if squared > 0.0 { ((p - a).dot(chord) / squared).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + chord * t)
}
