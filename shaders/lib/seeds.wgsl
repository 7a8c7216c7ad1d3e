// Starting points of Newton's method: where a ray meets the quadratic model of a cell.
// Twin: reference::seeds.
//
// In the two screen directions the model gives two conics F(x) = 0. The directions in which the
// Jacobian is strongest and weakest (its singular vectors) split them: the strong equation gives the
// strong unknown as a function of the weak one, which leaves a quadratic equation in one unknown: no, one
// or two roots, the two of a silhouette included. Only registers are used.

// Conics c00 + c10 s + c01 t + c20 s^2 + c11 s t + c02 t^2, two at once.
struct Conics {
    c00: vec2f,
    c10: vec2f,
    c01: vec2f,
    c20: vec2f,
    c11: vec2f,
    c02: vec2f,
}

const POLISH_STEPS: u32 = 5u;
// How far outside its cell a seed is still followed.
const REACH: f32 = 1.3;
// Within how much of a cell a fold counts as near.
const FOLD: f32 = 0.25;

// At most two roots in cell parameters.
struct Seeds {
    count: u32,
    first: vec2f,
    second: vec2f,
}

fn conics_value(c: Conics, x: vec2f) -> vec2f {
    return c.c00 + x.x * (c.c10 + x.x * c.c20 + x.y * c.c11) + x.y * (c.c01 + x.y * c.c02);
}

fn conics_ds(c: Conics, x: vec2f) -> vec2f {
    return c.c10 + 2.0 * x.x * c.c20 + x.y * c.c11;
}

fn conics_dt(c: Conics, x: vec2f) -> vec2f {
    return c.c01 + x.x * c.c11 + 2.0 * x.y * c.c02;
}

// The quadratic part between two directions; for a = b the part itself.
fn conics_bilinear(c: Conics, a: vec2f, b: vec2f) -> vec2f {
    return a.x * b.x * c.c20 + 0.5 * (a.x * b.y + a.y * b.x) * c.c11 + a.y * b.y * c.c02;
}

// Whether the Jacobian at `x` may vanish within a part of a cell: a second root may be as near.
fn conics_fold(c: Conics, x: vec2f) -> bool {
    let ds = conics_ds(c, x);
    let dt = conics_dt(c, x);
    let det = ds.x * dt.y - ds.y * dt.x;
    let bend = length(c.c20) + length(c.c11) + length(c.c02);
    return abs(det) < FOLD * bend * (length(ds) + length(dt));
}

fn solve_2x2(ds: vec2f, dt: vec2f, rhs: vec2f) -> vec2f {
    let det = ds.x * dt.y - ds.y * dt.x;
    let scale = (abs(ds.x) + abs(ds.y)) * (abs(dt.x) + abs(dt.y));
    let safe = select(det, select(-1.0, 1.0, det >= 0.0) * (1e-7 * scale + 1e-37), abs(det) < 1e-7 * scale + 1e-37);
    return vec2f(rhs.x * dt.y - rhs.y * dt.x, ds.x * rhs.y - ds.y * rhs.x) / safe;
}

// Roots along the weak direction through `x`, exact up to third order. `slack` is how far the conics
// may be from the surface: tangent or missing roots are drawn apart by as much.
fn conics_split(c: Conics, x: vec2f, slack: f32) -> Seeds {
    let f = conics_value(c, x);
    let ds = conics_ds(c, x);
    let dt = conics_dt(c, x);
    // Weak direction: eigenvector of the smaller eigenvalue of J^T J.
    let a = dot(ds, ds);
    let b = dot(ds, dt);
    let d = dot(dt, dt);
    let half_gap = 0.5 * (a - d);
    let radius = sqrt(half_gap * half_gap + b * b);
    // Strong direction (unnormalised), the better conditioned of two forms.
    let strong_raw = select(vec2f(b, radius - half_gap), vec2f(radius + half_gap, b), half_gap >= 0.0);
    let strong_length = length(strong_raw);
    let strong = select(vec2f(1.0, 0.0), strong_raw / max(strong_length, 1e-37), strong_length > 1e-30);
    let weak = vec2f(-strong.y, strong.x);
    let image = strong.x * ds + strong.y * dt;
    let sigma = max(length(image), 1e-37);
    let m = image / sigma;
    let l = vec2f(-m.y, m.x);
    let weak_image = weak.x * ds + weak.y * dt;
    let q_ww = conics_bilinear(c, weak, weak);
    let q_ws = conics_bilinear(c, weak, strong);
    let q_ss = conics_bilinear(c, strong, strong);
    // Strong unknown as a function of the weak one: beta = beta0 + beta1 w + beta2 w^2.
    let beta0 = clamp(-dot(m, f) / sigma, -3.0, 3.0);
    let slope = max(sigma + 2.0 * beta0 * dot(m, q_ss), 0.25 * sigma);
    let beta1 = clamp(-2.0 * beta0 * dot(m, q_ws) / slope, -2.0, 2.0);
    let beta2 = clamp(-dot(m, q_ww) / slope, -2.0, 2.0);
    let beta_start = clamp(beta0 - (beta0 * beta0 * dot(m, q_ss)) / slope, -3.0, 3.0);
    let g_ss = dot(l, q_ss);
    let g_ws = 2.0 * dot(l, q_ws);
    let g0 = dot(l, f) + beta_start * beta_start * g_ss;
    let g1 = dot(l, weak_image) + beta_start * g_ws + 2.0 * beta_start * beta1 * g_ss;
    let g2 = dot(l, q_ww) + beta1 * g_ws + (beta1 * beta1 + 2.0 * beta_start * beta2) * g_ss;
    let lift = 4.0 * abs(g2) * slack;
    let discriminant = g1 * g1 - 4.0 * g2 * g0;
    let root = sqrt(max(discriminant, 0.5 * lift));
    let q = -0.5 * (g1 + select(-root, root, g1 >= 0.0));
    let w1 = clamp(g0 / select(q, 1e-37, abs(q) < 1e-37), -8.0, 8.0);
    let has_second = abs(q) < 8.0 * abs(g2);
    let w2 = select(8.0, q / select(g2, 1e-37, abs(g2) < 1e-37), has_second);
    let x1 = x + w1 * weak + (beta_start + w1 * (beta1 + w1 * beta2)) * strong;
    let x2 = x + w2 * weak + (beta_start + w2 * (beta1 + w2 * beta2)) * strong;
    return Seeds(select(1u, 2u, has_second), x1, x2);
}

