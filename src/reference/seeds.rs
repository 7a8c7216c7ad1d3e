//! Starting points of Newton's method: where a ray meets the quadratic model of a cell. Twin of
//! `shaders/lib/seeds.wgsl`, which tells how.

use glam::Vec2;

/// Conics `c00 + c10 s + c01 t + c20 s^2 + c11 s t + c02 t^2`, two at once.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "coefficients by their powers")]
pub struct Conics {
    pub c00: Vec2,
    pub c10: Vec2,
    pub c01: Vec2,
    pub c20: Vec2,
    pub c11: Vec2,
    pub c02: Vec2,
}

/// At most two roots in cell parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seeds {
    /// 0, 1 or 2.
    pub count: u32,
    /// First root.
    pub first: Vec2,
    /// Second root.
    pub second: Vec2,
}

const POLISH_STEPS: u32 = 5;
/// How far outside its cell a seed is still followed.
const REACH: f32 = 1.3;
/// Within how much of a cell a fold counts as near.
const FOLD: f32 = 0.25;

pub(super) fn select<T>(no: T, yes: T, choose: bool) -> T {
    if choose { yes } else { no }
}

/// Both conics at `x`.
pub fn conics_value(c: &Conics, x: Vec2) -> Vec2 {
    c.c00 + x.x * (c.c10 + x.x * c.c20 + x.y * c.c11) + x.y * (c.c01 + x.y * c.c02)
}

fn conics_ds(c: &Conics, x: Vec2) -> Vec2 {
    c.c10 + 2.0 * x.x * c.c20 + x.y * c.c11
}

fn conics_dt(c: &Conics, x: Vec2) -> Vec2 {
    c.c01 + x.x * c.c11 + 2.0 * x.y * c.c02
}

/// The quadratic part between two directions; for a = b the part itself.
pub fn conics_bilinear(c: &Conics, a: Vec2, b: Vec2) -> Vec2 {
    a.x * b.x * c.c20 + 0.5 * (a.x * b.y + a.y * b.x) * c.c11 + a.y * b.y * c.c02
}

/// Whether the Jacobian at `x` may vanish within a part of a cell: a second root may be as near.
pub fn conics_fold(c: &Conics, x: Vec2) -> bool {
    let (ds, dt) = (conics_ds(c, x), conics_dt(c, x));
    let det = ds.x * dt.y - ds.y * dt.x;
    let bend = c.c20.length() + c.c11.length() + c.c02.length();
    det.abs() < FOLD * bend * (ds.length() + dt.length())
}

/// Solves `ds x + dt y = rhs`; nearly singular systems give large, finite answers.
pub fn solve_2x2(ds: Vec2, dt: Vec2, rhs: Vec2) -> Vec2 {
    let det = ds.x * dt.y - ds.y * dt.x;
    let scale = (ds.x.abs() + ds.y.abs()) * (dt.x.abs() + dt.y.abs());
    let least = 1e-7 * scale + 1e-37;
    let safe = select(det, select(-1.0, 1.0, det >= 0.0) * least, det.abs() < least);
    Vec2::new(rhs.x * dt.y - rhs.y * dt.x, ds.x * rhs.y - ds.y * rhs.x) / safe
}

