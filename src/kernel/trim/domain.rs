//! The rectangle of native parameters that the unit square of trimming stands for, and its periods.

use glam::DVec2;

use crate::kernel::nurbs::NurbsSurface;

/// A rectangle of native parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UvRect {
    /// Smallest u and v.
    pub min: DVec2,
    /// Largest u and v.
    pub max: DVec2,
}

impl UvRect {
    /// The rectangle around nothing.
    pub const EMPTY: Self = Self { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };

    /// The domain of a surface.
    pub fn of_surface(surface: &NurbsSurface) -> Self {
        let ((u0, u1), (v0, v1)) = (surface.knots_u().domain(), surface.knots_v().domain());
        Self { min: DVec2::new(u0, v0), max: DVec2::new(u1, v1) }
    }

    /// Width and height.
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// The smallest rectangle around both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The smallest rectangle that also holds `p`.
    pub fn include(&mut self, p: DVec2) {
        self.min = self.min.min(p);
        self.max = self.max.max(p);
    }

    /// Whether `p` lies in it or on its border.
    pub fn contains(&self, p: DVec2) -> bool {
        p == p.clamp(self.min, self.max)
    }

    /// Whether it has a finite, positive width and height.
    pub fn has_area(&self) -> bool {
        let size = self.size();
        size.is_finite() && size.min_element() > 0.0 && self.min.is_finite()
    }

    /// Native to normalised parameters.
    pub fn normalise(&self, native: DVec2) -> DVec2 {
        (native - self.min) / self.size()
    }

    /// Normalised to native parameters.
    pub fn native(&self, uv: DVec2) -> DVec2 {
        self.min + uv * self.size()
    }

    /// The four corners, counter-clockwise from the lowest.
    pub fn corners(&self) -> [DVec2; 4] {
        [self.min, DVec2::new(self.max.x, self.min.y), self.max, DVec2::new(self.min.x, self.max.y)]
    }
}

/// How the parameters of a surface repeat: the period of each closed direction, and which borders are
/// poles.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Periods {
    /// Period in u and in v; 0 where the surface is not closed.
    pub period: DVec2,
    /// Whether the border of smallest, largest u (`[0]`), v (`[1]`) is one point.
    pub poles: [[bool; 2]; 2],
}

/// Two sides of a surface are the same when they agree within this fraction of its size.
const CLOSED: f64 = 1e-6;

impl Periods {
    /// Looks at a surface.
    pub fn of_surface(surface: &NurbsSurface) -> Self {
        let tolerance = CLOSED * surface.bounds().diagonal();
        let size = UvRect::of_surface(surface).size();
        let degenerate = surface.degenerate_edges(tolerance);
        // A side that is one point closes nothing by itself; both sides being the same curve does.
        let closed = [
            surface.is_closed_u(tolerance) && !(degenerate.u_min && degenerate.u_max),
            surface.is_closed_v(tolerance) && !(degenerate.v_min && degenerate.v_max),
        ];
        Self {
            period: DVec2::new(if closed[0] { size.x } else { 0.0 }, if closed[1] { size.y } else { 0.0 }),
            poles: [[degenerate.u_min, degenerate.u_max], [degenerate.v_min, degenerate.v_max]],
        }
    }
}
