// Points of trim curves in space: the pcurve by streaming Horner in Bernstein form, then the patch it runs on.
// Twin: reference::ribbon.
// The pass supplies load_curve_point(index) -> vec4f besides load_point.

const RIBBON_SEGMENTS: u32 = 8u;

// Value and derivative of a homogeneous curve.
struct CurveJet {
    p: vec3f,
    d: vec3f,
}

// A point of a trim curve in view axes.
struct RibbonPoint {
    p: vec3f,
    tangent: vec3f,   // derivative along the curve
    normal: vec3f,    // du x dv, unit
    uv: vec2f,        // face-normalised
}

// Kept as two sums of degree n - 1, as in patch_jet.
fn curve_jet(first: u32, degree: u32, t: f32) -> CurveJet {
    let s = 1.0 - t;
    var low = load_curve_point(first).xyz;
    var high = load_curve_point(first + 1u).xyz;
    var power = 1.0;
    var previous = high;
    for (var i = 1u; i < degree; i++) {
        power *= t * f32(degree - i) / f32(i);
        let next = load_curve_point(first + i + 1u).xyz;
        low = low * s + power * previous;
        high = high * s + power * next;
        previous = next;
    }
    return CurveJet(low * s + high * t, f32(degree) * (high - low));
}

fn ribbon_point(piece: RibbonPiece, axes: Axes, reference_high: vec3f, reference_low: vec3f, t: f32) -> RibbonPoint {
    let curve = curve_jet(piece.first_curve, piece.degrees >> 16u, t);
    let local = curve.p.xy / curve.p.z;
    let along = (curve.d.xy - local * curve.d.z) / curve.p.z;
    let jet = patch_jet(piece.first_point, piece.degrees & 0xffu, (piece.degrees >> 8u) & 0xffu, local.x, local.y);
    let inverse = 1.0 / jet.s.w;
    let p = jet.s.xyz * inverse;
    let du = inverse * (jet.du.xyz - p * jet.du.w);
    let dv = inverse * (jet.dv.xyz - p * jet.dv.w);
    let shift = axes_apply(axes, (piece.origin_high - reference_high) + (piece.origin_low - reference_low));
    // The view axes are left-handed, so the factors change places.
    let n = cross(axes_apply(axes, dv), axes_apply(axes, du));
    return RibbonPoint(
        axes_apply(axes, p) + shift,
        axes_apply(axes, along.x * du + along.y * dv),
        select(vec3f(0.0, 0.0, -1.0), n / max(length(n), 1e-37), length(n) > 1e-37),
        mix(piece.uv_min, piece.uv_max, local),
    );
}

// Direction of a curve on the screen, unit, in pixels (y down). `w`: the homogeneous coordinate of `p`.
fn screen_direction(p: vec3f, tangent: vec3f, clip_scale: vec2f, size: vec2f, w: f32, w_slope: f32) -> vec2f {
    let d = (tangent.xy * w - p.xy * (w_slope * tangent.z)) * clip_scale * size * vec2f(1.0, -1.0);
    return select(vec2f(1.0, 0.0), d / max(length(d), 1e-37), length(d) > 1e-30);
}
