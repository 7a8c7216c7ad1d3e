//! Trim loops of a face record to closed chains of monotone pieces over the unit square.
//!
//! The domain is the box around the loops, cut to the surface in directions in which it is not closed. On closed
//! surfaces loops may lie a period away from each other: they are shifted to the largest one, and copied where
//! they reach over the seam. Rings (loops that go once round) are continued over the whole domain and
//! closed along one border, so that even-odd gives the band between two of them. Orientation and role are
//! not trusted, except that loops which are all marked as inner are holes in the whole surface.

use glam::DVec2;

use super::chain::{Chain, ChainLayer};
use super::clip;
use super::domain::{Periods, UvRect};
use super::loop_record::{LoopRecord, LoopRole};
use super::pieces::PieceList;
use super::remark::TrimRemark;
use crate::kernel::bezier::{BezierCurve2, MonotoneSplitter};
use crate::kernel::nurbs::NurbsSurface;

/// Curves flatter than this, in units of the face's size, are lines.
const STRAIGHT: f64 = 2e-9;
/// Relative slack when boxes are compared.
pub(super) const SLACK: f64 = 1e-6;

/// Loops ready for trimming.
#[derive(Debug, Clone, PartialEq)]
pub struct TrimLoops {
    /// Rectangle of native parameters that the pieces' unit square stands for.
    pub domain: UvRect,
    /// Monotone pieces in normalised parameters.
    pub pieces: PieceList,
    /// Number of Bezier curves before the monotone split.
    pub bezier: usize,
    /// Period in u and v, 0 where not closed (or never needed).
    pub period: DVec2,
    /// What was repaired.
    pub remarks: Vec<TrimRemark>,
    /// For each loop what became of it, then of the border of the surface where that stands for a missing
    /// outer loop. Empty when loops depend on each other or on the surface, as they may on closed ones.
    pub laid: Vec<LaidLoop>,
}

/// What became of one loop; see [`TrimLoops::laid`].
#[derive(Debug, Clone, PartialEq)]
pub struct LaidLoop {
    /// Whether it has any extent.
    pub is_chain: bool,
    /// Number of its Bezier curves.
    pub bezier: usize,
    /// Exact box in native parameters.
    pub rect: UvRect,
    /// How far its pieces reached out of the domain before they were cut off.
    pub overshoot: f64,
    /// Whether a chain of pieces is left.
    pub is_kept: bool,
    /// What was repaired in it.
    pub remarks: Vec<TrimRemark>,
}

/// Prepares the loops of a face. Without loops the surface's own border is the only one.
pub fn prepare(surface: &NurbsSurface, loops: &[LoopRecord]) -> TrimLoops {
    let mut remarks = Vec::new();
    let rect = UvRect::of_surface(surface);
    let mut known: Option<Periods> = None;
    let hull = hull_of_loops(loops);
    let scale = if hull.has_area() { hull.size() } else { rect.size() };
    let mut periods = || *known.get_or_insert_with(|| Periods::of_surface(surface));
    let (mut chains, mut laid) = (Vec::new(), Vec::with_capacity(loops.len()));
    for (loop_index, record) in loops.iter().enumerate() {
        let before = remarks.len();
        let mut layer = ChainLayer { surface: rect, scale, periods: &mut periods, remarks: &mut remarks };
        let chain = layer.lay(loop_index, &record.curves);
        laid.push(LaidLoop::of(chain.as_ref(), remarks[before..].to_vec()));
        chains.extend(chain);
    }
    let reaches_out = (rect.min - hull.min).max_element() > SLACK * scale.max_element()
        || (hull.max - rect.max).max_element() > SLACK * scale.max_element();
    if reaches_out {
        periods();
    }
    let holes_only = !loops.is_empty() && loops.iter().all(|l| l.role == LoopRole::Inner);
    let rings = chains.iter().any(|c| c.turns != DVec2::ZERO);
    if chains.is_empty() || (holes_only && !rings) {
        if !loops.is_empty() {
            remarks.push(TrimRemark::NoOuterLoop);
        }
        chains.push(rectangle(rect));
    }
    if chains.len() > laid.iter().filter(|l| l.is_chain).count() {
        laid.push(LaidLoop::of(chains.last(), Vec::new()));
    }
    if rings || known.is_some() {
        laid.clear();
    }
    let bezier = chains.iter().map(|c| c.curves.iter().filter(|c| c.1.is_some()).count()).sum();
    let boxes: Vec<UvRect> = chains.iter().map(bounds).collect();
    let arranger = Arranger { rect, periods: known.unwrap_or_default(), remarks: &mut remarks };
    let (chains, domain) = arranger.arrange(chains, &boxes);
    let mut pieces = PieceList::default();
    let mut splitter = Splitter::new(domain);
    let mut overshoot = 0.0f64;
    let mut laid_chains = laid.iter_mut().filter(|l| l.is_chain).zip(&boxes);
    for chain in &chains {
        let (beyond, is_kept) = splitter.append(chain, &mut pieces);
        overshoot = overshoot.max(beyond);
        if let Some((laid, rect)) = laid_chains.next() {
            (laid.overshoot, laid.is_kept, laid.rect) = (beyond, is_kept, *rect);
        }
    }
    if overshoot > SLACK && known.is_none_or(|p| p.period == DVec2::ZERO) {
        remarks.push(TrimRemark::BeyondSurface { relative: overshoot });
    }
    TrimLoops { domain, pieces, bezier, period: known.unwrap_or_default().period, remarks, laid }
}

