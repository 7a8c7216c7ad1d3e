//! Where a line meets a rational Bezier patch: all of it, with proof where there is one.
//!
//! The line is the intersection of two planes (Kajiya 1982). The signed, weighted distances of the control
//! points from both form a polynomial net in the plane; its zeros are the hits, whatever the weights. Boxes
//! of parameters are bisected until their hull excludes 0 (bounding box, also in the coordinates in which
//! the map is nearly the identity, as Bezier clipping does; Nishita et al. 1990) or the map is proved to
//! be one-to-one on the box (derivative control vectors within 1 of the identity in the maximum norm), when
//! Newton's method finds the only zero. What is left is tangent (or singular, as at poles): boxes whose hull
//! is 0 up to rounding, and boxes of `TANGENT_SIZE`, in which the smallest value decides.

use glam::{DMat2, DVec2, DVec3};

use super::plane_net::{newton, smallest};
use crate::kernel::bezier::BezierPatch;
use crate::kernel::view::Ray;

/// Off the middle, so that zeros at the centre of symmetric patches do not fall on the cut.
const CUT: f64 = 0.4871;
/// Zeros this far outside a box (in the patch's parameters) still belong to it.
const EDGE: f64 = 1e-12;
/// Boxes this small (in the patch's parameters) are not bisected further: zeros closer together than this
/// count as one tangency.
const TANGENT_SIZE: f64 = 1e-7;
/// Boxes bisected before a line counts as running inside the surface.
const BUDGET: usize = 5_000;

/// One zero of the plane-pair net.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineRoot {
    /// Parameters in the patch's unit square.
    pub uv: DVec2,
    /// Whether it is proved to be a simple zero; otherwise a tangency (or several zeros within rounding).
    pub simple: bool,
}

/// Work space that is kept from line to line.
#[derive(Debug, Default)]
pub struct LineSolver {
    net: Vec<DVec2>,
    arena: Vec<DVec2>,
    boxes: Vec<ParameterBox>,
    roots: Vec<LineRoot>,
}

#[derive(Debug, Clone, Copy)]
struct ParameterBox {
    min: DVec2,
    size: DVec2,
}

/// What is known of a box after looking at its net.
enum Verdict {
    Empty,
    Root(LineRoot),
    Split { along_u: bool },
}

impl LineSolver {
    /// All zeros of `patch` on the line of `ray`, and whether the search came to its end (it does not
    /// when the line runs inside the surface).
    pub fn solve(&mut self, patch: &BezierPatch, ray: &Ray) -> (&[LineRoot], bool) {
        let degree = (patch.degree_u, patch.degree_v);
        self.roots.clear();
        self.boxes.clear();
        self.arena.clear();
        let tolerance = project(patch, ray, &mut self.net);
        self.arena.extend_from_slice(&self.net);
        self.boxes.push(ParameterBox { min: DVec2::ZERO, size: DVec2::ONE });
        let length = self.net.len();
        let mut budget = BUDGET;
        while let Some(area) = self.boxes.pop() {
            let start = self.arena.len() - length;
            match examine(&self.arena[start..], degree, area, tolerance) {
                Verdict::Empty => self.arena.truncate(start),
                Verdict::Root(root) => {
                    self.arena.truncate(start);
                    self.keep(root);
                }
                Verdict::Split { along_u } => {
                    if budget == 0 {
                        return (&self.roots, false);
                    }
                    budget -= 1;
                    self.bisect(start, degree, area, along_u);
                }
            }
        }
        (&self.roots, true)
    }

    fn keep(&mut self, mut root: LineRoot) {
        root.uv = root.uv.clamp(DVec2::ZERO, DVec2::ONE);
        // The same zero found from both sides of a cut; tangencies are known to about the square root of
        // the rounding only.
        let near = |other: &LineRoot| if root.simple && other.simple { 10.0 * EDGE } else { 1e-6 };
        let same = |other: &LineRoot| (other.uv - root.uv).abs().max_element() <= near(other);
        match self.roots.iter_mut().find(|other| same(other)) {
            Some(other) if root.simple && !other.simple => *other = root,
            Some(_) => {}
            None => self.roots.push(root),
        }
    }

    /// Replaces the net at `start`, the last of the arena, by those of its two parts.
    fn bisect(&mut self, start: usize, (m, n): (usize, usize), area: ParameterBox, along_u: bool) {
        let length = self.arena.len() - start;
        self.arena.extend_from_within(start..);
        let (right, left) = self.arena[start..].split_at_mut(length);
        let (lines, stride, step, degree) = if along_u { (n + 1, n + 1, 1, m) } else { (m + 1, 1, n + 1, n) };
        for line in 0..lines {
            let at = |i: usize| line * step + i * stride;
            for k in 1..=degree {
                for i in 0..=degree - k {
                    right[at(i)] = right[at(i)] * (1.0 - CUT) + right[at(i + 1)] * CUT;
                }
                left[at(k)] = right[at(0)];
            }
        }
        let (mut low, mut high) = (area, area);
        let axis = usize::from(!along_u);
        low.size[axis] *= CUT;
        high.size[axis] *= 1.0 - CUT;
        high.min[axis] += low.size[axis];
        self.boxes.push(high);
        self.boxes.push(low);
    }
}

