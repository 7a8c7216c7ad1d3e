//! Scenes of any size for measuring: a quilt of bulged panels over a wavy ground.
//!
//! Panels are bicubic patches whose border control points are functions of the corners of that border alone,
//! so neighbours share their edges bit for bit. Trims run along the borders of the patches. Of eight panels
//! one has a round hole of four curves and one is not trimmed at all: four trim curves per face.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::outline::rectangle;
use super::shape::surface;
use crate::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
use crate::scene::records::{FaceRecord, LoopRecord, LoopRole, ModelRecord, PartRecord};

/// Side of a panel in millimetres.
const SIDE: f64 = 20.0;
/// How far the middle of a panel stands out.
const BULGE: f64 = 3.0;
/// Rows of panels to a part.
const ROWS_PER_PART: usize = 16;
/// Linear RGB of the parts, in turn.
const COLOURS: [[f32; 3]; 5] =
    [[0.60, 0.07, 0.045], [0.08, 0.22, 0.42], [0.62, 0.40, 0.08], [0.10, 0.32, 0.16], [0.46, 0.44, 0.40]];

/// A quilt of exactly `faces` panels, as nearly square as may be, row by row.
pub fn panels(faces: usize) -> ModelRecord {
    let columns = ((faces as f64).sqrt().ceil() as usize).max(1);
    let rows = faces.div_ceil(columns);
    let ground = Ground { size: DVec2::new(columns as f64, rows as f64) * SIDE };
    let bands = rows.div_ceil(ROWS_PER_PART);
    let parts = (0..bands).map(|band| PartRecord { name: format!("Band {}", band + 1), parent: None });
    let face = |index: usize| {
        let (row, column) = (index / columns, index % columns);
        let band = row / ROWS_PER_PART;
        FaceRecord {
            name: Some(format!("Panel {}.{}", row + 1, column + 1)),
            colour: Some(COLOURS[band % COLOURS.len()]),
            part: Some(band),
            ..FaceRecord::new(ground.panel(column, row), loops(index))
        }
    };
    ModelRecord {
        name: format!("{faces} panels"),
        parts: parts.collect(),
        faces: (0..faces).map(face).collect(),
        ..ModelRecord::default()
    }
}

/// What lies under the panels.
struct Ground {
    /// Extent of all panels.
    size: DVec2,
}

/// A corner that up to four panels share, with a third of a panel's side along x and along y.
#[derive(Clone, Copy)]
struct Corner {
    point: DVec3,
    along: DVec3,
    across: DVec3,
}

impl Ground {
    fn corner(&self, column: usize, row: usize) -> Corner {
        let p = DVec2::new(column as f64, row as f64) * SIDE;
        // One hill over all, and waves of some panels' length.
        let s = p / self.size * (0.5 * TAU);
        let (hill, wave) = (0.15 * self.size.min_element(), 2.0);
        let turn = p * (TAU / 170.0);
        let slope = DVec2::new(
            hill * s.x.cos() * s.y.sin() * (0.5 * TAU / self.size.x)
                + wave * turn.x.cos() * turn.y.cos() * (TAU / 170.0),
            hill * s.x.sin() * s.y.cos() * (0.5 * TAU / self.size.y)
                - wave * turn.x.sin() * turn.y.sin() * (TAU / 170.0),
        );
        let height = hill * s.x.sin() * s.y.sin() + wave * turn.x.sin() * turn.y.cos();
        Corner {
            point: p.extend(height),
            along: DVec3::new(1.0, 0.0, slope.x) * (SIDE / 3.0),
            across: DVec3::new(0.0, 1.0, slope.y) * (SIDE / 3.0),
        }
    }

    fn panel(&self, column: usize, row: usize) -> NurbsSurface {
        let [a, b] = [0, 1].map(|v| self.corner(column, row + v));
        let [c, d] = [0, 1].map(|v| self.corner(column + 1, row + v));
        // No twist, and a bulge that no border knows of.
        let inner = |corner: Corner, along: f64, across: f64| {
            corner.point + corner.along * along + corner.across * across + DVec3::Z * (BULGE * 16.0 / 9.0)
        };
        let points = vec![
            a.point,
            a.point + a.across,
            b.point - b.across,
            b.point,
            a.point + a.along,
            inner(a, 1.0, 1.0),
            inner(b, 1.0, -1.0),
            b.point + b.along,
            c.point - c.along,
            inner(c, -1.0, 1.0),
            inner(d, -1.0, -1.0),
            d.point - d.along,
            c.point,
            c.point + c.across,
            d.point - d.across,
            d.point,
        ];
        let knots = || KnotVector::bezier(3, 0.0, 1.0).expect("degree 3 is in range");
        surface(knots(), knots(), points, vec![1.0; 16])
    }
}

/// Trims of the panel at `index`.
fn loops(index: usize) -> Vec<LoopRecord> {
    let border = LoopRecord::new(LoopRole::Outer, rectangle(DVec2::ZERO, DVec2::ONE));
    match index % 8 {
        6 => vec![],
        3 => {
            let radius = 0.12 + 0.02 * (index / 8 % 9) as f64;
            vec![border, LoopRecord::new(LoopRole::Inner, round(DVec2::splat(0.5), radius))]
        }
        _ => vec![border],
    }
}

/// The circle as four rational arcs, run through clockwise.
fn round(centre: DVec2, radius: f64) -> Vec<NurbsCurve2> {
    let corners = [DVec2::X, DVec2::NEG_Y, DVec2::NEG_X, DVec2::Y].map(|d| centre + d * radius);
    (0..4)
        .map(|k| {
            let (from, to) = (corners[k], corners[(k + 1) % 4]);
            let knots = KnotVector::bezier(2, 0.0, 1.0).expect("degree 2 is in range");
            let weights = vec![1.0, std::f64::consts::FRAC_1_SQRT_2, 1.0];
            NurbsCurve2::new(knots, vec![from, from + to - centre, to], weights).expect("finite points")
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::nurbs::Direction;

    #[test]
    fn neighbours_share_their_edges_bit_for_bit() {
        let model = panels(30);
        let edge = |face: usize, direction, value| {
            let curve = model.faces[face].surface.iso_curve(direction, value);
            curve.points().to_vec()
        };
        // Six columns.
        assert_eq!(edge(7, Direction::U, 1.0), edge(8, Direction::U, 0.0));
        assert_eq!(edge(7, Direction::V, 1.0), edge(13, Direction::V, 0.0));
        let middle = model.faces[7].surface.point(0.5, 0.5);
        let chord = 0.5 * (edge(7, Direction::U, 0.0)[0] + edge(7, Direction::U, 1.0)[3]);
        assert!(middle.z > chord.z + 0.5 * BULGE);
    }

    #[test]
    fn there_are_as_many_faces_as_asked_for_and_four_curves_to_each() {
        for count in [1, 8, 1000] {
            let model = panels(count);
            assert_eq!(model.faces.len(), count);
            assert!(model.faces.iter().all(|f| f.part.is_some_and(|p| p < model.parts.len())));
            let curves: usize = model.faces.iter().flat_map(|f| &f.loops).map(|l| l.curves.len()).sum();
            assert_eq!(curves, 4 * count);
        }
        for trim in panels(8).faces.iter().flat_map(|f| f.loops.clone()) {
            for (i, curve) in trim.curves.iter().enumerate() {
                let next = &trim.curves[(i + 1) % trim.curves.len()];
                assert_eq!(curve.points().last(), next.points().first());
            }
        }
    }
}
