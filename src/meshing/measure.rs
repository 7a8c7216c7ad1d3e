//! The true distance between a mesh and the exact faces, by dense samples.
//!
//! From the mesh: points of every triangle against the trimmed face: the nearest point of its surface, found by Newton's
//! method from the triangle's own parameters, or where that lies outside the trims the nearest point of the outline. From the
//! face: points inside the trims and of the outline against the nearest triangle. A distance counts only after the whole
//! surface was searched for a nearer point, so that what is found is a lower bound of the true distance, which tends to it
//! with more samples.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::model_mesh::ModelMesh;
use crate::kernel::bezier::BezierCurve3;
use crate::kernel::face::{Face, Side};
use crate::kernel::query::{BoundsTree, Locator, closer_on_surface};
use crate::kernel::tessellate::line_error::distance_to_segment;
use crate::kernel::tessellate::outline::LiftedPiece;
use crate::kernel::tessellate::{FaceMesh, Ground, Outline};
use crate::kernel::view::Bounds;

/// Distances between a mesh and a model.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Distance {
    /// Largest distance from a point of the mesh to the trimmed face.
    pub mesh_to_surface: f64,
    /// Largest distance from a point of a face to its mesh.
    pub surface_to_mesh: f64,
    /// Where the larger of the two was found.
    #[serde(skip)]
    pub place: DVec3,
    /// Samples taken.
    pub samples: usize,
}

impl Distance {
    /// The larger of the two: the Hausdorff distance as far as sampled.
    pub fn largest(&self) -> f64 {
        self.mesh_to_surface.max(self.surface_to_mesh)
    }

    fn note(&mut self, mesh_to_surface: f64, surface_to_mesh: f64, place: DVec3) {
        if mesh_to_surface.max(surface_to_mesh) > self.largest() {
            self.place = place;
        }
        self.mesh_to_surface = self.mesh_to_surface.max(mesh_to_surface);
        self.surface_to_mesh = self.surface_to_mesh.max(surface_to_mesh);
    }

    /// The distance of two meshes from two faces together.
    pub fn join(self, other: Self) -> Self {
        Self {
            place: if other.largest() > self.largest() { other.place } else { self.place },
            mesh_to_surface: self.mesh_to_surface.max(other.mesh_to_surface),
            surface_to_mesh: self.surface_to_mesh.max(other.surface_to_mesh),
            samples: self.samples + other.samples,
        }
    }
}

/// Measures `mesh` against `faces` with about `density` samples along each edge of a triangle, at most
/// `most_per_face` from each side of a face.
pub fn measure(faces: &[Option<&Face>], mesh: &ModelMesh, density: usize, most_per_face: usize) -> Distance {
    let each = measure_each(faces, mesh, density, most_per_face);
    each.into_iter().flatten().fold(Distance::default(), Distance::join)
}

/// The same face by face; `None` for those without a mesh.
pub fn measure_each(
    faces: &[Option<&Face>],
    mesh: &ModelMesh,
    density: usize,
    most_per_face: usize,
) -> Vec<Option<Distance>> {
    faces
        .par_iter()
        .zip(&mesh.faces)
        .map(|(face, mesh)| Some(measure_face((*face)?, mesh.as_ref().ok()?, density, most_per_face)))
        .collect()
}