/// Fills `net` with the weighted distances from both planes; the result bounds their rounding.
fn project(patch: &BezierPatch, ray: &Ray, net: &mut Vec<DVec2>) -> f64 {
    let (a, b) = ray.direction.any_orthonormal_pair();
    // Foot of the patch on the line: distances come out with the rounding of the patch's own size.
    let middle = patch.points[patch.points.len() / 2];
    let origin = ray.origin + ray.direction * (middle - ray.origin).dot(ray.direction);
    let mut scale = 0.0f64;
    net.clear();
    net.extend(patch.points.iter().zip(&patch.weights).map(|(p, w)| {
        let offset: DVec3 = *p - origin;
        scale = scale.max(offset.abs().max_element() * w);
        DVec2::new(a.dot(offset), b.dot(offset)) * *w
    }));
    32.0 * f64::EPSILON * scale
}

fn examine(net: &[DVec2], degree: (usize, usize), area: ParameterBox, tolerance: f64) -> Verdict {
    let (low, high) = hull(net.iter().copied());
    if excludes_zero(low, high, tolerance) {
        return Verdict::Empty;
    }
    let centre = area.min + 0.5 * area.size;
    // Well above what excludes a box, so that boxes at the limit do not fall between the two.
    if low.abs().max(high.abs()).max_element() <= 8.0 * tolerance {
        return Verdict::Root(LineRoot { uv: centre, simple: false });
    }
    // A separating direction that the axes miss: towards the mean of the net.
    let mean = net.iter().copied().sum::<DVec2>();
    let toward = mean.try_normalize().unwrap_or(DVec2::X);
    if net.iter().all(|p| p.dot(toward) > 2.0 * tolerance) {
        return Verdict::Empty;
    }
    let steps = Steps::of(net, degree);
    let split = Verdict::Split { along_u: steps.longest_u >= steps.longest_v };
    let linear = DMat2::from_cols(steps.mean_u, steps.mean_v);
    let across = if steps.longest_u > steps.longest_v { steps.mean_u } else { steps.mean_v }.perp();
    let (least, most) = extremes(net.iter().map(|p| p.dot(across)));
    let rounding = 2.0 * tolerance * across.length();
    if least > rounding || most < -rounding {
        return Verdict::Empty;
    }
    if area.size.max_element() < TANGENT_SIZE {
        let (x, distance) = smallest(net, degree, tolerance);
        if distance > 8.0 * tolerance {
            return Verdict::Empty;
        }
        return Verdict::Root(LineRoot { uv: area.min + x * area.size, simple: false });
    }
    if linear.determinant().abs() <= 1e-9 * steps.longest_u * steps.longest_v {
        return split;
    }
    let inverse = linear.inverse();
    let rounding = tolerance * 2.0 * (inverse.x_axis.abs() + inverse.y_axis.abs());
    let (low, high) = hull(net.iter().map(|p| inverse * *p));
    if (low.cmpgt(rounding) | high.cmplt(-rounding)).any() {
        return Verdict::Empty;
    }
    if !is_one_to_one(net, degree, inverse) {
        return split;
    }
    match newton(net, degree, 0.5 - inverse * bilinear_middle(net, degree)) {
        Some(x) => {
            let uv = area.min + x * area.size;
            let inside = (uv.cmpge(area.min - EDGE) & uv.cmple(area.min + area.size + EDGE)).all();
            if inside { Verdict::Root(LineRoot { uv, simple: true }) } else { split }
        }
        None => split,
    }
}

/// Mean of the corner values: the value at the middle of the bilinear part.
fn bilinear_middle(net: &[DVec2], (m, n): (usize, usize)) -> DVec2 {
    0.25 * (net[0] + net[n] + net[m * (n + 1)] + net[m * (n + 1) + n])
}

fn hull(points: impl Iterator<Item = DVec2>) -> (DVec2, DVec2) {
    points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
}

fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

fn excludes_zero(low: DVec2, high: DVec2, tolerance: f64) -> bool {
    low.max_element() > tolerance || high.min_element() < -tolerance
}

/// Sizes and means of the derivative control vectors.
struct Steps {
    longest_u: f64,
    longest_v: f64,
    mean_u: DVec2,
    mean_v: DVec2,
}

impl Steps {
    fn of(net: &[DVec2], (m, n): (usize, usize)) -> Self {
        let stride = n + 1;
        let (mut longest_u, mut longest_v) = (0.0f64, 0.0f64);
        for i in 0..=m {
            for j in 0..=n {
                let at = i * stride + j;
                if i < m {
                    longest_u = longest_u.max((net[at + stride] - net[at]).length_squared());
                }
                if j < n {
                    longest_v = longest_v.max((net[at + 1] - net[at]).length_squared());
                }
            }
        }
        let ends_u: DVec2 = (0..=n).map(|j| net[m * stride + j] - net[j]).sum();
        let ends_v: DVec2 = (0..=m).map(|i| net[i * stride + n] - net[i * stride]).sum();
        Self {
            longest_u: longest_u.sqrt() * m as f64,
            longest_v: longest_v.sqrt() * n as f64,
            mean_u: ends_u / stride as f64,
            mean_v: ends_v / (m + 1) as f64,
        }
    }
}

/// Whether the net, mapped by `inverse`, has derivatives within 1 of the identity in the maximum norm all
/// over the box: then the map is one-to-one there.
fn is_one_to_one(net: &[DVec2], (m, n): (usize, usize), inverse: DMat2) -> bool {
    let stride = n + 1;
    let (mut off_u, mut off_v) = (DVec2::ZERO, DVec2::ZERO);
    for i in 0..=m {
        for j in 0..=n {
            let at = i * stride + j;
            if i < m {
                let step = inverse * (net[at + stride] - net[at]) * m as f64;
                off_u = off_u.max((step - DVec2::X).abs());
            }
            if j < n {
                let step = inverse * (net[at + 1] - net[at]) * n as f64;
                off_v = off_v.max((step - DVec2::Y).abs());
            }
        }
    }
    (off_u + off_v).max_element() < 0.95
}
