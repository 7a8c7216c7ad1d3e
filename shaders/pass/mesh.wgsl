// Triangles of the untrimmed surfaces with exact trims per pixel (Schollmeyer & Froehlich 2009, figure 10).
// Writes the same visibility buffer as the rays: (face slot + 1, u, v, normal or counts) and depth.

// The view, faces and trims are bound in `trims`.
@group(0) @binding(5) var<storage, read> vertices: array<MeshVertex>;
@group(0) @binding(6) var<storage, read> origins: array<MeshOrigin>;

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) normal: vec3f,                    // view axes
    @location(2) @interpolate(flat) ids: vec2u,    // face slot, 1: trim
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    let v = vertices[index];
    let face = faces[v.face];
    let axes = Axes(view.right.xyz, view.up.xyz, view.forward.xyz);
    let origin = origins[v.face];
    let high = origin.high - view.reference_high.xyz;
    let low = origin.low - view.reference_low.xyz;
    let p = axes_apply(axes, high + low) + axes_apply(axes, v.position);
    let w = view.depth.z + view.depth.w * p.z;
    let jitter = 2.0 * view.jitter / view.size * vec2f(1.0, -1.0);
    var out: Corner;
    out.position = vec4f(p.xy * view.clip_scale - jitter * w, view.depth.x + view.depth.y * p.z, w);
    out.uv = v.uv;
    out.normal = axes_apply(axes, v.normal);
    let trimmed = (face.flags & FACE_TRIMMED) != 0u && (v.flags & MESH_WHOLE) == 0u;
    out.ids = vec2u(v.face, u32(trimmed));
    return out;
}

fn words(in: Corner, uv: vec2f, verdict: Verdict) -> vec4u {
    let heat = (view.flags & CAST_HEAT) != 0u;
    let normal = in.normal / max(length(in.normal), 1e-37);
    let word = select(pack_normal(normal), pack_heat(normal, verdict.evaluations, verdict.inside, 0u), heat);
    return vec4u(in.ids.x + 1u, bitcast<u32>(uv.x), bitcast<u32>(uv.y), word);
}

@fragment
fn fragment(in: Corner) -> @location(0) vec4u {
    let uv = clamp(in.uv, vec2f(0.0), vec2f(BELOW_ONE));
    var verdict = Verdict(true, 0u, false);
    if (in.ids.y != 0u) {
        verdict = kept(faces[in.ids.x].grid, uv);
    }
    if (!verdict.inside && (view.flags & CAST_HEAT) == 0u) {
        discard;
    }
    return words(in, uv, verdict);
}

// For triangles that are kept whole, and all of them when nothing is trimmed: a pipeline of its own, since drivers that
// draw many pixels at a time walk through trimming for each as soon as it is in the program.
@fragment
fn fragment_whole(in: Corner) -> @location(0) vec4u {
    return words(in, clamp(in.uv, vec2f(0.0), vec2f(BELOW_ONE)), Verdict(true, 0u, false));
}