impl LaidLoop {
    pub(super) fn of(chain: Option<&Chain>, remarks: Vec<TrimRemark>) -> Self {
        Self {
            is_chain: chain.is_some(),
            bezier: chain.map_or(0, |c| c.curves.iter().filter(|c| c.1.is_some()).count()),
            rect: UvRect::EMPTY,
            overshoot: 0.0,
            is_kept: false,
            remarks,
        }
    }
}

pub(super) fn hull_of_loops(loops: &[LoopRecord]) -> UvRect {
    let mut hull = UvRect::EMPTY;
    for curve in loops.iter().flat_map(|l| &l.curves) {
        curve.points().iter().for_each(|p| hull.include(*p));
    }
    hull
}

fn rectangle(rect: UvRect) -> Chain {
    let corners = rect.corners();
    let side = |i: usize| (BezierCurve2::polynomial(vec![corners[i], corners[(i + 1) % 4]]), None);
    Chain { loop_index: 0, curves: (0..4).map(side).collect(), turns: DVec2::ZERO }
}

/// Exact box of a chain.
pub(super) fn bounds(chain: &Chain) -> UvRect {
    let mut rect = UvRect::EMPTY;
    let mut splitter = MonotoneSplitter::default();
    for (curve, _) in &chain.curves {
        splitter.split(&curve.points, &curve.weights, 0.0, |p, _| {
            rect.include(p[0]);
            rect.include(p[p.len() - 1]);
        });
    }
    rect
}

fn shifted(chain: &Chain, by: DVec2) -> Chain {
    let curves = chain.curves.iter().map(|(c, s)| (c.map_points(|p| p + by), *s)).collect();
    Chain { curves, ..*chain }
}

/// Turns chains into monotone pieces normalised to a domain.
pub(super) struct Splitter {
    domain: UvRect,
    splitter: MonotoneSplitter,
    points: Vec<DVec2>,
}

impl Splitter {
    pub fn new(domain: UvRect) -> Self {
        Self { domain, splitter: MonotoneSplitter::default(), points: Vec::new() }
    }

    /// Adds the pieces of a chain, cut to the unit square. Says how far they reached out of it, and
    /// whether anything is left.
    pub fn append(&mut self, chain: &Chain, list: &mut PieceList) -> (f64, bool) {
        let before = list.chain_count();
        for (curve, source) in &chain.curves {
            self.points.clear();
            self.points.extend(curve.points.iter().map(|p| self.domain.normalise(*p)));
            self.splitter.split(&self.points, &curve.weights, STRAIGHT, |p, w| list.push(p, w, *source));
        }
        list.close_chain();
        if list.chain_count() == before {
            return (0.0, false);
        }
        let overshoot = clip::overshoot(list, list.chain(before));
        if overshoot > 0.0 {
            clip::last_chain_to_unit_square(list);
        }
        (overshoot, list.chain_count() > before)
    }
}

