//! The parts of a face that can be picked one by one: loops, curves, control points.

use std::borrow::Borrow;

use super::active::FaceInHand;
use crate::scene::records::LoopRecord;

/// One element of a face, by its position in the face's loops.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Element {
    /// A whole trim loop.
    Loop {
        /// Position of the loop.
        trim_loop: usize,
    },
    /// A whole curve.
    Curve {
        /// Position of the loop.
        trim_loop: usize,
        /// Position of the curve in the loop.
        curve: usize,
    },
    /// A control point of a curve.
    Point {
        /// Position of the loop.
        trim_loop: usize,
        /// Position of the curve in the loop.
        curve: usize,
        /// Position of the control point in the curve.
        point: usize,
    },
    /// A control point of the surface.
    SurfacePoint {
        /// Position of the control point, u-major.
        point: usize,
    },
}

/// Address of a control point of a trim curve: loop, curve, point.
pub type PointAddress = (usize, usize, usize);

impl Element {
    /// The loop it is, or is of.
    pub fn trim_loop(self) -> Option<usize> {
        match self {
            Self::Loop { trim_loop } | Self::Curve { trim_loop, .. } | Self::Point { trim_loop, .. } => {
                Some(trim_loop)
            }
            Self::SurfacePoint { .. } => None,
        }
    }

    /// Loop and curve it is, or is of.
    pub fn curve(self) -> Option<(usize, usize)> {
        match self {
            Self::Curve { trim_loop, curve } | Self::Point { trim_loop, curve, .. } => {
                Some((trim_loop, curve))
            }
            _ => None,
        }
    }

    /// Whether `face` has it.
    pub fn exists_in(self, face: &FaceInHand) -> bool {
        let curve = |l: usize, c: usize| face.loops.get(l).and_then(|l| l.curves.get(c));
        match self {
            Self::Loop { trim_loop } => trim_loop < face.loops.len(),
            Self::Curve { trim_loop, curve: c } => curve(trim_loop, c).is_some(),
            Self::Point { trim_loop, curve: c, point } => {
                curve(trim_loop, c).is_some_and(|c| point < c.points().len())
            }
            Self::SurfacePoint { point } => point < face.surface.points().len(),
        }
    }

    /// The control points of trim curves that it stands for.
    pub fn points_of<L: Borrow<LoopRecord>>(self, loops: &[L]) -> Vec<PointAddress> {
        let of_curve = |l: usize, c: usize| {
            let curve = loops.get(l).and_then(|l| l.borrow().curves.get(c));
            let count = curve.map_or(0, |c| c.points().len());
            (0..count).map(move |p| (l, c, p))
        };
        match self {
            Self::Loop { trim_loop } => {
                let curves = loops.get(trim_loop).map_or(0, |l| l.borrow().curves.len());
                (0..curves).flat_map(|c| of_curve(trim_loop, c)).collect()
            }
            Self::Curve { trim_loop, curve } => of_curve(trim_loop, curve).collect(),
            Self::Point { trim_loop, curve, point } => vec![(trim_loop, curve, point)],
            Self::SurfacePoint { .. } => Vec::new(),
        }
    }

    /// What to call it, with numbers from 1.
    pub fn label(self) -> String {
        match self {
            Self::Loop { trim_loop } => format!("Loop {}", trim_loop + 1),
            Self::Curve { trim_loop, curve } => format!("Curve {}.{}", trim_loop + 1, curve + 1),
            Self::Point { trim_loop, curve, point } => {
                format!("Point {}.{}.{}", trim_loop + 1, curve + 1, point + 1)
            }
            Self::SurfacePoint { point } => format!("Surface point {}", point + 1),
        }
    }
}
