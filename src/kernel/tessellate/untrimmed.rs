//! The untrimmed surface of a face as triangles over the cells of its kd-tree, for a renderer that trims per
//! fragment.
//!
//! Cells over the box of the loops become convex polygons that hold all corners of their neighbours on their sides, so
//! that there are no cracks inside a face, and are triangulated in parameters (P2, section 7). Parameters, positions and
//! normals come per vertex.

use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

use super::coherence::CoherentPoints;
use super::kd_tree::{self, CellLimits};
use super::options::{TessellateError, TessellationOptions};
use super::outline::Ground;
use crate::kernel::bezier::Tangents;
use crate::kernel::face::Face;
use crate::kernel::trim::UvRect;

/// Triangles that cover the parameter rectangle of a face.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct UntrimmedMesh {
    /// Native parameters of each vertex.
    pub uvs: Vec<DVec2>,
    /// Points of the surface.
    pub positions: Vec<DVec3>,
    /// Unit normals along `du x dv`.
    pub normals: Vec<DVec3>,
    /// Vertices of each triangle, counter-clockwise in (u, v).
    pub triangles: Vec<[u32; 3]>,
    /// Number of cells of the tree.
    pub cells: usize,
}

/// The surface of `face` over the box of its loops, within `options.tolerance`; its trims are left out. Uses
/// `tolerance`, `conservative`, `surface_division` and `triangle_limit`.
///
/// # Errors
/// See [`TessellateError`].
pub fn untrimmed(face: &Face, options: &TessellationOptions) -> Result<UntrimmedMesh, TessellateError> {
    untrimmed_over(face, &face.domain, options)
}

/// As [`untrimmed`] over a part `rect` of the box of its loops.
///
/// # Errors
/// See [`TessellateError`].
pub fn untrimmed_over(
    face: &Face,
    rect: &UvRect,
    options: &TessellationOptions,
) -> Result<UntrimmedMesh, TessellateError> {
    options.check()?;
    let ground = Ground::new(face);
    if face.patches.is_empty() {
        return Err(TessellateError::Empty);
    }
    let limits = CellLimits {
        tolerance: options.tolerance,
        conservative: options.conservative,
        division: options.surface_division,
        most: options.triangle_limit / 2,
    };
    let cells = kd_tree::leaves(&ground, rect, &limits)?;
    let mut mesh = UntrimmedMesh { cells: cells.len(), ..UntrimmedMesh::default() };
    let corners = CornerIndex::new(&cells, &mut mesh.uvs);
    for (number, cell) in cells.iter().enumerate() {
        let polygon = corners.polygon(cell, number);
        triangulate(&polygon, &mesh.uvs, &mut mesh.triangles);
    }
    let slightly_in = 1e-6 * face.domain.size();
    // Corners come sorted by v.
    let mut points = CoherentPoints::new(&ground);
    for uv in &mesh.uvs {
        let at = points.tangents(*uv);
        mesh.positions.push(at.point);
        let normal = upright(&at, face.domain.size())
            .unwrap_or_else(|| normal(&ground, *uv, &face.domain, slightly_in));
        mesh.normals.push(normal);
    }
    Ok(mesh)
}

/// The unit normal at `uv`; where there is none (a pole), that of a point slightly inside.
pub(super) fn normal(ground: &Ground, uv: DVec2, domain: &UvRect, slightly: DVec2) -> DVec3 {
    if let Some(normal) = upright(&ground.tangents(uv), domain.size()) {
        return normal;
    }
    let middle = 0.5 * (domain.min + domain.max);
    let mut step = slightly;
    for _ in 0..4 {
        let inward = DVec2::new(step.x.copysign(middle.x - uv.x), step.y.copysign(middle.y - uv.y));
        let at = ground.tangents(uv + inward);
        let cross = at.du.cross(at.dv);
        if let Some(normal) = cross.try_normalize() {
            return normal;
        }
        step *= 32.0;
    }
    DVec3::Z
}

/// The unit normal, where derivatives give one: not where one of them, over the `size` of the domain, is as good as nothing
/// (a pole as files have it, with rounding of any direction).
pub(super) fn upright(at: &Tangents, size: DVec2) -> Option<DVec3> {
    /// What is this part of the other is nothing.
    const ROUNDING: f64 = 1e-7;
    let cross = at.du.cross(at.dv);
    let (along, across) = (at.du.length(), at.dv.length());
    let (u, v) = (along * size.x, across * size.y);
    (cross.length() > 1e-9 * along * across && u.min(v) > ROUNDING * u.max(v)).then(|| cross.normalize())
}

