//! Random operations from a seed, for tests and benchmarks of editing.
//!
//! They wander: curves are split and joined, degrees raised and lowered, loops and faces come and go, such that
//! nothing grows without bound. Some are refused by the scene, as a user's are; callers go on to the next.

use glam::{DVec2, DVec3};

use super::{CurveId, NetId, Operation, PointId, Shape, Transform};
use crate::kernel::nurbs::Direction;
use crate::scene::document::{Document, FaceView};
use crate::scene::edit::FaceId;
use crate::scene::records::LoopRole;

/// More of these in one face, and fewer are made than taken away.
const LOOPS: usize = 8;
const CURVES: usize = 24;
const POINTS: usize = 24;
const NET: usize = 200;

/// An endless sequence of operations, the same for the same seed and the same answers of the scene.
#[derive(Debug, Clone)]
pub struct RandomOperations {
    state: u64,
    faces: usize,
}

impl RandomOperations {
    /// Begins the sequence of `seed`; about `faces` faces are kept in each model.
    pub fn new(seed: u64, faces: usize) -> Self {
        Self { state: seed, faces }
    }

    /// A random number (SplitMix64: Steele, Lea & Flood 2014).
    fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Below `count`; 0 for none.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count.max(1) as u64) as usize
    }

    /// In 0..1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self) -> DVec2 {
        DVec2::new(self.unit() - 0.5, self.unit() - 0.5)
    }

    /// The next operation for a scene with faces.
    pub fn next_operation(&mut self, document: &dyn Document) -> Operation {
        let model = self.below(document.model_count());
        let count = document.face_count(model);
        let face = FaceId { model, face: self.below(count) };
        let Some(view) = document.face(face) else { return Operation::DeleteFaces { faces: vec![face] } };
        match self.below(40) {
            0 if count > self.faces => Operation::DeleteFaces { faces: vec![face] },
            0 => Operation::DuplicateFaces { faces: vec![face], by: DVec3::splat(self.unit()) },
            1 => Operation::SetName { faces: vec![face], name: Some(format!("name {}", self.below(1000))) },
            2 => {
                let colour = [0.5, self.unit() as f32, self.unit() as f32];
                Operation::SetColour { faces: vec![face], colour: Some(colour) }
            }
            3..=8 => self.surface(face, &view),
            9..=16 => self.whole_loop(face, &view),
            _ => self.curve(face, &view),
        }
    }

    fn surface(&mut self, face: FaceId, view: &FaceView) -> Operation {
        let (nu, nv) = view.surface.counts();
        let direction = if self.below(2) == 0 { Direction::U } else { Direction::V };
        let point = NetId { i: self.below(nu), j: self.below(nv) };
        let size = view.surface.bounds().diagonal();
        match self.below(8) {
            0 => Operation::ReverseSurface { face, direction },
            1 => Operation::SwapSurface { face },
            2 => Operation::FlipNormal { face },
            3 if nu * nv < NET => {
                let (start, end) = view.surface.knots(direction).domain();
                Operation::InsertSurfaceKnot {
                    face,
                    direction,
                    at: start + (end - start) * self.unit(),
                    times: 1,
                }
            }
            4 => Operation::SetSurfaceWeight { face, points: vec![point], weight: 0.5 + self.unit() },
            _ => {
                let by = DVec3::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5) * (0.01 * size);
                Operation::MoveSurfacePoints { face, points: vec![point], by }
            }
        }
    }

    fn whole_loop(&mut self, face: FaceId, view: &FaceView) -> Operation {
        let (domain, count) = (view.domain(), view.loops.len());
        let size = domain.size();
        let loops = vec![self.below(count)];
        let by = self.vector() * size * 0.1;
        if count == 0 || (count < LOOPS && self.below(6) == 0) {
            let centre = domain.min + size * DVec2::new(0.2 + 0.6 * self.unit(), 0.2 + 0.6 * self.unit());
            let radii = size * (0.02 + 0.1 * self.unit());
            let shape = match self.below(3) {
                0 => Shape::Rectangle { from: centre - radii, to: centre + radii },
                1 => Shape::Ellipse { centre, radii, degrees: 360.0 * self.unit() },
                _ => {
                    let corner = |k: usize| centre + radii * DVec2::from_angle(k as f64 * 1.2);
                    Shape::Polyline { points: (0..5).map(corner).collect() }
                }
            };
            return Operation::AddLoop { face, shape, role: LoopRole::Inner };
        }
        match self.below(8) {
            0 if count > LOOPS / 2 => Operation::DeleteLoops { face, loops },
            0 => Operation::DuplicateLoops { face, loops, by },
            1 => Operation::ReverseLoops { face, loops },
            2 => Operation::SetRole {
                face,
                loops,
                role: if self.below(2) == 0 { LoopRole::Inner } else { LoopRole::Outer },
            },
            3 => Operation::CloseLoops { face, loops },
            kind => {
                let about = Some(0.5 * (domain.min + domain.max));
                let transform = match kind {
                    4 => Transform::Rotate { degrees: 5.0 * self.unit(), about },
                    5 => Transform::Scale { by: DVec2::splat(0.9 + 0.2 * self.unit()), about },
                    6 => Transform::Mirror { along: DVec2::X, about },
                    _ => Transform::Move { by },
                };
                Operation::TransformLoops { face, loops, transform, beyond: false }
            }
        }
    }

    fn curve(&mut self, face: FaceId, view: &FaceView) -> Operation {
        let by = self.vector() * view.domain().size() * 0.02;
        let trim_loop = self.below(view.loops.len());
        let Some(trim) = view.loops.get(trim_loop) else { return Operation::Untrim { face } };
        let number = self.below(trim.curves.len());
        let Some(nurbs) = trim.curves.get(number) else { return Operation::Untrim { face } };
        let curve = CurveId { trim_loop, curve: number };
        let (start, end) = nurbs.domain();
        let at = start + (end - start) * (0.1 + 0.8 * self.unit());
        let big = 0.1 * view.domain().size().max_element();
        let (many_points, many_curves) = (nurbs.points().len() > POINTS, trim.curves.len() > CURVES);
        let point = PointId { trim_loop, curve: number, point: self.below(nurbs.points().len()) };
        match self.below(16) {
            0 if many_points => Operation::ReduceDegree { face, curve, tolerance: Some(big) },
            0 if nurbs.degree() < 6 => Operation::ElevateDegree { face, curve, by: 1 },
            1 if many_points => {
                let inner = nurbs.knots().breaks();
                Operation::RemoveKnot { face, curve, at: inner[inner.len() / 2], tolerance: Some(big) }
            }
            1 => Operation::InsertKnot { face, curve, at, times: 1 },
            2 | 3 if many_curves => Operation::DeleteCurves { face, curves: vec![curve] },
            2 => Operation::SplitCurve { face, curve, at },
            3 => Operation::JoinCurves { face, curve, tolerance: None },
            4 => Operation::ReduceDegree { face, curve, tolerance: Some(big) },
            5 | 6 => Operation::SetWeight { face, points: vec![point], weight: 0.5 + self.unit() },
            7 => Operation::MoveCurves { face, curves: vec![curve], by, beyond: false },
            8 => {
                let to = view.domain().native(DVec2::new(self.unit(), self.unit()));
                Operation::SetPoint { face, point, to, beyond: false }
            }
            _ => Operation::MovePoints { face, points: vec![point], by, beyond: self.below(8) == 0 },
        }
    }
}
