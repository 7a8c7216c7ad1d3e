//! The shape zoo: curves and surfaces of any degree with repeated knots, jumps, unclamped ends and
//! weights over four decades, made from a seed.

use glam::{DVec2, DVec3};
use hairline::kernel::bezier::BezierPatch;
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};

/// A small reproducible source of numbers (splitmix64).
pub struct Seed(pub u64);

impl Seed {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub fn point2(&mut self) -> DVec2 {
        DVec2::new(self.between(-10.0, 10.0), self.between(-10.0, 10.0))
    }

    pub fn point3(&mut self) -> DVec3 {
        self.point2().extend(self.between(-10.0, 10.0))
    }

    /// 0.01 to 100, evenly over the logarithm.
    pub fn weight(&mut self) -> f64 {
        10f64.powf(self.between(-2.0, 2.0))
    }

    pub fn weights(&mut self, count: usize, rational: bool) -> Vec<f64> {
        (0..count).map(|_| if rational { self.weight() } else { 1.0 }).collect()
    }

    /// Up to three inner knots of multiplicity 1 to `degree + 1`; one time in three unclamped.
    pub fn knots(&mut self, degree: usize) -> KnotVector {
        let start = self.between(-3.0, 3.0);
        let mut knots = vec![start; degree + 1];
        let mut t = start;
        for _ in 0..self.below(4) {
            t += self.between(0.05, 2.0);
            let multiplicity = if self.below(2) == 0 { 1 } else { 1 + self.below(degree + 1) };
            knots.extend(std::iter::repeat_n(t, multiplicity));
        }
        knots.extend(vec![t + self.between(0.05, 2.0); degree + 1]);
        if self.below(3) == 0 {
            let last = knots.len() - 1;
            for k in 1..=degree {
                knots[degree - k] = knots[degree - k + 1] - self.between(0.0, 1.0);
                knots[last - degree + k] = knots[last - degree + k - 1] + self.between(0.0, 1.0);
            }
        }
        KnotVector::new(degree, knots).expect("made sorted")
    }

    pub fn curve(&mut self, degree: usize, rational: bool) -> NurbsCurve2 {
        let knots = self.knots(degree);
        let count = knots.control_count();
        let points = (0..count).map(|_| self.point2()).collect();
        let weights = self.weights(count, rational);
        NurbsCurve2::new(knots, points, weights).expect("counts fit")
    }

    pub fn surface(&mut self, degrees: (usize, usize), rational: bool) -> NurbsSurface {
        let (u, v) = (self.knots(degrees.0), self.knots(degrees.1));
        let count = u.control_count() * v.control_count();
        let points = (0..count).map(|_| self.point3()).collect();
        let weights = self.weights(count, rational);
        NurbsSurface::new(u, v, points, weights).expect("counts fit")
    }

    pub fn patch(&mut self, degrees: (usize, usize), rational: bool) -> BezierPatch {
        let count = (degrees.0 + 1) * (degrees.1 + 1);
        BezierPatch {
            degree_u: degrees.0,
            degree_v: degrees.1,
            points: (0..count).map(|_| self.point3()).collect(),
            weights: self.weights(count, rational),
            uv_min: DVec2::ZERO,
            uv_max: DVec2::ONE,
        }
    }
}

/// Parameters inside each span of `knots`: none on a knot, where one-sided derivatives may differ.
pub fn samples(knots: &KnotVector, per_span: usize) -> Vec<f64> {
    let inside = |(_, a, b): (usize, f64, f64)| {
        (0..per_span).map(move |k| a + (b - a) * (k as f64 + 0.5) / per_span as f64)
    };
    knots.spans().flat_map(inside).collect()
}

/// The surface of revolution about z of a profile (r, z), a full turn in u from +x, exact.
pub fn revolution(profile: &NurbsCurve2) -> NurbsSurface {
    let knots = KnotVector::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0]);
    let half = 0.5f64.sqrt();
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    let corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    for (k, (x, y)) in corners.into_iter().enumerate() {
        for (p, w) in profile.points().iter().zip(profile.weights()) {
            points.push(DVec3::new(p.x * f64::from(x), p.x * f64::from(y), p.y));
            weights.push(w * if k % 2 == 1 { half } else { 1.0 });
        }
    }
    NurbsSurface::new(knots.expect("sorted"), profile.knots().clone(), points, weights).expect("counts fit")
}

/// `quarters` quarter arcs of a circle about `centre`, counter-clockwise from its lowest point.
pub fn arc(centre: DVec2, radius: f64, quarters: usize) -> NurbsCurve2 {
    let mut knots = vec![0.0; 3];
    (1..quarters).for_each(|k| knots.extend([k as f64; 2]));
    knots.extend([quarters as f64; 3]);
    let offsets = [(0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1)];
    let points = offsets[..=2 * quarters]
        .iter()
        .map(|(x, y)| centre + radius * DVec2::new(f64::from(*x), f64::from(*y)))
        .collect();
    let half = 0.5f64.sqrt();
    let weights = (0..=2 * quarters).map(|k| if k % 2 == 1 { half } else { 1.0 }).collect();
    NurbsCurve2::new(KnotVector::new(2, knots).expect("sorted"), points, weights).expect("counts fit")
}

/// The unit sphere, poles at +-z.
pub fn sphere() -> NurbsSurface {
    revolution(&arc(DVec2::ZERO, 1.0, 2))
}

/// A torus about z.
pub fn torus(major: f64, minor: f64) -> NurbsSurface {
    revolution(&arc(DVec2::new(major, 0.0), minor, 4))
}
