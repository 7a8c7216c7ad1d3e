// The ground grid: one square in the plane of the ground, its lines found per pixel. Cheaper than lines of their own,
// because a pixel is shaded once and only where the model leaves it free, and calm where lines are closer than pixels.

struct Grid {
  clip_from_relative: mat4x4f,
  // Middle of the square relative to the eye, on a crossing of lines; w: half its side, spacings.
  centre: vec4f,
  // Linear RGB; a: strength of the lines between the tenth ones.
  color: vec4f,
  // From the middle to a tenth line in x and in y, and to the axes, spacings.
  tenth: vec2f,
  axes: vec2f,
  // Distance of the lines.
  spacing: f32,
  // Strength of every tenth line.
  strength: f32,
  // Width of a line, pixels.
  width_px: f32,
  // Factor of the (reversed) depth: below 1 is farther than it is.
  depth: f32,
}

@group(0) @binding(0) var<uniform> grid: Grid;

struct Corner {
  @builtin(position) clip: vec4f,
  // Position in the plane from the middle, spacings.
  @location(0) plane: vec2f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
  let right = (index == 1u) || (index == 2u) || (index == 4u);
  let upper = (index == 2u) || (index == 4u) || (index == 5u);
  let side = grid.centre.w;
  let plane = vec2f(select(-side, side, right), select(-side, side, upper));
  var clip = grid.clip_from_relative * vec4f(grid.centre.xyz + vec3f(plane * grid.spacing, 0.0), 1.0);
  clip.z *= grid.depth;
  return Corner(clip, plane);
}

// Part of the pixel that lines cover which are `away` from it and repeat after `period`; `pixel`: its width. All in
// spacings. Where lines are closer than two pixels it tends to their mean, or they would flicker.
fn cover(away: vec2f, period: f32, pixel: vec2f) -> vec2f {
  let sharp = clamp(0.5 * grid.width_px + 0.5 - away / pixel, vec2f(0.0), vec2f(1.0));
  let mean = min(grid.width_px * pixel / period, vec2f(1.0));
  return mix(sharp, mean, clamp(4.0 * pixel / period - 1.0, vec2f(0.0), vec2f(1.0)));
}

@fragment
fn fragment(in: Corner) -> @location(0) vec4f {
  let plane = in.plane;
  let pixel = max(vec2f(length(vec2f(dpdx(plane.x), dpdy(plane.x))), length(vec2f(dpdx(plane.y), dpdy(plane.y)))), vec2f(1e-9));
  let fine = abs(fract(plane + 0.5) - 0.5);
  let coarse = abs(fract(0.1 * (plane - grid.tenth) + 0.5) - 0.5) * 10.0;
  // The axes are lines of their own.
  let free = clamp(abs(plane - grid.axes) / pixel - 1.0, vec2f(0.0), vec2f(1.0));
  let lines = max(grid.color.a * cover(fine, 1.0, pixel), grid.strength * cover(coarse, 10.0, pixel)) * free;
  let fade = 1.0 - smoothstep(0.35, 1.0, length(plane) / grid.centre.w);
  return vec4f(grid.color.rgb, (lines.x + lines.y - lines.x * lines.y) * fade);
}
