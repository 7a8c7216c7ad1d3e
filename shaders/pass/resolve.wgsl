// Turns the visibility buffer into colours, one sample per pixel, premultiplied linear RGB.

@group(0) @binding(0) var<uniform> look: Look;
@group(0) @binding(1) var visibility: texture_2d<u32>;
@group(0) @binding(2) var depths: texture_depth_2d;
@group(0) @binding(3) var<storage, read> faces: array<FaceHeader>;
@group(0) @binding(4) var raw: texture_2d<u32>;   // before fat lines; else the same

// What a pipeline is made without. PLAIN: surfaces in their own colours only, no difference; EDGES: edges if asked for.
override PLAIN: bool = false;
override EDGES: bool = true;

// Wider lines are cut to this.
const MOST_EDGE_PIXELS: i32 = 4;

// As far away as can be: of pixels without a surface none is drawn.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4f(2.0 * corner - 1.0, 0.0, 1.0);
}

fn clamped(pixel: vec2i) -> vec2i {
    return clamp(pixel, vec2i(0), vec2i(look.size) - 1);
}

fn words_at(pixel: vec2i) -> vec4u {
    return textureLoad(visibility, clamped(pixel), 0);
}

// View depth of a pixel that shows a surface.
fn z_at(pixel: vec2i) -> f32 {
    let d = textureLoad(depths, clamped(pixel), 0);
    return (d * look.depth.z - look.depth.x) / min(look.depth.y - d * look.depth.w, -1e-30);
}

fn ray_at(pixel: vec2f) -> Ray {
    let ndc = (2.0 * pixel / look.size - 1.0) * vec2f(1.0, -1.0);
    return Ray(ndc * look.slope_scale, ndc * look.offset_scale);
}

// Whether the pixel beside is another face, nothing, or the same face behind a silhouette. Of two
// pixels that differ only one draws the line: the nearer, or the one with the smaller face.
fn edge_to(here: vec4u, z: f32, p: vec3f, n: vec3f, pixel: vec2i, step: vec2i) -> bool {
    let there = words_at(pixel + step);
    if (there.x == 0u) {
        return all(clamped(pixel + step) == pixel + step);
    }
    let z_there = z_at(pixel + step);
    if (there.x != here.x) {
        let width = look.pixel.x + look.pixel.y * abs(z);
        let tie = abs(z_there - z) < 2.0 * width;
        return select(z < z_there, here.x < there.x, tie);
    }
    // Where the tangent plane here says the neighbour should be.
    let ray = ray_at(vec2f(pixel + step) + 0.5 + look.jitter);
    let along = vec3f(ray.slope, 1.0);
    let down = dot(n, along);
    let plane_z = dot(n, p - vec3f(ray.offset, 0.0)) / select(down, -1e-6, abs(down) < 1e-6);
    let width = f32(abs(step.x) + abs(step.y)) * (look.pixel.x + look.pixel.y * abs(z));
    return z_there - max(plane_z, z) > 12.0 * width && abs(down) > 1e-6 && z_there - z > 12.0 * width;
}

// How much of the pixel a line covers that runs along an edge, on the side that draws it.
fn edge_cover(here: vec4u, z: f32, p: vec3f, n: vec3f, pixel: vec2i) -> f32 {
    // Loops that ask at their end: see classify.
    var k = 1;
    loop {
        if (edge_to(here, z, p, n, pixel, vec2i(k, 0)) || edge_to(here, z, p, n, pixel, vec2i(-k, 0)) ||
            edge_to(here, z, p, n, pixel, vec2i(0, k)) || edge_to(here, z, p, n, pixel, vec2i(0, -k))) {
            return clamp(look.edge_width - f32(k - 1), 0.0, 1.0);
        }
        k++;
        if (k > MOST_EDGE_PIXELS || look.edge_width <= f32(k - 1)) {
            break;
        }
    }
    return 0.0;
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let here = words_at(pixel);
    if (here.x == 0u) {
        return vec4f(0.0);
    }
    let face = faces[here.x - 1u];
    let z = z_at(pixel);
    let ray = ray_at(position.xy + look.jitter);
    let p = ray_point(ray, z);
    let eye = -normalize(vec3f(ray.slope, 1.0));
    let mode = select(look.mode, MODE_SHADED, PLAIN);
    let heat = mode == MODE_HEAT;
    let deviation = mode == MODE_DEVIATION;
    var n = select(unpack_normal(here.w), unpack_heat_normal(here.w), heat || deviation);
    let outside = (dot(n, eye) >= 0.0) != ((face.flags & FACE_REVERSED) != 0u);
    n = select(-n, n, dot(n, eye) >= 0.0);
    var base = face.colour;
    if (mode == MODE_FACES) {
        base = face_palette(face.number);
    }
    if (mode == MODE_UV) {
        base = uv_board(vec2f(bitcast<f32>(here.y), bitcast<f32>(here.z)));
    }
    if (mode == MODE_SHADED && !outside) {
        base = inside_tint(base);
    }
    if (heat) {
        base = heat_colour(here.w);
    }
    if (deviation) {
        base = deviation_colour(here.w & 255u);
    }
    if ((face.flags & FACE_SELECTED) != 0u) {
        base = mix(base, look.selected.rgb, look.selected.a);
    }
    if ((face.flags & FACE_HOVERED) != 0u) {
        base = mix(base, look.hovered.rgb, look.hovered.a);
    }
    var colour = lit(base, n, eye);
    if (EDGES && look.edges != 0u) {
        colour = mix(colour, look.edge.rgb, look.edge.a * edge_cover(here, z, p, n, pixel));
    }
    if (!PLAIN && look.difference != 0u) {
        colour = difference_colour(colour, any(textureLoad(raw, pixel, 0) != here));
    }
    return vec4f(colour, 1.0);
}
