//! What the structures are measured against: the trivial flattened polygon, kurbo, lyon, and the floor.

use glam::{DVec2, Vec2};
use kurbo::{BezPath, Shape as _};
use lyon_path::Path;

use super::shapes::Loops;
use crate::kernel::bezier::BezierCurve2;

/// Even-odd over the edges of curves flattened to eight pieces each: the honest bar.
#[derive(Debug, Clone, Default)]
pub struct Flattened {
    loops: Vec<Vec<Vec2>>,
}

impl Flattened {
    /// Flattens each curve to 8 edges, straight ones to 1.
    pub fn new(loops: &Loops) -> Self {
        let flatten = |curves: &Vec<BezierCurve2>| {
            let mut points: Vec<Vec2> = Vec::new();
            for curve in curves {
                let pieces = if curve.degree() == 1 { 1 } else { 8 };
                points.extend((0..pieces).map(|k| curve.point(f64::from(k) / f64::from(pieces)).as_vec2()));
            }
            points.extend(points.first().copied());
            points
        };
        Self { loops: loops.iter().map(flatten).collect() }
    }

    /// The textbook loop over all edges.
    pub fn classify(&self, p: Vec2) -> bool {
        let mut inside = false;
        for points in &self.loops {
            for edge in points.windows(2) {
                let (a, b) = (edge[0], edge[1]);
                if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) {
                    inside = !inside;
                }
            }
        }
        inside
    }
}

/// The loops as a kurbo path; none when a curve is rational or of a degree above 3.
pub fn kurbo_path(loops: &Loops) -> Option<BezPath> {
    let at = |p: DVec2| kurbo::Point::new(p.x, p.y);
    let mut path = BezPath::new();
    for curves in loops {
        path.move_to(at(curves.first()?.start()));
        for curve in curves {
            if curve.is_rational() {
                return None;
            }
            match *curve.points.as_slice() {
                [_, b] => path.line_to(at(b)),
                [_, b, c] => path.quad_to(at(b), at(c)),
                [_, b, c, d] => path.curve_to(at(b), at(c), at(d)),
                _ => return None,
            }
        }
        path.close_path();
    }
    Some(path)
}

/// Even-odd by kurbo's winding number.
pub fn kurbo_inside(path: &BezPath, p: DVec2) -> bool {
    path.winding(kurbo::Point::new(p.x, p.y)) & 1 != 0
}

/// The loops as a lyon path; none when a curve is rational or of a degree above 3.
pub fn lyon_path(loops: &Loops) -> Option<Path> {
    let at = |p: DVec2| lyon_path::math::point(p.x as f32, p.y as f32);
    let mut builder = Path::builder();
    for curves in loops {
        builder.begin(at(curves.first()?.start()));
        for curve in curves {
            if curve.is_rational() {
                return None;
            }
            match *curve.points.as_slice() {
                [_, b] => builder.line_to(at(b)),
                [_, b, c] => builder.quadratic_bezier_to(at(b), at(c)),
                [_, b, c, d] => builder.cubic_bezier_to(at(b), at(c), at(d)),
                _ => return None,
            };
        }
        builder.end(true);
    }
    Some(builder.build())
}

/// Even-odd by lyon's hit test.
pub fn lyon_inside(path: &Path, p: Vec2) -> bool {
    let point = lyon_path::math::point(p.x, p.y);
    lyon_algorithms::hit_test::hit_test_path(&point, path.iter(), lyon_path::FillRule::EvenOdd, 1e-5)
}

/// The least that any table of `bytes` bytes costs: one index computation and one random read.
#[derive(Debug, Clone)]
pub struct Floor {
    table: Vec<[f32; 4]>,
    side: u32,
}

impl Floor {
    /// A table of about `bytes` bytes.
    pub fn new(bytes: usize) -> Self {
        let side = ((bytes / 16) as f64).sqrt().ceil().max(1.0) as u32;
        Self { table: (0..side * side).map(|i| [i as f32, 1.0, 0.5, 0.25]).collect(), side }
    }

    /// One read at the place of `p`, and a little arithmetic on it.
    pub fn classify(&self, p: Vec2) -> bool {
        let scale = self.side as f32;
        let index = (p.y * scale) as u32 * self.side + (p.x * scale) as u32;
        let [a, b, c, d] = self.table[(index as usize).min(self.table.len() - 1)];
        a * p.x + b * p.y + c > d
    }
}
