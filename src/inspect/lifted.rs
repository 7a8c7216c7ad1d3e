//! A trim curve lifted into space: the exact curve `S(p(t))`, with a table of points along it.
//!
//! The table (at Bezier breaks of the pcurve and between, finer where the pcurve crosses knots of the surface)
//! gives arc length, a box, and starts for searches; all figures are of the exact curve.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::edge::CurveAddress;
use super::ground::Ground;
use crate::kernel::bezier::BezierCurve2;
use crate::kernel::nurbs::{KnotVector, NurbsCurve2};
use crate::kernel::trim::EdgeId;
use crate::kernel::view::Bounds;

/// Points of the table at most.
const MOST_NODES: usize = 513;
/// A stretch of the table is halved while Simpson's rule changes by more than this part in doing so; what is
/// left is a fifteenth of it.
const ROUGH: f64 = 1e-6;
/// Halvings at most.
const DEPTH: u32 = 6;

/// A point of a lifted curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Parameter.
    pub t: f64,
    /// Native parameters of the surface (as the pcurve gives them).
    pub uv: DVec2,
    /// The point.
    pub point: DVec3,
    /// Derivative by t.
    pub tangent: DVec3,
}

/// An entry of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Parameter.
    pub t: f64,
    /// The point.
    pub point: DVec3,
    /// Length of the derivative.
    pub speed: f64,
    /// Arc length up to here.
    pub length: f64,
}

/// A lifted trim curve.
#[derive(Debug, Clone)]
pub struct LiftedCurve {
    /// Where it is from.
    pub address: CurveAddress,
    /// Part (body) of its face.
    pub part: Option<usize>,
    /// Edge of the model it lies on, where the file says so.
    pub edge: Option<EdgeId>,
    /// Whether the face lies to its left (in uv).
    pub material_left: bool,
    ground: Arc<Ground>,
    pieces: Vec<(BezierCurve2, (f64, f64))>,
    nodes: Vec<Node>,
    bounds: Bounds,
    /// Four times what it bends away from a chord between two nodes.
    bend: f64,
}

impl LiftedCurve {
    /// Lifts `curve` onto `ground`. `None` when its image is not finite.
    pub fn new(
        address: CurveAddress,
        ground: &Arc<Ground>,
        curve: &NurbsCurve2,
        (part, edge): (Option<usize>, Option<EdgeId>),
    ) -> Option<Self> {
        let mut lifted = Self {
            address,
            part,
            edge,
            material_left: true,
            ground: ground.clone(),
            pieces: curve.to_bezier(),
            nodes: Vec::new(),
            bounds: Bounds::EMPTY,
            bend: 0.0,
        };
        if lifted.pieces.is_empty() {
            return None;
        }
        lifted.nodes = lifted.table();
        (lifted.bounds, lifted.bend) = lifted.bounding_box();
        let finite = lifted.nodes.iter().all(|n| n.point.is_finite() && n.length.is_finite());
        finite.then_some(lifted)
    }

    /// The surface.
    pub fn ground(&self) -> &Ground {
        &self.ground
    }

    /// Table of points along it, an odd number, rising in parameter.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// A box that holds it.
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The point at `t`, where the table has it.
    pub fn in_table(&self, t: f64) -> Option<DVec3> {
        self.nodes.binary_search_by(|n| n.t.total_cmp(&t)).ok().map(|k| self.nodes[k].point)
    }

    /// Whether all of it is further than `distance` from `p`, as its table tells without a look at the surface.
    pub fn is_beyond(&self, p: DVec3, distance: f64) -> bool {
        let limit = distance + self.bend;
        // Rounding on the way here must not decide.
        let limit = limit * limit * (1.0 + 1e-9);
        self.nodes.windows(2).all(|w| {
            let (chord, from) = (w[1].point - w[0].point, p - w[0].point);
            let along = from.dot(chord) / chord.length_squared().max(f64::MIN_POSITIVE);
            (from - chord * along.clamp(0.0, 1.0)).length_squared() > limit
        })
    }

