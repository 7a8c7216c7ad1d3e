//! Maps between parametrisations of one surface: each coordinate on its own, affine or angle to arc.

use glam::DVec2;

use crate::kernel::nurbs::NurbsCurve2;
use crate::kernel::primitives::arc_parameter;
use crate::kernel::query::fit::{Sample, Target, fit};

/// `x -> x * scale + offset`, and then from an angle to the parameter of an arc's spline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisMap {
    /// Factor.
    pub scale: f64,
    /// Summand.
    pub offset: f64,
    /// Ends of the arc, when the image so far is an angle on it.
    pub arc: Option<(f64, f64)>,
}

/// A map of (u, v).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvMap {
    /// Exchange u and v first.
    pub swap: bool,
    /// For the first coordinate (after the exchange).
    pub u: AxisMap,
    /// For the second.
    pub v: AxisMap,
}

impl AxisMap {
    /// Leaves numbers as they are.
    pub const IDENTITY: Self = Self { scale: 1.0, offset: 0.0, arc: None };

    /// Multiplies.
    pub fn scaling(scale: f64) -> Self {
        Self { scale, ..Self::IDENTITY }
    }

    /// Adds whole turns to the angle.
    pub fn turned(self, turns: f64) -> Self {
        Self { offset: self.offset + turns * std::f64::consts::TAU, ..self }
    }

    /// The image of `x`.
    pub fn apply(&self, x: f64) -> f64 {
        let y = x * self.scale + self.offset;
        self.arc.map_or(y, |(start, end)| arc_parameter(start, end, y))
    }
}

impl UvMap {
    /// Leaves parameters as they are.
    pub const IDENTITY: Self = Self { swap: false, u: AxisMap::IDENTITY, v: AxisMap::IDENTITY };

    /// A map without exchange.
    pub fn new(u: AxisMap, v: AxisMap) -> Self {
        Self { swap: false, u, v }
    }

    /// The image of a point.
    pub fn apply(&self, p: DVec2) -> DVec2 {
        let p = if self.swap { DVec2::new(p.y, p.x) } else { p };
        DVec2::new(self.u.apply(p.x), self.v.apply(p.y))
    }

    /// The image of a curve: exact where the map is affine along it, else fitted to `tolerance`, where
    /// `distance` tells how far apart two points of the image count.
    pub fn map(
        &self,
        curve: &NurbsCurve2,
        tolerance: f64,
        distance: &mut dyn FnMut(DVec2, DVec2) -> f64,
    ) -> Option<NurbsCurve2> {
        if *self == Self::IDENTITY {
            return Some(curve.clone());
        }
        map_curve(
            curve,
            [self.u.arc.is_some(), self.v.arc.is_some()],
            self.swap,
            &|p| self.apply(p),
            tolerance,
            distance,
        )
    }
}

/// As [`UvMap::map`] for any map of the two coordinates one by one; `bent` tells which are not affine.
pub fn map_curve(
    curve: &NurbsCurve2,
    bent: [bool; 2],
    swap: bool,
    map: &dyn Fn(DVec2) -> DVec2,
    tolerance: f64,
    distance: &mut dyn FnMut(DVec2, DVec2) -> f64,
) -> Option<NurbsCurve2> {
    let constant = |axis: usize| {
        let axis = if swap { 1 - axis } else { axis };
        curve.points().iter().all(|p| p[axis] == curve.points()[0][axis])
    };
    let straight = curve.degree() == 1 && curve.points().len() == 2;
    // Bent coordinates that stay constant do no harm; and a straight line along the bent coordinate
    // stays the same set of points.
    let exact = (0..2).all(|k| !bent[k] || constant(k));
    let iso = straight && (0..2).all(|k| !bent[k] || constant(k) || constant(1 - k));
    if exact || iso {
        return Some(curve.map_points(map));
    }
    let mut breaks = curve.knots().breaks();
    if curve.degree() > 2 && breaks.len() > 3 {
        let knots = curve.knots().as_slice();
        let (start, end) = curve.domain();
        breaks.retain(|b| {
            *b == start || *b == end || knots.iter().filter(|k| *k == b).count() + 1 >= curve.degree()
        });
    }
    let mut target = Mapped { curve, map, distance };
    fit(&mut target, &breaks, None, tolerance).map(|f| f.0)
}

struct Mapped<'a> {
    curve: &'a NurbsCurve2,
    map: &'a dyn Fn(DVec2) -> DVec2,
    distance: &'a mut dyn FnMut(DVec2, DVec2) -> f64,
}

impl Target for Mapped<'_> {
    fn sample(&mut self, t: f64, _near: Option<DVec2>, side: i32) -> Sample {
        let (start, end) = self.curve.domain();
        let hair = 1e-9 * (end - start);
        let d = self.curve.derivatives((t + f64::from(side) * hair).clamp(start, end), 1);
        let p = self.curve.point(t);
        // Coordinates are mapped one by one, so two central differences give the whole derivative.
        let h = 1e-6 * (1.0 + d[1].length().min(1.0));
        let difference = |step: DVec2| ((self.map)(p + step) - (self.map)(p - step)) / (2.0 * h);
        let derivative = difference(DVec2::new(h, 0.0)) * d[1].x + difference(DVec2::new(0.0, h)) * d[1].y;
        Sample { uv: (self.map)(p), derivative }
    }

    fn distance(&mut self, a: DVec2, b: DVec2) -> f64 {
        (self.distance)(a, b)
    }
}
