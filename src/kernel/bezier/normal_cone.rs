//! Cones that hold every normal of a patch.
//!
//! The (unnormalised) normal of a rational patch `P / W` is a positive multiple of
//! `N = W (Pu x Pv) + Wv (P x Pu) + Wu (Pv x P)`, a polynomial patch: its Bernstein coefficients,
//! computed exactly by Bernstein products, span a convex cone that holds all normals (Sederberg & Meyers
//! 1988, "Loop detection in surface patch intersections"; the rational numerator as in Hohenberger &
//! Reuding 1995). A half angle below a quarter turn means that the patch is a graph over the plane
//! across the axis: no silhouette for rays near the axis, one root at most.

use glam::DVec3;

use super::BezierPatch;
use super::products::Net;

/// All normals `du x dv` of a patch make at most `half_angle` with `axis`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalCone {
    /// Unit vector.
    pub axis: DVec3,
    /// Radians, below a half turn.
    pub half_angle: f64,
}

impl BezierPatch {
    /// The cone of the normals `du x dv`; `None` when they spread over a half space or more, or vanish
    /// everywhere. Points where the normal vanishes (poles) do not count.
    pub fn normal_cone(&self) -> Option<NormalCone> {
        let normals = self.normal_net();
        let largest = normals.iter().map(|n| n.length()).fold(0.0, f64::max);
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        // Below this a coefficient is rounding (a pole's), not a direction.
        let negligible = largest * 1e-12;
        let directions: Vec<DVec3> =
            normals.iter().filter(|n| n.length() > negligible).map(|n| n.normalize()).collect();
        let axis = directions.iter().copied().sum::<DVec3>().try_normalize()?;
        let cosine = directions.iter().map(|d| d.dot(axis)).fold(1.0, f64::min);
        // The margin covers the rounding of the products above.
        (cosine > 1e-6).then(|| NormalCone { axis, half_angle: cosine.min(1.0).acos() + 1e-7 })
    }

    /// The scaled Bernstein coefficients of the numerator of `du x dv`; positive multiples of the
    /// control vectors, so they span the same cone.
    fn normal_net(&self) -> Vec<DVec3> {
        let net = Net::of(self);
        let (du, dv) = (net.difference_u(), net.difference_v());
        let (pu, pv) = (du.scaled(|h| h.0), dv.scaled(|h| h.0));
        let cross = pu.product(&pv, |a, b| a.cross(b));
        if !self.is_rational() {
            return cross.coefficients;
        }
        let (p, w) = (net.scaled(|h| h.0), net.scaled(|h| h.1));
        let (wu, wv) = (du.scaled(|h| h.1), dv.scaled(|h| h.1));
        let first = cross.product(&w, |a, b| a * b);
        let second = p.product(&pu, |a, b| a.cross(b)).product(&wv, |a, b| a * b);
        let third = pv.product(&p, |a, b| a.cross(b)).product(&wu, |a, b| a * b);
        let sum = first.coefficients.iter().zip(&second.coefficients).zip(&third.coefficients);
        sum.map(|((a, b), c)| *a + *b + *c).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn bilinear(corner: DVec3) -> BezierPatch {
        BezierPatch {
            degree_u: 1,
            degree_v: 1,
            points: vec![DVec3::ZERO, DVec3::Y, DVec3::X, corner],
            weights: vec![1.0; 4],
            uv_min: DVec2::ZERO,
            uv_max: DVec2::ONE,
        }
    }

    #[test]
    fn a_plane_has_one_normal() {
        let cone = bilinear(DVec3::new(1.0, 1.0, 0.0)).normal_cone().expect("flat");
        assert!((cone.axis - DVec3::Z).length() < 1e-12);
        assert!(cone.half_angle < 1e-6);
    }

    #[test]
    fn normals_of_rational_patches_stay_in_the_cone() {
        let mut patch = bilinear(DVec3::new(1.2, 0.9, 0.7));
        for weights in [[1.0; 4], [1.0, 5.0, 0.2, 3.0], [0.1, 0.1, 10.0, 1.0]] {
            patch.weights = weights.to_vec();
            let cone = patch.normal_cone().expect("gently curved");
            for k in 0..=400 {
                let jet = patch.jet((k / 20) as f64 / 20.0, (k % 20) as f64 / 20.0);
                let normal = jet.du.cross(jet.dv).normalize();
                assert!(normal.dot(cone.axis) >= cone.half_angle.cos() - 1e-12);
            }
        }
    }

    #[test]
    fn a_folded_patch_has_no_cone() {
        let patch = bilinear(DVec3::new(-1.0, -1.0, 0.0));
        assert_eq!(patch.normal_cone(), None);
    }
}