    /// Arc length.
    pub fn length(&self) -> f64 {
        self.nodes.last().map_or(0.0, |n| n.length)
    }

    /// First and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        (self.nodes[0].t, self.nodes[self.nodes.len() - 1].t)
    }

    /// First and last point.
    pub fn ends(&self) -> [DVec3; 2] {
        [self.nodes[0].point, self.nodes[self.nodes.len() - 1].point]
    }

    /// Parameters at which the pcurve changes its polynomial.
    pub fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.pieces.iter().map(|p| p.1.0).chain(self.pieces.last().map(|p| p.1.1))
    }

    /// Polynomial pieces of the pcurve with their intervals.
    pub fn pieces(&self) -> &[(BezierCurve2, (f64, f64))] {
        &self.pieces
    }

    /// Whether all of it is one point: shorter than a tenth of a millionth of its face.
    pub fn is_degenerate(&self) -> bool {
        self.length() <= (1e-7 * self.ground.size()).max(16.0 * self.ground.rounding())
    }

    /// Parameters of the surface and their derivative at `t`.
    pub fn uv(&self, t: f64) -> (DVec2, DVec2) {
        let last = self.pieces.len() - 1;
        let at = self.pieces.partition_point(|p| p.1.1 <= t).min(last);
        let (curve, (a, b)) = &self.pieces[at];
        let (uv, derivative) = curve.tangent((t - a) / (b - a));
        (uv, derivative / (b - a))
    }

    /// Point and derivative at `t`.
    pub fn at(&self, t: f64) -> CurvePoint {
        let (uv, d) = self.uv(t);
        let surface = self.ground.tangents(uv);
        CurvePoint { t, uv, point: surface.point, tangent: surface.du * d.x + surface.dv * d.y }
    }

    /// Unit vector at `t` in the tangent plane, across the curve, into the face; beside a pole where there is
    /// none at `t` itself.
    pub fn inward(&self, t: f64) -> Option<DVec3> {
        let (a, b) = self.domain();
        let middle = 0.5 * (a + b);
        [0.0, 1e-6, 1e-3].into_iter().find_map(|step| {
            let (uv, d) = self.uv(t + (middle - t) * step);
            let (surface, normal) = self.ground.frame(uv);
            let along = (surface.du * d.x + surface.dv * d.y).try_normalize()?;
            let left = normal?.cross(along);
            Some(if self.material_left { left } else { -left })
        })
    }

    /// Arc length from the start to `t`.
    pub fn length_to(&self, t: f64) -> f64 {
        let (a, b) = self.span(|n| n.t <= t);
        hermite_length(a, b, t)
    }

    /// Parameter at which `length` of the arc has gone by.
    pub fn parameter_at(&self, length: f64) -> f64 {
        let (a, b) = self.span(|n| n.length <= length);
        if !(b.length > a.length) || length <= a.length {
            return a.t;
        }
        if length >= b.length {
            return b.t;
        }
        // False position; an end that stays counts half the next time (Illinois).
        let (mut low, mut high) = ((a.t, a.length - length), (b.t, b.length - length));
        let mut rose = None;
        for _ in 0..50 {
            let t = low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1));
            let miss = hermite_length(a, b, t) - length;
            if miss == 0.0 || t <= low.0 || t >= high.0 {
                return t.clamp(low.0, high.0);
            }
            let rises = miss < 0.0;
            let stays = if rises { &mut high } else { &mut low };
            if rose == Some(rises) {
                stays.1 *= 0.5;
            }
            if rises {
                low = (t, miss)
            } else {
                high = (t, miss)
            }
            rose = Some(rises);
        }
        0.5 * (low.0 + high.0)
    }

    /// The two neighbouring nodes of which the first is the last that `before` holds for.
    fn span(&self, before: impl Fn(&Node) -> bool) -> (&Node, &Node) {
        let at = self.nodes.partition_point(before).clamp(1, self.nodes.len() - 1);
        (&self.nodes[at - 1], &self.nodes[at])
    }

    fn table(&self) -> Vec<Node> {
        let surface = self.ground.surface();
        let room = (MOST_NODES / 4 / self.pieces.len()).max(1);
        let mut nodes: Vec<Node> = Vec::new();
        let node = |t: f64| {
            let p = self.at(t);
            Node { t, point: p.point, speed: p.tangent.length(), length: 0.0 }
        };
        for (curve, (a, b)) in &self.pieces {
            let (low, high) = curve.hull();
            let crossed = knots_between(surface.knots_u(), low.x, high.x)
                + knots_between(surface.knots_v(), low.y, high.y);
            let count = (1 + crossed).clamp(1, room);
            if nodes.is_empty() {
                nodes.push(node(*a));
            }
            for k in 0..count {
                let at = |k: usize| if k == count { *b } else { a + (b - a) * k as f64 / count as f64 };
                let start = nodes[nodes.len() - 1];
                self.fill(&mut nodes, start, node(0.5 * (at(k) + at(k + 1))), node(at(k + 1)), DEPTH);
            }
        }
        nodes
    }

    /// Appends the nodes after `start` up to `end`, at least four, `middle` among them: as many as arc length by
    /// Simpson's rule asks for.
    fn fill(&self, nodes: &mut Vec<Node>, start: Node, middle: Node, end: Node, depth: u32) {
        let node = |t: f64| {
            let p = self.at(t);
            Node { t, point: p.point, speed: p.tangent.length(), length: 0.0 }
        };
        let simpson = |a: &Node, m: &Node, b: &Node| (b.t - a.t) / 6.0 * (a.speed + 4.0 * m.speed + b.speed);
        let (left, right) = (node(0.5 * (start.t + middle.t)), node(0.5 * (middle.t + end.t)));
        let halves = [simpson(&start, &left, &middle), simpson(&middle, &right, &end)];
        let whole = simpson(&start, &middle, &end);
        let sum = halves[0] + halves[1];
        if depth > 0 && nodes.len() < MOST_NODES && (sum - whole).abs() > ROUGH * sum {
            self.fill(nodes, start, left, middle, depth - 1);
            let reached = nodes[nodes.len() - 1];
            return self.fill(nodes, reached, right, end, depth - 1);
        }
        let mut length = start.length;
        for (a, m, b) in [(start, left, middle), (middle, right, end)] {
            // The first half of the same parabola.
            let first = (b.t - a.t) / 24.0 * (5.0 * a.speed + 8.0 * m.speed - b.speed);
            let both = simpson(&a, &m, &b);
            nodes.push(Node { length: length + first.clamp(0.0, both), ..m });
            length += both;
            nodes.push(Node { length, ..b });
        }
    }

    /// The box of the nodes, grown by what the curve bends away between three of them, and that.
    fn bounding_box(&self) -> (Bounds, f64) {
        let mut bounds = Bounds::of(self.nodes.iter().map(|n| n.point));
        let bend = |w: &[Node]| (w[1].point - 0.5 * (w[0].point + w[2].point)).length();
        let most = self.nodes.windows(3).map(bend).fold(0.0, f64::max);
        let margin = DVec3::splat(most);
        bounds.min -= margin;
        bounds.max += margin;
        (bounds, most)
    }
}

fn knots_between(knots: &KnotVector, low: f64, high: f64) -> usize {
    let all = knots.as_slice();
    let inner = all.partition_point(|k| *k < high).saturating_sub(all.partition_point(|k| *k <= low));
    // Repeated knots count more than once; that only makes the table finer.
    inner.min(2 * knots.control_count())
}

/// Arc length at `t` between two nodes: the cubic with their lengths and speeds.
fn hermite_length(a: &Node, b: &Node, t: f64) -> f64 {
    let h = b.t - a.t;
    let s = ((t - a.t) / h).clamp(0.0, 1.0);
    let r = 1.0 - s;
    let value = a.length * r * r * (1.0 + 2.0 * s)
        + b.length * s * s * (3.0 - 2.0 * s)
        + h * s * r * (a.speed * r - b.speed * s);
    value.clamp(a.length, b.length)
}
