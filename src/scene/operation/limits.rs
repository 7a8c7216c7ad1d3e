//! Which numbers operations accept: finite, and not so large that arithmetic in them has lost its digits.

use glam::{DVec2, DVec3};

use super::address::Subject;
use super::error::{OperationError, Place, Problem};
use crate::kernel::trim::UvRect;

/// Trim curves may reach this many domain sizes away from the domain.
const REACH: f64 = 1e4;
/// Largest model coordinate: 1e12 mm leave a tenth of a millimetre.
const MODEL_LIMIT: f64 = 1e12;

/// Refuses a number that is not finite.
pub(super) fn finite(place: Place, what: &'static str, value: f64) -> Result<f64, OperationError> {
    if value.is_finite() {
        return Ok(value);
    }
    Err(place.error(Problem::Number { what, value, expected: "finite" }))
}

/// Refuses a number that is not finite and positive.
pub(super) fn positive(place: Place, what: &'static str, value: f64) -> Result<f64, OperationError> {
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(place.error(Problem::Number { what, value, expected: "positive and finite" }))
}

/// Refuses a weight that is not positive and finite, or so extreme that points collapse.
pub(super) fn weight(place: Place, value: f64) -> Result<f64, OperationError> {
    const EXTREME: f64 = 1e9;
    if value.is_finite() && value > 0.0 && value < EXTREME && value > 1.0 / EXTREME {
        return Ok(value);
    }
    if value.is_finite() && value > 0.0 {
        let limit = if value > 1.0 { EXTREME } else { 1.0 / EXTREME };
        return Err(place.error(Problem::Absurd { what: "weight", value, limit }));
    }
    Err(place.error(Problem::Weight { value }))
}

/// Refuses a vector of the uv plane that is not finite.
pub(super) fn finite2(place: Place, what: [&'static str; 2], value: DVec2) -> Result<DVec2, OperationError> {
    finite(place, what[0], value.x)?;
    finite(place, what[1], value.y)?;
    Ok(value)
}

/// Refuses a trim point that is not finite or absurdly far from the domain.
pub(super) fn trim_point(subject: &Subject, place: Place, p: DVec2) -> Result<DVec2, OperationError> {
    finite2(place, ["u", "v"], p)?;
    let UvRect { min, max } = subject.view.domain();
    for (axis, what) in ["u", "v"].into_iter().enumerate() {
        let limit = REACH * (max[axis] - min[axis]);
        if p[axis] < min[axis] - limit || p[axis] > max[axis] + limit {
            let limit = if p[axis] < min[axis] { min[axis] - limit } else { max[axis] + limit };
            return Err(place.error(Problem::Absurd { what, value: p[axis], limit }));
        }
    }
    Ok(p)
}

/// Refuses a model point that is not finite or absurdly far away.
pub(super) fn model_point(place: Place, p: DVec3) -> Result<DVec3, OperationError> {
    for (axis, what) in ["x", "y", "z"].into_iter().enumerate() {
        finite(place, what, p[axis])?;
        if p[axis].abs() > MODEL_LIMIT {
            return Err(place.error(Problem::Absurd { what, value: p[axis], limit: MODEL_LIMIT }));
        }
    }
    Ok(p)
}

/// How far dragged things may go: into the domain, or as far out as they already are. Directions in which
/// the surface is closed have no limit.
pub(super) struct Fence {
    domain: UvRect,
    /// Directions without a limit, found out only when needed.
    free: std::cell::OnceCell<[bool; 2]>,
}

impl Fence {
    pub fn around(subject: &Subject) -> Self {
        Self { domain: subject.view.domain(), free: std::cell::OnceCell::new() }
    }

    /// `from + by`, stopped at the border.
    pub fn moved(&self, subject: &Subject, from: DVec2, by: DVec2) -> DVec2 {
        let mut to = from + by;
        for axis in 0..2 {
            let (low, high) = (self.domain.min[axis].min(from[axis]), self.domain.max[axis].max(from[axis]));
            if !(to[axis] >= low && to[axis] <= high) && !self.is_free(subject)[axis] {
                to[axis] = to[axis].clamp(low, high);
            }
        }
        to
    }

    /// The part of the shift `by` that keeps `hull` in bounds.
    pub fn shift(&self, subject: &Subject, hull: UvRect, by: DVec2) -> DVec2 {
        let mut allowed = by;
        for axis in 0..2 {
            let least = (self.domain.min[axis] - hull.min[axis]).min(0.0);
            let most = (self.domain.max[axis] - hull.max[axis]).max(0.0);
            if !(by[axis] >= least && by[axis] <= most) && !self.is_free(subject)[axis] {
                allowed[axis] = by[axis].clamp(least, most);
            }
        }
        allowed
    }

    fn is_free(&self, subject: &Subject) -> [bool; 2] {
        *self.free.get_or_init(|| {
            let periods = subject.view.periods();
            [periods.x > 0.0, periods.y > 0.0]
        })
    }
}
