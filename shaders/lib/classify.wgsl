// Whether a point is inside the trim loops: the parity grid. Twin: kernel::trim::grid::classify and
// kernel::trim::record, statement by statement but for `near`, for which the twin takes that some curve is listed.
// The pass supplies load_trim_cell(i), load_trim_entry(i) -> u32, load_trim_data(i) -> vec4f and load_trim_word(i, k) -> f32,
// the k-th word from there on.
//
// Software drivers draw many pixels at a time and compute both sides of every branch: what can be left out is left out by
// a loop, and loops ask at their end whether to go on, as one that asks first goes round once more for nothing.

const GRID_NON_ZERO: u32 = 1u;
const CELL_REFINED: u32 = 128u;
const ENTRY_LO: u32 = 1u;
const ENTRY_HI: u32 = 2u;
const ENTRY_DOWN: u32 = 4u;
const ENTRY_RATIONAL: u32 = 8u;
const MAX_LEVELS: u32 = 4u;
const MAX_HALVINGS: u32 = 20u;
const MAX_ENTRIES: u32 = 4096u;
const BORDER: f32 = 4.8e-7;
// The largest number below 1: trim tests are half open.
const BELOW_ONE: f32 = 0.99999994;

// By how much parameters and trim curves may be wrong from rounding. Faces that meet exactly overlap by as much, so
// that no ray passes between them.
const ROUNDING_UV: f32 = 1.2e-7;

// Whether all curves are lines, of degree 2 or polynomial cubics, whose records are handed to `crossing` whole.
override SHORT_RECORDS: bool = false;

struct Verdict {
    inside: bool,
    evaluations: u32,
    near: bool,        // a curve may be as near as rounding moves points
}

struct Crossing {
    right: bool,
    near: bool,
    evaluations: u32,
}

// What the ends of a segment tell about a point.
struct Told {
    told: bool,        // all there is to know
    value: bool,
    near: bool,
}

fn cross2(a: vec2f, b: vec2f) -> f32 {
    return a.x * b.y - a.y * b.x;
}

// Fat bounds of a polynomial cubic from its scaled inner points.
fn cubic_bounds(q: vec4f, d: vec2f) -> vec2f {
    let e0 = q.xy;
    let e1 = q.zw - q.xy;
    let e2 = 3.0 * d - q.zw;
    let a = cross2(e1, e0);
    let b = cross2(e2, e1);
    let c = cross2(e2, e0);
    let least = min(min(min(a, b), min(c - a, c - b)), 0.0);
    let most = max(max(max(a, b), max(c - a, c - b)), 0.0);
    return vec2f(-0.2500005 * most, -0.2500005 * least);
}

fn cubic_point(q: vec4f, d: vec2f, t: f32) -> vec2f {
    let s = 1.0 - t;
    return t * (s * (s * q.xy + t * q.zw) + t * t * d);
}

// The same as curve_point for degree 2, from the second word of four of the record.
fn quadratic_point(q: vec4f, d: vec2f, rational: bool, t: f32) -> vec2f {
    let s = 1.0 - t;
    let x = (t * q.yz) * s + (t * t) * d;
    let w = (s + t * q.w) * s + t * t;
    return select(x, x / w, rational);
}

// Horner's scheme in scaled Bernstein form, of degree 2 or more.
fn curve_point(address: u32, d: vec2f, degree: u32, rational: bool, t: f32) -> vec2f {
    let s = 1.0 - t;
    var power = 1.0;
    var x = vec2f(0.0);
    var w = 1.0;
    var index = 5u;
    var i = 1u;
    loop {
        power *= t;
        x = x * s + power * vec2f(load_trim_word(address, index), load_trim_word(address, index + 1u));
        index += 2u;
        if (rational) {
            w = w * s + power * load_trim_word(address, index);
            index += 1u;
        }
        i++;
        if (i >= degree) {
            break;
        }
    }
    power *= t;
    x = x * s + power * d;
    if (rational) {
        w = w * s + power;
        return x / w;
    }
    return x;
}

