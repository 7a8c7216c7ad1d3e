//! A surface that curves are laid on: point and derivatives, the parameters of a near point, periods.
//!
//! Analytic surfaces answer in closed form. Splines are searched: Newton's method on the squared
//! distance from the last known parameters, or from the best of a grid of samples (Piegl & Tiller,
//! section 6.1, with the starts made safe by sampling each span).

use std::sync::OnceLock;

use glam::{DVec2, DVec3};

use crate::kernel::nurbs::NurbsSurface;
use crate::kernel::primitives::AnalyticSurface;

/// Samples per direction at most; start points, not results, depend on it.
const MOST_SAMPLES: usize = 48;
/// Newton steps at most.
const STEPS: usize = 30;
/// Parts of a model's size below which two edges of a surface count as one (a closed surface).
const CLOSED: f64 = 1e-7;

/// A spline surface prepared for searches.
#[derive(Debug)]
pub struct SplineCarrier {
    surface: NurbsSurface,
    size: f64,
    periods: [Option<f64>; 2],
    samples: OnceLock<Vec<(DVec2, DVec3)>>,
}

/// What a trim curve lies on.
#[derive(Debug)]
pub enum Carrier {
    /// In closed form, natural parameters.
    Analytic(AnalyticSurface),
    /// A spline.
    Spline(SplineCarrier),
}

impl SplineCarrier {
    /// Prepares `surface`.
    pub fn new(surface: NurbsSurface) -> Self {
        let size = surface.bounds().diagonal();
        let ((u0, u1), (v0, v1)) = (surface.knots_u().domain(), surface.knots_v().domain());
        let periods = [
            surface.is_closed_u(CLOSED * size).then_some(u1 - u0),
            surface.is_closed_v(CLOSED * size).then_some(v1 - v0),
        ];
        Self { surface, size, periods, samples: OnceLock::new() }
    }

    /// The surface.
    pub fn surface(&self) -> &NurbsSurface {
        &self.surface
    }

    /// Gives the surface back.
    pub fn into_surface(self) -> NurbsSurface {
        self.surface
    }

    fn samples(&self) -> &[(DVec2, DVec3)] {
        self.samples.get_or_init(|| {
            let grid = |knots: &crate::kernel::nurbs::KnotVector| -> Vec<f64> {
                let breaks = knots.breaks();
                let each = (knots.degree() + 1).min(MOST_SAMPLES / breaks.len().min(MOST_SAMPLES)).max(1);
                let mut all: Vec<f64> = breaks
                    .windows(2)
                    .flat_map(|w| (0..each).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / each as f64))
                    .collect();
                all.extend(breaks.last());
                let stride = all.len().div_ceil(2 * MOST_SAMPLES).max(1);
                all.into_iter().step_by(stride).collect()
            };
            let (us, vs) = (grid(self.surface.knots_u()), grid(self.surface.knots_v()));
            us.iter()
                .flat_map(|u| vs.iter().map(|v| (DVec2::new(*u, *v), self.surface.point(*u, *v))))
                .collect()
        })
    }

    fn limits(&self) -> (DVec2, DVec2) {
        let ((u0, u1), (v0, v1)) = (self.surface.knots_u().domain(), self.surface.knots_v().domain());
        (DVec2::new(u0, v0), DVec2::new(u1, v1))
    }

    /// `uv` moved into the domain: wrapped where the surface is closed, else clamped.
    fn inside(&self, uv: DVec2) -> DVec2 {
        let (min, max) = self.limits();
        let one = |k: usize| match self.periods[k] {
            Some(period) if uv[k] < min[k] || uv[k] > max[k] => {
                (min[k] + (uv[k] - min[k]).rem_euclid(period)).clamp(min[k], max[k])
            }
            _ => uv[k].clamp(min[k], max[k]),
        };
        DVec2::new(one(0), one(1))
    }

    /// Newton's method from `start`; parameters inside the domain, and the distance.
    fn newton(&self, p: DVec3, start: DVec2) -> (DVec2, f64) {
        let (min, max) = self.limits();
        let span = max - min;
        let mut uv = self.inside(start);
        let mut best = (uv, f64::INFINITY);
        let mut damping = 1.0;
        for _ in 0..STEPS {
            let jet = self.surface.jet(uv.x, uv.y);
            let r = jet.point - p;
            let distance = r.length();
            if distance < best.1 {
                best = (uv, distance);
                damping = 1.0;
            } else if damping > 0.05 && distance > best.1 * (1.0 + 1e-12) {
                damping *= 0.5;
            }
            let g = DVec2::new(r.dot(jet.du), r.dot(jet.dv));
            let (a, b, c) = (
                jet.du.dot(jet.du) + r.dot(jet.duu),
                jet.du.dot(jet.dv) + r.dot(jet.duv),
                jet.dv.dot(jet.dv) + r.dot(jet.dvv),
            );
            let step = solve(a, b, c, g).filter(|s| s.dot(g) > 0.0).or_else(|| {
                // Far away the full Hessian may point uphill: Gauss-Newton always descends.
                solve(jet.du.dot(jet.du), jet.du.dot(jet.dv), jet.dv.dot(jet.dv), g)
            });
            let Some(step) = step else { break };
            let step = (step * damping).clamp(-0.25 * span, 0.25 * span);
            let next = self.inside(uv - step);
            if ((next - uv).abs() / span).max_element() < 1e-15 {
                break;
            }
            uv = next;
        }
        let last = (self.surface.point(uv.x, uv.y) - p).length();
        if last < best.1 { (uv, last) } else { best }
    }

    /// Whether the surface is perpendicular to the way from `p`, as far as its edges let it be.
    fn is_foot(&self, p: DVec3, uv: DVec2) -> bool {
        let jet = self.surface.jet(uv.x, uv.y);
        let r = jet.point - p;
        let level = 1e-6 * r.length();
        let (min, max) = self.limits();
        let edge = |k: usize| self.periods[k].is_none() && (uv[k] <= min[k] || uv[k] >= max[k]);
        (edge(0) || r.dot(jet.du).abs() <= level * jet.du.length())
            && (edge(1) || r.dot(jet.dv).abs() <= level * jet.dv.length())
    }

    fn locate(&self, p: DVec3, near: Option<DVec2>) -> DVec2 {
        if let Some(near) = near {
            let (uv, distance) = self.newton(p, near);
            // Curves that lie a little off the surface have a nearest point all the same.
            if distance <= 1e-6 * self.size || self.is_foot(p, uv) {
                return uv;
            }
        }
        let mut starts: Vec<(f64, DVec2)> =
            self.samples().iter().map(|(uv, q)| ((*q - p).length_squared(), *uv)).collect();
        let keep = starts.len().min(6);
        starts.select_nth_unstable_by(keep - 1, |a, b| a.0.total_cmp(&b.0));
        starts.truncate(keep);
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = (DVec2::ZERO, f64::INFINITY);
        for start in near.into_iter().chain(starts.into_iter().map(|s| s.1)) {
            let found = self.newton(p, start);
            if found.1 < best.1 - 1e-12 * self.size {
                best = found;
            }
        }
        best.0
    }
}