/// The same for one face.
pub fn measure_face(face: &Face, mesh: &FaceMesh, density: usize, most: usize) -> Distance {
    let target = Target::new(face);
    let mut distance = Distance::default();
    let boxes: Vec<Bounds> =
        mesh.triangles.iter().map(|t| Bounds::of(t.map(|v| mesh.positions[v as usize]))).collect();
    let tree = BoundsTree::new(&boxes);
    let per_triangle = (density + 1) * (density + 2) / 2;
    let skip = (mesh.triangles.len() * per_triangle / most.max(1)).max(1);
    for triangle in mesh.triangles.iter().step_by(skip) {
        let p = triangle.map(|v| mesh.positions[v as usize]);
        let uv = triangle.map(|v| mesh.uvs[v as usize]);
        for i in 0..=density {
            for j in 0..=density - i {
                let l = [i as f64, j as f64, (density - i - j) as f64].map(|x| x / density as f64);
                let at = p[0] * l[0] + p[1] * l[1] + p[2] * l[2];
                let start = uv[0] * l[0] + uv[1] * l[1] + uv[2] * l[2];
                let (foot, from_face) = target.offer(at, start, distance.mesh_to_surface);
                distance.note(from_face, 0.0, at);
                distance.samples += 1;
                // The surface's own points near the foot against the mesh.
                if target.locator.classify_native(foot.x, foot.y) == Side::In {
                    let p = target.ground.point(foot);
                    distance.note(0.0, to_mesh(mesh, &tree, p), p);
                }
            }
        }
    }
    let side =
        ((most as f64).sqrt() as usize).clamp(4, 40 + 2 * (mesh.triangles.len() as f64).sqrt() as usize);
    for k in 0..side * side {
        let share = DVec2::new((k % side) as f64 + 0.5, (k / side) as f64 + 0.5) / side as f64;
        let uv = face.domain.native(share);
        if target.locator.classify_native(uv.x, uv.y) == Side::In {
            let p = target.ground.point(uv);
            distance.note(0.0, to_mesh(mesh, &tree, p), p);
            distance.samples += 1;
        }
    }
    let skip = (target.points.len() / most.max(1)).max(1);
    for p in target.points.iter().step_by(skip) {
        distance.note(0.0, to_mesh(mesh, &tree, *p), *p);
        distance.samples += 1;
    }
    distance
}

/// A trimmed face to measure from: its surface and its outline as a fine polyline.
pub(super) struct Target<'a> {
    face: &'a Face,
    locator: Locator,
    ground: Ground<'a>,
    /// Points of the outline.
    points: Vec<DVec3>,
    curves: Vec<BezierCurve3>,
    /// Parts of the outline: curve and parameters.
    parts: Vec<(usize, f64, f64)>,
    /// Boxes of the parts.
    tree: BoundsTree,
}

/// Parts of a piece of the outline.
const PARTS: usize = 16;
/// Steps along a part, between which there is one nearest point at most.
const STARTS: usize = 8;

impl<'a> Target<'a> {
    pub(super) fn new(face: &'a Face) -> Self {
        let locator = Locator::new(face.clone());
        let ground = Ground::new(face);
        let outline = Outline::new(face, &ground, 1e-6 * face.bounds.diagonal());
        let pieces: Vec<&LiftedPiece> = outline.runs().flat_map(|(_, _, run)| &run.pieces).collect();
        let curves: Vec<BezierCurve3> = pieces.iter().map(|p| p.space.clone()).collect();
        let (mut points, mut parts, mut boxes) = (Vec::new(), Vec::new(), Vec::new());
        for (number, piece) in pieces.iter().enumerate() {
            let curve = &piece.space;
            let count = if curve.degree() == 1 { 2 } else { PARTS };
            for k in 0..count {
                let (from, to) = (k as f64 / count as f64, (k + 1) as f64 / count as f64);
                if bounds_face(&locator, piece, from) {
                    points.push(curve.point(from));
                } else if !bounds_face(&locator, piece, 0.5 * (from + to))
                    && !bounds_face(&locator, piece, to)
                {
                    continue;
                }
                parts.push((number, from, to));
                boxes.push(Bounds::of(curve.restrict(from, to).points));
            }
        }
        let tree = BoundsTree::new(&boxes);
        Self { face, locator, ground, points, curves, parts, tree }
    }

    /// Foot of `p` on the surface, searched from `start`, and the distance of `p` from the trimmed face where that is more than
    /// `most`.
    pub(super) fn offer(&self, p: DVec3, start: DVec2, most: f64) -> (DVec2, f64) {
        let (mut foot, off) = project(&self.ground, p, start);
        let outside = |foot: DVec2| self.locator.classify_native(foot.x, foot.y) != Side::In;
        let from_face =
            |foot: DVec2, off: f64| if outside(foot) { off.max(self.off_outline(p)) } else { off };
        let mut found = from_face(foot, off);
        if found > most
            && let Some(nearest) = closer_on_surface(&self.face.patches, p, found)
        {
            if nearest.distance < off {
                foot = nearest.uv;
            }
            found = found.min(from_face(nearest.uv, nearest.distance));
        }
        (foot, found)
    }

