//! Triangles made smaller along trim curves, so that most of a face is kept whole and needs no trimming per pixel.
//!
//! A triangle that a trim curve passes through is halved across its longest side, and with it whoever shares that side
//! (M. C. Rivara, 1984), so that no vertex ever lies inside another's side. New vertices are middles of sides: the
//! triangles show what they showed before, to rounding.

use std::collections::{HashMap, VecDeque};

use super::lone_curve::TriangleTrim;
use crate::kernel::face::Face;
use crate::kernel::tessellate::UntrimmedMesh;

/// Triangles of an untrimmed face with what the trims leave of each.
#[derive(Debug, Clone, Default)]
pub struct SortedMesh {
    /// Vertices and triangles; normals of new vertices are no units.
    pub mesh: UntrimmedMesh,
    /// Of each triangle.
    pub trims: Vec<TriangleTrim>,
}

/// Sorts the triangles of `mesh` by what the trims of `face` leave of them, and halves those that trims pass through until
/// their sides are no longer than `length` (model units) or there are `most` triangles.
pub fn sort_triangles(mesh: UntrimmedMesh, face: &Face, length: f64, most: usize) -> SortedMesh {
    let mut work =
        Bisection { mesh, trims: Vec::new(), sides: HashMap::new(), waiting: VecDeque::new(), face, length };
    for k in 0..work.mesh.triangles.len() {
        let found = work.look(k);
        work.trims.push(found);
        for side in sides(work.mesh.triangles[k]) {
            work.sides.entry(side).or_default().push(k);
        }
        work.wait(k);
    }
    while let Some(k) = work.waiting.pop_front() {
        if work.mesh.triangles.len() >= most {
            break;
        }
        if let Some(side) = work.long_side(k) {
            work.halve(side);
        }
    }
    SortedMesh { mesh: work.mesh, trims: work.trims }
}

/// A side, smaller vertex first.
type Side = [u32; 2];

fn side(a: u32, b: u32) -> Side {
    [a.min(b), a.max(b)]
}

fn sides([a, b, c]: [u32; 3]) -> [Side; 3] {
    [side(a, b), side(b, c), side(c, a)]
}

struct Bisection<'a> {
    mesh: UntrimmedMesh,
    trims: Vec<TriangleTrim>,
    /// The triangles at a side. Only looked into: its order decides nothing.
    sides: HashMap<Side, Vec<usize>>,
    waiting: VecDeque<usize>,
    face: &'a Face,
    length: f64,
}

impl Bisection<'_> {
    fn look(&self, k: usize) -> TriangleTrim {
        let uv = self.mesh.triangles[k].map(|c| self.face.domain.normalise(self.mesh.uvs[c as usize]));
        TriangleTrim::of(&self.face.grid, uv)
    }

    fn wait(&mut self, k: usize) {
        if self.long_side(k).is_some() {
            self.waiting.push_back(k);
        }
    }

    /// The longest side of a triangle that trims pass through, if it is too long.
    fn long_side(&self, k: usize) -> Option<Side> {
        if !self.trims[k].is_mixed() {
            return None;
        }
        let length = |s: &Side| {
            let [a, b] = s.map(|c| self.mesh.positions[c as usize]);
            (b - a).length_squared()
        };
        let longest =
            sides(self.mesh.triangles[k]).into_iter().max_by(|a, b| length(a).total_cmp(&length(b)))?;
        (length(&longest) > self.length * self.length).then_some(longest)
    }

    /// Halves the triangles at a side.
    fn halve(&mut self, [a, b]: Side) {
        let (i, j) = (a as usize, b as usize);
        let middle = self.mesh.uvs.len() as u32;
        self.mesh.uvs.push(0.5 * (self.mesh.uvs[i] + self.mesh.uvs[j]));
        self.mesh.positions.push(0.5 * (self.mesh.positions[i] + self.mesh.positions[j]));
        self.mesh.normals.push(0.5 * (self.mesh.normals[i] + self.mesh.normals[j]));
        for k in self.sides.remove(&[a, b]).unwrap_or_default() {
            let old = self.mesh.triangles[k];
            let with = |from: u32| old.map(|c| if c == from { middle } else { c });
            let (first, second) = (with(b), with(a));
            let new = self.mesh.triangles.len();
            self.mesh.triangles[k] = first;
            self.mesh.triangles.push(second);
            for s in sides(second) {
                let there = self.sides.entry(s).or_default();
                there.retain(|t| *t != k);
                there.push(new);
            }
            for s in sides(first) {
                let there = self.sides.entry(s).or_default();
                if !there.contains(&k) {
                    there.push(k);
                }
            }
            let inherited = self.trims[k];
            self.trims.push(inherited);
            if inherited.is_mixed() {
                for half in [k, new] {
                    self.trims[half] = self.look(half);
                    self.wait(half);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encoding::piece_mesh::surface;
    use crate::kernel::trim::TrimStructure;
    use crate::scene::demo;
    use glam::DVec2;

    fn double_area(mesh: &UntrimmedMesh, triangle: [u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|k| mesh.uvs[k as usize]);
        (b - a).perp_dot(c - a)
    }

    #[test]
    fn no_corner_lies_inside_a_side_and_nothing_is_lost() {
        let faces = demo::model().faces;
        let mut divided = 0;
        for record in faces.iter().filter(|f| !f.loops.is_empty()).take(12) {
            let face = record.derive().expect("valid test data");
            let Ok(whole) = surface(&face, &face.domain, -4, 60_000) else { continue };
            let area: f64 = whole.triangles.iter().map(|t| double_area(&whole, *t)).sum();
            let sorted = sort_triangles(whole.clone(), &face, 0.3, 60_000);
            let mesh = &sorted.mesh;
            divided += usize::from(mesh.triangles.len() > whole.triangles.len());
            assert_eq!(mesh.triangles.len(), sorted.trims.len());
            let after: f64 = mesh.triangles.iter().map(|t| double_area(mesh, *t)).sum();
            assert!((after - area).abs() <= 1e-9 * area.abs(), "{after} of {area}");
            assert!(mesh.triangles.iter().all(|t| double_area(mesh, *t) > 0.0), "none is turned over");
            // Every side has two triangles, or lies on the border of the parameter rectangle.
            let mut counts: HashMap<Side, usize> = HashMap::new();
            mesh.triangles.iter().flat_map(|t| sides(*t)).for_each(|s| *counts.entry(s).or_default() += 1);
            let (min, max) = (face.domain.min, face.domain.max);
            for ([a, b], count) in counts {
                let [p, q] = [a, b].map(|k| mesh.uvs[k as usize]);
                let on =
                    |get: fn(DVec2) -> f64| get(p) == get(q) && (get(p) == get(min) || get(p) == get(max));
                assert!(count == 2 || count == 1 && (on(|p| p.x) || on(|p| p.y)), "{count} at {p} {q}");
            }
            for (triangle, trim) in mesh.triangles.iter().zip(&sorted.trims) {
                let [a, b, c] = triangle.map(|k| face.domain.normalise(mesh.uvs[k as usize]));
                for (s, t) in [(0.1, 0.1), (0.8, 0.1), (0.1, 0.8), (0.33, 0.33)] {
                    let kept = face.grid.classify((a + (b - a) * s + (c - a) * t).as_vec2());
                    assert!(trim.is_mixed() || kept == (*trim == TriangleTrim::Whole));
                }
            }
        }
        assert!(divided > 3, "{divided}");
    }
}
