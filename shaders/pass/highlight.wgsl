// Tints selected and hovered faces over the finished picture, from the visibility buffer: selecting costs no
// new rays. Borders of marked regions get a line of the full colour.

struct Highlight {
  // Linear colours, a: strength of the tint.
  selected: vec4f,
  hovered: vec4f,
  // Left upper corner and size of the viewport in the target, pixels.
  min_px: vec2f,
  size_px: vec2f,
  // Size of the visibility buffer.
  buffer_px: vec2f,
  // Half the width of the border, pixels of the target.
  border_px: f32,
  padding: f32,
}

@group(0) @binding(0) var<uniform> highlight: Highlight;
@group(0) @binding(1) var visibility: texture_2d<u32>;
// Per face slot: 1 selected, 2 hovered.
@group(0) @binding(2) var<storage, read> marks: array<u32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
  return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// Marks of the face at a position of the viewport, 0..1.
fn mark_at(p: vec2f) -> u32 {
  let texel = clamp(vec2i(p * highlight.buffer_px), vec2i(0), vec2i(highlight.buffer_px) - 1);
  let slot = textureLoad(visibility, texel, 0).x;
  if (slot == 0u || slot > arrayLength(&marks)) {
    return 0u;
  }
  return marks[slot - 1u];
}

// Without borders: what a coarse picture gets, where they would be bars of blocks. An entry point of its own, because
// software drivers look five times otherwise.
@fragment
fn fragment_plain(@builtin(position) position: vec4f) -> @location(0) vec4f {
  let here = mark_at((position.xy - highlight.min_px) / highlight.size_px);
  if (here == 0u) {
    discard;
  }
  if (here == 2u) {
    return highlight.hovered;
  }
  return highlight.selected;
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
  let p = (position.xy - highlight.min_px) / highlight.size_px;
  let step = highlight.border_px / highlight.size_px;
  let here = mark_at(p);
  let west = mark_at(p - vec2f(step.x, 0.0));
  let east = mark_at(p + vec2f(step.x, 0.0));
  let north = mark_at(p - vec2f(0.0, step.y));
  let south = mark_at(p + vec2f(0.0, step.y));
  let any_mark = here | west | east | north | south;
  if (any_mark == 0u) {
    discard;
  }
  let selected = (here & 1u) != 0u;
  let hovered = (here & 2u) != 0u;
  // Of five looks, how many are in the selection: softens the border.
  let inside = f32((here & 1u) + (west & 1u) + (east & 1u) + (north & 1u) + (south & 1u)) / 5.0;
  let border = 1.0 - abs(2.0 * inside - 1.0);
  var tint = 0.0;
  if (selected) {
    tint = highlight.selected.a;
  }
  var color = vec4f(highlight.selected.rgb, max(tint, 0.9 * border));
  if (hovered) {
    let over = highlight.hovered.a * (1.0 - 0.6 * color.a);
    let a = over + color.a * (1.0 - over);
    color = vec4f((highlight.hovered.rgb * over + color.rgb * color.a * (1.0 - over)) / max(a, 1e-6), a);
  }
  return color;
}
