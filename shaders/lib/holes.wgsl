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
    let limit = 30.0 * width * steps;
    let plane = plane_depth(n, ray_point(hole_ray(at), z_there), hole_ray(pixel));
    let plane_z = clamp(plane, z_there - limit, z_there + limit);
    if (own != 0u && z - plane_z <= least) {
        return none;
    }
    // A surface that bends away lies behind its own tangent planes, seen from either place.
    if (own == there.x) {
        let back = plane_depth(unpack_normal(raw_words(pixel).w), ray_point(hole_ray(pixel), z), hole_ray(at));
        let own_limit = 30.0 * hole_width(z) * steps;
        if (clamp(back, z - own_limit, z + own_limit) - z_there <= least) {
            return none;
        }
    }
    return HoleSide(true, there.x, z_there, plane_z, steps);
}

// `step`: by how many pixels one may lie above the other.
fn hole_one_depth(a: HoleSide, b: HoleSide, step: i32) -> bool {
    let slope = abs(a.plane_z - a.z) + abs(b.plane_z - b.z);
    let slack = hole_width(a.z) * (2.0 + 2.0 * (a.steps + b.steps));
    return abs(a.plane_z - b.plane_z) - hole_width(a.z) * f32(step) <= slack + 0.5 * slope;
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
                // Right beside it one face on both sides will do: a speck that was left when all around was filled.
                let speck = near == 1 && far == 1 && (second.face == a || second.face == b);
                let pair = speck || (first.face == a && second.face == b) || (first.face == b && second.face == a);
                if (second.there && pair && hole_one_depth(first, second, 0)) {
                    return true;
                }
            }
        }
    }
    return false;
}

// Steps of a search grow slowly beyond this many pixels: the sides of a wide slit are wider than the steps.
const HOLE_EXACT: i32 = 16;

// The first nearer surface along `direction` (unit, pixels), up to `most` pixels away.
fn hole_search(pixel: vec2i, own: u32, z: f32, direction: vec2f, most: i32) -> HoleSide {
    for (var k = 1; k <= most; k += 1 + k / HOLE_EXACT) {
        let side = hole_side(pixel, vec2i(round(f32(k) * direction)), own, z);
        if (side.there) {
            return side;
        }
    }
    return HoleSide(false, 0u, 0.0, 0.0, 0.0);
}

fn hole_is_of(side: HoleSide, a: u32, b: u32) -> bool {
    return side.there && (side.face == a || side.face == b);
}

// The same for slits that are wider, across `direction` (unit, pixels) and up to `most` pixels away.
fn is_wide_hole(pixel: vec2i, own: u32, z: f32, a: u32, b: u32, direction: vec2f, most: i32) -> bool {
    let first = hole_search(pixel, own, z, -direction, most);
    if (!hole_is_of(first, a, b)) {
        return false;
    }
    let second = hole_search(pixel, own, z, direction, most);
    return hole_is_of(second, a, b) && hole_one_depth(first, second, most / 2);
}

fn in_picture(p: vec2f) -> bool {
    return all(p >= vec2f(0.0)) && all(p < hole_view().size);
}

// Where a side of the slit lies outside of the picture or behind another face: whether the slit is one farther along,
// where both can be seen.
fn is_hole_along(pixel: vec2i, own: u32, z: f32, a: u32, b: u32, direction: vec2f, most: i32) -> bool {
    let centre = vec2f(pixel) + 0.5;
    let across = f32(most) * direction;
    if (in_picture(centre + across) && in_picture(centre - across)) {
        let first = hole_search(pixel, own, z, -direction, most);
        let second = hole_search(pixel, own, z, direction, most);
        let hidden = first.there && second.there && hole_is_of(first, a, b) != hole_is_of(second, a, b);
        if (!hidden) {
            return false;
        }
    }
    let along = vec2f(-direction.y, direction.x);
    for (var k = 1; k <= 2 * most; k *= 2) {
        for (var sign = -1; sign <= 1; sign += 2) {
            let at = pixel + vec2i(round(f32(sign * k) * along));
            if (!in_picture(vec2f(at))) {
                continue;
            }
            if (is_wide_hole(at, raw_words(at).x, raw_z(at), a, b, direction, most)) {
                return true;
            }
        }
    }
    return false;
}
