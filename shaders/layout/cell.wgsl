// A piece of a face that is nearly quadratic. Mirror: encoding::cell::Cell.
// Lengths are model units relative to `origin`; cell parameters x are in -1..1 squared and the patch's
// own parameters are 0.5 + 0.5 x.
struct Cell {
    box_centre: vec3f,
    face: u32,             // slot in the face table
    box_x: vec4f,          // unit axis of the oriented box, half length
    box_y: vec4f,
    box_z: vec4f,
    origin_high: vec3f,    // origin = high + low
    first_point: u32,      // first control point
    origin_low: vec3f,
    degrees: u32,          // degree in u | degree in v << 8
    uv_min: vec2f,         // face-normalised (u, v) of x = (-1, -1)
    uv_max: vec2f,         // and of (1, 1)
    m00: vec3f,            // quadratic model m00 + m10 s + m01 t + m20 s^2 + m11 s t + m02 t^2
    residual: f32,         // largest distance of the model from the surface
    m10: vec3f,
    size: f32,             // length of the box's half diagonal
    m01: vec3f,
    flags: u32,            // CELL_WHOLE
    m20: vec3f,
    pad1: u32,
    m11: vec3f,
    pad2: u32,
    m02: vec3f,
    pad3: u32,
}

// No trim curve passes through the cell: everything on it is kept.
const CELL_WHOLE: u32 = 1u;
