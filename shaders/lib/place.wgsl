// Where points and triangles of meshes are in a view. Axes: see View.

fn axes_of(seen: View) -> Axes {
    return Axes(seen.right.xyz, seen.up.xyz, seen.forward.xyz);
}

// A point that lies `by` (model axes) from high + low, in view axes.
fn place_in_view(seen: View, high: vec3f, low: vec3f, by: vec3f) -> vec3f {
    let axes = axes_of(seen);
    let shift = axes_apply(axes, (high - seen.reference_high.xyz) + (low - seen.reference_low.xyz));
    return shift + axes_apply(axes, by);
}

// Clip coordinates of a point in view axes, moved as far as the samples are within their pixels.
fn clip_place(seen: View, p: vec3f) -> vec4f {
    let w = seen.depth.z + seen.depth.w * p.z;
    let jitter = 2.0 * seen.jitter / seen.size * vec2f(1.0, -1.0);
    return vec4f(p.xy * seen.clip_scale - jitter * w, seen.depth.x + seen.depth.y * p.z, w);
}
