// What shading and trimming know of a face. Mirror: encoding::face::FaceHeader.
struct FaceHeader {
    colour: vec3f,    // linear RGB
    flags: u32,       // FACE_*
    number: u32,      // position of the face in its model, from 0
    pad0: u32,
    pad1: u32,
    pad2: u32,
    grid: GridHeader,
}

// Mirror: kernel::trim::grid::GridHeader, which describes the words behind it.
struct GridHeader {
    columns: u32,     // of the outer block; 0: nothing is inside
    rows: u32,
    scale_u: f32,     // column = floor(u * scale_u)
    scale_v: f32,
    cell_base: u32,   // added to every index into the cells,
    entry_base: u32,  // the entries
    data_base: u32,   // and the records
    flags: u32,       // GRID_NON_ZERO
}

const FACE_VISIBLE: u32 = 1u;
const FACE_SELECTED: u32 = 2u;
const FACE_HOVERED: u32 = 4u;
const FACE_REVERSED: u32 = 8u;
const FACE_TRIMMED: u32 = 16u;
