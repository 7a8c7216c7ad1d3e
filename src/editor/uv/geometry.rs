//! The active face's loops as polylines for the panel, kept until face or zoom change.

use std::sync::Arc;

use bevy::prelude::*;
use glam::DVec2;

use super::flat::{FlatCurve, FlatteningKey};
use super::view::UvView;
use crate::editor::elements::FaceInHand;
use crate::kernel::bezier::BezierCurve2;
use crate::kernel::face::Face;
use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::trim::UvRect;
use crate::scene::records::{LoopRecord, LoopRole};

/// Polylines of the active face.
#[derive(Resource, Debug, Default)]
pub struct UvGeometry {
    /// Per loop, per curve.
    pub curves: Vec<Vec<Arc<FlatCurve>>>,
    /// Whether each loop is a hole, by its role or by what is around it.
    pub holes: Vec<bool>,
    /// Closed polylines that the face is inside of by the even-odd rule, as trimming sees them.
    pub chains: Vec<Vec<DVec2>>,
    /// Counts changes.
    pub revision: u64,
    made_of: Option<MadeOf>,
}

/// What the polylines were made of.
#[derive(Debug)]
struct MadeOf {
    entity: Entity,
    loops: Vec<Arc<LoopRecord>>,
    face: Option<Arc<Face>>,
    key: FlatteningKey,
}

impl UvGeometry {
    /// Brings the polylines up to date. Those of curves that did not change are kept.
    pub fn update(&mut self, face: Option<&FaceInHand>, view: &UvView) {
        let Some(face) = face else {
            if self.made_of.is_some() {
                *self = Self { revision: self.revision + 1, ..Self::default() };
            }
            return;
        };
        let derived = face.derived.as_ref().and_then(|d| d.face.clone());
        let before = self.made_of.take().filter(|made| made.entity == face.entity && made.key.serves(view));
        let key = before.as_ref().map_or_else(|| FlatteningKey::of(view), |made| made.key);
        let same_loop = |l: usize| {
            before.as_ref().and_then(|b| b.loops.get(l)).is_some_and(|b| Arc::ptr_eq(b, &face.loops[l]))
        };
        let kept_curves = before.as_ref().is_some_and(|b| b.loops.len() == face.loops.len())
            && (0..face.loops.len()).all(same_loop);
        let kept_chains = before
            .as_ref()
            .is_some_and(|b| b.face.as_ref().map(Arc::as_ptr) == derived.as_ref().map(Arc::as_ptr));
        if !kept_curves {
            let old = before.as_ref().map_or(&[][..], |b| &b.loops);
            self.flatten_curves(&face.loops, old, &key);
        }
        if !kept_chains {
            self.chains = derived.as_deref().map_or_else(Vec::new, |face| chains(face, &key));
        }
        self.revision += u64::from(!kept_curves || !kept_chains);
        self.made_of = Some(MadeOf { entity: face.entity, loops: face.loops.clone(), face: derived, key });
    }

    fn flatten_curves(&mut self, loops: &[Arc<LoopRecord>], before: &[Arc<LoopRecord>], key: &FlatteningKey) {
        let old = std::mem::take(&mut self.curves);
        let kept = |l: usize, c: usize| {
            let same = before.get(l)?.curves.get(c)? == loops[l].curves.get(c)?;
            old.get(l)?.get(c).filter(|_| same).cloned()
        };
        self.curves = (0..loops.len())
            .map(|l| {
                let curves = loops[l].curves.iter().enumerate();
                curves
                    .map(|(c, curve)| kept(l, c).unwrap_or_else(|| Arc::new(FlatCurve::of(curve, key))))
                    .collect()
            })
            .collect();
        self.holes = holes(loops, &self.curves);
    }

    /// Box around everything: the surface's domain and all control points of loops.
    pub fn bounds(surface: &NurbsSurface, loops: &[Arc<LoopRecord>]) -> UvRect {
        let mut rect = UvRect::of_surface(surface);
        let points = loops.iter().flat_map(|l| &l.curves).flat_map(|c| c.points());
        points.for_each(|p| rect.include(*p));
        rect
    }
}

/// The chains of a derived face in native parameters.
fn chains(face: &Face, key: &FlatteningKey) -> Vec<Vec<DVec2>> {
    let list = &face.pieces;
    let chain = |index: usize| {
        let mut points: Vec<DVec2> = Vec::new();
        for number in list.chain(index) {
            let piece = &list.pieces()[number];
            let curve = BezierCurve2 {
                points: list.points(piece).iter().map(|p| face.domain.native(*p)).collect(),
                weights: list.weights(piece).to_vec(),
            };
            let flat = FlatCurve::of_piece(&curve, key);
            points.extend(&flat.points[..flat.points.len() - 1]);
        }
        points
    };
    (0..list.chain_count()).map(chain).collect()
}

/// Which loops are holes: said by their role, else by the number of loops around them.
fn holes(loops: &[Arc<LoopRecord>], curves: &[Vec<Arc<FlatCurve>>]) -> Vec<bool> {
    let boxes: Vec<UvRect> =
        curves.iter().map(|c| c.iter().fold(UvRect::EMPTY, |r, c| r.union(c.bounds))).collect();
    let crosses = |p: DVec2, l: usize| {
        let count = curves[l].iter().flat_map(|c| c.points.windows(2)).filter(|e| {
            let (a, b) = (e[0], e[1]);
            (a.y <= p.y) != (b.y <= p.y) && a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x
        });
        count.count() % 2 == 1
    };
    let nested = |l: usize| {
        let Some(p) = curves[l].first().and_then(|c| c.points.first()) else { return false };
        let around = (0..loops.len()).filter(|o| *o != l && boxes[*o].contains(*p) && crosses(*p, *o));
        around.count() % 2 == 1
    };
    loops
        .iter()
        .enumerate()
        .map(|(l, record)| match record.role {
            LoopRole::Outer => false,
            LoopRole::Inner => true,
            LoopRole::Unknown => nested(l),
        })
        .collect()
}
