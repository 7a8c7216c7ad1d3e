// A piece of a trim curve on one patch. Mirror: encoding::ribbon::RibbonPiece.
// The patch is cut to the neighbourhood of the piece; curve points are in its own 0..1 parameters.
struct RibbonPiece {
    origin_high: vec3f,   // the patch's points count from high + low, model units
    first_point: u32,     // first control point of the patch
    origin_low: vec3f,
    degrees: u32,         // degree in u | in v << 8 | of the curve << 16
    uv_min: vec2f,        // face-normalised (u, v) of the patch's corner (0, 0)
    uv_max: vec2f,        // and (1, 1)
    first_curve: u32,     // first control point of the curve: x w, y w, w, 0
    face: u32,            // slot in the face table
    other: u32,           // slot of the face across the edge
    gap: f32,             // largest distance from the curve across the edge, model units
}

// A stretch of a piece that is drawn as a strip. Mirror: encoding::ribbon::RibbonSpan.
struct RibbonSpan {
    piece: u32,
    start: f32,   // parameters on the piece, 0..1
    end: f32,
    pad0: u32,
}
