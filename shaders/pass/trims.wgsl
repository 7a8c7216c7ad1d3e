// What every pass that trims is bound to: the view, the faces and their parity grids.

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage, read> faces: array<FaceHeader>;
@group(0) @binding(2) var<storage, read> trim_cells: array<u32>;
@group(0) @binding(3) var<storage, read> trim_entries: array<u32>;
@group(0) @binding(4) var<storage, read> trim_data: array<vec4f>;

fn load_trim_cell(index: u32) -> u32 {
    return trim_cells[index];
}

fn load_trim_entry(index: u32) -> u32 {
    return trim_entries[index];
}

fn load_trim_data(index: u32) -> vec4f {
    return trim_data[index];
}

fn load_trim_word(index: u32, word: u32) -> f32 {
    return trim_data[index + (word >> 2u)][word & 3u];
}

// A grid as two words of four that are the same all over a triangle: read once per corner instead of once per pixel.
struct GridWords {
    size: vec4u,
    base: vec4u,
}

fn grid_words(grid: GridHeader) -> GridWords {
    return GridWords(vec4u(grid.columns, grid.rows, bitcast<u32>(grid.scale_u), bitcast<u32>(grid.scale_v)),
        vec4u(grid.cell_base, grid.entry_base, grid.data_base, grid.flags));
}

fn grid_header(size: vec4u, base: vec4u) -> GridHeader {
    return GridHeader(size.x, size.y, bitcast<f32>(size.z), bitcast<f32>(size.w), base.x, base.y, base.z, base.w);
}

// Whether the trims keep `uv`, or a point that rounding may have moved there: faces that meet exactly overlap by as
// much, so that no ray passes between them. Twin: reference::cast::is_kept.
fn kept(grid: GridHeader, uv: vec2f) -> Verdict {
    var verdict = Verdict(false, 0u, false);
    // All in one loop: see classify.
    var k = 0u;
    loop {
        let here = uv + select(nudge(k - 1u), vec2f(0.0), k == 0u);
        let found = classify(grid, here.x, here.y);
        verdict = Verdict(found.inside, select(verdict.evaluations, found.evaluations, k == 0u),
            select(verdict.near, found.near, k == 0u));
        k++;
        if (verdict.inside || !verdict.near || k > 4u) {
            break;
        }
    }
    return verdict;
}
