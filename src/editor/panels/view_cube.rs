//! The view cube: shows how the camera is turned; faces, edges and corners are clicked to turn it.
//!
//! Each of the six faces is cut in 3 x 3 cells; a cell is named by its direction in {-1, 0, 1}^3, so that
//! cells at an edge or corner belong to it on all faces alike.

use bevy::window::RequestRedraw;
use bevy_egui::egui::{
    self, Color32, FontFamily, FontId, Id, Mesh, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2,
};
use glam::{DMat3, DVec3, IVec3};

use super::{Reads, Writes};
use crate::editor::camera::CameraRequest;

/// Half the edge of the cube, points.
const HALF: f64 = 27.0;
/// Room for the cube in every position, and its distance from the corner of the viewport.
pub(super) const ROOM: f32 = 110.0;
/// Share of a face's half width that belongs to its middle cell.
const INNER: f64 = 0.62;

/// A face of the cube: outward normal, and where right and up of its label point.
struct Side {
    normal: DVec3,
    right: DVec3,
    up: DVec3,
    label: &'static str,
}

const SIDES: [Side; 6] = [
    Side { normal: DVec3::NEG_Y, right: DVec3::X, up: DVec3::Z, label: "FRONT" },
    Side { normal: DVec3::Y, right: DVec3::NEG_X, up: DVec3::Z, label: "BACK" },
    Side { normal: DVec3::NEG_X, right: DVec3::NEG_Y, up: DVec3::Z, label: "LEFT" },
    Side { normal: DVec3::X, right: DVec3::Y, up: DVec3::Z, label: "RIGHT" },
    Side { normal: DVec3::Z, right: DVec3::X, up: DVec3::Y, label: "TOP" },
    Side { normal: DVec3::NEG_Z, right: DVec3::X, up: DVec3::NEG_Y, label: "BOTTOM" },
];

/// Shows the cube in the upper right corner of the viewport.
pub(super) fn show(root: &Ui, viewport: Rect, reads: &Reads, writes: &mut Writes) {
    if viewport.width() < 2.5 * ROOM || viewport.height() < 1.6 * ROOM {
        return;
    }
    let room = Rect::from_min_size(pos2(viewport.max.x - ROOM - 6.0, viewport.min.y + 6.0), vec2(ROOM, ROOM));
    let area =
        egui::Area::new(Id::new("view cube")).order(egui::Order::Middle).fixed_pos(room.min).movable(false);
    area.show(root.ctx(), |ui| {
        let (_, response) = ui.allocate_exact_size(room.size(), Sense::click());
        let (right, up, back) = reads.camera.now.axes();
        // Rows: screen right, screen up, towards the viewer.
        let screen_from_world = DMat3::from_cols(right, up, back).transpose();
        let hot = response.hover_pos().and_then(|p| cell_at(p, room.center(), &screen_from_world));
        paint(ui.painter(), room.center(), &screen_from_world, hot, reads);
        if response.clicked()
            && let Some(cell) = hot
        {
            let (direction, up) = view_from(cell);
            writes.camera.write(CameraRequest::Look { direction, up });
            writes.redraw.write(RequestRedraw);
        }
    });
}

fn to_screen(screen_from_world: &DMat3, centre: Pos2, p: DVec3) -> Pos2 {
    let s = *screen_from_world * p;
    centre + vec2((s.x * HALF) as f32, (-s.y * HALF) as f32)
}

fn faces_viewer(side: &Side, screen_from_world: &DMat3) -> bool {
    (*screen_from_world * side.normal).z > 0.02
}

/// Corners of a cell of a side; `i`, `j` in -1..=1 along right and up.
fn cell_corners(side: &Side, i: i32, j: i32) -> [DVec3; 4] {
    let range = |k: i32| match k {
        -1 => (-1.0, -INNER),
        0 => (-INNER, INNER),
        _ => (INNER, 1.0),
    };
    let ((a0, a1), (b0, b1)) = (range(i), range(j));
    [(a0, b0), (a1, b0), (a1, b1), (a0, b1)].map(|(a, b)| side.normal + side.right * a + side.up * b)
}

/// The direction a cell stands for.
fn cell_name(side: &Side, i: i32, j: i32) -> IVec3 {
    (side.normal + side.right * f64::from(i) + side.up * f64::from(j)).round().as_ivec3()
}

fn cell_at(pointer: Pos2, centre: Pos2, screen_from_world: &DMat3) -> Option<IVec3> {
    for side in SIDES.iter().filter(|s| faces_viewer(s, screen_from_world)) {
        // Solve pointer = normal + a right + b up in the screen plane.
        let project = |v: DVec3| (*screen_from_world * v).truncate();
        let target =
            glam::DVec2::new(f64::from(pointer.x - centre.x), -f64::from(pointer.y - centre.y)) / HALF;
        let basis = glam::DMat2::from_cols(project(side.right), project(side.up));
        let ab = basis.inverse() * (target - project(side.normal));
        if ab.is_finite() && ab.abs().max_element() <= 1.0 {
            let cell = |x: f64| if x.abs() <= INNER { 0 } else { x.signum() as i32 };
            return Some(cell_name(side, cell(ab.x), cell(ab.y)));
        }
    }
    None
}