// Whether a point so far to a `side` of the chord `d` may change sides of the curve, which lies within `bounds` of it, when
// rounding moves it.
fn is_near(side: f32, bounds: vec2f, d: vec2f) -> bool {
    let slack = 2.0 * ROUNDING_UV * (abs(d.x) + abs(d.y));
    return side >= bounds.x - slack && side <= bounds.y + slack;
}

fn ends_tell(ends: vec4f, entry: u32, u: f32, v: f32) -> Told {
    let below = v < ends.y;
    let above = v >= ends.w;
    let left = min(ends.x, ends.z);
    let right = max(ends.x, ends.z);
    let told = below || above || u < left || u >= right;
    let aside = select(u < left, (entry & ENTRY_HI) != 0u, above);
    let value = select(aside, (entry & ENTRY_LO) != 0u, below);
    let beside = select(u <= right + 2.0 * ROUNDING_UV, u >= left - 2.0 * ROUNDING_UV, u < left);
    let over = select(beside, v <= ends.w + 2.0 * ROUNDING_UV, above);
    return Told(told, value, told && select(over, v >= ends.y - 2.0 * ROUNDING_UV, below));
}

// Whether the segment's u at height v is larger than u, for points in the box of its ends. `short`: the words of the record
// behind the ends, of short records.
fn crossing(address: u32, ends: vec4f, short: vec4f, entry: u32, u: f32, v: f32) -> Crossing {
    let p = vec2f(u, v) - ends.xy;
    let d = ends.zw - ends.xy;
    let degree = ((entry >> 4u) & 63u) + 1u;
    let rational = (entry & ENTRY_RATIONAL) != 0u;
    var side = cross2(p, d);
    if (degree == 1u) {
        return Crossing(side < 0.0, is_near(side, vec2f(0.0), d), 0u);
    }
    let compact = degree == 3u && !rational;
    var q = short;
    if (!SHORT_RECORDS) {
        q = load_trim_data(address + 1u);
    }
    let fat = bitcast<u32>(q.x);
    let stored = vec2f(bitcast<f32>(fat & 0xffff0000u), bitcast<f32>(fat << 16u));
    let bounds = select(stored, cubic_bounds(q, d), compact);
    if (side < bounds.x) {
        return Crossing(true, is_near(side, bounds, d), 0u);
    }
    if (side > bounds.y) {
        return Crossing(false, is_near(side, bounds, d), 0u);
    }
    var a = vec2f(0.0);
    var b = d;
    var t = 0.0;
    var dt = 1.0;
    var band = 1.0;
    for (var k = 0u; k < MAX_HALVINGS; k++) {
        dt *= 0.5;
        band *= 0.125;
        var m: vec2f;
        if (SHORT_RECORDS) {
            m = select(quadratic_point(q, d, rational, t + dt), cubic_point(q, d, t + dt), compact);
        } else if (compact) {
            m = cubic_point(q, d, t + dt);
        } else {
            m = curve_point(address, d, degree, rational, t + dt);
        }
        m = min(max(m, vec2f(min(a.x, b.x), a.y)), vec2f(max(a.x, b.x), b.y));
        if (p.y >= m.y) {
            a = m;
            t += dt;
        } else {
            b = m;
        }
        let low = min(a.x, b.x);
        let high = max(a.x, b.x);
        side = cross2(p - a, b - a);
        let right_of = p.x < low || (p.x < high && side < bounds.x * band);
        if (right_of || p.x >= high || side > bounds.y * band) {
            let at_end = p.y < a.y + 2.0 * ROUNDING_UV || p.y > b.y - 2.0 * ROUNDING_UV;
            let beside = p.x >= low - 2.0 * ROUNDING_UV && p.x <= high + 2.0 * ROUNDING_UV;
            return Crossing(right_of, beside && (at_end || is_near(side, bounds * band, b - a)), k + 1u);
        }
    }
    return Crossing(side < 0.0, true, MAX_HALVINGS);
}

