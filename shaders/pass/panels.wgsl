// Panels: bevy_egui's shader with the colours made linear per vertex instead of per pixel.
// egui multiplies texture and colour sRGB encoded. Encoding is nearly a power, so that the product of the
// linear values is the same to within a grey level, without the six powers per pixel that made the panels the
// dearest part of a frame on a software driver.

struct Transform {
    scale: vec2f,
    translation: vec2f,
}

struct Corner {
    @location(0) position: vec2f,   // points
    @location(1) uv: vec2f,
    @location(2) color: vec4f,      // sRGB encoded, premultiplied
}

struct Varying {
    @builtin(position) clip: vec4f,
    @location(0) color: vec4f,      // linear, premultiplied
    @location(1) uv: vec2f,
}

@group(0) @binding(0) var<uniform> transform: Transform;

#ifdef BINDLESS
struct BindlessOffset {
    offset: u32,
}

@group(1) @binding(0) var images: binding_array<texture_2d<f32>>;
@group(1) @binding(1) var samplers: binding_array<sampler>;
var<immediate> bindless: BindlessOffset;
#else
@group(1) @binding(0) var image: texture_2d<f32>;
@group(1) @binding(1) var image_sampler: sampler;
#endif

fn linear_from_srgb(c: vec3f) -> vec3f {
    let high = pow((c + 0.055) / 1.055, vec3f(2.4));
    return select(high, c / 12.92, c < vec3f(0.04045));
}

@vertex
fn vs_main(in: Corner) -> Varying {
    let clip = vec4f(in.position * transform.scale + transform.translation, 0.0, 1.0);
    return Varying(clip, vec4f(linear_from_srgb(in.color.rgb), in.color.a), in.uv);
}

@fragment
fn fs_main(in: Varying) -> @location(0) vec4f {
#ifdef BINDLESS
    let texel = textureSample(images[bindless.offset], samplers[bindless.offset], in.uv);
#else
    let texel = textureSample(image, image_sampler, in.uv);
#endif
    return texel * in.color;
}
