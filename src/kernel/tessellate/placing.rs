//! Where vertices of a mesh in the making are put: on the surface, on chords shared with neighbours, or off the surface on the
//! side where triangles are nearer to it (module `balance`).

use std::cell::RefCell;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use glam::{DVec2, DVec3};
use spade::handles::FixedVertexHandle;

use super::balance::{Bend, OF_DISTANCE};
use super::chords::EdgeSample;
use super::refine::Refinement;
use super::triangulate::Region;
use super::untrimmed::{normal, upright};

/// Vertices of a mesh in the making.
#[derive(Debug, Clone, Default)]
pub struct Vertices {
    /// Native parameters.
    pub uvs: Vec<DVec2>,
    /// Points of the surface there.
    pub on_surface: Vec<DVec3>,
    /// Positions in the mesh: shared ones on the boundary.
    pub positions: Vec<DVec3>,
    /// The same straight above the points of the surface: what a vertex lies aside makes no triangle worse.
    pub upright: Vec<DVec3>,
    /// Unit normals of the surface.
    pub normals: Vec<DVec3>,
    /// How far shared positions lie off the surface by no choice of ours.
    pub gaps: Vec<f64>,
    /// How many, from the first on, belong to the boundary.
    pub fixed: usize,
}

impl Vertices {
    /// None yet, with room for `count`.
    pub(super) fn with_capacity(count: usize) -> Self {
        Self {
            uvs: Vec::with_capacity(count),
            on_surface: Vec::with_capacity(count),
            positions: Vec::with_capacity(count),
            upright: Vec::with_capacity(count),
            normals: Vec::with_capacity(count),
            gaps: Vec::with_capacity(count),
            fixed: 0,
        }
    }

    /// Puts a vertex inside nearer to the surface, where it is farther off than `most`.
    pub(super) fn lower(&mut self, k: usize, most: f64) -> bool {
        let p = self.on_surface[k];
        let off = self.upright[k] - p;
        let far = off.length();
        if !(far > most) || k < self.fixed {
            return false;
        }
        self.upright[k] = p + off * (most / far);
        self.positions[k] = self.upright[k];
        true
    }
}

/// Points by pairs of numbers.
pub type Middles = RefCell<HashMap<u64, DVec3, BuildHasherDefault<PairHasher>>>;

/// Mixes the bits of one number: pairs of vertices are even enough for no more.
#[derive(Debug, Clone, Copy, Default)]
pub struct PairHasher(u64);

impl Hasher for PairHasher {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|b| self.write_u64(u64::from(*b)));
    }
    fn write_u64(&mut self, x: u64) {
        let mixed = (self.0 ^ x).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ (mixed >> 32);
    }
}

impl Refinement<'_> {
    /// Keeps a new vertex and its neighbours from standing off the surface by much of their distance: triangles would lean.
    /// Adds the triangles round neighbours that are put nearer to `around`.
    pub(super) fn settle(
        &self,
        region: &Region,
        vertices: &mut Vertices,
        number: u32,
        around: &mut Vec<[FixedVertexHandle; 3]>,
    ) {
        for k in 0..around.len() {
            for corner in around[k] {
                let other = region.number(corner);
                if other == number {
                    continue;
                }
                let (a, b) = (number as usize, other as usize);
                let apart = vertices.on_surface[a].distance(vertices.on_surface[b]);
                vertices.lower(a, OF_DISTANCE * apart);
                if vertices.lower(b, OF_DISTANCE * apart) {
                    around.extend(region.star(corner));
                }
            }
        }
    }

    /// Adds a vertex on the surface.
    pub fn add(&self, vertices: &mut Vertices, uv: DVec2) {
        let (p, normal) = match self.plane {
            Some(plane) => (self.ground.point(uv), plane.normal()),
            None => {
                let at = self.ground.tangents(uv);
                let inward = || normal(self.ground, uv, &self.domain, 1e-6 * self.domain.size());
                (at.point, upright(&at, self.domain.size()).unwrap_or_else(inward))
            }
        };
        vertices.gaps.push(0.0);
        vertices.uvs.push(uv);
        vertices.on_surface.push(p);
        vertices.positions.push(p);
        vertices.upright.push(p);
        vertices.normals.push(normal);
    }

    /// Adds a vertex of the boundary.
    pub(super) fn add_sample(&self, vertices: &mut Vertices, sample: &EdgeSample) {
        self.add(vertices, sample.uv);
        let last = vertices.uvs.len() - 1;
        let (p, normal) = (vertices.on_surface[last], vertices.normals[last]);
        let off = sample.point - p;
        vertices.positions[last] = sample.point;
        vertices.upright[last] = p + normal * off.dot(normal);
        vertices.gaps[last] = (off - sample.off).dot(normal).abs();
    }

    /// Adds a vertex off the surface, if that is wanted, on the side where triangles are nearer to it.
    pub(super) fn add_balanced(&self, vertices: &mut Vertices, uv: DVec2) {
        let jet = if self.plane.is_none() { self.ground.jet(uv) } else { None };
        let Some((jet, bend)) = jet.and_then(|jet| Some((jet, Bend::new(&jet)?))) else {
            self.add(vertices, uv);
            return;
        };
        vertices.uvs.push(uv);
        vertices.on_surface.push(jet.point);
        let shift = if self.options.balanced { bend.shift(self.options.tolerance) } else { 0.0 };
        vertices.positions.push(jet.point + bend.normal * shift);
        vertices.upright.push(jet.point + bend.normal * shift);
        vertices.normals.push(bend.normal);
        vertices.gaps.push(0.0);
    }

    /// The surface's point in the middle of an edge.
    pub(super) fn middle(&self, vertices: &Vertices, a: u32, b: u32) -> DVec3 {
        let key = u64::from(a.min(b)) << 32 | u64::from(a.max(b));
        *self
            .middles
            .borrow_mut()
            .entry(key)
            .or_insert_with(|| self.ground.point(0.5 * (vertices.uvs[a as usize] + vertices.uvs[b as usize])))
    }
}
