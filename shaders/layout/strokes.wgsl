// What lines and marks of the viewport get once per draw. Mirror: editor::render::strokes::Uniform.
// Positions are relative to the eye.
struct StrokeView {
  clip_from_relative: mat4x4f,
  // Centre of the disc outside of which lines fade away, relative to the eye; w: its radius. Marks do not fade.
  fade: vec4f,
  // Size of the viewport, pixels.
  size_px: vec2f,
  // Factor of the (reversed) depth: below 1 is farther than it is, above 1 nearer.
  depth: f32,
  opacity: f32,
}

@group(0) @binding(0) var<uniform> view: StrokeView;
