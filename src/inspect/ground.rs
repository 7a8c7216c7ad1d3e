//! The surface that trim curves are lifted onto, with what they need to know of it.
//!
//! Parameters beyond a closed surface are wrapped; beyond an open one they are clamped to its border, as
//! trimming clips there too.

use glam::{DVec2, DVec3};

use crate::kernel::bezier::Tangents;
use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::trim::{Periods, UvRect};
use crate::kernel::view::Bounds;

/// A surface ready to lift curves.
#[derive(Debug, Clone)]
pub struct Ground {
    surface: NurbsSurface,
    rect: UvRect,
    /// Period in u and v, 0 where open (or where no curve leaves the surface).
    period: DVec2,
    /// Length of the diagonal of the box around the control points.
    size: f64,
    /// Coordinates are no larger than this.
    reach: f64,
}

impl Ground {
    /// Takes a surface whose trim curves stay in `hull`.
    pub fn new(surface: &NurbsSurface, hull: &UvRect) -> Self {
        let rect = UvRect::of_surface(surface);
        let slack = 1e-9 * rect.size();
        let outside = (rect.min - hull.min).cmpgt(slack).any() || (hull.max - rect.max).cmpgt(slack).any();
        let period = if outside { Periods::of_surface(surface).period } else { DVec2::ZERO };
        let bounds = surface.bounds();
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        Self { surface: surface.clone(), rect, period, size: bounds.diagonal(), reach }
    }

    /// The surface.
    pub fn surface(&self) -> &NurbsSurface {
        &self.surface
    }

    /// The parameters of the surface.
    pub fn rect(&self) -> &UvRect {
        &self.rect
    }

    /// Size of the surface (model units).
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Rounding of a point of the surface (model units).
    pub fn rounding(&self) -> f64 {
        8.0 * f64::EPSILON * self.reach
    }

    /// Parameters on the surface, and in which of them it goes on there.
    fn inside(&self, uv: DVec2) -> (DVec2, DVec2) {
        let (mut at, mut moves) = (uv, DVec2::ONE);
        for k in 0..2 {
            let (min, max) = (self.rect.min[k], self.rect.max[k]);
            if uv[k] >= min && uv[k] <= max {
                continue;
            }
            if self.period[k] > 0.0 {
                at[k] = (min + (uv[k] - min).rem_euclid(self.period[k])).clamp(min, max);
            } else {
                at[k] = uv[k].clamp(min, max);
                moves[k] = 0.0;
            }
        }
        (at, moves)
    }

    /// Point and first derivatives at native parameters.
    pub fn tangents(&self, uv: DVec2) -> Tangents {
        let (at, moves) = self.inside(uv);
        let mut tangents = self.surface.tangents(at.x, at.y);
        tangents.du *= moves.x;
        tangents.dv *= moves.y;
        tangents
    }

    /// Unit normal `du x dv` (not turned for reversed faces); beside a pole where there is none at `uv`.
    pub fn normal(&self, uv: DVec2) -> Option<DVec3> {
        let at = self.inside(uv).0;
        let centre = 0.5 * (self.rect.min + self.rect.max);
        [0.0, 1e-6, 1e-3].into_iter().find_map(|step| {
            let beside = at + (centre - at) * step;
            normal_of(&self.surface.tangents(beside.x, beside.y))
        })
    }

    /// Point, first derivatives and unit normal at native parameters.
    pub fn frame(&self, uv: DVec2) -> (Tangents, Option<DVec3>) {
        let (at, moves) = self.inside(uv);
        let mut tangents = self.surface.tangents(at.x, at.y);
        let normal = normal_of(&tangents).or_else(|| self.normal(uv));
        tangents.du *= moves.x;
        tangents.dv *= moves.y;
        (tangents, normal)
    }

    /// Box of a few points around.
    pub fn bounds(&self) -> Bounds {
        self.surface.bounds()
    }
}

/// `du x dv`, unit.
fn normal_of(t: &Tangents) -> Option<DVec3> {
    let normal = t.du.cross(t.dv);
    // Two derivatives of very different length are fine, parallel ones are not.
    let limit = 1e-18 * t.du.length_squared() * t.dv.length_squared();
    (normal.length_squared() > limit).then(|| normal.try_normalize()).flatten()
}
