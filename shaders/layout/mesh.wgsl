// A vertex of a face's untrimmed triangles. Mirror: encoding::mesh::MeshVertex.
struct MeshVertex {
    position: vec3f,   // model units relative to the MeshOrigin
    face: u32,         // slot in the face table
    normal: vec3f,     // du x dv, unit, model axes
    flags: u32,        // MESH_*
    uv: vec2f,         // face-normalised
    entry: u32,        // entry word of the only trim segment that passes through the triangle
    origin: u32,       // position of the MeshOrigin
}

// Where the vertices of a piece of a face are measured from: high + low, model units. Mirror: encoding::mesh::MeshOrigin.
struct MeshOrigin {
    high: vec3f,
    pad0: u32,
    low: vec3f,
    pad1: u32,
}

// No trim curve passes through the triangle: everything on it is kept.
const MESH_WHOLE: u32 = 1u;
// Points are kept where the value of `entry` is 0, not where it is 1.
const MESH_ZERO_KEPT: u32 = 2u;
