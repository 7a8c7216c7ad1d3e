//! The trim curves of one face, lifted, each knowing on which side of it the face lies.
//!
//! A loop that is closed in uv has its face to the left when it runs counter-clockwise and an even number of the
//! others hold it, or neither. Faces with rings (loops closed by a period) ask their trimming.

use std::sync::Arc;

use glam::DVec2;

use super::edge::CurveAddress;
use super::ground::Ground;
use super::lifted::LiftedCurve;
use crate::kernel::face::{Face, Side};
use crate::kernel::nurbs::{NurbsCurve2, NurbsSurface};
use crate::kernel::trim::{EdgeId, LoopRole, UvRect};
use crate::scene::records::FaceRecord;

/// Points on each polynomial piece that stand for it when loops are turned and nested.
const POINTS: usize = 6;

/// All trim curves of `record`, number `face` of its model, in order; with the sides of the surface where
/// no loop bounds the face from outside. Curves whose image is not finite are left out.
pub fn lift(face: usize, record: &FaceRecord) -> Vec<LiftedCurve> {
    let surface = &record.surface;
    let mut loops: Vec<(Vec<NurbsCurve2>, Vec<Option<EdgeId>>)> = record
        .loops
        .iter()
        .map(|l| (l.curves.clone(), (0..l.curves.len()).map(|k| l.edge(k)).collect()))
        .collect();
    if record.loops.iter().all(|l| l.role == LoopRole::Inner || l.curves.is_empty()) {
        loops.push((sides(surface), vec![None; 4]));
    }
    let mut hull = UvRect::EMPTY;
    loops.iter().flat_map(|l| &l.0).flat_map(NurbsCurve2::points).for_each(|p| hull.include(*p));
    let ground = Arc::new(Ground::new(surface, &hull));
    let mut curves = Vec::new();
    for (trim_loop, (pcurves, edges)) in loops.iter().enumerate() {
        for (curve, (pcurve, edge)) in pcurves.iter().zip(edges).enumerate() {
            let address = CurveAddress { face, trim_loop, curve };
            curves.extend(LiftedCurve::new(address, &ground, pcurve, (record.part, *edge)));
        }
    }
    turn(&mut curves, &hull, record);
    curves
}

/// The four sides of a surface, counter-clockwise.
pub(super) fn sides(surface: &NurbsSurface) -> Vec<NurbsCurve2> {
    let corners = UvRect::of_surface(surface).corners();
    (0..4).map(|k| NurbsCurve2::line(corners[k], corners[(k + 1) % 4])).collect()
}

/// Sets on which side of each curve the face lies.
fn turn(curves: &mut [LiftedCurve], hull: &UvRect, record: &FaceRecord) {
    let size = hull.size().max_element();
    let mut polygons: Vec<Vec<DVec2>> = Vec::new();
    let mut closed = true;
    for group in curves.chunk_by(|a, b| a.address.trim_loop == b.address.trim_loop) {
        let polygon: Vec<DVec2> = group.iter().flat_map(polyline).collect();
        let (Some(last), Some(first)) = (group.last(), group.first()) else { continue };
        closed &= (last.uv(last.domain().1).0 - first.uv(first.domain().0).0).length() <= 0.1 * size;
        polygons.push(polygon);
    }
    if !closed {
        return ask_trimming(curves, record);
    }
    let left: Vec<bool> = (0..polygons.len())
        .map(|k| {
            let inside_of = (0..polygons.len()).filter(|o| *o != k && contains(&polygons[*o], &polygons[k]));
            (signed_area(&polygons[k]) > 0.0) == inside_of.count().is_multiple_of(2)
        })
        .collect();
    let mut groups = curves.chunk_by_mut(|a, b| a.address.trim_loop == b.address.trim_loop);
    for left in left {
        for curve in groups.next().into_iter().flatten() {
            curve.material_left = left;
        }
    }
}

fn polyline(curve: &LiftedCurve) -> impl Iterator<Item = DVec2> + '_ {
    curve.pieces().iter().flat_map(|(piece, _)| {
        let count = if piece.degree() == 1 { 1 } else { POINTS };
        (0..count).map(move |k| piece.point(k as f64 / count as f64))
    })
}

fn signed_area(polygon: &[DVec2]) -> f64 {
    let Some(origin) = polygon.first() else { return 0.0 };
    (0..polygon.len())
        .map(|k| (polygon[k] - origin).perp_dot(polygon[(k + 1) % polygon.len()] - origin))
        .sum()
}

/// Whether most of a few points of `inner` lie in `polygon` (even-odd): some may lie on it.
fn contains(polygon: &[DVec2], inner: &[DVec2]) -> bool {
    let (mut votes, mut asked) = (0, 0);
    for k in 0..3 {
        let at = k * inner.len() / 3;
        let p = 0.5 * (inner[at] + inner[(at + 1) % inner.len()]);
        let crossings = (0..polygon.len()).filter(|i| {
            let (a, b) = (polygon[*i], polygon[(i + 1) % polygon.len()]);
            (a.y <= p.y) != (b.y <= p.y) && a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) > p.x
        });
        votes += crossings.count() % 2;
        asked += 1;
    }
    2 * votes > asked
}

/// Looks a little to the left of the middle of each curve.
fn ask_trimming(curves: &mut [LiftedCurve], record: &FaceRecord) {
    const BESIDE: f64 = 1e-4;
    let Ok(face) = Face::derive(&record.surface, &record.loops) else { return };
    for curve in curves {
        let (a, b) = curve.domain();
        // Not quite the middle, where symmetric loops have their corners.
        let (uv, d) = curve.uv(a + 0.47 * (b - a));
        let size = face.domain.size();
        let along = d / size;
        let Some(left) = DVec2::new(-along.y, along.x).try_normalize() else { continue };
        let side = |sign: f64| {
            let p = uv + left * size * BESIDE * sign;
            face.classify_native(p.x, p.y) == Side::In
        };
        curve.material_left = side(1.0) || !side(-1.0);
    }
}
