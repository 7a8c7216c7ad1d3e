//! How far the surface over a triangle is from it: an estimate at a few points first, the proven bound where that does not
//! decide.

use glam::DVec3;

use super::placing::Vertices;
use super::refine::Refinement;

/// Triangles that look away from the surface and are higher than this part of the tolerance are divided.
const FOLDED: f64 = 0.05;

/// Corners that are too high over the surface are lowered until triangles are this part of the tolerance off.
const LOWERED: f64 = 0.9;
const TOO_HIGH: f64 = 0.95;

/// What points of the surface say of a triangle.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Estimate {
    /// Distance from the surface.
    pub(super) error: f64,
    /// How far the surface is from it at the middles of its edges.
    pub(super) shares: [f64; 3],
    /// What is added for neighbours that lie under the images of its edges.
    pub(super) sideways: f64,
    pub(super) normal: DVec3,
    /// Its longest edge.
    pub(super) longest: f64,
    /// Whether it looks away from the surface.
    pub(super) folded: bool,
    /// How much lower its corners would have to be over the surface, where they are too high for how it bends.
    pub(super) lower: [f64; 3],
}

/// What is known of a triangle.
#[derive(Default)]
pub(super) struct Found {
    /// Bound or estimate of its distance from the surface.
    pub(super) error: f64,
    /// How far the surface is from it at the middles of its edges.
    pub(super) shares: [f64; 3],
    /// The edge, and where on it (0 to 1), that crosses a crease which matters.
    pub(super) crease: Option<(usize, f64)>,
    /// How much nearer to the surface its corners should be.
    pub(super) lower: [f64; 3],
    /// Whether it is divided for looking away from the surface.
    pub(super) folded: bool,
}

impl Refinement<'_> {
    /// Error of a triangle: what points of the surface say, and where that does not decide the bound.
    pub(super) fn error(&self, vertices: &Vertices, triangle: [u32; 3], allowed: f64, prove: bool) -> Found {
        if self.plane.is_some() {
            return Found::default();
        }
        let estimate = self.estimate(vertices, triangle, allowed, false);
        if !prove && estimate.error <= allowed {
            return Found { error: estimate.error, shares: estimate.shares, ..Found::default() };
        }
        self.proven(vertices, triangle, &estimate, allowed)
    }

    /// Error of a triangle at the middles of its edges and in its own.
    ///
    /// What counts is the distance from the triangle's plane. Where the image of an edge leaves the triangle sideways its
    /// neighbour lies under it, in a plane turned by about the turn of the normal within the triangle. If `only_whether` it is
    /// within what is allowed matters, the first point that is not ends it.
    pub(super) fn estimate(
        &self,
        vertices: &Vertices,
        triangle: [u32; 3],
        allowed: f64,
        only_whether: bool,
    ) -> Estimate {
        let p = triangle.map(|n| vertices.upright[n as usize]);
        let normals = triangle.map(|n| vertices.normals[n as usize]);
        let edges = [0, 1, 2].map(|k| p[(k + 1) % 3] - p[k]);
        let cross = edges[0].cross(-edges[2]);
        let longest = edges.iter().map(|e| e.length_squared()).fold(0.0, f64::max);
        let solid = cross.length_squared() > 1e-18 * longest * longest;
        let normal = if solid {
            cross.normalize_or_zero()
        } else {
            (normals[0] + normals[1] + normals[2]).normalize_or_zero()
        };
        let corners = [0, 1, 2].map(|k| (vertices.on_surface[triangle[k] as usize] - p[k]).dot(normal));
        let mut middles = [DVec3::ZERO; 3];
        for k in 0..3 {
            middles[k] = self.middle(vertices, triangle[k], triangle[(k + 1) % 3]) - p[k];
            let off = middles[k].dot(normal).abs().max(corners[k].abs());
            if only_whether && !(off <= allowed) {
                return Estimate { error: off, ..Estimate::default() };
            }
        }
        // The sine of the largest turn, 1 beyond a right angle.
        let squared = |n: DVec3| if n.dot(normal) > 0.0 { n.cross(normal).length_squared() } else { 1.0 };
        let turn = if solid { normals.map(squared).into_iter().fold(0.0, f64::max).sqrt() } else { 0.0 };
        let mut sideways = 0.0f64;
        let mut asides = [0.0; 3];
        let mut worst = 0.0f64;
        let shares = [0, 1, 2].map(|k| {
            let d = middles[k];
            let height = d.dot(normal);
            let up = height.abs();
            worst = if up > worst.abs() { height } else { worst };
            if solid {
                // As long as the edge, which the normal is upright on.
                let out = edges[k].cross(normal);
                let aside = d.dot(out).abs() / edges[k].length_squared().max(f64::MIN_POSITIVE).sqrt();
                asides[k] = aside;
                let most = 2.0 * aside * turn;
                if most > sideways {
                    sideways = sideways.max(most.min((up * up + aside * aside).sqrt() - up));
                }
            }
            up
        });
        let uv = triangle.map(|n| vertices.uvs[n as usize]);
        let middle = (self.ground.point((uv[0] + uv[1] + uv[2]) / 3.0) - p[0]).dot(normal);
        worst = if middle.abs() > worst.abs() { middle } else { worst };
        let error = corners.into_iter().map(f64::abs).fold(worst.abs(), f64::max) + sideways;
        let high = worst.abs() > TOO_HIGH * allowed && error > allowed;
        let excess = worst.abs() - LOWERED * allowed;
        let lower = corners.map(|c| if high && c * worst > 0.0 { excess } else { 0.0 });
        let away = normal.dot(normals[0] + normals[1] + normals[2]) < 0.0;
        let far = cross.length() > FOLDED * allowed * longest.sqrt();
        if solid && away && far && self.patience.has_folds() {
            // Folded over: the surface runs unevenly over its parameters here.
            return Estimate {
                error: error.max(2.0 * allowed),
                shares: asides,
                folded: true,
                ..Estimate::default()
            };
        }
        Estimate { error, shares, sideways, normal, longest: longest.sqrt(), folded: false, lower }
    }

    /// What bounds say of a triangle that is `estimate`d to be within the tolerance.
    pub(super) fn proven(
        &self,
        vertices: &Vertices,
        triangle: [u32; 3],
        estimate: &Estimate,
        allowed: f64,
    ) -> Found {
        let Estimate { error, shares, sideways, normal, longest, folded, lower } = *estimate;
        let Some(flatness) = self.flatness.filter(|_| !folded) else {
            return Found { error, shares, crease: None, lower, folded };
        };
        let uv = triangle.map(|n| vertices.uvs[n as usize]);
        let crease = if error > 0.25 * allowed { flatness.crossed(&uv, 0.25 * allowed) } else { None };
        // Beside a triangle smaller than the tolerance nothing is far.
        if !(error <= allowed) || longest < 0.1 * allowed {
            return Found { error, shares, crease, lower, folded };
        }
        let start = vertices.upright[triangle[0] as usize];
        let proven = flatness.triangle(uv, (start, normal), allowed - sideways) + sideways;
        Found { error: proven.max(error), shares, crease, lower, folded }
    }
}
