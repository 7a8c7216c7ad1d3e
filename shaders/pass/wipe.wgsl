// Puts one of two kept pictures of the same size where the scissor says: visibility, colour and depth.

@group(0) @binding(0) var visibility: texture_2d<u32>;
@group(0) @binding(1) var sum: texture_2d<f32>;
@group(0) @binding(2) var depths: texture_depth_2d;

struct Pixel {
    @location(0) visibility: vec4u,
    @location(1) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4f(2.0 * corner - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) at: vec4f) -> Pixel {
    let pixel = vec2i(at.xy);
    return Pixel(textureLoad(visibility, pixel, 0), textureLoad(sum, pixel, 0), textureLoad(depths, pixel, 0));
}
