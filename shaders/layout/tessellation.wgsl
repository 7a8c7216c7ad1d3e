// Which face a run of vertices belongs to, and where they are measured from: high + low, model units. `MeshVertex.face`
// counts these. Mirror: encoding::tessellation::TessellationPart.
struct TessellationPart {
    high: vec3f,
    slot: u32,         // of the face in the face table
    low: vec3f,
    pad0: u32,
}
