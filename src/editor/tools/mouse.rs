//! What the mouse does, in words.

/// What the mouse does in the viewport, for the help sheet.
pub const MOUSE_HELP: &[(&str, &str)] = &[
    ("Left click", "Select the face under the pointer"),
    ("Ctrl / Shift + click", "Add to or take from the selection"),
    ("Double click", "Fit the face under the pointer"),
    ("Middle or right drag", "Orbit about the point under the pointer"),
    ("Alt + left drag", "Orbit, for trackpads"),
    ("Shift + drag", "Pan (with middle, right or Alt + left)"),
    ("Wheel", "Zoom to the pointer"),
    ("Cube", "Turn to the view of the face, edge or corner clicked"),
    ("Drag the divider", "Move the wipe between exact surfaces and triangles"),
    ("Drag a handle", "Move a control point, curve or loop, in the UV editor or on the surface"),
    ("Shift / Ctrl while dragging", "Keep to 45° / turn snapping round"),
    ("X, Y, Z while dragging", "Keep a surface point to that axis"),
    ("Double click on a curve", "Select its loop"),
    ("Right click in the UV editor", "Menu of what is there"),
    ("Drop files", "Open them; with Shift add them to the scene"),
];
