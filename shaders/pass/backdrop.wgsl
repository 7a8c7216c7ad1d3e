// The background of the viewport: a vertical gradient, dithered so that it shows no bands.

struct Backdrop {
  // Linear colours.
  top: vec4f,
  bottom: vec4f,
  // y of the upper border and height of the viewport, pixels.
  top_px: f32,
  height_px: f32,
  padding: vec2f,
}

@group(0) @binding(0) var<uniform> backdrop: Backdrop;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
  // A triangle that covers everything.
  return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
  let t = clamp((position.y - backdrop.top_px) / backdrop.height_px, 0.0, 1.0);
  // Interleaved gradient noise (Jimenez 2014).
  let noise = fract(52.9829189 * fract(dot(position.xy, vec2f(0.06711056, 0.00583715)))) - 0.5;
  let color = mix(backdrop.top.rgb, backdrop.bottom.rgb, t);
  return vec4f(color + noise / 400.0, 1.0);
}
