//! All hits of a ray with exact surfaces, in f64: the yardstick that pictures are measured by.
//!
//! A tree of control-hull boxes finds the patches a line may meet, [`LineSolver`] finds every zero on
//! them; each hit is polished on the original patch and comes with its residual (distance from the ray). A
//! hit on the edge between two patches of a face counts once.

use glam::{DVec2, DVec3};

use super::BoundsTree;
use super::line_roots::{LineRoot, LineSolver};
use crate::kernel::bezier::BezierPatch;
use crate::kernel::view::{Bounds, Ray};

/// One point where a ray meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayHit {
    /// Parameter on the ray (distance, as directions have unit length); may be negative.
    pub t: f64,
    /// The face it lies on, as given to [`Raycaster::new`].
    pub face: usize,
    /// The patch, by position in the list given to [`Raycaster::new`].
    pub patch: usize,
    /// Native surface parameters.
    pub uv: DVec2,
    /// The point of the surface.
    pub point: DVec3,
    /// `du x dv` there, not normalised; zero at poles.
    pub normal: DVec3,
    /// Distance of `point` from the ray, model units.
    pub residual: f64,
    /// Whether the ray is tangent there (up to rounding), so that the hit may stand for two.
    pub tangent: bool,
}

/// The hits of one ray.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RayHits {
    /// Sorted by `t`, then by face.
    pub hits: Vec<RayHit>,
    /// Whether the search ended on all patches; it does not where the ray runs inside a surface.
    pub complete: bool,
}

/// Patches made ready for ray casting.
#[derive(Debug, Clone)]
pub struct Raycaster {
    patches: Vec<(usize, BezierPatch)>,
    tree: BoundsTree,
}

impl Raycaster {
    /// Takes patches with the number of the face that each belongs to.
    pub fn new(patches: Vec<(usize, BezierPatch)>) -> Self {
        let bounds: Vec<Bounds> = patches.iter().map(|(_, p)| p.bounds()).collect();
        Self { tree: BoundsTree::new(&bounds), patches }
    }

    /// The patches with their faces.
    pub fn patches(&self) -> &[(usize, BezierPatch)] {
        &self.patches
    }

    /// The box around all control points.
    pub fn bounds(&self) -> Bounds {
        self.tree.bounds()
    }

    /// All hits of the whole line of `ray` with the untrimmed patches, negative `t` included.
    pub fn hits(&self, ray: &Ray) -> RayHits {
        let mut result = RayHits { hits: Vec::new(), complete: true };
        let mut solver = LineSolver::default();
        let size = self.bounds().diagonal() + (self.bounds().centre() - ray.origin).length();
        let margin = 1e-12 * size;
        self.tree.along_line(ray, margin, |index| {
            let (face, patch) = &self.patches[index];
            let (roots, complete) = solver.solve(patch, ray);
            result.complete &= complete;
            result.hits.extend(roots.iter().map(|root| hit(patch, ray, *root, *face, index)));
        });
        result.hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.face.cmp(&b.face)).then(a.patch.cmp(&b.patch)));
        merge(&mut result.hits, 1e-10 * size);
        result
    }
}

/// All hits of the line of `ray` with one patch; `face` and `patch` of the hits are 0.
pub fn patch_hits(patch: &BezierPatch, ray: &Ray) -> RayHits {
    let mut solver = LineSolver::default();
    let (roots, complete) = solver.solve(patch, ray);
    let mut hits: Vec<RayHit> = roots.iter().map(|root| hit(patch, ray, *root, 0, 0)).collect();
    hits.sort_by(|a, b| a.t.total_cmp(&b.t));
    RayHits { hits, complete }
}

/// Polishes `root` on the patch itself.
fn hit(patch: &BezierPatch, ray: &Ray, root: LineRoot, face: usize, index: usize) -> RayHit {
    let off = |p: DVec3| {
        let offset = p - ray.origin;
        offset - ray.direction * offset.dot(ray.direction)
    };
    let mut uv = root.uv;
    let mut at = patch.tangents(uv.x, uv.y);
    let mut residual = off(at.point).length();
    for _ in 0..3 {
        if residual == 0.0 {
            break;
        }
        let normal = at.du.cross(at.dv);
        let slope = normal.dot(ray.direction);
        // Where the line meets the tangent plane, in the plane's own coordinates (Cramer's rule).
        let target = off(at.point);
        let step = DVec2::new(at.dv.cross(target).dot(ray.direction), target.cross(at.du).dot(ray.direction))
            / slope;
        if !step.is_finite() {
            break;
        }
        let next = (uv + step).clamp(DVec2::ZERO, DVec2::ONE);
        let moved = patch.tangents(next.x, next.y);
        let distance = off(moved.point).length();
        if distance.is_nan() || distance >= residual {
            break;
        }
        (uv, at, residual) = (next, moved, distance);
    }
    RayHit {
        t: (at.point - ray.origin).dot(ray.direction),
        face,
        patch: index,
        uv: patch.native(uv),
        point: at.point,
        normal: at.du.cross(at.dv),
        residual,
        tangent: !root.simple,
    }
}

/// Takes out hits of one face at one point: found on both patches along an edge, a seam, at a pole.
fn merge(hits: &mut Vec<RayHit>, tolerance: f64) {
    let mut kept: Vec<RayHit> = Vec::with_capacity(hits.len());
    for hit in hits.drain(..) {
        let known = kept.iter().rev().take_while(|k| hit.t - k.t <= tolerance);
        let mut twins = known.filter(|k| k.face == hit.face);
        if !twins.any(|k| (k.point - hit.point).length() <= tolerance) {
            kept.push(hit);
        }
    }
    *hits = kept;
}
