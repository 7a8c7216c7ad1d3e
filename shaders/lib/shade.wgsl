// Colours of surfaces, linear RGB. Twin: reference::shade.
// Light stands still relative to the viewer: a headlight, a key light from the upper left, a fill light
// from the right and a rim. View axes: x right, y up, z away from the viewer.

const KEY: vec3f = vec3f(-0.4588315, 0.6423641, -0.6138680);
const FILL: vec3f = vec3f(0.8017837, -0.1069045, -0.5879747);

// Light of a surface of colour `base` with unit normal `n`, seen along `-eye`; both sides are lit.
fn lit(base: vec3f, n: vec3f, eye: vec3f) -> vec3f {
    let facing = clamp(dot(n, eye), 0.0, 1.0);
    let key = clamp(0.85 * dot(n, KEY) + 0.15, 0.0, 1.0);
    let fill = clamp(dot(n, FILL), 0.0, 1.0);
    let sky = 0.5 + 0.5 * n.y;
    let diffuse = 0.16 + 0.10 * sky + 0.30 * facing + 0.52 * key + 0.12 * fill;
    let half_key = normalize(KEY + eye);
    let gloss = pow(clamp(dot(n, half_key), 0.0, 1.0), 48.0);
    let rim = pow(1.0 - facing, 4.0);
    return base * diffuse + vec3f(0.16 * gloss + 0.06 * rim);
}

// Inside of a face: the same colour, darker and warmer.
fn inside_tint(base: vec3f) -> vec3f {
    return mix(base * 0.72, vec3f(0.32, 0.22, 0.15), 0.35);
}

// A colour that tells face `number` from its neighbours: golden-ratio hues.
fn face_palette(number: u32) -> vec3f {
    let k = f32(number % 4096u);
    let hue = fract(k * 0.61803399 + 0.08);
    let value = 0.55 + 0.35 * fract(k * 0.41421356);
    let wave = abs(fract(vec3f(hue, hue + 0.6666667, hue + 0.3333333)) * 6.0 - 3.0) - 1.0;
    let saturated = mix(vec3f(1.0), clamp(wave, vec3f(0.0), vec3f(1.0)), 0.55);
    return value * saturated * saturated;
}

// Parameters as colours: u red, v green, on a board of 10 by 10.
fn uv_board(uv: vec2f) -> vec3f {
    let cell = vec2u(clamp(uv, vec2f(0.0), vec2f(1.0)) * 10.0);
    let even = ((cell.x + cell.y) & 1u) == 0u;
    let colour = vec3f(0.06 + 0.9 * uv.x, 0.06 + 0.9 * uv.y, 0.25 * (1.0 - max(uv.x, uv.y)) + 0.05);
    return select(0.62, 1.0, even) * colour;
}

// Schollmeyer & Froehlich 2009, figure 9.
fn heat_colour(word: u32) -> vec3f {
    let count = word & 127u;
    let kept = (word & 128u) != 0u;
    let none = select(vec3f(0.10, 0.22, 0.80), vec3f(0.90, 0.78, 0.10), kept);
    let some = select(vec3f(0.90, 0.12, 0.10), vec3f(0.15, 0.80, 0.15), kept);
    return select(some * (1.0 / (0.75 + 0.25 * f32(count))), none, count == 0u);
}

// Level of the distance between a triangle and the exact surface as a colour: 0 none, 200 the tolerance, more beyond it,
// 255 not measured.
fn deviation_colour(level: u32) -> vec3f {
    let x = 0.02 * f32(level);
    let low = mix(vec3f(0.03, 0.07, 0.42), vec3f(0.01, 0.36, 0.62), clamp(x, 0.0, 1.0));
    let middle = mix(low, vec3f(0.06, 0.52, 0.16), clamp(x - 1.0, 0.0, 1.0));
    let high = mix(middle, vec3f(0.85, 0.66, 0.03), clamp(x - 2.0, 0.0, 1.0));
    let full = mix(high, vec3f(0.90, 0.24, 0.02), clamp(x - 3.0, 0.0, 1.0));
    let beyond = select(full, vec3f(0.75, 0.0, 0.45), level > 200u);
    return select(beyond, vec3f(0.36), level == 255u);
}

// What fat lines filled stands out of a pale grey picture.
fn difference_colour(colour: vec3f, filled: bool) -> vec3f {
    let grey = 0.25 + 0.6 * dot(colour, vec3f(0.2126, 0.7152, 0.0722));
    return select(vec3f(grey), vec3f(0.85, 0.01, 0.16), filled);
}

fn srgb_from_linear(c: vec3f) -> vec3f {
    let low = 12.92 * c;
    let high = 1.055 * pow(max(c, vec3f(0.0031308)), vec3f(1.0 / 2.4)) - 0.055;
    return select(high, low, c <= vec3f(0.0031308));
}
