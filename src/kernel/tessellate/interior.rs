//! How many vertices lie inside a face, and the first ones: a lattice by how the surface bends.

use glam::DVec2;

use super::chords::EdgeSample;
use super::options::TessellateError;
use super::patience::enough;
use super::placing::Vertices;
use super::refine::Refinement;
use super::seed::{expected, seeds};
use super::tessellator::{Boundary, Tessellator};
use super::triangulate::Region;
use crate::kernel::face::Side;
use crate::kernel::trim::UvRect;

/// Fewer vertices inside are not worth knowing better.
const MANY: f64 = 1000.0;
/// Vertices of a lattice over the box of a face, for each that may lie inside.
const MOSTLY_OUTSIDE: usize = 8;

impl Tessellator<'_> {
    /// Puts the first vertices inside.
    pub(super) fn sow(
        &self,
        refinement: &Refinement,
        region: &mut Region,
        vertices: &mut Vertices,
    ) -> Result<(), TessellateError> {
        let Some(bends) = &self.bends else { return Ok(()) };
        let bounds = around(vertices.uvs.iter().copied());
        let limit = self.options.triangle_limit;
        // Samples may have met what is only a hair wide.
        let wanted = expected(bends, &bounds, self.tolerance);
        if wanted > MANY && wanted > enough(&self.ground, self.tolerance) {
            return Ok(());
        }
        // A lattice over the box may be mostly outside of the face.
        let most = limit.saturating_mul(MOSTLY_OUTSIDE);
        let Some(seeds) = seeds(bends, &bounds, self.tolerance, most) else {
            return Err(TessellateError::TooManyTriangles { limit });
        };
        refinement.sow(region, vertices, &seeds);
        Ok(())
    }

    /// About how many triangles the mesh within `boundary` will have.
    pub fn expected(&self, boundary: &Boundary) -> f64 {
        const PROBES: usize = 8;
        /// Area of the largest triangle with edges of length one.
        const LARGEST: f64 = 0.433;
        let samples = || boundary.iter().flatten().flatten();
        let chords: usize = boundary.iter().flatten().map(|run| run.len().saturating_sub(1)).sum();
        let bounds = around(samples().map(|s| s.uv));
        let small =
            self.options.max_edge.map_or(0.0, |edge| self.area(boundary, &bounds) / (LARGEST * edge * edge));
        let Some(bends) = &self.bends else { return small.max(chords as f64) };
        let mut inside = expected(bends, &bounds, self.tolerance);
        if inside > MANY {
            let probe = |k: usize| {
                let share = DVec2::new((k % PROBES) as f64 + 0.5, (k / PROBES) as f64 + 0.5) / PROBES as f64;
                let uv = bounds.native(share);
                self.face.classify_native(uv.x, uv.y) == Side::In
            };
            let hits = (0..PROBES * PROBES).filter(|k| probe(*k)).count();
            inside = inside.min(enough(&self.ground, self.tolerance));
            inside *= hits as f64 / (PROBES * PROBES) as f64;
        }
        small.max(chords as f64 + 2.0 * inside)
    }

    /// About the area within `boundary`: of the polygons in parameters, times what the surface does to areas in the middle.
    fn area(&self, boundary: &Boundary, bounds: &UvRect) -> f64 {
        let ring = |runs: &Vec<Vec<EdgeSample>>| -> f64 {
            let places: Vec<DVec2> = runs.iter().flatten().map(|s| s.uv - bounds.min).collect();
            let next = places.iter().cycle().skip(1);
            places.iter().zip(next).map(|(a, b)| 0.5 * a.perp_dot(*b)).sum()
        };
        let at = self.ground.tangents(0.5 * (bounds.min + bounds.max));
        boundary.iter().map(ring).sum::<f64>().abs() * at.du.cross(at.dv).length()
    }
}

/// The rectangle around places.
fn around(places: impl Iterator<Item = DVec2>) -> UvRect {
    let start = UvRect { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };
    places.fold(start, |r, p| UvRect { min: r.min.min(p), max: r.max.max(p) })
}
