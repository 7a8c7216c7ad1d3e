//! What a drag moves: control points, whole curves or whole loops, and what moves along with them.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use crate::editor::elements::{Element, FaceInHand, PointAddress};
use crate::kernel::trim::UvRect;
use crate::scene::edit::FaceId;
use crate::scene::operation::{CurveId, NetId, Operation, PointId, Transform};

/// Ends closer than this part of the domain are joined.
const JOINED: f64 = 1e-6;

/// Elements that move together.
#[derive(Debug, Clone, PartialEq)]
pub enum Moved {
    /// Whole loops.
    Loops(Vec<usize>),
    /// Whole curves.
    Curves(Vec<CurveId>),
    /// Control points.
    Points(Vec<PointId>),
}

impl Moved {
    /// Of elements of one kind that kind, else their control points.
    pub fn of(elements: &[Element], face: &FaceInHand) -> Self {
        let loops: Vec<usize> = elements
            .iter()
            .filter_map(|e| match e {
                Element::Loop { trim_loop } => Some(*trim_loop),
                _ => None,
            })
            .collect();
        if !loops.is_empty() && loops.len() == elements.len() {
            return Self::Loops(loops);
        }
        let curves: Vec<CurveId> = elements
            .iter()
            .filter_map(|e| match e {
                Element::Curve { trim_loop, curve } => Some(CurveId { trim_loop: *trim_loop, curve: *curve }),
                _ => None,
            })
            .collect();
        if !curves.is_empty() && curves.len() == elements.len() {
            return Self::Curves(curves);
        }
        let all: BTreeSet<PointAddress> = elements.iter().flat_map(|e| e.points_of(&face.loops)).collect();
        let id = |(trim_loop, curve, point)| PointId { trim_loop, curve, point };
        Self::Points(all.into_iter().map(id).collect())
    }

    /// Whether nothing moves.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Loops(l) => l.is_empty(),
            Self::Curves(c) => c.is_empty(),
            Self::Points(p) => p.is_empty(),
        }
    }

    /// The operation that moves them by a vector of the uv plane.
    pub fn operation(&self, face: FaceId, by: DVec2) -> Operation {
        let beyond = false;
        match self {
            Self::Loops(loops) => Operation::TransformLoops {
                face,
                loops: loops.clone(),
                transform: Transform::Move { by },
                beyond,
            },
            Self::Curves(curves) => Operation::MoveCurves { face, curves: curves.clone(), by, beyond },
            Self::Points(points) => Operation::MovePoints { face, points: points.clone(), by, beyond },
        }
    }

    /// The same when what was gripped meets something at `met`: a point by itself goes exactly there.
    pub fn operation_to(&self, face: FaceId, by: DVec2, met: Option<DVec2>) -> Operation {
        match (self, met) {
            (Self::Points(points), Some(to)) if points.len() == 1 => {
                Operation::SetPoint { face, point: points[0], to, beyond: true }
            }
            _ => self.operation(face, by),
        }
    }

    /// Their control points.
    pub fn points(&self, face: &FaceInHand) -> BTreeSet<PointAddress> {
        let of = |e: Element| e.points_of(&face.loops);
        match self {
            Self::Loops(loops) => loops.iter().flat_map(|l| of(Element::Loop { trim_loop: *l })).collect(),
            Self::Curves(curves) => curves
                .iter()
                .flat_map(|c| of(Element::Curve { trim_loop: c.trim_loop, curve: c.curve }))
                .collect(),
            Self::Points(points) => points.iter().map(|p| (p.trim_loop, p.curve, p.point)).collect(),
        }
    }
}

/// The control points that move, with the ends of neighbours that are joined to them.
pub fn with_joined(face: &FaceInHand, what: &Moved) -> BTreeSet<PointAddress> {
    let mut all = what.points(face);
    let near = JOINED * UvRect::of_surface(&face.surface).size();
    let mut joined = Vec::new();
    for (l, record) in face.loops.iter().enumerate() {
        let count = record.curves.len();
        for c in 0..count {
            let next = (c + 1) % count;
            let (end, start) = ((l, c, record.curves[c].points().len() - 1), (l, next, 0));
            let (Some(a), Some(b)) = (face.point(end), face.point(start)) else { continue };
            if (a - b).abs().cmple(near).all() {
                if all.contains(&end) {
                    joined.push(start);
                }
                if all.contains(&start) {
                    joined.push(end);
                }
            }
        }
    }
    all.extend(joined);
    all
}

/// The operation that moves control points of the surface.
pub fn surface_operation(face: FaceId, points: &[usize], count_v: usize, by: DVec3) -> Operation {
    let points = points.iter().map(|p| NetId { i: p / count_v, j: p % count_v }).collect();
    Operation::MoveSurfacePoints { face, points, by }
}
