//! Where parameters stand in the triangulation.
//!
//! Triangles shall be about as wide in space as they are long, so one factor for each parameter puts them into even places.
//! No factor does where a surface runs through a length of its own within a hair of its parameters, as a pipe does whose
//! frame turns over within a millionth: all vertices there would stand on one line, and every triangle would reach across. So
//! rows of patches that are that much faster than the rest are drawn out to what they are in space. Places are continuous and
//! rise with the parameters; they are those of the factors alone where no row stands out.

use glam::DVec2;

use super::outline::Ground;
use crate::kernel::bezier::BezierPatch;
use crate::kernel::trim::UvRect;

/// Rows narrower than this part of the domain may be drawn out.
const HAIR: f64 = 1e-2;
/// They are where they are so many times faster than the whole.
pub(super) const FAST: f64 = 30.0;

/// A parameter and its place, and places per parameter from there on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Knot {
    at: f64,
    place: f64,
    factor: f64,
}

/// Places of native parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Places {
    factors: DVec2,
    size: DVec2,
    /// For each axis where factors change; nothing where they do not.
    knots: [Vec<Knot>; 2],
}

impl Places {
    /// By one factor for each parameter of a `domain`.
    pub fn even(factors: DVec2, domain: &UvRect) -> Self {
        Self { factors, size: domain.size(), knots: [Vec::new(), Vec::new()] }
    }

    /// The same, but that rows of the `ground` which run through more than `least` (model units) in no time are drawn out: a
    /// `step` of length in space is one.
    pub(super) fn new(ground: &Ground, factors: DVec2, domain: &UvRect, step: f64, least: f64) -> Self {
        let mut places = Self::even(factors, domain);
        let lines = [ground.sheet.u_lines(), ground.sheet.v_lines()];
        for axis in 0..2 {
            let width = places.size[axis];
            let narrow = |w: &[f64]| w[1] - w[0] < HAIR * width;
            if lines[axis].len() < 3 || !lines[axis].windows(2).any(narrow) {
                continue;
            }
            let across = lines[1 - axis].len().saturating_sub(1);
            let cell = |k: usize, l: usize| {
                if axis == 0 { ground.sheet.cell(k, l) } else { ground.sheet.cell(l, k) }
            };
            let length = |k: usize| {
                let patches = (0..across).filter_map(|l| cell(k, l));
                patches.map(|p| length(p, axis)).fold(0.0, f64::max)
            };
            let lengths: Vec<f64> = (0..lines[axis].len() - 1).map(length).collect();
            let whole = lengths.iter().sum::<f64>() / width;
            let mut knots: Vec<Knot> = Vec::new();
            let mut place = lines[axis][0] * factors[axis];
            for (w, length) in lines[axis].windows(2).zip(&lengths) {
                let fast = narrow(w) && *length > least && *length > FAST * whole * (w[1] - w[0]);
                let factor = if fast && step > 0.0 {
                    // Control points may swing far about a surface that does not.
                    let k = knots.len();
                    let way =
                        (0..across).filter_map(|l| cell(k, l)).map(|p| way(p, axis)).fold(0.0, f64::max);
                    factors[axis].max(way / (w[1] - w[0]) / step)
                } else {
                    factors[axis]
                };
                knots.push(Knot { at: w[0], place, factor });
                place += (w[1] - w[0]) * factor;
            }
            if place.is_finite() && knots.iter().any(|k| k.factor != factors[axis]) {
                places.knots[axis] = knots;
            }
        }
        places
    }

    /// Whether each parameter has one factor.
    pub fn is_even(&self) -> bool {
        self.knots.iter().all(Vec::is_empty)
    }

    /// The place of native parameters.
    pub fn of(&self, uv: DVec2) -> DVec2 {
        if self.is_even() { uv * self.factors } else { DVec2::new(self.along(0, uv.x), self.along(1, uv.y)) }
    }

    /// The parameters at a place.
    pub fn native(&self, place: DVec2) -> DVec2 {
        if self.is_even() {
            return place / self.factors;
        }
        let back = |axis: usize| {
            let knots = &self.knots[axis];
            let first = knots.partition_point(|k| k.place <= place[axis]).saturating_sub(1);
            knots
                .get(first)
                .map_or(place[axis] / self.factors[axis], |k| k.at + (place[axis] - k.place) / k.factor)
        };
        DVec2::new(back(0), back(1))
    }

    fn along(&self, axis: usize, x: f64) -> f64 {
        let knots = &self.knots[axis];
        let first = knots.partition_point(|k| k.at <= x).saturating_sub(1);
        knots.get(first).map_or(x * self.factors[axis], |k| k.place + (x - k.at) * k.factor)
    }

    /// The step from one place to another, by their parameters.
    pub fn step(&self, from: DVec2, to: DVec2) -> DVec2 {
        if self.is_even() { (to - from) * self.factors } else { self.of(to) - self.of(from) }
    }

    /// How far two values of one parameter are apart, as a part of the domain or of the places of it: the larger.
    pub fn part(&self, axis: usize, from: f64, to: f64) -> f64 {
        let of_domain = (to - from).abs() / self.size[axis];
        match self.knots[axis].as_slice() {
            [first, .., last] => {
                let all = last.place - first.place
                    + (self.size[axis] - (last.at - first.at)).max(0.0) * last.factor;
                of_domain.max((self.along(axis, to) - self.along(axis, from)).abs() / all)
            }
            _ => of_domain,
        }
    }

    /// The middle between places, by their parameters.
    pub fn middle<const N: usize>(&self, uv: [DVec2; N]) -> DVec2 {
        if self.is_even() {
            uv.into_iter().sum::<DVec2>() / N as f64
        } else {
            self.native(uv.map(|uv| self.of(uv)).into_iter().sum::<DVec2>() / N as f64)
        }
    }
}

/// The longest way along an axis through the control points of a patch.
fn length(patch: &BezierPatch, axis: usize) -> f64 {
    let row = patch.degree_v + 1;
    let (count, next, other) = if axis == 0 {
        (patch.degree_u, row, (row, 1))
    } else {
        (patch.degree_v, 1, (patch.degree_u + 1, row))
    };
    let way = |first: usize| -> f64 {
        (0..count)
            .map(|k| patch.points[first + k * next].distance(patch.points[first + (k + 1) * next]))
            .sum()
    };
    (0..other.0).map(|l| way(l * other.1)).fold(0.0, f64::max)
}

/// The longest of some ways along an axis over a patch.
fn way(patch: &BezierPatch, axis: usize) -> f64 {
    const LINES: usize = 4;
    const STEPS: usize = 16;
    let at = |line: usize, step: usize| {
        let (along, aside) = (step as f64 / STEPS as f64, line as f64 / LINES as f64);
        if axis == 0 { patch.point(along, aside) } else { patch.point(aside, along) }
    };
    let way = |line: usize| -> f64 { (0..STEPS).map(|k| at(line, k).distance(at(line, k + 1))).sum() };
    (0..=LINES).map(way).fold(0.0, f64::max)
}
