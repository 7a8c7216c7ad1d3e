// Casts one ray per pixel at the cells whose boxes cover it.
// Writes (face slot + 1, u, v, normal or counts) and reverse-z depth.

// The view, faces and trims are bound in `trims`.
@group(0) @binding(5) var<storage, read> order: array<u32>;
@group(0) @binding(6) var<storage, read> cells: array<Cell>;
@group(0) @binding(7) var<storage, read> points: array<vec4f>;

// Of each pixel the nearest depth hit so far in this pass, bits of f32; 0: none.
@group(0) @binding(8) var<storage, read_write> nearest: array<atomic<u32>>;

fn load_point(index: u32) -> vec4f {
    return points[index];
}

// Stands in `order` where there is no cell. Mirror: encoding::order::NO_CELL.
const NO_CELL: u32 = 0xffffffffu;

struct Proxy {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) ids: vec4u,      // face slot, first point, degrees, cell * 2 + 1: trim
    @location(1) @interpolate(flat) m00: vec4f,      // quadratic model in view axes; w: residual
    @location(2) @interpolate(flat) m10: vec4f,      // w: size
    @location(3) @interpolate(flat) m01: vec3f,
    @location(4) @interpolate(flat) m20: vec3f,
    @location(5) @interpolate(flat) m11: vec3f,
    @location(6) @interpolate(flat) m02: vec3f,
    @location(7) @interpolate(flat) uv: vec4f,
    @location(8) @interpolate(flat) shift: vec3f,
    @location(9) @interpolate(flat) grid_size: vec4u,  // GridHeader, first and second half
    @location(10) @interpolate(flat) grid_base: vec4u,
}

struct Visibility {
    @location(0) words: vec4u,
    @builtin(frag_depth) depth: f32,
}

// A strip of 14 corners round the box, widened by an eighth of a pixel so that the
// snapping of corners to sub-pixels opens no seams. The faces
// turned away from the viewer are drawn: they cover the pixel from inside the box and behind the near
// plane as well.
@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32, @builtin(instance_index) instance: u32) -> Proxy {
    if (order[instance] == NO_CELL) {
        var none: Proxy;
        none.position = vec4f(0.0, 0.0, -1.0, 1.0);
        return none;
    }
    let cell = cells[order[instance]];
    let face = faces[cell.face];
    let axes = axes_of(view);
    let high = cell.origin_high - view.reference_high.xyz;
    let low = cell.origin_low - view.reference_low.xyz;
    let shift = axes_apply(axes, high + low);
    let bit = 1u << (vertex_index % 14u);
    let on = (vec3u(0x287au, 0x02afu, 0x31e3u) & vec3u(bit)) != vec3u(0u);
    let corner = select(vec3f(-1.0), vec3f(1.0), on);
    let centre = axes_apply(axes, cell.box_centre) + shift;
    let far = max(centre.z + cell.size, 0.0);
    let half = vec3f(cell.box_x.w, cell.box_y.w, cell.box_z.w) + 0.125 * (view.pixel.x + view.pixel.y * far);
    let c = corner * half;
    let offset = c.x * cell.box_x.xyz + c.y * cell.box_y.xyz + c.z * cell.box_z.xyz;
    let p = centre + axes_apply(axes, offset);
    var out: Proxy;
    out.position = select(vec4f(0.0, 0.0, -1.0, 1.0), clip_place(view, p), (face.flags & FACE_VISIBLE) != 0u);
    let trimmed = (face.flags & FACE_TRIMMED) != 0u && (cell.flags & CELL_WHOLE) == 0u;
    out.ids = vec4u(cell.face, cell.first_point, cell.degrees, order[instance] << 1u | u32(trimmed));
    out.m00 = vec4f(axes_apply(axes, cell.m00) + shift, cell.residual);
    out.m10 = vec4f(axes_apply(axes, cell.m10), cell.size);
    out.m01 = axes_apply(axes, cell.m01);
    out.m20 = axes_apply(axes, cell.m20);
    out.m11 = axes_apply(axes, cell.m11);
    out.m02 = axes_apply(axes, cell.m02);
    out.uv = vec4f(cell.uv_min, cell.uv_max);
    out.shift = shift;
    let grid = grid_words(face.grid);
    out.grid_size = grid.size;
    out.grid_base = grid.base;
    return out;
}

