// Puts the accumulated picture over the background into the target, with depth.

@group(0) @binding(0) var<uniform> look: Look;
@group(0) @binding(1) var accumulated: texture_2d<f32>;
@group(0) @binding(2) var smooth_sampler: sampler;
@group(0) @binding(3) var depths: texture_depth_2d;

struct Screen {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,   // 0..1 from the top left
}

struct Pixel {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Screen {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return Screen(vec4f(2.0 * corner - 1.0, 0.0, 1.0), vec2f(corner.x, 1.0 - corner.y));
}

// Premultiplied linear colour of the surfaces.
fn mean(uv: vec2f) -> vec4f {
    return textureSampleLevel(accumulated, smooth_sampler, uv, 0.0) / look.samples;
}

// The same over the background.
fn composed(uv: vec2f) -> vec4f {
    let sum = mean(uv);
    let background = mix(look.background_top, look.background_bottom, uv.y);
    let over = vec4f(background.rgb * background.a, background.a);
    return sum + (1.0 - clamp(sum.a, 0.0, 1.0)) * over;
}

fn encoded(colour: vec4f) -> vec4f {
    let straight = colour.rgb / max(colour.a, 1e-6);
    return vec4f(srgb_from_linear(clamp(straight, vec3f(0.0), vec3f(1.0))), clamp(colour.a, 0.0, 1.0));
}

fn depth_at(uv: vec2f) -> f32 {
    return textureLoad(depths, clamp(vec2i(uv * look.size), vec2i(0), vec2i(look.size) - 1), 0);
}

// For targets that encode what they are given. Entry points of their own, because software drivers compute
// both sides of every branch. With depth they go over what is there.
@fragment
fn fragment_linear(in: Screen) -> Pixel {
    return Pixel(mean(in.uv), depth_at(in.uv));
}

@fragment
fn fragment(in: Screen) -> Pixel {
    return Pixel(encoded(mean(in.uv)), depth_at(in.uv));
}

// For targets without a depth buffer.
@fragment
fn fragment_flat_linear(in: Screen) -> @location(0) vec4f {
    return composed(in.uv);
}

@fragment
fn fragment_flat(in: Screen) -> @location(0) vec4f {
    return encoded(composed(in.uv));
}
