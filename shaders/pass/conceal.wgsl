// Fat lines: strips along trim curves, as wide as the gap there and a pixel, drawn as hits of the face that the curve
// bounds, into a copy of the visibility buffer. Only pixels are filled through which one sees between the two faces of
// the edge (Schollmeyer & Froehlich 2009, section 6: a switch between the two pictures).

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage, read> pieces: array<RibbonPiece>;
@group(0) @binding(2) var<storage, read> spans: array<RibbonSpan>;
@group(0) @binding(3) var<storage, read> points: array<vec4f>;
@group(0) @binding(4) var<storage, read> curve_points: array<vec4f>;
@group(0) @binding(5) var<storage, read> faces: array<FaceHeader>;
@group(0) @binding(6) var raw: texture_2d<u32>;
@group(0) @binding(7) var raw_depths: texture_depth_2d;

fn load_point(index: u32) -> vec4f {
    return points[index];
}

fn load_curve_point(index: u32) -> vec4f {
    return curve_points[index];
}

fn raw_words(pixel: vec2i) -> vec4u {
    return textureLoad(raw, pixel, 0);
}

fn z_of_depth(d: f32) -> f32 {
    return (d * view.depth.z - view.depth.x) / min(view.depth.y - d * view.depth.w, -1e-30);
}

fn raw_z(pixel: vec2i) -> f32 {
    return z_of_depth(textureLoad(raw_depths, pixel, 0));
}

fn hole_view() -> HoleView {
    return HoleView(view.slope_scale, view.offset_scale, view.jitter, view.size, view.pixel);
}

struct Strip {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) normal: vec3f,
    @location(2) across: vec2f,                     // pixels, from the face at the left of the curve to the right
    @location(3) off: vec2f,                        // beside the curve and beyond its end, pixels
    @location(4) @interpolate(flat) ids: vec3u,     // faces on this and the other side, slots + 1; pixels across
}

struct Filled {
    @location(0) words: vec4u,
    @builtin(frag_depth) depth: f32,
}

// The strip reaches over the gap on both sides of its curve, and so over the middle from both curves. It lies in the
// tangent plane of the face, as far as that rises by no more than this many pixels per pixel.
const STEEPEST: f32 = 4.0;
// Of two strips in one plane the one whose curve is nearer is shown: strips are this much farther per pixel.
const FARTHER_PX: f32 = 0.02;
// A third face shows through a wide hole only when it is farther behind than this many times the distance from the
// curve: where three faces meet, the third bends away beside and beyond the ends of the strip.
const CLEAR: f32 = 3.0;
const MARGIN_PX: f32 = 1.0;
const MOST_PX: f32 = 512.0;

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> Strip {
    let span = spans[instance];
    let piece = pieces[span.piece];
    let axes = Axes(view.right.xyz, view.up.xyz, view.forward.xyz);
    let k = index / 2u;
    // The first and the last pair run on beyond the ends, so that no corner stays open.
    let part = f32(clamp(k, 1u, RIBBON_SEGMENTS + 1u) - 1u) / f32(RIBBON_SEGMENTS);
    let t = mix(span.start, span.end, part);
    let at = ribbon_point(piece, axes, view.reference_high.xyz, view.reference_low.xyz, t);
    let w = view.depth.z + view.depth.w * at.p.z;
    let direction = screen_direction(at.p, at.tangent, view.clip_scale, view.size, w, view.depth.w);
    let reach = min(piece.gap / (view.pixel.x + view.pixel.y * abs(at.p.z)), MOST_PX) + MARGIN_PX;
    let sideways = vec2f(-direction.y, direction.x);
    let side = select(-reach, reach, (index & 1u) == 1u);
    let end = select(0.0, reach, k == RIBBON_SEGMENTS + 2u) - select(0.0, reach, k == 0u);
    let shift_px = sideways * side + direction * end;
    let ndc = at.p.xy * view.clip_scale / select(w, 1e-30, w == 0.0) + shift_px * vec2f(1.0, -1.0) * 2.0 / view.size;
    let ray = Ray(ndc * view.slope_scale, ndc * view.offset_scale);
    // In perspective no corner leaves its side of the eye.
    let most = select(0.5 * abs(at.p.z), 1e30, view.depth.w == 0.0);
    let limit = min(STEEPEST * length(shift_px) * (view.pixel.x + view.pixel.y * abs(at.p.z)), most);
    let z = clamp(plane_depth(at.normal, at.p, ray), at.p.z - limit, at.p.z + limit);
    let w_there = view.depth.z + view.depth.w * z;
    let jitter = 2.0 * view.jitter / view.size * vec2f(1.0, -1.0);
    var out: Strip;
    let clip = vec4f((ndc - jitter) * w_there, view.depth.x + view.depth.y * z, w_there);
    let shown = (faces[piece.face].flags & faces[piece.other].flags & FACE_VISIBLE) != 0u;
    out.position = select(vec4f(0.0, 0.0, -1.0, 1.0), clip, shown);
    out.uv = at.uv;
    out.normal = at.normal;
    out.across = sideways;
    out.off = vec2f(side, abs(end));
    out.ids = vec3u(piece.face + 1u, piece.other + 1u, u32(ceil(reach)));
    return out;
}

@fragment
fn fragment(in: Strip) -> Filled {
    let pixel = vec2i(in.position.xy);
    let here = raw_words(pixel);
    let z = raw_z(pixel);
    // Nearly all pixels show a surface that is about as near: no holes.
    let z_line = z_of_depth(in.position.z);
    if (here.x != 0u && z <= z_line) {
        discard;
    }
    var hole = is_hole(pixel, here.x, z, in.ids.x, in.ids.y);
    let third = here.x != 0u && here.x != in.ids.x && here.x != in.ids.y;
    if (!hole && i32(in.ids.z) >= HOLE_REACH && (!third || z > z_line + CLEAR * (abs(in.off.x) + in.off.y) * hole_width(z_line))) {
        let direction = in.across / max(length(in.across), 1e-6);
        let most = 2 * i32(in.ids.z);
        hole = is_wide_hole(pixel, here.x, z, in.ids.x, in.ids.y, direction, most);
        if (!hole && in.off.y <= 1.0) {
            hole = is_hole_along(pixel, here.x, z, in.ids.x, in.ids.y, direction, most);
        }
    }
    if (!hole) {
        discard;
    }
    let uv = clamp(in.uv, vec2f(0.0), vec2f(0.99999994));
    let normal = in.normal / max(length(in.normal), 1e-37);
    let z_shown = z_line + FARTHER_PX * abs(in.off.x) * hole_width(z_line);
    let depth = (view.depth.x + view.depth.y * z_shown) / (view.depth.z + view.depth.w * z_shown);
    return Filled(vec4u(in.ids.x, bitcast<u32>(uv.x), bitcast<u32>(uv.y), pack_normal(normal)), depth);
}