    /// Distance of `p` from the outline.
    fn off_outline(&self, p: DVec3) -> f64 {
        let nearest = self.tree.nearest(p, |k| self.off_part(p, k));
        // Without an outline nothing is off it.
        if nearest.is_finite() { nearest } else { 0.0 }
    }

    /// Distance of `p` from a part of the outline.
    fn off_part(&self, p: DVec3, part: usize) -> f64 {
        let (curve, start, end) = self.parts[part];
        let curve = &self.curves[curve];
        if curve.degree() == 1 {
            return distance_to_segment(p, curve.point(start), curve.point(end));
        }
        // A part of an edge that swings (a loft through many sections) has more than one place that is nearest around it.
        let step = (end - start) / STARTS as f64;
        let offs: [f64; STARTS + 1] =
            std::array::from_fn(|k| curve.point(start + k as f64 * step).distance(p));
        let beside = |k: usize| offs[k.saturating_sub(1)].min(offs[(k + 1).min(STARTS)]);
        let around = (0..=STARTS).filter(|k| offs[*k] <= beside(*k)).map(|k| start + k as f64 * step);
        around
            .map(|t| off_around(curve, p, (t - step).max(start), (t + step).min(end)))
            .chain(offs)
            .fold(f64::INFINITY, f64::min)
    }
}

/// Distance of `p` from a curve between two parameters, with one nearest point between them.
fn off_around(curve: &BezierCurve3, p: DVec3, mut from: f64, mut to: f64) -> f64 {
    let (start, end) = (from, to);
    let off = |t: f64| curve.point(t).distance(p);
    for _ in 0..6 {
        let third = (to - from) / 3.0;
        if off(from + third) < off(to - third) {
            to -= third;
        } else {
            from += third;
        }
    }
    // From here Newton's method is quicker.
    let mut best = f64::INFINITY;
    let mut t = 0.5 * (from + to);
    for _ in 0..6 {
        let jet = curve.jet(t);
        let off = jet.point - p;
        best = best.min(off.length());
        let plain = jet.d1.length_squared();
        let full = plain + off.dot(jet.d2);
        let step = -off.dot(jet.d1) / if full > 0.0 { full } else { plain };
        if !step.is_finite() {
            break;
        }
        t = (t + step).clamp(start, end);
    }
    best.min(off(t))
}

/// Whether the face is on either side of its outline at `t` of a piece. Where two loops run along each other (a hole that ends
/// on the rim of the surface, or beyond it) it is on neither, and the outline there is no part of it.
fn bounds_face(locator: &Locator, piece: &LiftedPiece, t: f64) -> bool {
    /// How far aside is looked, as a part of the domain: far enough to be answered at once.
    const ASIDE: f64 = 5e-6;
    let (at, along) = piece.uv.tangent(t);
    let size = locator.face().domain.size();
    let across = ASIDE * size * (along / size).perp().normalize_or(DVec2::X);
    [at + across, at - across].iter().any(|p| locator.classify_native(p.x, p.y) == Side::In)
}

/// Foot of `p` on the surface, going downhill from `start`; and the distance.
fn project(ground: &Ground, p: DVec3, start: DVec2) -> (DVec2, f64) {
    let mut uv = start;
    let mut best = ground.point(uv).distance(p);
    for _ in 0..10 {
        let at = ground.tangents(uv);
        let off = p - at.point;
        let (a, b, c) = (at.du.dot(at.du), at.du.dot(at.dv), at.dv.dot(at.dv));
        let (x, y) = (off.dot(at.du), off.dot(at.dv));
        let det = a * c - b * b;
        let mut step =
            if det > 1e-14 * a * c { DVec2::new(c * x - b * y, a * y - b * x) / det } else { DVec2::ZERO };
        let mut moved = false;
        for _ in 0..5 {
            let next = uv + step;
            let distance = ground.point(next).distance(p);
            if distance < best {
                moved = best - distance > 1e-9 * best;
                (uv, best) = (next, distance);
                break;
            }
            step *= 0.3;
        }
        if !moved {
            break;
        }
    }
    (uv, best)
}