/// Corners of all cells, found along lines of constant u and of constant v.
struct CornerIndex {
    ids: Vec<[u32; 4]>,
    /// For each u (in bits): `(v, vertex)`, sorted.
    on_u: BTreeMap<u64, Vec<(f64, u32)>>,
    /// For each v: `(u, vertex)`.
    on_v: BTreeMap<u64, Vec<(f64, u32)>>,
}

impl CornerIndex {
    fn new(cells: &[UvRect], uvs: &mut Vec<DVec2>) -> Self {
        let mut corners: Vec<(DVec2, usize, usize)> = Vec::with_capacity(4 * cells.len());
        for (number, cell) in cells.iter().enumerate() {
            corners.extend(cell.corners().into_iter().enumerate().map(|(k, p)| (p, number, k)));
        }
        corners.sort_by(|a, b| a.0.y.total_cmp(&b.0.y).then(a.0.x.total_cmp(&b.0.x)));
        let mut index = Self { ids: vec![[0; 4]; cells.len()], on_u: BTreeMap::new(), on_v: BTreeMap::new() };
        for (p, number, k) in corners {
            if uvs.last() != Some(&p) {
                let id = uvs.len() as u32;
                uvs.push(p);
                index.on_u.entry(p.x.to_bits()).or_default().push((p.y, id));
                index.on_v.entry(p.y.to_bits()).or_default().push((p.x, id));
            }
            index.ids[number][k] = uvs.len() as u32 - 1;
        }
        index
    }

    /// Vertices round a cell, counter-clockwise from its lowest corner.
    fn polygon(&self, cell: &UvRect, number: usize) -> Vec<u32> {
        let between = |lines: &BTreeMap<u64, Vec<(f64, u32)>>, line: f64, low: f64, high: f64| -> Vec<u32> {
            let Some(all) = lines.get(&line.to_bits()) else { return Vec::new() };
            let (from, to) = (all.partition_point(|e| e.0 <= low), all.partition_point(|e| e.0 < high));
            all[from..to.max(from)].iter().map(|e| e.1).collect()
        };
        let (min, max) = (cell.min, cell.max);
        let ids = self.ids[number];
        let mut polygon = vec![ids[0]];
        polygon.extend(between(&self.on_v, min.y, min.x, max.x));
        polygon.push(ids[1]);
        polygon.extend(between(&self.on_u, max.x, min.y, max.y));
        polygon.push(ids[2]);
        polygon.extend(between(&self.on_v, max.y, min.x, max.x).into_iter().rev());
        polygon.push(ids[3]);
        polygon.extend(between(&self.on_u, min.x, min.y, max.y).into_iter().rev());
        polygon
    }
}

/// Ears of a convex polygon with vertices on its sides, the roundest first.
fn triangulate(polygon: &[u32], uvs: &[DVec2], triangles: &mut Vec<[u32; 3]>) {
    let mut rest = polygon.to_vec();
    let first = uvs[rest[0] as usize];
    let span = rest.iter().fold(DVec2::ZERO, |s, i| s.max((uvs[*i as usize] - first).abs()));
    let scaled = |i: u32| (uvs[i as usize] - first) / span;
    while rest.len() > 3 {
        let count = rest.len();
        let quality = |k: usize| {
            let [a, b, c] = [rest[(k + count - 1) % count], rest[k], rest[(k + 1) % count]].map(scaled);
            let area = (b - a).perp_dot(c - a);
            let longest =
                (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
            // An ear must not leave only points of one side.
            let leaves_area = (0..count).any(|j| {
                let (p, q) = (rest[j], rest[(j + 1) % count]);
                j != k && (j + 1) % count != k && (scaled(p) - a).perp_dot(scaled(q) - a).abs() > 0.0
            });
            if area > 0.0 && leaves_area { area / longest } else { 0.0 }
        };
        let best = (0..count).max_by(|a, b| quality(*a).total_cmp(&quality(*b))).unwrap_or(0);
        triangles.push([rest[(best + count - 1) % count], rest[best], rest[(best + 1) % count]]);
        rest.remove(best);
    }
    triangles.push([rest[0], rest[1], rest[2]]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pole_with_rounding_has_the_normal_of_its_surroundings() {
        let (du, dv) = (DVec3::new(0.0, 3e-16, 2e-16), DVec3::X);
        let at = Tangents { point: DVec3::ZERO, du, dv };
        assert_eq!(upright(&at, DVec2::new(std::f64::consts::TAU, 1.0)), None);
        // As short for its parameter, but that goes far.
        let normal = upright(&at, DVec2::new(1e16, 1.0)).expect("a normal");
        assert!((normal - du.cross(dv).normalize()).length() < 1e-15);
    }
}
