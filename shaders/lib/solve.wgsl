// Newton's method on the exact rational patch. Twin: reference::solve.
//
// The ray is the meeting line of two planes through the pixel (Kajiya 1982). A step is taken from an
// exact evaluation; the quadratic model tells how large the error after the step is, so that no
// evaluation is spent on proving what is known. Near silhouettes two zeros draw together and plain steps
// reach whichever they like: there each step goes to the nearer (or farther) zero of the exact tangent
// plane bent by the model's curvature, so that the two are never confused.

// A cell as the solver sees it: its quadratic model in view axes, relative to the reference point.
struct Piece {
    first_point: u32,
    degrees: u32,
    residual: f32,
    size: f32,
    shift: vec3f,  // the cell's origin
    m00: vec3f,
    m10: vec3f,
    m01: vec3f,
    m20: vec3f,
    m11: vec3f,
    m02: vec3f,
}

// What Newton's method found.
struct Root {
    converged: bool,
    evaluations: u32,
    x: vec2f,       // cell parameters
    z: f32,         // view depth
    slack: f32,     // by how much x may be wrong
    normal: vec3f,  // du x dv in view axes, unit
}

// Branches: Newton's own steps to the only zero nearby, or steps to the nearer or farther of two zeros.
const ANY: u32 = 0u;
const NEARER: u32 = 1u;
const FARTHER: u32 = 2u;
const MAX_STEPS: u32 = 8u;
// Rounding of cell parameters: cells overlap by this much so that no ray passes between them.
const HAIR: f32 = 4e-6;
// Error allowed to remain, in pixels.
const PIXEL_TOLERANCE: f32 = 0.02;
// Rounding of an evaluation in f32 relative to the size of a cell.
const ROUNDING: f32 = 4e-7;

fn project(ray: Ray, m: vec3f) -> vec2f {
    return m.xy - ray.slope * m.z;
}

fn piece_conics(ray: Ray, piece: Piece) -> Conics {
    return Conics(
        project(ray, piece.m00) - ray.offset,
        project(ray, piece.m10),
        project(ray, piece.m01),
        project(ray, piece.m20),
        project(ray, piece.m11),
        project(ray, piece.m02),
    );
}

fn model_z(piece: Piece, x: vec2f) -> f32 {
    return piece.m00.z + x.x * (piece.m10.z + x.x * piece.m20.z + x.y * piece.m11.z) +
        x.y * (piece.m01.z + x.y * piece.m02.z);
}

// Where to start: the model's roots on or just beside the cell, nearest first. Where the model sees one
// that may stand for two, both starts are that one.
fn piece_seeds(piece: Piece, conics: Conics) -> Seeds {
    let start = seeds(conics, piece.residual);
    let swap = start.count == 2u && model_z(piece, start.second) < model_z(piece, start.first);
    let first = select(start.first, start.second, swap);
    let second = select(start.second, start.first, swap);
    let twofold = start.count == 1u && conics_fold(conics, start.first);
    return Seeds(select(start.count, 2u, twofold), first, select(first, second, start.count == 2u));
}

// What a step along the cell's curvature adds to the depth at a point whose derivatives are `slope`.
fn depth_step(piece: Piece, slope: vec2f, d: vec2f) -> f32 {
    return d.x * (slope.x + d.x * piece.m20.z + d.y * piece.m11.z) + d.y * (slope.y + d.y * piece.m02.z);
}

// The step to the nearer or farther of the two zeros that the exact tangents and the model's curvature
// show from here.
fn branch_step(local: Conics, piece: Piece, slope: vec2f, branch: u32, slack: f32) -> vec2f {
    let both = conics_split(local, vec2f(0.0), slack);
    let in_order = depth_step(piece, slope, both.first) <= depth_step(piece, slope, both.second);
    return select(both.second, both.first, both.count == 1u || in_order == (branch == NEARER));
}

// The normal at a root from first derivatives; the model stands in where they vanish (poles).
fn root_normal(piece: Piece, ds: vec3f, dt: vec3f, x: vec2f) -> vec3f {
    // The view axes are left-handed (z forward), so the factors change places.
    let n = cross(dt, ds);
    let c = 0.9 * x;
    let model_ds = piece.m10 + 2.0 * c.x * piece.m20 + c.y * piece.m11;
    let model_dt = piece.m01 + c.x * piece.m11 + 2.0 * c.y * piece.m02;
    let model_n = cross(model_dt, model_ds);
    let lost = dot(n, n) < 1e-8 * dot(model_n, model_n);
    let chosen = select(n, model_n, lost);
    return chosen / max(length(chosen), 1e-37);
}

// `pixel`: a pixel is pixel.x + pixel.y z wide at depth z. `branch`: ANY, NEARER or FARTHER.
fn newton(ray: Ray, axes: Axes, piece: Piece, conics: Conics, pixel: vec2f, start: vec2f, branch: u32) -> Root {
    var root = Root(false, 0u, start, 0.0, 0.0, vec3f(0.0, 0.0, -1.0));
    for (var step = 0u; step < MAX_STEPS; step++) {
        let p01 = 0.5 + 0.5 * root.x;
        let jet = patch_jet(piece.first_point, piece.degrees & 0xffu, piece.degrees >> 8u, p01.x, p01.y);
        root.evaluations++;
        let inverse = 1.0 / jet.s.w;
        let p = axes_apply(axes, jet.s.xyz * inverse);
        let ps = 0.5 * inverse * (axes_apply(axes, jet.du.xyz) - p * jet.du.w);
        let pt = 0.5 * inverse * (axes_apply(axes, jet.dv.xyz) - p * jet.dv.w);
        let at = p + piece.shift;
        let f = project(ray, at) - ray.offset;
        let fs = project(ray, ps);
        let ft = project(ray, pt);
        let tolerance = PIXEL_TOLERANCE * (pixel.x + pixel.y * abs(at.z)) + ROUNDING * piece.size;
        let slope = vec2f(ps.z, pt.z);
        let local = Conics(f, fs, ft, conics.c20, conics.c11, conics.c02);
        var full = solve_2x2(fs, ft, -f);
        if (branch != ANY) {
            full = branch_step(local, piece, slope, branch, tolerance);
        }
        let delta = clamp(full, vec2f(-0.5), vec2f(0.5));
        let miss = select(conics_value(local, delta), conics_bilinear(conics, delta, delta), branch == ANY);
        let reach = abs(delta.x) + abs(delta.y);
        let predicted = abs(miss.x) + abs(miss.y) + 12.0 * piece.residual * reach * reach;
        root.x += delta;
        if (max(abs(root.x.x), abs(root.x.y)) > 2.0) {
            break;
        }
        if (predicted <= tolerance && all(delta == full)) {
            let ds = ps + 2.0 * delta.x * piece.m20 + delta.y * piece.m11;
            let dt = pt + delta.x * piece.m11 + 2.0 * delta.y * piece.m02;
            let det = max(abs(fs.x * ft.y - fs.y * ft.x), 1e-37);
            root.converged = true;
            root.z = at.z + depth_step(piece, slope, delta);
            root.slack = min(0.02, 2.0 * predicted * (length(fs) + length(ft)) / det);
            root.normal = root_normal(piece, ds, dt, root.x);
            break;
        }
    }
    return root;
}
