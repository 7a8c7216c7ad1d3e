//! Colours of surfaces, linear RGB. Twin of `shaders/lib/shade.wgsl`.

use glam::{Vec2, Vec3};

const KEY: Vec3 = Vec3::new(-0.458_831_5, 0.642_364_1, -0.613_868);
const FILL: Vec3 = Vec3::new(0.801_783_7, -0.106_904_5, -0.587_974_7);

/// What fat lines filled stands out of a pale grey picture.
pub fn difference_colour(colour: Vec3, filled: bool) -> Vec3 {
    let grey = 0.25 + 0.6 * colour.dot(Vec3::new(0.2126, 0.7152, 0.0722));
    if filled { Vec3::new(0.85, 0.01, 0.16) } else { Vec3::splat(grey) }
}

/// Light of a surface of colour `base` with unit normal `n`, seen along `-eye`; both sides are lit.
pub fn lit(base: Vec3, n: Vec3, eye: Vec3) -> Vec3 {
    let facing = n.dot(eye).clamp(0.0, 1.0);
    let key = (0.85 * n.dot(KEY) + 0.15).clamp(0.0, 1.0);
    let fill = n.dot(FILL).clamp(0.0, 1.0);
    let sky = 0.5 + 0.5 * n.y;
    let diffuse = 0.16 + 0.10 * sky + 0.30 * facing + 0.52 * key + 0.12 * fill;
    let half_key = (KEY + eye).normalize();
    let gloss = n.dot(half_key).clamp(0.0, 1.0).powf(48.0);
    let rim = (1.0 - facing).powf(4.0);
    base * diffuse + Vec3::splat(0.16 * gloss + 0.06 * rim)
}

/// Inside of a face: the same colour, darker and warmer.
pub fn inside_tint(base: Vec3) -> Vec3 {
    mix(base * 0.72, Vec3::new(0.32, 0.22, 0.15), 0.35)
}

/// `a` towards `b` by `t`, as in WGSL.
pub fn mix(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a * (1.0 - t) + b * t
}

/// A colour that tells face `number` from its neighbours: golden-ratio hues.
pub fn face_palette(number: u32) -> Vec3 {
    let k = (number % 4096) as f32;
    let fract = |x: f32| x - x.floor();
    let hue = fract(k * 0.618_034 + 0.08);
    let value = 0.55 + 0.35 * fract(k * 0.414_213_57);
    let wave = |shift: f32| ((fract(hue + shift) * 6.0 - 3.0).abs() - 1.0).clamp(0.0, 1.0);
    let saturated = mix(Vec3::ONE, Vec3::new(wave(0.0), wave(0.666_666_7), wave(0.333_333_3)), 0.55);
    value * saturated * saturated
}

/// Parameters as colours: u red, v green, on a board of 10 by 10.
pub fn uv_board(uv: Vec2) -> Vec3 {
    let cell = uv.clamp(Vec2::ZERO, Vec2::ONE) * 10.0;
    let even = ((cell.x as u32 + cell.y as u32) & 1) == 0;
    let colour = Vec3::new(0.06 + 0.9 * uv.x, 0.06 + 0.9 * uv.y, 0.25 * (1.0 - uv.x.max(uv.y)) + 0.05);
    if even { colour } else { 0.62 * colour }
}

/// Colour of a heat word (Schollmeyer & Froehlich 2009, figure 9).
pub fn heat_colour(word: u32) -> Vec3 {
    let count = word & 127;
    let kept = word & 128 != 0;
    match (count, kept) {
        (0, true) => Vec3::new(0.90, 0.78, 0.10),
        (0, false) => Vec3::new(0.10, 0.22, 0.80),
        (_, true) => Vec3::new(0.15, 0.80, 0.15) * (1.0 / (0.75 + 0.25 * count as f32)),
        (_, false) => Vec3::new(0.90, 0.12, 0.10) * (1.0 / (0.75 + 0.25 * count as f32)),
    }
}

/// Level of the distance between a triangle and the exact surface as a colour: 0 none, 200 the tolerance, more beyond it,
/// 255 not measured.
pub fn deviation_colour(level: u32) -> Vec3 {
    match level {
        255 => return Vec3::splat(0.36),
        201.. => return Vec3::new(0.75, 0.0, 0.45),
        _ => {}
    }
    let x = 0.02 * level as f32;
    let to = |from: Vec3, to: Vec3, step: f32| mix(from, to, (x - step).clamp(0.0, 1.0));
    let low = to(Vec3::new(0.03, 0.07, 0.42), Vec3::new(0.01, 0.36, 0.62), 0.0);
    let middle = to(low, Vec3::new(0.06, 0.52, 0.16), 1.0);
    let high = to(middle, Vec3::new(0.85, 0.66, 0.03), 2.0);
    to(high, Vec3::new(0.90, 0.24, 0.02), 3.0)
}

/// sRGB encoding.
pub fn srgb_from_linear(c: Vec3) -> Vec3 {
    let encode = |x: f32| {
        if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
    };
    Vec3::new(encode(c.x), encode(c.y), encode(c.z))
}