/// Roots along the weak direction through `x`; `slack` draws tangent or missing ones apart.
pub fn conics_split(c: &Conics, x: Vec2, slack: f32) -> Seeds {
    let f = conics_value(c, x);
    let ds = conics_ds(c, x);
    let dt = conics_dt(c, x);
    let a = ds.dot(ds);
    let b = ds.dot(dt);
    let d = dt.dot(dt);
    let half_gap = 0.5 * (a - d);
    let radius = (half_gap * half_gap + b * b).sqrt();
    let strong_raw =
        select(Vec2::new(b, radius - half_gap), Vec2::new(radius + half_gap, b), half_gap >= 0.0);
    let strong_length = strong_raw.length();
    let strong = select(Vec2::X, strong_raw / strong_length.max(1e-37), strong_length > 1e-30);
    let weak = Vec2::new(-strong.y, strong.x);
    let image = strong.x * ds + strong.y * dt;
    let sigma = image.length().max(1e-37);
    let m = image / sigma;
    let l = Vec2::new(-m.y, m.x);
    let weak_image = weak.x * ds + weak.y * dt;
    let q_ww = conics_bilinear(c, weak, weak);
    let q_ws = conics_bilinear(c, weak, strong);
    let q_ss = conics_bilinear(c, strong, strong);
    let beta0 = (-m.dot(f) / sigma).clamp(-3.0, 3.0);
    let slope = (sigma + 2.0 * beta0 * m.dot(q_ss)).max(0.25 * sigma);
    let beta1 = (-2.0 * beta0 * m.dot(q_ws) / slope).clamp(-2.0, 2.0);
    let beta2 = (-m.dot(q_ww) / slope).clamp(-2.0, 2.0);
    let beta_start = (beta0 - (beta0 * beta0 * m.dot(q_ss)) / slope).clamp(-3.0, 3.0);
    let g_ss = l.dot(q_ss);
    let g_ws = 2.0 * l.dot(q_ws);
    let g0 = l.dot(f) + beta_start * beta_start * g_ss;
    let g1 = l.dot(weak_image) + beta_start * g_ws + 2.0 * beta_start * beta1 * g_ss;
    let g2 = l.dot(q_ww) + beta1 * g_ws + (beta1 * beta1 + 2.0 * beta_start * beta2) * g_ss;
    let lift = 4.0 * g2.abs() * slack;
    let discriminant = g1 * g1 - 4.0 * g2 * g0;
    let root = discriminant.max(0.5 * lift).sqrt();
    let q = -0.5 * (g1 + select(-root, root, g1 >= 0.0));
    let w1 = (g0 / select(q, 1e-37, q.abs() < 1e-37)).clamp(-8.0, 8.0);
    let has_second = q.abs() < 8.0 * g2.abs();
    let w2 = select(8.0, q / select(g2, 1e-37, g2.abs() < 1e-37), has_second);
    Seeds {
        count: select(1, 2, has_second),
        first: x + w1 * weak + (beta_start + w1 * (beta1 + w1 * beta2)) * strong,
        second: x + w2 * weak + (beta_start + w2 * (beta1 + w2 * beta2)) * strong,
    }
}

/// A possible root and how close the conics come to zero there.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    x: Vec2,
    value: f32,
}

/// A few Newton steps, each kept only if it brings the conics closer to zero and halved if not, until
/// they are as close as `enough`.
fn conics_polish(c: &Conics, start: Vec2, enough: f32) -> Candidate {
    let mut x = start.clamp(Vec2::splat(-3.0), Vec2::splat(3.0));
    let mut value = conics_value(c, x).length();
    let mut damping = 1.0f32;
    for _ in 0..POLISH_STEPS {
        if value <= enough {
            break;
        }
        let step = solve_2x2(conics_ds(c, x), conics_dt(c, x), -conics_value(c, x));
        let next = (x + damping * step.clamp(Vec2::splat(-1.0), Vec2::splat(1.0)))
            .clamp(Vec2::splat(-3.0), Vec2::splat(3.0));
        let next_value = conics_value(c, next).length();
        let better = next_value < value;
        x = select(x, next, better);
        value = select(value, next_value, better);
        damping = select(0.5 * damping, 1.0, better);
    }
    Candidate { x, value }
}

fn on_reach(candidate: Candidate, near: f32) -> bool {
    candidate.value <= near && candidate.x.x.abs().max(candidate.x.y.abs()) < REACH
}

/// Adds a candidate unless it is none or already there.
fn seeds_add(seeds: Seeds, candidate: Candidate, near: f32) -> Seeds {
    let fresh = (candidate.x - seeds.first).abs();
    let usable = on_reach(candidate, near) && (seeds.count == 0 || fresh.x + fresh.y > 1e-4);
    let to_first = usable && seeds.count == 0;
    let to_second = usable && seeds.count == 1;
    Seeds {
        count: seeds.count + u32::from(to_first || to_second),
        first: select(seeds.first, candidate.x, to_first),
        second: select(seeds.second, candidate.x, to_second),
    }
}

/// The roots of the conics on or just beside the cell, polished. `slack` is how far the surface may be
/// from its model: points whose conics are that close to zero count as roots.
pub fn seeds(c: &Conics, slack: f32) -> Seeds {
    let rough = conics_split(c, Vec2::ZERO, 4.0 * slack);
    let both = rough.count == 2 && (rough.second.x.abs().max(rough.second.y.abs())) < 2.5;
    let middle = select(rough.first, 0.5 * (rough.first + rough.second), both);
    let fine = conics_split(c, middle.clamp(Vec2::splat(-1.5), Vec2::splat(1.5)), slack);
    let near = 4.0 * slack + 1e-5 * (c.c10.length() + c.c01.length());
    let far = fine.second.x.abs().max(fine.second.y.abs()) > 4.0;
    let mut found = Seeds { count: 0, first: Vec2::ZERO, second: Vec2::ZERO };
    for attempt in 0..4 {
        if found.count > 0 && (attempt > 1 || far) {
            break;
        }
        let early = select(fine.second, fine.first, attempt == 0);
        let late = select(Vec2::ZERO, rough.first, attempt == 2);
        let start = select(late, early, attempt < 2);
        found = seeds_add(found, conics_polish(c, start, 0.25 * near), near);
    }
    found
}