struct Arranger<'a> {
    rect: UvRect,
    periods: Periods,
    remarks: &'a mut Vec<TrimRemark>,
}

impl Arranger<'_> {
    /// All chains closed and in one place, with the domain.
    fn arrange(mut self, chains: Vec<Chain>, boxes: &[UvRect]) -> (Vec<Chain>, UvRect) {
        if chains.iter().any(|c| c.turns != DVec2::ZERO) {
            let (rings, closed): (Vec<_>, Vec<_>) =
                chains.into_iter().zip(boxes).partition(|(c, _)| c.turns != DVec2::ZERO);
            return self.with_rings(rings.into_iter().unzip(), closed.into_iter().unzip());
        }
        let closed = chains;
        let all = boxes.iter().fold(UvRect::EMPTY, |a, b| a.union(*b));
        let mut domain = self.on_surface(all);
        if self.periods.period == DVec2::ZERO || closed.len() < 2 {
            return (closed, domain);
        }
        let area = |r: &UvRect| r.size().x * r.size().y;
        let largest =
            (0..boxes.len()).max_by(|a, b| area(&boxes[*a]).total_cmp(&area(&boxes[*b]))).unwrap_or(0);
        let main = boxes[largest];
        let mut placed = Vec::new();
        domain = main;
        for (i, chain) in closed.into_iter().enumerate() {
            if i == largest {
                placed.push(chain);
                continue;
            }
            for by in self.places(&boxes[i], &main) {
                let full = self.is_full(&main);
                let moved = UvRect { min: boxes[i].min + by, max: boxes[i].max + by };
                for axis in 0..2 {
                    if !full[axis] {
                        domain.min[axis] = domain.min[axis].min(moved.min[axis]);
                        domain.max[axis] = domain.max[axis].max(moved.max[axis]);
                    }
                }
                placed.push(if by == DVec2::ZERO { chain.clone() } else { shifted(&chain, by) });
            }
        }
        (placed, self.on_surface(domain))
    }

    /// Cuts a box to the surface where that is not closed.
    fn on_surface(&self, mut rect: UvRect) -> UvRect {
        for axis in 0..2 {
            if self.periods.period[axis] == 0.0 {
                rect.min[axis] = rect.min[axis].max(self.rect.min[axis]);
                rect.max[axis] = rect.max[axis].min(self.rect.max[axis]);
            }
        }
        rect
    }

    /// In which directions `main` spans a whole period.
    fn is_full(&self, main: &UvRect) -> [bool; 2] {
        [0, 1].map(|axis| {
            let period = self.periods.period[axis];
            period > 0.0 && main.size()[axis] > (1.0 - SLACK) * period
        })
    }

    /// Shifts by whole periods that bring a box into `main`: one, or all that overlap it where `main`
    /// spans a whole period.
    fn places(&self, rect: &UvRect, main: &UvRect) -> Vec<DVec2> {
        let full = self.is_full(main);
        let along = |axis: usize| -> Vec<f64> {
            let period = self.periods.period[axis];
            if period == 0.0 {
                return vec![0.0];
            }
            let (low, high) = (rect.min[axis], rect.max[axis]);
            let slack = SLACK * period;
            let outside =
                |by: f64| (main.min[axis] - low - by).max(0.0) + (high + by - main.max[axis]).max(0.0);
            let centre = ((main.min[axis] + main.max[axis] - low - high) / (2.0 * period)).round();
            let candidates = [-1.0, 0.0, 1.0].map(|k| (centre + k) * period);
            let best =
                candidates.into_iter().min_by(|a, b| outside(*a).total_cmp(&outside(*b))).unwrap_or(0.0);
            // Not moved without need.
            let best = if outside(0.0) <= outside(best) + slack { 0.0 } else { best };
            if !full[axis] || outside(best) <= slack {
                return vec![best];
            }
            let overlaps = |by: f64| high + by > main.min[axis] + slack && low + by < main.max[axis] - slack;
            candidates.into_iter().filter(|by| overlaps(*by)).collect()
        };
        let (us, vs) = (along(0), along(1));
        us.iter().flat_map(|u| vs.iter().map(|v| DVec2::new(*u, *v))).collect()
    }

    fn with_rings(
        &mut self,
        (rings, ring_boxes): (Vec<Chain>, Vec<UvRect>),
        (closed, boxes): (Vec<Chain>, Vec<UvRect>),
    ) -> (Vec<Chain>, UvRect) {
        // Rings that go round both ways are taken by the direction of u.
        let axis = if rings[0].turns.x != 0.0 { 0 } else { 1 };
        let other = 1 - axis;
        let period = self.periods.period[axis];
        let mut domain = self.rect;
        domain.max[axis] = domain.min[axis] + period;
        let close_high = self.close_high(&rings, axis);
        // With an even number of rings the border they close along cancels out: cut there.
        let all = ring_boxes.iter().chain(&boxes).fold(UvRect::EMPTY, |a, b| a.union(*b));
        if rings.len().is_multiple_of(2) {
            domain.min[other] = all.min[other];
            domain.max[other] = all.max[other];
        } else if close_high {
            domain.min[other] = all.min[other];
        } else {
            domain.max[other] = all.max[other];
        }
        let domain = self.on_surface(domain);
        let border = if close_high { domain.max[other] } else { domain.min[other] };
        let mut chains = Vec::new();
        for (ring, rect) in rings.iter().zip(&ring_boxes) {
            self.remarks.push(TrimRemark::OpenByPeriod { loop_index: ring.loop_index });
            chains.push(close_ring(ring, rect, axis, period, &domain, border));
        }
        for (chain, rect) in closed.iter().zip(&boxes) {
            chains.extend(self.places(rect, &domain).into_iter().map(|by| shifted(chain, by)));
        }
        (chains, domain)
    }

    /// On which side of a single ring the face lies: towards the only pole, else to its left.
    fn close_high(&self, rings: &[Chain], axis: usize) -> bool {
        let poles = self.periods.poles[1 - axis];
        if poles[0] != poles[1] {
            return poles[1];
        }
        let forward = rings[0].turns[axis] > 0.0;
        forward == (axis == 0)
    }
}