/// Solves the symmetric system `[a b; b c] x = g`; `None` where it is singular.
fn solve(a: f64, b: f64, c: f64, g: DVec2) -> Option<DVec2> {
    let det = a * c - b * b;
    if det.abs() > 1e-14 * (a.abs() * c.abs()).max(b * b) && det.is_finite() {
        return Some(DVec2::new(c * g.x - b * g.y, a * g.y - b * g.x) / det);
    }
    // One direction only (a pole): move along the stronger one.
    match (a.abs() >= c.abs(), a.abs().max(c.abs()) > 0.0) {
        (true, true) => Some(DVec2::new(g.x / a, 0.0)),
        (false, true) => Some(DVec2::new(0.0, g.y / c)),
        _ => None,
    }
}

impl Carrier {
    /// A carrier for a spline.
    pub fn spline(surface: NurbsSurface) -> Self {
        Self::Spline(SplineCarrier::new(surface))
    }

    /// Point and first derivatives; on closed splines parameters may run past the ends.
    pub fn jet(&self, uv: DVec2) -> [DVec3; 3] {
        match self {
            Self::Analytic(surface) => surface.jet(uv),
            Self::Spline(spline) => spline.jet(uv),
        }
    }

    /// Point.
    pub fn point(&self, uv: DVec2) -> DVec3 {
        match self {
            Self::Analytic(surface) => surface.jet(uv)[0],
            Self::Spline(spline) => spline.point(uv),
        }
    }

    /// Periods in u and v, where the surface closes.
    pub fn periods(&self) -> [Option<f64>; 2] {
        match self {
            Self::Analytic(surface) => surface.periods(),
            Self::Spline(spline) => spline.periods,
        }
    }

    /// Parameters of the point of the surface nearest to `p`: of several the one nearest to `near`,
    /// where periodic parameters go on continuously.
    pub fn locate(&self, p: DVec3, near: Option<DVec2>) -> DVec2 {
        let uv = match self {
            Self::Analytic(surface) => surface.invert(p),
            Self::Spline(spline) => spline.locate(p, near),
        };
        let Some(near) = near else { return uv };
        let periods = self.periods();
        let shift = |k: usize| periods[k].map_or(0.0, |t| ((near[k] - uv[k]) / t).round() * t);
        uv + DVec2::new(shift(0), shift(1))
    }

    /// Whether `u` (0) or `v` (1) has no meaning at `uv`: a pole. Relative to the other derivative.
    pub fn is_singular(&self, uv: DVec2) -> [bool; 2] {
        let [_, du, dv] = self.jet(uv);
        let (periods, spans) = (self.periods(), self.spans());
        let scale = |k: usize| periods[k].unwrap_or(spans[k]);
        let (a, b) = (du.length() * scale(0), dv.length() * scale(1));
        let tiny = 1e-7;
        [a <= tiny * b, b <= tiny * a]
    }

    fn spans(&self) -> DVec2 {
        match self {
            Self::Analytic(_) => DVec2::ONE,
            Self::Spline(spline) => {
                let (min, max) = spline.limits();
                max - min
            }
        }
    }
}

impl SplineCarrier {
    /// Periods in u and v, where the surface closes.
    pub fn periods(&self) -> [Option<f64>; 2] {
        self.periods
    }

    /// Point and first derivatives; where the surface is closed parameters may run past the ends.
    pub fn jet(&self, uv: DVec2) -> [DVec3; 3] {
        let uv = self.wrapped(uv);
        let jet = self.surface.jet(uv.x, uv.y);
        [jet.point, jet.du, jet.dv]
    }

    /// Point; where the surface is closed parameters may run past the ends.
    pub fn point(&self, uv: DVec2) -> DVec3 {
        let uv = self.wrapped(uv);
        self.surface.point(uv.x, uv.y)
    }

    /// `uv` wrapped into the domain where the surface is closed; otherwise as it is.
    fn wrapped(&self, uv: DVec2) -> DVec2 {
        let (min, max) = self.limits();
        let one = |k: usize| match self.periods[k] {
            Some(period) if uv[k] < min[k] || uv[k] > max[k] => min[k] + (uv[k] - min[k]).rem_euclid(period),
            _ => uv[k],
        };
        DVec2::new(one(0), one(1))
    }
}