// Boxes are widened by this many pixels and this part of their size.
const BOX_PIXELS: f32 = 0.125;
const BOX_SLACK: f32 = 2e-3;

// The box of a cell, widened by what rounding and the tolerance of the solver may move a hit.
fn cell_box(index: u32, shift: vec3f) -> ViewBox {
    let axes = axes_of(view);
    let cell = cells[index];
    let centre = axes_apply(axes, cell.box_centre) + shift;
    let far = max(centre.z + cell.size, 0.0);
    let margin = BOX_PIXELS * (view.pixel.x + view.pixel.y * far) + BOX_SLACK * cell.size;
    return ViewBox(centre, vec4f(axes_apply(axes, cell.box_x.xyz), cell.box_x.w + margin),
        vec4f(axes_apply(axes, cell.box_y.xyz), cell.box_y.w + margin),
        vec4f(axes_apply(axes, cell.box_z.xyz), cell.box_z.w + margin));
}

@fragment
fn fragment(in: Proxy) -> Visibility {
    let pixel = in.position.xy + view.jitter;
    let ndc = (2.0 * pixel / view.size - 1.0) * vec2f(1.0, -1.0);
    let ray = Ray(ndc * view.slope_scale, ndc * view.offset_scale);
    let piece = Piece(in.ids.y, in.ids.z, in.m00.w, in.m10.w, in.shift,
        in.m00.xyz, in.m10.xyz, in.m01, in.m20, in.m11, in.m02);
    let place = u32(in.position.y) * u32(view.size.x) + u32(in.position.x);
    let known = bitcast<f32>(atomicLoad(&nearest[place]));
    if (known > 0.0) {
        let span = box_span(ray, cell_box(in.ids.w >> 1u, piece.shift));
        if (known > depth_from(view.depth, span.x)) {
            discard;
        }
    }
    let conics = piece_conics(ray, piece);
    let start = piece_seeds(piece, conics);
    if (start.count == 0u) {
        discard;
    }
    let axes = axes_of(view);
    var found = false;
    var evaluations = 0u;
    var curve_evaluations = 0u;
    var inside = true;
    let trim = (view.flags & CAST_TRIM) != 0u;
    let heat = (view.flags & CAST_HEAT) != 0u;
    var depth = 0.0;
    var uv = vec2f(0.0);
    var normal = vec3f(0.0, 0.0, -1.0);
    var x = start.first;
    var branch = select(ANY, NEARER, start.count == 2u);
    loop {
        let root = newton(ray, axes, piece, conics, view.pixel, x, branch);
        evaluations += root.evaluations;
        // One zero and none found: the surface may have two where the model sees one.
        let going = select(branch == NEARER, !root.converged, branch == ANY);
        x = select(start.first, start.second, branch == NEARER);
        branch = select(NEARER, FARTHER, branch == NEARER);
        depth = (view.depth.x + view.depth.y * root.z) / (view.depth.z + view.depth.w * root.z);
        let on_cell = max(abs(root.x.x), abs(root.x.y)) <= 1.0 + HAIR + root.slack;
        if (root.converged && on_cell && depth > 0.0 && depth <= 1.0) {
            uv = clamp(mix(in.uv.xy, in.uv.zw, 0.5 + 0.5 * root.x), vec2f(0.0), vec2f(BELOW_ONE));
            normal = root.normal;
            if (trim && (in.ids.w & 1u) != 0u) {
                let verdict = kept(grid_header(in.grid_size, in.grid_base), uv);
                inside = verdict.inside;
                curve_evaluations += verdict.evaluations;
            }
            found = inside || heat;
        }
        if (found || !going) {
            break;
        }
    }
    if (!found) {
        discard;
    }
    var out: Visibility;
    let word = select(pack_normal(normal), pack_heat(normal, curve_evaluations, inside, evaluations), heat);
    out.words = vec4u(in.ids.x + 1u, bitcast<u32>(uv.x), bitcast<u32>(uv.y), word);
    out.depth = depth;
    atomicMax(&nearest[place], bitcast<u32>(depth));
    return out;
}
