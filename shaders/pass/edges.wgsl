// Edges by themselves: strips of a colour and a width in pixels along exact trim curves, smoothed at their borders and
// hidden behind surfaces.

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage, read> pieces: array<RibbonPiece>;
@group(0) @binding(2) var<storage, read> spans: array<RibbonSpan>;
@group(0) @binding(3) var<storage, read> points: array<vec4f>;
@group(0) @binding(4) var<storage, read> curve_points: array<vec4f>;
@group(0) @binding(5) var<storage, read> faces: array<FaceHeader>;
@group(0) @binding(6) var<storage, read> looks: array<EdgeLook>;

fn load_point(index: u32) -> vec4f {
    return points[index];
}

fn load_curve_point(index: u32) -> vec4f {
    return curve_points[index];
}

struct Strip {
    @builtin(position) position: vec4f,
    @location(0) colour: vec4f,
    @location(1) @interpolate(linear) across: vec2f,   // from the middle, half the width; pixels
}

// Towards the viewer, in pixels: as far as surfaces beside the curve may rise within the strip.
const LIFT_PX: f32 = 3.0;

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> Strip {
    let span = spans[instance];
    let piece = pieces[span.piece];
    let look = looks[min(piece.edge, arrayLength(&looks) - 1u)];
    let axes = Axes(view.right.xyz, view.up.xyz, view.forward.xyz);
    let k = index / 2u;
    let t = mix(span.start, span.end, f32(k) / f32(RIBBON_SEGMENTS));
    let at = ribbon_point(piece, axes, view.reference_high.xyz, view.reference_low.xyz, t);
    let w = view.depth.z + view.depth.w * at.p.z;
    let direction = screen_direction(at.p, at.tangent, view.clip_scale, view.size, w, view.depth.w);
    let reach = 0.5 * look.width + 1.0;
    let side = select(-reach, reach, (index & 1u) == 1u);
    let shift = vec2f(-direction.y, direction.x) * side * vec2f(1.0, -1.0) * 2.0 / view.size;
    let pixel = view.pixel.x + view.pixel.y * abs(at.p.z);
    let near = at.p.z - (LIFT_PX + look.width) * pixel;
    let nearness = (view.depth.x + view.depth.y * near) / max(view.depth.z + view.depth.w * near, 1e-30);
    var out: Strip;
    let clip = vec4f(at.p.xy * view.clip_scale + shift * w, nearness * w, w);
    let shown = (faces[piece.face].flags & FACE_VISIBLE) != 0u && look.width > 0.0;
    out.position = select(vec4f(0.0, 0.0, -1.0, 1.0), clip, shown);
    out.colour = look.colour;
    out.across = vec2f(side, 0.5 * look.width);
    return out;
}

fn cover(in: Strip) -> f32 {
    return in.colour.a * clamp(in.across.y + 0.5 - abs(in.across.x), 0.0, 1.0);
}

// For targets that encode what they are given.
@fragment
fn fragment_linear(in: Strip) -> @location(0) vec4f {
    return vec4f(in.colour.rgb, cover(in));
}

@fragment
fn fragment(in: Strip) -> @location(0) vec4f {
    return vec4f(srgb_from_linear(in.colour.rgb), cover(in));
}
