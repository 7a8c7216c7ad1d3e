//! Between the screen and the parameters of the active face's surface.
//!
//! A ray meets the untrimmed surface in several places: a drag goes on at the one nearest to where it was, so that
//! it keeps to its sheet. A ray that misses goes to the nearest point of the border or silhouette, found by
//! a damped descent from there. Beyond the knots a closed surface goes round and an open one ends.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::kernel::bezier::BezierPatch;
use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::query::Raycaster;
use crate::kernel::trim::{Periods, UvRect};
use crate::kernel::view::Ray;

/// A surface made ready for rays.
#[derive(Debug, Clone)]
pub struct SurfaceMap {
    surface: Arc<NurbsSurface>,
    domain: UvRect,
    period: DVec2,
    caster: Raycaster,
}

impl SurfaceMap {
    /// Makes `surface` ready.
    pub fn new(surface: Arc<NurbsSurface>) -> Self {
        let patches: Vec<(usize, BezierPatch)> = surface.to_bezier().into_iter().map(|p| (0, p)).collect();
        Self {
            domain: UvRect::of_surface(&surface),
            period: Periods::of_surface(&surface).period,
            caster: Raycaster::new(patches),
            surface,
        }
    }

    /// The surface.
    pub fn surface(&self) -> &Arc<NurbsSurface> {
        &self.surface
    }

    /// The parameters inside the domain that stand for `uv`.
    pub fn inside(&self, uv: DVec2) -> DVec2 {
        let mut inside = uv.clamp(self.domain.min, self.domain.max);
        for axis in 0..2 {
            if self.period[axis] > 0.0 && inside[axis] != uv[axis] {
                let from = self.domain.min[axis];
                inside[axis] =
                    (from + (uv[axis] - from).rem_euclid(self.period[axis])).min(self.domain.max[axis]);
            }
        }
        inside
    }

    /// The point of space at `uv`.
    pub fn point(&self, uv: DVec2) -> DVec3 {
        let uv = self.inside(uv);
        self.surface.point(uv.x, uv.y)
    }

    /// The parameters that a drag over `ray` goes to, coming from `near`.
    pub fn follow(&self, ray: &Ray, near: DVec2) -> Option<DVec2> {
        let hits = self.caster.hits(ray);
        let here = self.point(near);
        let apart = |p: DVec3| (p - here).length();
        let hit = hits.hits.iter().min_by(|a, b| apart(a.point).total_cmp(&apart(b.point)));
        let uv = match hit {
            Some(hit) => hit.uv,
            None => self.nearest(ray, self.inside(near))?,
        };
        Some(self.unwrapped(uv, near))
    }

    /// The image of `uv` whole periods away that is nearest to `near`.
    fn unwrapped(&self, uv: DVec2, near: DVec2) -> DVec2 {
        let turns = |axis: usize| {
            let period = self.period[axis];
            if period > 0.0 { ((near[axis] - uv[axis]) / period).round() * period } else { 0.0 }
        };
        uv + DVec2::new(turns(0), turns(1))
    }

    /// Where the surface comes nearest to a ray that misses it: Gauss and Newton's descent from `start`.
    fn nearest(&self, ray: &Ray, start: DVec2) -> Option<DVec2> {
        const STEPS: usize = 60;
        let off = |p: DVec3| {
            let offset = p - ray.origin;
            offset - ray.direction * offset.dot(ray.direction)
        };
        let across = |d: DVec3| d - ray.direction * d.dot(ray.direction);
        let mut uv = start;
        let mut distance = off(self.surface.point(uv.x, uv.y)).length();
        let mut damping = 1e-6;
        for _ in 0..STEPS {
            let jet = self.surface.jet(uv.x, uv.y);
            let (du, dv, r) = (across(jet.du), across(jet.dv), off(jet.point));
            let scale = du.length_squared().max(dv.length_squared());
            let (a, b, c) = (du.dot(du) + damping * scale, du.dot(dv), dv.dot(dv) + damping * scale);
            let (p, q) = (du.dot(r), dv.dot(r));
            let step = DVec2::new(b * q - c * p, b * p - a * q) / (a * c - b * b);
            if !step.is_finite() {
                break;
            }
            let next = self.slide(uv, step, (p, q), (a, c));
            let moved = off(self.surface.point(next.x, next.y)).length();
            if moved < distance {
                let small = distance - moved <= 1e-12 * distance;
                (uv, distance) = (next, moved);
                damping = (0.3 * damping).max(1e-12);
                if small {
                    break;
                }
            } else {
                damping *= 10.0;
                if damping > 1e8 {
                    break;
                }
            }
        }
        uv.is_finite().then_some(uv)
    }

