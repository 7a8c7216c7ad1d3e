// Marks of constant size in pixels, smoothed at their borders: control points in the viewport.
// One instance per mark, six vertices each. Positions are relative to the eye.

struct Mark {
  @location(0) at: vec3f,
  // sRGB encoded, not premultiplied.
  @location(1) fill: vec4f,
  @location(2) line: vec4f,
  @location(3) size_px: f32,
  // 1: a disc, 0: a square.
  @location(4) round: f32,
}

struct Corner {
  @builtin(position) clip: vec4f,
  @location(0) fill: vec4f,
  @location(1) line: vec4f,
  // From the middle of the mark, pixels.
  @location(2) @interpolate(linear) offset: vec2f,
  // Half its size, pixels; whether it is a disc.
  @location(3) shape: vec2f,
}

// Width of the border, pixels.
const BORDER = 1.4;

@vertex
fn vertex(mark: Mark, @builtin(vertex_index) index: u32) -> Corner {
  var out: Corner;
  let centre = view.clip_from_relative * vec4f(mark.at, 1.0);
  let right = (index % 6u == 1u) || (index % 6u == 2u) || (index % 6u == 4u);
  let up = (index % 6u == 2u) || (index % 6u == 4u) || (index % 6u == 5u);
  let reach = 0.5 * mark.size_px + 1.0;
  let offset = vec2f(select(-reach, reach, right), select(-reach, reach, up));
  let moved = centre.xy + offset / (0.5 * view.size_px) * centre.w;
  out.clip = vec4f(moved, centre.z * view.depth, centre.w);
  if (centre.w <= 0.0) {
    out.clip = vec4f(2.0, 2.0, 2.0, 1.0);
  }
  out.fill = mark.fill;
  out.line = mark.line;
  out.offset = offset;
  out.shape = vec2f(0.5 * mark.size_px, mark.round);
  return out;
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
  let square = max(abs(corner.offset.x), abs(corner.offset.y));
  let distance = select(square, length(corner.offset), corner.shape.y > 0.5);
  let cover = clamp(corner.shape.x + 0.5 - distance, 0.0, 1.0);
  let inner = clamp(corner.shape.x - BORDER + 0.5 - distance, 0.0, 1.0);
  // A transparent inside has no colour to fade to.
  let color = mix(corner.line.rgb, corner.fill.rgb, inner * corner.fill.a);
  let alpha = mix(corner.line.a, corner.fill.a, inner);
  return vec4f(color, alpha * cover * view.opacity);
}
