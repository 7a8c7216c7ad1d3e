// The last word of the visibility buffer. Twin: reference::pack.

// Unit vector to the octahedron unfolded into a square.
fn octahedral(n: vec3f) -> vec2f {
    let flat = n.xy / max(abs(n.x) + abs(n.y) + abs(n.z), 1e-30);
    let sign = select(vec2f(-1.0), vec2f(1.0), flat >= vec2f(0.0));
    return select((1.0 - abs(flat.yx)) * sign, flat, n.z >= 0.0);
}

fn from_octahedral(e: vec2f) -> vec3f {
    let z = 1.0 - abs(e.x) - abs(e.y);
    let sign = select(vec2f(-1.0), vec2f(1.0), e >= vec2f(0.0));
    return normalize(vec3f(select((1.0 - abs(e.yx)) * sign, e, z >= 0.0), z));
}

fn pack_normal(n: vec3f) -> u32 {
    return pack2x16snorm(octahedral(n));
}

fn unpack_normal(word: u32) -> vec3f {
    return from_octahedral(unpack2x16snorm(word));
}

// Curve evaluations (7 bits), kept (1 bit), surface evaluations (8 bits), normal (2 x 8 bits).
fn pack_heat(n: vec3f, curve_evaluations: u32, kept: bool, surface_evaluations: u32) -> u32 {
    let e = vec2u((octahedral(n) * 0.5 + 0.5) * 255.0 + 0.5);
    return min(curve_evaluations, 127u) | (u32(kept) << 7u) | (min(surface_evaluations, 255u) << 8u) |
        (e.x << 16u) | (e.y << 24u);
}

fn unpack_heat_normal(word: u32) -> vec3f {
    let e = vec2f(vec2u(word >> 16u, word >> 24u) & vec2u(255u)) / 255.0;
    return from_octahedral(2.0 * e - 1.0);
}
