// Rays in view axes. Twin: reference::ray.

// The points (offset + slope z, z).
struct Ray {
    slope: vec2f,
    offset: vec2f,
}

fn ray_point(ray: Ray, z: f32) -> vec3f {
    return vec3f(ray.offset + ray.slope * z, z);
}

// Depth at which a ray meets the plane through `p` with normal `n`.
fn plane_depth(n: vec3f, p: vec3f, ray: Ray) -> f32 {
    let down = dot(n, vec3f(ray.slope, 1.0));
    return dot(n, p - vec3f(ray.offset, 0.0)) / select(down, 1e-30, abs(down) < 1e-30);
}

// A box in view axes.
struct ViewBox {
    centre: vec3f,
    x: vec4f,  // unit axis, half length
    y: vec4f,
    z: vec4f,
}

fn slab(ray: Ray, centre: vec3f, axis: vec4f) -> vec2f {
    let turn = dot(axis.xyz, vec3f(ray.slope, 1.0));
    let start = dot(axis.xyz, vec3f(ray.offset, 0.0) - centre);
    let safe = select(turn, 1e-20, abs(turn) < 1e-20);
    let a = (-axis.w - start) / safe;
    let b = (axis.w - start) / safe;
    return vec2f(min(a, b), max(a, b));
}

// Depths at which a ray enters and leaves a box; it passes by when the first is larger.
fn box_span(ray: Ray, bound: ViewBox) -> vec2f {
    let x = slab(ray, bound.centre, bound.x);
    let y = slab(ray, bound.centre, bound.y);
    let z = slab(ray, bound.centre, bound.z);
    return vec2f(max(max(x.x, y.x), z.x), min(min(x.y, y.y), z.y));
}

// The largest depth value (reverse z) behind `z`: 1 from the near plane on.
fn depth_from(planes: vec4f, z: f32) -> f32 {
    let w = planes.z + planes.w * z;
    return select(1.0, min((planes.x + planes.y * z) / w, 1.0), w > 0.0);
}