/// Distance of `p` from the nearest triangle.
fn to_mesh(mesh: &FaceMesh, tree: &BoundsTree, p: DVec3) -> f64 {
    tree.nearest(p, |k| to_triangle(p, mesh.triangles[k].map(|v| mesh.positions[v as usize])))
}

/// Distance of a point from a triangle (Ericson 2005, section 5.1.5).
fn to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let normal = ab.cross(ac);
    let squared = normal.length_squared();
    if squared > 0.0 {
        let v = normal.dot(ap.cross(ac)) / squared;
        let w = normal.dot(ab.cross(ap)) / squared;
        if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
            return normal.dot(ap).abs() / squared.sqrt();
        }
    }
    distance_to_segment(p, a, b).min(distance_to_segment(p, b, c)).min(distance_to_segment(p, c, a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
    use crate::kernel::tessellate::{TessellationOptions, tessellate};
    use crate::kernel::trim::loop_record::{LoopRecord, LoopRole};

    fn knots() -> KnotVector {
        KnotVector::new(1, vec![0.0, 0.0, 1.0, 1.0]).expect("knots")
    }

    /// A closed loop of lines.
    fn lines(role: LoopRole, corners: &[(f64, f64)]) -> LoopRecord {
        let at = |k: usize| DVec2::from(corners[k % corners.len()]);
        let line = |k| NurbsCurve2::new(knots(), vec![at(k), at(k + 1)], vec![1.0; 2]).expect("a line");
        LoopRecord::new(role, (0..corners.len()).map(line).collect())
    }

    #[test]
    fn where_a_hole_ends_on_the_rim_the_rim_is_no_part_of_the_face() {
        let points = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let surface = NurbsSurface::new(knots(), knots(), points.to_vec(), vec![1.0; 4]).expect("a surface");
        let rim = lines(LoopRole::Outer, &[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        for below in [0.0, -0.3] {
            let hole = [(0.4, below), (0.4, 0.5), (0.6, 0.5), (0.6, below)];
            let hole = lines(LoopRole::Inner, &hole);
            let face = Face::derive(&surface, &[rim.clone(), hole]).expect("a face");
            let mesh = tessellate(&face, &TessellationOptions::new(1e-3)).expect("a mesh");
            assert!((mesh.area() - 0.9).abs() < 1e-6, "{}", mesh.area());
            let found = measure_face(&face, &mesh, 4, 4000);
            assert!(found.largest() < 1e-6, "{found:?}");
        }
    }

    #[test]
    fn an_edge_that_swings_is_as_near_as_its_nearest_swing() {
        let points = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let surface = NurbsSurface::new(knots(), knots(), points.to_vec(), vec![1.0; 4]).expect("a surface");
        let face = Face::derive(&surface, &[]).expect("a face");
        let mut target = Target::new(&face);
        let heights = [0.0, 5.0, -9.0, 9.0, -5.0, 0.0];
        let swings = (0..6).map(|k| DVec3::new(f64::from(k), heights[k as usize], 0.0)).collect();
        let curve = BezierCurve3 { points: swings, weights: vec![1.0; 6] };
        target.tree = BoundsTree::new(&[Bounds::of(curve.points.iter().copied())]);
        (target.curves, target.parts) = (vec![curve.clone()], vec![(0, 0.0, 1.0)]);
        for k in 0..60 {
            let p = DVec3::new(0.1 * f64::from(k), (f64::from(k) * 0.7).sin(), 0.2);
            let dense = (0..=20_000).map(|i| curve.point(f64::from(i) / 2e4).distance(p));
            let dense = dense.fold(f64::INFINITY, f64::min);
            let found = target.off_outline(p);
            assert!((found - dense).abs() < 1e-5, "{p}: {found} for {dense}");
        }
    }
}