// The k-th of four steps to points that rounding may have moved here.
fn nudge(k: u32) -> vec2f {
    let by = select(-ROUNDING_UV, ROUNDING_UV, (k & 1u) == 0u);
    return select(vec2f(0.0, by), vec2f(by, 0.0), k < 2u);
}

fn classify(grid: GridHeader, u_in: f32, v_in: f32) -> Verdict {
    if (grid.columns == 0u || !(min(u_in, v_in) >= -BORDER && max(u_in, v_in) <= 1.0 + BORDER)) {
        return Verdict(false, 0u, false);
    }
    let u = min(max(u_in, 0.0), BELOW_ONE);
    let v = min(max(v_in, 0.0), BELOW_ONE);
    var x = u * grid.scale_u;
    var y = v * grid.scale_v;
    var scale = vec2f(grid.scale_u, grid.scale_v);
    var column = min(u32(x), grid.columns - 1u);
    var row = min(u32(y), grid.rows - 1u);
    var index = grid.cell_base + row * grid.columns + column;
    var cell = load_trim_cell(index);
    for (var level = 1u; level < MAX_LEVELS; level++) {
        if ((cell & CELL_REFINED) == 0u) {
            break;
        }
        let child = grid.entry_base + (cell >> 8u);
        let k = load_trim_entry(child + 1u);
        x = (x - f32(column)) * f32(k);
        y = (y - f32(row)) * f32(k);
        scale *= f32(k);
        column = min(u32(x), k - 1u);
        row = min(u32(y), k - 1u);
        index = grid.cell_base + load_trim_entry(child) + row * k + column;
        cell = load_trim_cell(index);
    }
    var winding = bitcast<i32>(cell << 25u) >> 25u;
    let first = cell >> 8u;
    let end = load_trim_cell(index + 1u) >> 8u;
    var evaluations = 0u;
    // Curves of the next cell may not be listed here.
    let border = min(vec2f(x, y) - vec2f(f32(column), f32(row)), vec2f(f32(column), f32(row)) + 1.0 - vec2f(x, y));
    var near = end > first && any(border < 4.0 * ROUNDING_UV * scale);
    let last = min(end, first + MAX_ENTRIES);
    var e = first;
    if (e < last) {
        loop {
            // On to the next curve that its ends do not tell about, so that few rounds look at one.
            var entry = 0u;
            var address = 0u;
            var ends = vec4f(0.0);
            var told = true;
            loop {
                entry = load_trim_entry(grid.entry_base + e);
                address = grid.data_base + (entry >> 10u);
                ends = load_trim_data(address);
                e++;
                let by_ends = ends_tell(ends, entry, u, v);
                told = by_ends.told;
                near |= by_ends.near;
                winding += select(0, select(1, -1, (entry & ENTRY_DOWN) != 0u), told && by_ends.value);
                if (!told || e >= last) {
                    break;
                }
            }
            if (!told) {
                let c = crossing(address, ends, vec4f(0.0), entry, u, v);
                near |= c.near;
                evaluations += c.evaluations;
                winding += select(0, select(1, -1, (entry & ENTRY_DOWN) != 0u), c.right);
            }
            if (e >= last) {
                break;
            }
        }
    }
    let inside = select((winding & 1) != 0, winding != 0, (grid.flags & GRID_NON_ZERO) != 0u);
    return Verdict(inside, evaluations, near);
}

// The value of a segment with a short record, and whether it is near, at a point clamped to the parameters.
fn value_of(ends: vec4f, short: vec4f, entry: u32, uv: vec2f) -> Told {
    let p = clamp(uv, vec2f(0.0), vec2f(BELOW_ONE));
    let by_ends = ends_tell(ends, entry, p.x, p.y);
    let c = crossing(0u, ends, short, entry, p.x, p.y);
    return Told(true, select(c.right, by_ends.value, by_ends.told), select(c.near, by_ends.near, by_ends.told));
}
