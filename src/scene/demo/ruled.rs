//! Walls of holes: the exact ruled surface between the images of one pcurve on two shells.
//!
//! The image of a cubic pcurve on a rational patch of degrees `(p, q)` is a rational curve of degree
//! `3 (p + q)`: homogeneous coordinates are polynomials of that degree, found here by interpolation.
//! Both shells must share knots and weights, which holds for scaled copies.

use glam::{DVec2, DVec3, DVec4};

use super::outline::interpolate;
use super::shape::surface;
use crate::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};

/// The wall from `outer` to `inner` along `loop_curves`: polynomial pieces none of which crosses a
/// knot line. u counts the pieces, v runs from 0 (outer) to 1 (inner).
pub fn wall(outer: &NurbsSurface, inner: &NurbsSurface, loop_curves: &[NurbsCurve2]) -> NurbsSurface {
    let (p, q) = outer.degrees();
    let degree = loop_curves[0].degree() * (p + q);
    let rows = |shell| -> Vec<DVec4> {
        let mut row: Vec<DVec4> = Vec::new();
        for curve in loop_curves {
            let image = image(shell, &within_period(shell, curve), degree);
            // Pieces share their end points exactly.
            row.extend(&image[usize::from(!row.is_empty())..]);
        }
        let first = row[0];
        if let Some(last) = row.last_mut() {
            *last = first;
        }
        row
    };
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for (a, b) in rows(outer).into_iter().zip(rows(inner)) {
        for point in [a, b] {
            points.push(point.truncate() / point.w);
            weights.push(point.w);
        }
    }
    let mut knots = vec![0.0; degree + 1];
    for piece in 1..loop_curves.len() {
        knots.extend(vec![piece as f64; degree]);
    }
    knots.extend(vec![loop_curves.len() as f64; degree + 1]);
    let knots_u = KnotVector::new(degree, knots).expect("these knots are sorted");
    let knots_v = KnotVector::bezier(1, 0.0, 1.0).expect("degree 1 is in range");
    surface(knots_u, knots_v, points, weights)
}

/// `curve` moved by whole periods in u into the knots of a shell that is closed in u.
fn within_period(shell: &NurbsSurface, curve: &NurbsCurve2) -> NurbsCurve2 {
    let (start, end) = shell.knots_u().domain();
    let (a, b) = curve.domain();
    let turns = ((curve.point(0.5 * (a + b)).x - start) / (end - start)).floor();
    curve.map_points(|p| p - DVec2::new(turns * (end - start), 0.0))
}

/// Homogeneous control points (weight last, coordinates premultiplied) of the image of `curve`.
fn image(shell: &NurbsSurface, curve: &NurbsCurve2, degree: usize) -> Vec<DVec4> {
    let (start, end) = curve.domain();
    let nodes: Vec<f64> =
        (0..=degree).map(|i| 0.5 - 0.5 * (std::f64::consts::PI * i as f64 / degree as f64).cos()).collect();
    let middle = curve.point(0.5 * (start + end));
    let values = nodes.iter().map(|t| homogeneous(shell, middle, curve.point(start + (end - start) * t)));
    let (xyz, w): (Vec<DVec3>, Vec<DVec2>) = values.map(|h| (h.truncate(), DVec2::new(h.w, 0.0))).unzip();
    let (xyz, w) = (interpolate(&nodes, xyz), interpolate(&nodes, w));
    xyz.into_iter().zip(w).map(|(p, w)| p.extend(w.x)).collect()
}

/// Homogeneous point of the patch that holds `inside`, at the parameters `at`.
fn homogeneous(shell: &NurbsSurface, inside: DVec2, at: DVec2) -> DVec4 {
    let (ku, kv) = (shell.knots_u(), shell.knots_v());
    let (su, sv) = (ku.span(inside.x), kv.span(inside.y));
    let (bu, bv) = (ku.basis(su, at.x, 0), kv.basis(sv, at.y, 0));
    let mut sum = DVec4::ZERO;
    for (i, a) in bu[0].iter().enumerate() {
        for (j, b) in bv[0].iter().enumerate() {
            let index = (su - ku.degree() + i) * kv.control_count() + sv - kv.degree() + j;
            let weight = a * b * shell.weights()[index];
            sum += (shell.points()[index] * weight).extend(weight);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::demo::outline::smooth;
    use crate::scene::demo::shape::sphere;

    #[test]
    fn walls_meet_both_shells_exactly() {
        let (outer, inner) = (sphere(3.0), sphere(2.5));
        let trim = smooth(|t| DVec2::new(1.5, 1.4) + DVec2::from_angle(t * std::f64::consts::TAU) * 0.3, 4);
        let wall = wall(&outer, &inner, &trim);
        assert_eq!(wall.degrees(), (12, 1));
        for (piece, curve) in trim.iter().enumerate() {
            for t in [0.0, 0.2, 0.7, 1.0] {
                let uv = curve.point(t);
                for (shell, v) in [(&outer, 0.0), (&inner, 1.0)] {
                    let off = wall.point(piece as f64 + t, v).distance(shell.point(uv.x, uv.y));
                    assert!(off < 1e-10, "{off}");
                }
            }
        }
    }
}