/// Repeats a ring over the whole domain and closes it along the border.
fn close_ring(ring: &Chain, rect: &UvRect, axis: usize, period: f64, domain: &UvRect, border: f64) -> Chain {
    let turns = ring.turns;
    let forward = turns[axis] > 0.0;
    let reach = turns[axis].abs();
    // Copies k with rect + k * reach over the domain, one to spare on either side.
    let first = ((domain.min[axis] - rect.max[axis]) / reach).floor() - 1.0;
    let last = ((domain.max[axis] - rect.min[axis]) / reach).ceil() + 1.0;
    let count = (last - first).clamp(1.0, 64.0 + 8.0 * (period / reach)) as i32;
    let mut chain = Chain { loop_index: ring.loop_index, ..Chain::default() };
    for k in 0..=count {
        let step = if forward { first + f64::from(k) } else { last - f64::from(k) };
        // A backward ring's turns point backward: its copies follow each other downwards.
        let by = turns.abs() * step;
        let copy = shifted(ring, by);
        if let (Some((before, _)), Some((next, _))) = (chain.curves.last(), copy.curves.first()) {
            let line = vec![before.end(), next.start()];
            if line[0] != line[1] {
                chain.curves.push((BezierCurve2::polynomial(line), None));
            }
        }
        chain.curves.extend(copy.curves);
    }
    if let (Some((head, _)), Some((tail, _))) = (chain.curves.first(), chain.curves.last()) {
        let (start, end) = (head.start(), tail.end());
        let at_border = |p: DVec2| if axis == 0 { DVec2::new(p.x, border) } else { DVec2::new(border, p.y) };
        for line in [[end, at_border(end)], [at_border(end), at_border(start)], [at_border(start), start]] {
            chain.curves.push((BezierCurve2::polynomial(line.to_vec()), None));
        }
    }
    chain
}
