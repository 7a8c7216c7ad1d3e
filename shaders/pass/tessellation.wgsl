// Triangles of a tessellation as a mesh file would hold them, trimmed by their own boundaries, in place of the exact surfaces.
// Writes the same visibility buffer as the rays: (face slot + 1, u, v, normal or level of the deviation) and depth.

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage, read> vertices: array<MeshVertex>;
@group(0) @binding(2) var<storage, read> parts: array<TessellationPart>;
@group(0) @binding(3) var<storage, read> corners: array<u32>;   // three vertices to a triangle
@group(0) @binding(4) var<storage, read> levels: array<u32>;    // of each triangle, see deviation_colour

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) normal: vec3f,                     // of the surface, view axes
    @location(2) relative: vec3f,                   // place, view axes
    @location(3) @interpolate(flat) facet: vec3f,   // normal of the triangle, view axes
    @location(4) @interpolate(flat) ids: vec2u,     // face slot, level
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    let v = vertices[corners[index]];
    let part = parts[v.face];
    let first = index - index % 3u;
    let a = vertices[corners[first]].position;
    let b = vertices[corners[first + 1u]].position;
    let c = vertices[corners[first + 2u]].position;
    let axes = axes_of(view);
    let p = place_in_view(view, part.high, part.low, v.position);
    var out: Corner;
    out.position = clip_place(view, p);
    out.uv = v.uv;
    out.normal = axes_apply(axes, v.normal);
    out.relative = p;
    // In two steps: the sides of small triangles multiply to nothing.
    let side = normalize(b - a + vec3f(1e-37, 0.0, 0.0));
    out.facet = axes_apply(axes, cross(side, normalize(c - a + vec3f(0.0, 1e-37, 0.0))));
    out.ids = vec2u(part.slot, levels[index / 3u]);
    return out;
}

// The normal on the side of the triangle that is seen: near silhouettes that of the surface may look away already.
fn towards(n: vec3f, facet: vec3f, eye: vec3f) -> vec3f {
    let sign = select(-1.0, 1.0, dot(facet, eye) >= 0.0);
    let facing = sign * dot(n, eye);
    return normalize(n + sign * max(0.02 - facing, 0.0) * eye);
}

@fragment
fn fragment(in: Corner) -> @location(0) vec4u {
    let uv = clamp(in.uv, vec2f(0.0), vec2f(1.0));
    let parallel = view.slope_scale.x == 0.0;
    let eye = select(-in.relative / max(length(in.relative), 1e-37), vec3f(0.0, 0.0, -1.0), parallel);
    let facet = in.facet / max(length(in.facet), 1e-37);
    let smooth_normal = towards(in.normal / max(length(in.normal), 1e-37), facet, eye);
    let normal = select(smooth_normal, facet, (view.flags & CAST_FACETS) != 0u);
    var word = pack_normal(normal);
    if ((view.flags & CAST_HEAT) != 0u) {
        word = pack_heat(normal, 0u, true, 0u);
    }
    if ((view.flags & CAST_DEVIATION) != 0u) {
        word = (word & 0xffffff00u) | in.ids.y;
    }
    return vec4u(in.ids.x + 1u, bitcast<u32>(uv.x), bitcast<u32>(uv.y), word);
}
