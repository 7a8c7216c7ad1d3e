// Whether a pixel lies behind a nearer surface on both sides of it. Twin: reference::holes.
// The pass supplies raw_words(pixel) -> vec4u, raw_z(pixel) -> f32 (view depth) and hole_view() -> HoleView.

struct HoleView {
    slope_scale: vec2f,
    offset_scale: vec2f,
    jitter: vec2f,
    size: vec2f,
    pixel: vec2f,
}

const HOLE_REACH: i32 = 3;

struct HoleSide {
    there: bool,
    face: u32,      // slot + 1
    z: f32,
    plane_z: f32,
    steps: f32,
}

fn hole_width(z: f32) -> f32 {
    return hole_view().pixel.x + hole_view().pixel.y * abs(z);
}

fn hole_ray(pixel: vec2i) -> Ray {
    let v = hole_view();
    let ndc = (2.0 * (vec2f(pixel) + 0.5 + v.jitter) / v.size - 1.0) * vec2f(1.0, -1.0);
    return Ray(ndc * v.slope_scale, ndc * v.offset_scale);
}

// The surface `step` beside the pixel if it is nearer and the pixel lies behind its tangent plane.
// `own`: face slot + 1 of the pixel, 0 for none; `z`: its depth.
fn hole_side(pixel: vec2i, step: vec2i, own: u32, z: f32) -> HoleSide {
    let none = HoleSide(false, 0u, 0.0, 0.0, 0.0);
    let at = pixel + step;
    if (any(at < vec2i(0)) || any(at >= vec2i(hole_view().size))) {
        return none;
    }
    let there = raw_words(at);
    if (there.x == 0u) {
        return none;
    }
    let z_there = raw_z(at);
    let width = hole_width(z_there);
    let least = select(0.02 * width + 4e-6 * abs(z_there), width, own == there.x);
    if (own != 0u && z - z_there <= least) {
        return none;
    }
    let steps = f32(max(abs(step.x), abs(step.y)));
    let n = unpack_normal(there.w);
    let ahead = hole_ray(pixel);
    let p = ray_point(hole_ray(at), z_there);
    let down = dot(n, vec3f(ahead.slope, 1.0));
    let limit = 30.0 * width * steps;
    let plane = dot(n, p - vec3f(ahead.offset, 0.0)) / select(down, 1e-30, abs(down) < 1e-30);
    let plane_z = clamp(plane, z_there - limit, z_there + limit);
    if (own != 0u && z - plane_z <= least) {
        return none;
    }
    return HoleSide(true, there.x, z_there, plane_z, steps);
}

fn hole_one_depth(a: HoleSide, b: HoleSide) -> bool {
    let slope = abs(a.plane_z - a.z) + abs(b.plane_z - b.z);
    let slack = hole_width(a.z) * (2.0 + 2.0 * (a.steps + b.steps));
    return abs(a.plane_z - b.plane_z) <= slack + 0.5 * slope;
}

// Whether faces `a` and `b` (slots + 1) lie on both sides of a pixel and nearer.
fn is_hole(pixel: vec2i, own: u32, z: f32, a: u32, b: u32) -> bool {
    for (var k = 0; k < 4; k++) {
        let direction = select(select(vec2i(1, -1), vec2i(1, 1), k == 2), select(vec2i(0, 1), vec2i(1, 0), k == 0), k < 2);
        for (var near = 1; near <= HOLE_REACH; near++) {
            let first = hole_side(pixel, -near * direction, own, z);
            if (!first.there || (first.face != a && first.face != b)) {
                continue;
            }
            for (var far = 1; far <= HOLE_REACH; far++) {
                let second = hole_side(pixel, far * direction, own, z);
                let pair = (first.face == a && second.face == b) || (first.face == b && second.face == a);
                if (second.there && pair && hole_one_depth(first, second)) {
                    return true;
                }
            }
        }
    }
    return false;
}

// The same for slits that are wider, across `direction` (unit, pixels) and up to `most` pixels away.
fn is_wide_hole(pixel: vec2i, own: u32, z: f32, a: u32, b: u32, direction: vec2f, most: i32) -> bool {
    var first = HoleSide(false, 0u, 0.0, 0.0, 0.0);
    var second = first;
    for (var k = 1; k <= most; k++) {
        if (!first.there) {
            first = hole_side(pixel, vec2i(round(-f32(k) * direction)), own, z);
        }
        if (!second.there) {
            second = hole_side(pixel, vec2i(round(f32(k) * direction)), own, z);
        }
        if (first.there && second.there) {
            break;
        }
    }
    let of_edge = (first.face == a || first.face == b) && (second.face == a || second.face == b);
    return first.there && second.there && of_edge && hole_one_depth(first, second);
}
