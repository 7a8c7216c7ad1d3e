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
use super::bernstein::binomial_row;

/// All normals `du x dv` of a patch make at most `half_angle` with `axis`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalCone {
    /// Unit vector.
    pub axis: DVec3,
    /// Radians, below a half turn.
    pub half_angle: f64,
}

/// A vector- or number-valued tensor-product polynomial in scaled Bernstein form: coefficient `(i, j)`
/// times `C(m, i) C(n, j)`.
struct Scaled<T> {
    degree: (usize, usize),
    coefficients: Vec<T>,
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
        let origin = self.bounds().centre();
        let degree = (self.degree_u, self.degree_v);
        let homogeneous: Vec<(DVec3, f64)> =
            self.points.iter().zip(&self.weights).map(|(p, w)| ((*p - origin) * *w, *w)).collect();
        let net = Net { degree, values: homogeneous };
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

/// A homogeneous control net.
struct Net {
    degree: (usize, usize),
    values: Vec<(DVec3, f64)>,
}

impl Net {
    fn at(&self, i: usize, j: usize) -> (DVec3, f64) {
        self.values[i * (self.degree.1 + 1) + j]
    }

    /// Control net of the derivative in u, but for the factor `degree`, which is common to a product's
    /// terms.
    fn difference_u(&self) -> Self {
        let (m, n) = self.degree;
        let values = (0..m).flat_map(|i| (0..=n).map(move |j| difference(self.at(i + 1, j), self.at(i, j))));
        Self { degree: (m - 1, n), values: values.collect() }
    }

    fn difference_v(&self) -> Self {
        let (m, n) = self.degree;
        let values = (0..=m).flat_map(|i| (0..n).map(move |j| difference(self.at(i, j + 1), self.at(i, j))));
        Self { degree: (m, n - 1), values: values.collect() }
    }

    fn scaled<T>(&self, part: impl Fn((DVec3, f64)) -> T) -> Scaled<T>
    where
        T: std::ops::Mul<f64, Output = T>,
    {
        let (m, n) = self.degree;
        let (bu, bv) = (binomial_row(m), binomial_row(n));
        let values = self.values.iter().enumerate();
        let coefficients = values.map(|(k, h)| part(*h) * (bu[k / (n + 1)] * bv[k % (n + 1)])).collect();
        Scaled { degree: self.degree, coefficients }
    }
}

fn difference(a: (DVec3, f64), b: (DVec3, f64)) -> (DVec3, f64) {
    (a.0 - b.0, a.1 - b.1)
}

impl<T: Copy> Scaled<T> {
    /// The product under a bilinear `times`: a plain convolution in scaled form.
    fn product<S: Copy>(&self, other: &Scaled<S>, times: impl Fn(T, S) -> DVec3) -> Scaled<DVec3> {
        let ((m1, n1), (m2, n2)) = (self.degree, other.degree);
        let degree = (m1 + m2, n1 + n2);
        let stride = degree.1 + 1;
        let mut coefficients = vec![DVec3::ZERO; (degree.0 + 1) * stride];
        for (k, a) in self.coefficients.iter().enumerate() {
            let (i, j) = (k / (n1 + 1), k % (n1 + 1));
            for (l, b) in other.coefficients.iter().enumerate() {
                let at = (i + l / (n2 + 1)) * stride + j + l % (n2 + 1);
                coefficients[at] += times(*a, *b);
            }
        }
        Scaled { degree, coefficients }
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
