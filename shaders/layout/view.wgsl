// The camera of one cast. Mirror: encoding::view::View.
// View axes: x right, y up, z forward (away from the viewer), origin at the reference point
// (the eye, or for orthographic cameras the target).
struct View {
    right: vec4f,         // world axes, unit; w unused
    up: vec4f,
    forward: vec4f,
    reference_high: vec4f, // reference point = high + low, model units; w unused
    reference_low: vec4f,
    clip_scale: vec2f,    // view x, y to clip x, y
    slope_scale: vec2f,   // ndc to x / z and y / z of the ray; 0 for orthographic
    offset_scale: vec2f,  // ndc to x, y of the ray at z = 0; 0 for perspective
    jitter: vec2f,        // sub-pixel shift of the sample, pixels
    depth: vec4f,         // depth = (a + b z) / (c + d z), reverse z
    size: vec2f,          // pixels
    pixel: vec2f,         // size of a pixel at depth z = pixel.x + pixel.y z, model units
    flags: u32,           // CAST_*
    cell_count: u32,
    pad0: u32,
    pad1: u32,
}

const CAST_TRIM: u32 = 1u;  // leave out what is trimmed away
const CAST_HEAT: u32 = 2u;  // write evaluation counts instead of normals
const CAST_FACETS: u32 = 4u; // triangles of a tessellation are flat
const CAST_DEVIATION: u32 = 8u; // with CAST_HEAT: their levels of deviation instead of counts
