// Rays in view axes. Twin: reference::ray.

// The points (offset + slope z, z).
struct Ray {
    slope: vec2f,
    offset: vec2f,
}

fn ray_point(ray: Ray, z: f32) -> vec3f {
    return vec3f(ray.offset + ray.slope * z, z);
}