    /// A step that ends at the border; along the border it goes on with the other parameter alone.
    fn slide(&self, uv: DVec2, step: DVec2, slope: (f64, f64), curvature: (f64, f64)) -> DVec2 {
        let low = self.domain.min;
        let high = self.domain.max;
        let mut step = step;
        let held = |axis: usize, step: f64| {
            (uv[axis] <= low[axis] && step < 0.0) || (uv[axis] >= high[axis] && step > 0.0)
        };
        if held(0, step.x) {
            step = DVec2::new(0.0, -slope.1 / curvature.1);
        } else if held(1, step.y) {
            step = DVec2::new(-slope.0 / curvature.0, 0.0);
        }
        (uv + step).clamp(low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::view::{Camera, Projection};
    use crate::scene::demo;

    fn maps() -> Vec<SurfaceMap> {
        demo::model().faces.into_iter().map(|f| SurfaceMap::new(Arc::new(f.surface))).collect()
    }

    /// The ray through a point of the surface finds that point again, from near it.
    #[test]
    fn rays_come_back_to_where_they_were_aimed() {
        for map in maps() {
            for (s, t) in [(0.3, 0.4), (0.71, 0.22), (0.5, 0.86)] {
                let uv = map.domain.native(DVec2::new(s, t));
                let jet = map.surface.jet(uv.x, uv.y);
                let Some(normal) = jet.du.cross(jet.dv).try_normalize() else { continue };
                let size = map.surface.bounds().diagonal();
                for projection in
                    [Projection::Perspective { fov_y: 0.7 }, Projection::Orthographic { height: size }]
                {
                    let eye = jet.point + (normal + 0.3 * jet.du.normalize()).normalize() * size;
                    let camera =
                        Camera { eye, target: jet.point, up: normal.any_orthogonal_vector(), projection };
                    let ray = camera.ray(DVec2::ZERO, 1.3);
                    let near = uv + 0.01 * map.domain.size();
                    let found = map.follow(&ray, near).expect("it hits");
                    let off = (map.point(found) - jet.point).length();
                    assert!(off < 1e-6 * size, "{off} of {size}");
                }
            }
        }
    }

    /// A ray beside the surface leads to its rim, never to nonsense.
    #[test]
    fn rays_that_miss_lead_to_the_rim() {
        for map in maps() {
            let bounds = map.surface.bounds();
            let size = bounds.diagonal();
            let uv = map.domain.native(DVec2::new(0.6, 0.5));
            for k in 0..8 {
                let side = DVec2::from_angle(f64::from(k) * 0.8) * size;
                let target = bounds.centre() + DVec3::new(side.x, side.y, 0.0);
                let eye = target + DVec3::Z * 3.0 * size;
                let ray = Ray { origin: eye, direction: -DVec3::Z };
                let found = map.follow(&ray, uv).expect("somewhere");
                let inside = map.inside(found);
                assert!(found.is_finite() && map.domain.contains(inside));
                let gap = |p: DVec3| (p.truncate() - target.truncate()).length();
                assert!(gap(map.point(found)) <= gap(map.point(uv)) + 1e-9 * size, "farther than before");
            }
        }
    }
}
