// Rational Bezier patches by streaming Horner in Bernstein form: any degree in constant registers
// (Sederberg 1995). Twin: reference::patch_jet.
// The pass supplies `load_point(index) -> vec4f`: control point times weight, and the weight.

// Homogeneous value and derivatives in the patch's own 0..1 parameters.
struct Jet {
    s: vec4f,
    du: vec4f,
    dv: vec4f,
}

// A degree-n sum is kept as its two degree n - 1 sums, over the first and the last n points: the value
// is their blend and the derivative n times their difference.
fn patch_jet(first_point: u32, degree_u: u32, degree_v: u32, u: f32, v: f32) -> Jet {
    let a = 1.0 - u;
    let b = 1.0 - v;
    var low = vec4f(0.0);
    var high = vec4f(0.0);
    var low_dv = vec4f(0.0);
    var high_dv = vec4f(0.0);
    var weight_low = 1.0;   // C(m, i) u^i of the low sum, m = degree_u - 1
    var weight_high = 0.0;  // C(m, i - 1) u^(i - 1) of the high sum
    var at = first_point;
    // Loops that ask at their end: see classify.
    var i = 0u;
    loop {
        var left = load_point(at);
        var p = load_point(at + 1u);
        var right = p;
        at += 2u;
        var weight = 1.0;
        var j = 1u;
        if (j < degree_v) {
            loop {
                weight *= v * f32(degree_v - j) / f32(j);
                let q = load_point(at);
                at += 1u;
                left = left * b + weight * p;
                right = right * b + weight * q;
                p = q;
                j++;
                if (j >= degree_v) {
                    break;
                }
            }
        }
        let row = left * b + right * v;
        let row_dv = right - left;
        low = low * select(1.0, a, i < degree_u) + weight_low * row;
        low_dv = low_dv * select(1.0, a, i < degree_u) + weight_low * row_dv;
        high = high * a + weight_high * row;
        high_dv = high_dv * a + weight_high * row_dv;
        weight_high = weight_low;
        weight_low *= u * (f32(degree_u) - 1.0 - f32(i)) / f32(i + 1u);
        i++;
        if (i > degree_u) {
            break;
        }
    }
    let du = f32(degree_u);
    let dv = f32(degree_v);
    return Jet(low * a + high * u, du * (high - low), dv * (low_dv * a + high_dv * u));
}
