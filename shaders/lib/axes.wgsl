// Model axes seen from the viewer. Twin: reference::solve.

struct Axes {
    right: vec3f,
    up: vec3f,
    forward: vec3f,
}

fn axes_apply(axes: Axes, p: vec3f) -> vec3f {
    return vec3f(dot(axes.right, p), dot(axes.up, p), dot(axes.forward, p));
}
