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

fn solve_2x2(ds: vec2f, dt: vec2f, rhs: vec2f) -> vec2f {
    let det = ds.x * dt.y - ds.y * dt.x;
    let scale = (abs(ds.x) + abs(ds.y)) * (abs(dt.x) + abs(dt.y));
    let safe = select(det, select(-1.0, 1.0, det >= 0.0) * (1e-7 * scale + 1e-37), abs(det) < 1e-7 * scale + 1e-37);
    return vec2f(rhs.x * dt.y - rhs.y * dt.x, ds.x * rhs.y - ds.y * rhs.x) / safe;
}

// One Newton step on the conics, kept near the cell.
fn conics_step(c: Conics, x: vec2f) -> vec2f {
    let step = solve_2x2(conics_ds(c, x), conics_dt(c, x), -conics_value(c, x));
    return clamp(x + clamp(step, vec2f(-1.0), vec2f(1.0)), vec2f(-3.0), vec2f(3.0));
}

// Roots along the weak direction through `x`, exact up to third order. `slack` is how far the conics
// may be from the surface: they have no root only if nothing within it has one.
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
    if (discriminant < -2.0 * lift) {
        return Seeds(0u, vec2f(0.0), vec2f(0.0));
    }
    let root = sqrt(max(discriminant, 0.5 * lift));
    let q = -0.5 * (g1 + select(-root, root, g1 >= 0.0));
    let w1 = clamp(g0 / select(q, 1e-37, abs(q) < 1e-37), -8.0, 8.0);
    let has_second = abs(q) < 8.0 * abs(g2);
    let w2 = select(8.0, q / select(g2, 1e-37, abs(g2) < 1e-37), has_second);
    let x1 = x + w1 * weak + (beta_start + w1 * (beta1 + w1 * beta2)) * strong;
    let x2 = x + w2 * weak + (beta_start + w2 * (beta1 + w2 * beta2)) * strong;
    return Seeds(select(1u, 2u, has_second), x1, x2);
}

// The roots of the conics near the cell, polished.
fn seeds(c: Conics, slack: f32) -> Seeds {
    let rough = conics_split(c, vec2f(0.0), 4.0 * slack);
    let middle = select(rough.first, 0.5 * (rough.first + rough.second), rough.count == 2u);
    let fine = conics_split(c, clamp(middle, vec2f(-1.5), vec2f(1.5)), slack);
    if (rough.count == 0u || fine.count == 0u) {
        return Seeds(0u, vec2f(0.0), vec2f(0.0));
    }
    var x1 = clamp(fine.first, vec2f(-3.0), vec2f(3.0));
    var x2 = clamp(fine.second, vec2f(-3.0), vec2f(3.0));
    x1 = conics_step(c, conics_step(c, x1));
    x2 = conics_step(c, conics_step(c, x2));
    let distinct = fine.count == 2u && (abs(x1.x - x2.x) + abs(x1.y - x2.y)) > 1e-4;
    return Seeds(select(1u, 2u, distinct), x1, x2);
}
