// How a picture shall look. Mirror: encoding::look::Look. Colours are linear RGB; a = 1 where opaque.
struct Look {
    background_top: vec4f,
    background_bottom: vec4f,
    edge: vec4f,          // colour of edges, a: strength
    selected: vec4f,      // colour, a: strength
    hovered: vec4f,
    slope_scale: vec2f,   // as in View
    offset_scale: vec2f,
    jitter: vec2f,
    size: vec2f,          // pixels of the visibility buffer
    depth: vec4f,
    mode: u32,            // MODE_*
    edges: u32,           // 1: drawn
    samples: f32,         // samples in the accumulated picture
    edge_width: f32,      // pixels
    pixel: vec2f,         // as in View
    difference: u32,      // 1: grey, what fat lines changed in a colour
    pad1: u32,
}

const MODE_SHADED: u32 = 0u;
const MODE_FACES: u32 = 1u;
const MODE_UV: u32 = 2u;
const MODE_HEAT: u32 = 3u;
const MODE_DEVIATION: u32 = 4u;