/// Direction of sight and up vector for looking at a cell from outside.
fn view_from(cell: IVec3) -> (DVec3, DVec3) {
    let direction = -cell.as_dvec3().normalize_or(DVec3::Z);
    let up = match (cell.x, cell.y, cell.z) {
        (0, 0, 1) => DVec3::Y,
        (0, 0, -1) => DVec3::NEG_Y,
        _ => DVec3::Z,
    };
    (direction, up)
}

fn paint(painter: &Painter, centre: Pos2, screen_from_world: &DMat3, hot: Option<IVec3>, reads: &Reads) {
    let p = &reads.palette;
    axes(painter, centre, screen_from_world, reads, false);
    for side in SIDES.iter().filter(|s| faces_viewer(s, screen_from_world)) {
        let facing = (*screen_from_world * side.normal).z as f32;
        let base = if p.light { p.raised } else { egui::Color32::from_rgb(70, 75, 84) };
        let fill = shade(base, if p.light { 0.86 + 0.14 * facing } else { 0.62 + 0.38 * facing });
        let corner = |c: DVec3| to_screen(screen_from_world, centre, c);
        let outline = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(a, b)| corner(side.normal + side.right * a + side.up * b));
        painter.add(Shape::convex_polygon(outline.to_vec(), fill, Stroke::new(1.0, p.line)));
        for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j))) {
            if hot == Some(cell_name(side, i, j)) {
                let corners = cell_corners(side, i, j).map(corner);
                painter.add(Shape::convex_polygon(
                    corners.to_vec(),
                    p.accent.gamma_multiply(0.75),
                    Stroke::NONE,
                ));
            }
        }
        let on_hot = hot == Some(side.normal.round().as_ivec3());
        let ink = if on_hot { p.on_accent } else { p.text.gamma_multiply(0.35 + 0.65 * facing) };
        label(painter, centre, screen_from_world, side, ink);
    }
    axes(painter, centre, screen_from_world, reads, true);
}

fn shade(color: Color32, f: f32) -> Color32 {
    let s = |c: u8| (f32::from(c) * f).clamp(0.0, 255.0) as u8;
    Color32::from_rgb(s(color.r()), s(color.g()), s(color.b()))
}

/// A label lying in its side: the text's mesh, mapped to the side and turned with it.
fn label(painter: &Painter, centre: Pos2, screen_from_world: &DMat3, side: &Side, ink: Color32) {
    // Laid out larger than it is drawn, for the atlas has whole pixels only.
    const LAID_OUT: f32 = 26.0;
    let font = FontId::new(LAID_OUT, FontFamily::Name("medium".into()));
    let galley = painter.layout_no_wrap(side.label.to_owned(), font, ink);
    let scale = 15.5 / f64::from(LAID_OUT) / HALF * 0.72;
    let middle = galley.rect.center();
    let atlas = painter.ctx().fonts(|f| f.font_image_size());
    let mut mesh = Mesh::with_texture(egui::TextureId::default());
    for row in &galley.rows {
        let first = mesh.vertices.len() as u32;
        mesh.indices.extend(row.visuals.mesh.indices.iter().map(|i| first + i));
        for vertex in &row.visuals.mesh.vertices {
            let at = vertex.pos + row.pos.to_vec2() - middle;
            let (x, y) = (f64::from(at.x) * scale, -f64::from(at.y) * scale);
            let place = side.normal + side.right * x + side.up * y;
            mesh.vertices.push(egui::epaint::Vertex {
                pos: to_screen(screen_from_world, centre, place),
                uv: pos2(vertex.uv.x / atlas[0] as f32, vertex.uv.y / atlas[1] as f32),
                color: ink,
            });
        }
    }
    painter.add(Shape::mesh(mesh));
}

/// The three axes from the cube's lower left front corner; those behind the cube first.
fn axes(painter: &Painter, centre: Pos2, screen_from_world: &DMat3, reads: &Reads, in_front: bool) {
    let p = &reads.palette;
    let corner = DVec3::splat(-1.12);
    for (axis, color, name) in
        [(DVec3::X, p.axis_x, "x"), (DVec3::Y, p.axis_y, "y"), (DVec3::Z, p.axis_z, "z")]
    {
        // An axis runs along an edge: it is hidden when both sides at that edge look away.
        let visible = SIDES
            .iter()
            .filter(|s| s.normal.dot(corner) > 0.0 && s.normal.dot(axis) == 0.0)
            .any(|s| faces_viewer(s, screen_from_world));
        if visible != in_front {
            continue;
        }
        let from = to_screen(screen_from_world, centre, corner);
        let to = to_screen(screen_from_world, centre, corner + axis * 2.35);
        painter.line_segment([from, to], Stroke::new(1.6, color));
        let beyond = to_screen(screen_from_world, centre, corner + axis * 2.62);
        painter.text(beyond, egui::Align2::CENTER_CENTER, name, FontId::proportional(11.0), color);
    }
}
