//! Rational Bezier patches by streaming Horner in Bernstein form: any degree in constant registers
//! (Sederberg 1995). Twin of `shaders/lib/patch_jet.wgsl`.

use glam::Vec4;

/// Homogeneous value and derivatives in the patch's own 0..1 parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet {
    /// Point times weight, and the weight.
    pub s: Vec4,
    /// Derivative in u.
    pub du: Vec4,
    /// Derivative in v.
    pub dv: Vec4,
}

/// Evaluates the patch whose first control point is `points[first_point]`. A degree-n sum is kept as
/// its two degree n - 1 sums, over the first and the last n points: the value is their blend and the
/// derivative n times their difference.
pub fn patch_jet(points: &[[f32; 4]], first_point: u32, degree_u: u32, degree_v: u32, u: f32, v: f32) -> Jet {
    let load_point = |index: u32| Vec4::from_array(points[index as usize]);
    let a = 1.0 - u;
    let b = 1.0 - v;
    let mut low = Vec4::ZERO;
    let mut high = Vec4::ZERO;
    let mut low_dv = Vec4::ZERO;
    let mut high_dv = Vec4::ZERO;
    let mut weight_low = 1.0f32;
    let mut weight_high = 0.0f32;
    let mut at = first_point;
    for i in 0..=degree_u {
        let mut left = load_point(at);
        let mut p = load_point(at + 1);
        let mut right = p;
        at += 2;
        let mut weight = 1.0f32;
        for j in 1..degree_v {
            weight *= v * (degree_v - j) as f32 / j as f32;
            let q = load_point(at);
            at += 1;
            left = left * b + weight * p;
            right = right * b + weight * q;
            p = q;
        }
        let row = left * b + right * v;
        let row_dv = right - left;
        let keep = if i < degree_u { a } else { 1.0 };
        low = low * keep + weight_low * row;
        low_dv = low_dv * keep + weight_low * row_dv;
        high = high * a + weight_high * row;
        high_dv = high_dv * a + weight_high * row_dv;
        weight_high = weight_low;
        weight_low *= u * (degree_u as f32 - 1.0 - i as f32) / (i + 1) as f32;
    }
    let du = degree_u as f32;
    let dv = degree_v as f32;
    Jet { s: low * a + high * u, du: du * (high - low), dv: dv * (low_dv * a + high_dv * u) }
}
