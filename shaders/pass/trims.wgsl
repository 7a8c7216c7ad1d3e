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

// Whether the trims keep `uv`, or a point that rounding may have moved there: faces that meet exactly overlap by as
// much, so that no ray passes between them. Twin: reference::cast::is_kept.
fn kept(grid: GridHeader, uv: vec2f) -> Verdict {
    var verdict = classify(grid, uv.x, uv.y);
    // As a loop: see seeds.
    for (var k = 0u; k < 4u; k++) {
        if (verdict.inside || !verdict.near) {
            break;
        }
        let beside = uv + nudge(k);
        verdict.inside = classify(grid, beside.x, beside.y).inside;
    }
    return verdict;
}
