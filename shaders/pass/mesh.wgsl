// Triangles of the untrimmed surfaces with exact trims per pixel (Schollmeyer & Froehlich 2009, figure 10).
// Writes the same visibility buffer as the rays: (face slot + 1, u, v, normal or counts) and depth.
//
// Triangles that are kept whole, all of them when nothing is trimmed, and those that one segment alone passes through have entry
// points of their own: drivers that draw many pixels at a time walk through trimming for each as soon as it is in the program.

// The view, faces and trims are bound in `trims`.
@group(0) @binding(5) var<storage, read> vertices: array<MeshVertex>;
@group(0) @binding(6) var<storage, read> origins: array<MeshOrigin>;

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) normal: vec3f,                     // view axes
    @location(2) @interpolate(flat) face: u32,      // slot
}

struct TrimmedCorner {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) normal: vec3f,
    @location(2) @interpolate(flat) ids: vec2u,     // face slot, 1: trim
    @location(3) @interpolate(flat) grid_size: vec4u,
    @location(4) @interpolate(flat) grid_base: vec4u,
}

// Of a triangle that one segment alone passes through.
struct LoneCorner {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) normal: vec3f,
    @location(2) @interpolate(flat) ids: vec3u,     // face slot, entry word, MESH_*
    @location(3) @interpolate(flat) ends: vec4f,    // the segment's record
    @location(4) @interpolate(flat) short: vec4f,
}

fn corner(index: u32) -> Corner {
    let v = vertices[index];
    let origin = origins[v.origin];
    let p = place_in_view(view, origin.high, origin.low, v.position);
    return Corner(clip_place(view, p), v.uv, axes_apply(axes_of(view), v.normal), v.face);
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    return corner(index);
}

@vertex
fn vertex_trimmed(@builtin(vertex_index) index: u32) -> TrimmedCorner {
    let plain = corner(index);
    let face = faces[plain.face];
    let trimmed = (face.flags & FACE_TRIMMED) != 0u && (vertices[index].flags & MESH_WHOLE) == 0u;
    let grid = grid_words(face.grid);
    return TrimmedCorner(plain.position, plain.uv, plain.normal, vec2u(plain.face, u32(trimmed)), grid.size, grid.base);
}

@vertex
fn vertex_lone(@builtin(vertex_index) index: u32) -> LoneCorner {
    let plain = corner(index);
    let entry = vertices[index].entry;
    let address = faces[plain.face].grid.data_base + (entry >> 10u);
    let ids = vec3u(plain.face, entry, vertices[index].flags);
    return LoneCorner(plain.position, plain.uv, plain.normal, ids, load_trim_data(address), load_trim_data(address + 1u));
}

fn words(face: u32, normal: vec3f, uv: vec2f, verdict: Verdict) -> vec4u {
    let heat = (view.flags & CAST_HEAT) != 0u;
    let unit = normal / max(length(normal), 1e-37);
    let word = select(pack_normal(unit), pack_heat(unit, verdict.evaluations, verdict.inside, 0u), heat);
    return vec4u(face + 1u, bitcast<u32>(uv.x), bitcast<u32>(uv.y), word);
}

@fragment
fn fragment(in: Corner) -> @location(0) vec4u {
    return words(in.face, in.normal, clamp(in.uv, vec2f(0.0), vec2f(BELOW_ONE)), Verdict(true, 0u, false));
}

@fragment
fn fragment_trimmed(in: TrimmedCorner) -> @location(0) vec4u {
    let uv = clamp(in.uv, vec2f(0.0), vec2f(BELOW_ONE));
    var verdict = Verdict(true, 0u, false);
    if (in.ids.y != 0u) {
        verdict = kept(grid_header(in.grid_size, in.grid_base), uv);
    }
    if (!verdict.inside && (view.flags & CAST_HEAT) == 0u) {
        discard;
    }
    return words(in.ids.x, in.normal, uv, verdict);
}

// What `kept` says, from the only segment that passes through the triangle.
@fragment
fn fragment_lone(in: LoneCorner) -> @location(0) vec4u {
    let uv = clamp(in.uv, vec2f(0.0), vec2f(BELOW_ONE));
    let zero_kept = (in.ids.z & MESH_ZERO_KEPT) != 0u;
    var inside = false;
    var near = false;
    var k = 0u;
    loop {
        let found = value_of(in.ends, in.short, in.ids.y, uv + select(nudge(k - 1u), vec2f(0.0), k == 0u));
        inside = found.value != zero_kept;
        near |= found.near;
        k++;
        if (inside || !near || k > 4u) {
            break;
        }
    }
    if (!inside) {
        discard;
    }
    return words(in.ids.x, in.normal, uv, Verdict(true, 0u, false));
}