// A possible root and how close the conics come to zero there.
struct Candidate {
    x: vec2f,
    value: f32,
}

// A few Newton steps, each kept only if it brings the conics closer to zero and halved if not, until they
// are as close as `enough`.
fn conics_polish(c: Conics, start: vec2f, enough: f32) -> Candidate {
    var x = clamp(start, vec2f(-3.0), vec2f(3.0));
    var value = length(conics_value(c, x));
    var damping = 1.0;
    var k = 0u;
    if (value > enough) {
        loop {
            let step = solve_2x2(conics_ds(c, x), conics_dt(c, x), -conics_value(c, x));
            let next = clamp(x + damping * clamp(step, vec2f(-1.0), vec2f(1.0)), vec2f(-3.0), vec2f(3.0));
            let next_value = length(conics_value(c, next));
            let better = next_value < value;
            x = select(x, next, better);
            value = select(value, next_value, better);
            damping = select(0.5 * damping, 1.0, better);
            k++;
            if (value <= enough || k >= POLISH_STEPS) {
                break;
            }
        }
    }
    return Candidate(x, value);
}

fn on_reach(candidate: Candidate, near: f32) -> bool {
    return candidate.value <= near && max(abs(candidate.x.x), abs(candidate.x.y)) < REACH;
}

// Adds a candidate unless it is none or already there.
fn seeds_add(seeds: Seeds, candidate: Candidate, near: f32) -> Seeds {
    let fresh = abs(candidate.x - seeds.first);
    let usable = on_reach(candidate, near) && (seeds.count == 0u || fresh.x + fresh.y > 1e-4);
    let to_first = usable && seeds.count == 0u;
    let to_second = usable && seeds.count == 1u;
    return Seeds(
        seeds.count + u32(to_first || to_second),
        select(seeds.first, candidate.x, to_first),
        select(seeds.second, candidate.x, to_second),
    );
}

// The roots of the conics on or just beside the cell, polished. `slack` is how far the surface may be
// from its model: points whose conics are that close to zero count as roots.
fn seeds(c: Conics, slack: f32) -> Seeds {
    let rough = conics_split(c, vec2f(0.0), 4.0 * slack);
    let both = rough.count == 2u && max(abs(rough.second.x), abs(rough.second.y)) < 2.5;
    let middle = select(rough.first, 0.5 * (rough.first + rough.second), both);
    let fine = conics_split(c, clamp(middle, vec2f(-1.5), vec2f(1.5)), slack);
    let near = 4.0 * slack + 1e-5 * (length(c.c10) + length(c.c01));
    let far = max(abs(fine.second.x), abs(fine.second.y)) > 4.0;
    var found = Seeds(0u, vec2f(0.0), vec2f(0.0));
    // A loop, since software drivers skip what a loop leaves out but not what a condition does.
    var attempt = 0u;
    loop {
        let early = select(fine.second, fine.first, attempt == 0u);
        let late = select(vec2f(0.0), rough.first, attempt == 2u);
        let start = select(late, early, attempt < 2u);
        found = seeds_add(found, conics_polish(c, start, 0.25 * near), near);
        attempt++;
        if (attempt > 3u || (found.count > 0u && (attempt > 1u || far))) {
            break;
        }
    }
    return found;
}
