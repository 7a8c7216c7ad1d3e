//! Points of a surface in an order that shares work (P2, section 8: coherent evaluation).
//!
//! A tensor product surface at (u, v) is a curve in u whose control points depend on v alone. Where one point after
//! the other has the same v, bit for bit, the curve is kept. Corners of the cells of a kd-tree, sorted by v, often do.

use glam::{DVec2, DVec4};

use super::outline::Ground;
use crate::kernel::bezier::bernstein::{self, MAX_COUNT};
use crate::kernel::bezier::{BezierPatch, Tangents};

/// Evaluates a surface, remembering the curve of the last v.
pub struct CoherentPoints<'a> {
    ground: &'a Ground<'a>,
    /// Patch and v of the curve.
    at: Option<(&'a BezierPatch, u64)>,
    /// Homogeneous control points of the curve and their derivatives in v.
    row: Vec<[DVec4; 2]>,
    /// Curves made so far.
    pub rows: usize,
}

impl<'a> CoherentPoints<'a> {
    /// Nothing remembered.
    pub fn new(ground: &'a Ground<'a>) -> Self {
        Self { ground, at: None, row: Vec::new(), rows: 0 }
    }

    /// Point and derivatives in native parameters at `uv`; as [`Ground::tangents`] up to rounding.
    pub fn tangents(&mut self, uv: DVec2) -> Tangents {
        let Some((patch, local)) = self.ground.locate(uv) else { return self.ground.tangents(uv) };
        let key = local.y.to_bits();
        if !self.at.is_some_and(|(p, v)| std::ptr::eq(p, patch) && v == key) {
            self.at = Some((patch, key));
            self.rows += 1;
            match patch.degree_v {
                0..4 => self.collapse::<4>(patch, local.y),
                4..8 => self.collapse::<8>(patch, local.y),
                _ => self.collapse::<MAX_COUNT>(patch, local.y),
            }
        }
        match patch.degree_u {
            0..4 => self.along::<4>(patch, local.x),
            4..8 => self.along::<8>(patch, local.x),
            _ => self.along::<MAX_COUNT>(patch, local.x),
        }
    }

    fn collapse<const N: usize>(&mut self, patch: &BezierPatch, v: f64) {
        let basis = bernstein::tangent::<N>(patch.degree_v, v);
        let count = patch.degree_v + 1;
        self.row.clear();
        for (points, weights) in patch.points.chunks(count).zip(patch.weights.chunks(count)) {
            let mut sums = [DVec4::ZERO; 2];
            for (j, (p, w)) in points.iter().zip(weights).enumerate() {
                let h = (*p * *w).extend(*w);
                sums[0] += h * basis[0][j];
                sums[1] += h * basis[1][j];
            }
            self.row.push(sums);
        }
    }

    fn along<const N: usize>(&self, patch: &BezierPatch, u: f64) -> Tangents {
        let basis = bernstein::tangent::<N>(patch.degree_u, u);
        let [mut here, mut in_u, mut in_v] = [DVec4::ZERO; 3];
        for (i, [h, d]) in self.row.iter().enumerate() {
            here += *h * basis[0][i];
            in_u += *h * basis[1][i];
            in_v += *d * basis[0][i];
        }
        let point = here.truncate() / here.w;
        let size = patch.uv_max - patch.uv_min;
        let derivative = |h: DVec4, size: f64| (h.truncate() - point * h.w) / (here.w * size);
        Tangents { point, du: derivative(in_u, size.x), dv: derivative(in_v, size.y) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::face::Face;
    use crate::scene::demo;

    #[test]
    fn points_in_rows_are_those_of_the_surface_and_share_their_curves() {
        for record in demo::model().faces.iter().take(6) {
            let face: Face = record.derive().unwrap();
            let ground = Ground::new(&face);
            let mut points = CoherentPoints::new(&ground);
            let mut across = std::collections::BTreeSet::new();
            for k in 0..99 {
                let uv = face.domain.native(DVec2::new(f64::from(k % 11) / 10.0, f64::from(k / 11) / 8.0));
                let (found, exact) = (points.tangents(uv), ground.tangents(uv));
                let size = face.bounds.diagonal() + exact.du.length() + exact.dv.length();
                assert!(found.point.distance(exact.point) < 1e-12 * size);
                assert!(
                    found.du.distance(exact.du) < 1e-9 * size && found.dv.distance(exact.dv) < 1e-9 * size
                );
                let (patch, local) = ground.locate(uv).unwrap();
                across.insert((patch.uv_min.x.to_bits(), patch.uv_min.y.to_bits(), local.y.to_bits()));
            }
            assert_eq!(points.rows, across.len());
        }
    }
}
