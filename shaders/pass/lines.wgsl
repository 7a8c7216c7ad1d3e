// Straight lines of constant width in pixels, smoothed at their borders: axes, edges and handles of the viewport.
// One instance per line, six vertices each. Positions are relative to the eye.

struct Line {
  @location(0) start: vec3f,
  @location(1) end: vec3f,
  // Linear, not premultiplied.
  @location(2) color: vec4f,
  @location(3) width_px: f32,
}

struct Corner {
  @builtin(position) clip: vec4f,
  @location(0) color: vec4f,
  // Distance from the middle of the line, pixels; z: half its width.
  @location(1) @interpolate(linear) across: vec2f,
  @location(2) relative: vec3f,
}

// Nearest w of a line that is drawn: what is behind the eye is cut off.
const NEAR_W = 1e-6;

@vertex
fn vertex(line: Line, @builtin(vertex_index) index: u32) -> Corner {
  var a = view.clip_from_relative * vec4f(line.start, 1.0);
  var b = view.clip_from_relative * vec4f(line.end, 1.0);
  var p = line.start;
  var q = line.end;
  let near = NEAR_W + 1e-4 * max(abs(a.w), abs(b.w));
  var out: Corner;
  if (a.w < near && b.w < near) {
    out.clip = vec4f(2.0, 2.0, 2.0, 1.0);
    return out;
  }
  if (a.w < near) {
    let t = (near - a.w) / (b.w - a.w);
    a = mix(a, b, t);
    p = mix(p, q, t);
  } else if (b.w < near) {
    let t = (near - b.w) / (a.w - b.w);
    b = mix(b, a, t);
    q = mix(q, p, t);
  }
  let at_end = (index % 6u == 1u) || (index % 6u == 2u) || (index % 6u == 4u);
  let left = (index % 6u == 2u) || (index % 6u == 4u) || (index % 6u == 5u);
  let half = 0.5 * view.size_px;
  let along = (b.xy / b.w - a.xy / a.w) * half;
  let length = max(length(along), 1e-6);
  let normal = vec2f(-along.y, along.x) / length;
  let reach = 0.5 * line.width_px + 0.5;
  let side = select(-reach, reach, left);
  let end = select(a, b, at_end);
  out.clip = vec4f(end.xy + normal * side / half * end.w, end.z * view.depth, end.w);
  out.color = line.color;
  out.across = vec2f(side, 0.5 * line.width_px);
  out.relative = select(p, q, at_end);
  return out;
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
  let cover = clamp(corner.across.y + 0.5 - abs(corner.across.x), 0.0, 1.0);
  let away = distance(corner.relative, view.fade.xyz) / view.fade.w;
  let fade = 1.0 - smoothstep(0.35, 1.0, away);
  return vec4f(corner.color.rgb, corner.color.a * cover * fade * view.opacity);
}
