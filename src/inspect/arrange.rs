//! From overlaps to edges, for one cluster of curves that have to do with each other.
//!
//! Every curve is broken where any of its partners changes; the elementary stretches that lie side by side are
//! united, closest first: two naked ones as far apart as an overlap may be, more than two only where they
//! are as good as coincident. Neighbouring stretches with the same partners are joined again. So every part
//! of every curve is in exactly one edge.

use super::edge::{Edge, EdgeKind, EdgeUse};
use super::lifted::LiftedCurve;
use super::nearest::nearest;
use super::overlap::Overlap;
use super::scale::Scale;

/// Rounds in which breaks are carried over to partners; each reaches one partner further.
const ROUNDS: usize = 4;
/// Breaks on one curve at most; more would be a pile of slivers.
const MOST_BREAKS: usize = 4_096;
/// A naked end shorter than this part of its curve is the end of the gap beside it, not an edge of its own.
const SHORT_END: f64 = 0.05;

/// Curves that may share edges, in the order of their addresses.
pub struct Cluster<'a> {
    /// The curves.
    pub curves: Vec<&'a LiftedCurve>,
    /// Overlaps between them; numbers are positions in `curves`.
    pub overlaps: Vec<Overlap>,
    /// Sets of curves that are one edge as a whole.
    pub wholes: Vec<Vec<usize>>,
    /// Ends of curves that stand out past the other side by no more than this belong to the gap.
    pub reach: f64,
}

/// An elementary stretch.
#[derive(Debug, Clone, Copy)]
struct Element {
    curve: usize,
    range: (f64, f64),
}

impl Cluster<'_> {
    /// The edges of the cluster, without gaps.
    pub fn edges(&self) -> Vec<Edge> {
        let alone = self.overlaps.is_empty();
        if alone && self.wholes.len() == 1 && self.wholes[0].len() == self.curves.len() {
            return vec![self.whole_edge()];
        }
        let elements = self.elements();
        let first: Vec<usize> =
            (0..=self.curves.len()).map(|c| elements.partition_point(|e| e.curve < c)).collect();
        let mut sets = Sets::new(elements.len());
        self.unite_wholes(&elements, &first, &mut sets);
        self.unite_overlaps(&elements, &first, &mut sets);
        self.absorb_slivers(&elements, &first, &mut sets);
        self.join(&elements, &mut sets)
    }

    fn whole_edge(&self) -> Edge {
        let elements: Vec<Element> = (0..self.curves.len())
            .map(|curve| Element { curve, range: self.curves[curve].domain() })
            .collect();
        self.edge(&elements)
    }

    /// All elementary stretches, by curve, rising.
    fn elements(&self) -> Vec<Element> {
        let mut breaks: Vec<Vec<f64>> =
            self.curves.iter().map(|c| vec![c.domain().0, c.domain().1]).collect();
        for overlap in &self.overlaps {
            for (curve, range) in overlap.curves.iter().zip(overlap.ranges) {
                let (curve, snap) = (*curve as usize, self.snap(overlap));
                for t in [range.0, range.1] {
                    self.add_break(&mut breaks, curve, t, snap);
                }
            }
        }
        for _ in 0..ROUNDS {
            if !self.carry_breaks(&mut breaks) {
                break;
            }
        }
        let stretches = breaks.iter().enumerate().flat_map(|(curve, breaks)| {
            breaks.windows(2).map(move |w| Element { curve, range: (w[0], w[1]) })
        });
        stretches.collect()
    }

    /// How near breaks of an overlap may be to another to be the same.
    fn snap(&self, overlap: &Overlap) -> f64 {
        let [a, b] = overlap.curves.map(|c| self.curves[c as usize]);
        Scale::join(a, b).max(1.5 * overlap.distance)
    }

    /// The largest of the snaps of the overlaps of curve `c` at `t`.
    fn snap_beside(&self, c: usize, t: f64) -> f64 {
        let at = |o: &&Overlap| {
            (0..2).any(|k| o.curves[k] as usize == c && o.ranges[k].0 <= t && t <= o.ranges[k].1)
        };
        self.overlaps.iter().filter(at).map(|o| self.snap(o)).fold(0.0, f64::max)
    }

    fn add_break(&self, breaks: &mut [Vec<f64>], curve: usize, t: f64, snap: f64) -> bool {
        let (lifted, breaks) = (self.curves[curve], &mut breaks[curve]);
        let at = breaks.partition_point(|b| *b < t);
        let length = lifted.length_to(t);
        let snap = snap.min(0.1 * lifted.length());
        let near = |k: usize| (lifted.length_to(breaks[k]) - length).abs() <= snap;
        if at == 0 || at == breaks.len() || near(at - 1) || near(at) || breaks.len() >= MOST_BREAKS {
            return false;
        }
        breaks.insert(at, t);
        true
    }

    /// Carries the breaks of each curve over to its partners; whether there were new ones.
    fn carry_breaks(&self, breaks: &mut [Vec<f64>]) -> bool {
        let mut new = false;
        for overlap in &self.overlaps {
            for (from, to) in [(0, 1), (1, 0)] {
                let (a, b) = (overlap.curves[from] as usize, overlap.curves[to] as usize);
                new |= self.carry(
                    breaks,
                    (a, overlap.ranges[from]),
                    (b, overlap.ranges[to]),
                    self.snap(overlap),
                );
            }
        }
        for whole in &self.wholes {
            for pair in whole.windows(2) {
                for (a, b) in [(pair[0], pair[1]), (pair[1], pair[0])] {
                    let snap = Scale::whole(self.curves[a]);
                    new |=
                        self.carry(breaks, (a, self.curves[a].domain()), (b, self.curves[b].domain()), snap);
                }
            }
        }
        new
    }

    fn carry(
        &self,
        breaks: &mut [Vec<f64>],
        (a, range): (usize, (f64, f64)),
        (b, image): (usize, (f64, f64)),
        snap: f64,
    ) -> bool {
        let inner: Vec<f64> = breaks[a].iter().copied().filter(|t| *t > range.0 && *t < range.1).collect();
        let mut new = false;
        for t in inner {
            let foot = nearest(self.curves[b], self.curves[a].at(t).point, image).at.t;
            if foot > image.0 && foot < image.1 {
                new |= self.add_break(breaks, b, foot, snap);
            }
        }
        new
    }

    fn unite_wholes(&self, elements: &[Element], first: &[usize], sets: &mut Sets) {
        for whole in &self.wholes {
            let lead = whole[0];
            for &other in &whole[1..] {
                for e in first[lead]..first[lead + 1] {
                    let f = self.beside(elements, first, e, other);
                    sets.unite(e, f);
                }
            }
        }
    }

    /// The element of curve `other` beside the middle of element `e`.
    fn beside(&self, elements: &[Element], first: &[usize], e: usize, other: usize) -> usize {
        let element = &elements[e];
        let curve = self.curves[element.curve];
        if first[other + 1] - first[other] == 1 {
            return first[other];
        }
        let middle = curve.at(middle(element)).point;
        let t = nearest(self.curves[other], middle, self.curves[other].domain()).at.t;
        let within = &elements[first[other]..first[other + 1]];
        first[other] + within.partition_point(|f| f.range.1 <= t).min(within.len() - 1)
    }

    fn unite_overlaps(&self, elements: &[Element], first: &[usize], sets: &mut Sets) {
        let mut order: Vec<usize> = (0..self.overlaps.len()).collect();
        let of = |k: usize| &self.overlaps[k];
        order.sort_by(|x, y| {
            of(*x).distance.total_cmp(&of(*y).distance).then(of(*x).curves.cmp(&of(*y).curves))
        });
        for overlap in order.into_iter().map(of) {
            let [a, b] = overlap.curves.map(|c| c as usize);
            let within = |e: &Element| {
                let m = middle(e);
                m > overlap.ranges[0].0 && m < overlap.ranges[0].1
            };
            for e in (first[a]..first[a + 1]).filter(|e| within(&elements[*e])) {
                let f = self.beside(elements, first, e, b);
                let m = middle(&elements[f]);
                let matches = m > overlap.ranges[1].0 && m < overlap.ranges[1].1;
                let alone = sets.is_alone(e) && sets.is_alone(f);
                if matches && (alone || overlap.tight) && e != f {
                    sets.unite(e, f);
                }
            }
        }
    }

    /// Gives naked stretches that are shorter than the gap beside them to the neighbour they belong to, and
    /// naked ends: a face slid along its edge leaves one at each end, as long as it was slid.
    fn absorb_slivers(&self, elements: &[Element], first: &[usize], sets: &mut Sets) {
        for c in 0..self.curves.len() {
            let range = first[c]..first[c + 1];
            if range.len() < 2 {
                continue;
            }
            for e in range.clone() {
                let curve = self.curves[c];
                let (a, b) = elements[e].range;
                let length = curve.length_to(b) - curve.length_to(a);
                if !sets.is_alone(e) || length > 0.1 * curve.length() {
                    continue;
                }
                let neighbours = [e.checked_sub(1), Some(e + 1)].into_iter().flatten();
                let is_end = e == range.start || e + 1 == range.end;
                let short_end = is_end && length <= self.reach.min(SHORT_END * curve.length());
                let taker = neighbours.filter(|n| range.contains(n)).find(|n| {
                    let short = short_end || length <= 2.0 * self.snap_beside(c, middle(&elements[*n]));
                    short && !sets.is_alone(*n)
                });
                if let Some(taker) = taker {
                    sets.unite(e, taker);
                }
            }
        }
    }

    /// One edge for each run of sets that have the same curves next to each other.
    fn join(&self, elements: &[Element], sets: &mut Sets) -> Vec<Edge> {
        let members = sets.members();
        let mut edges: Vec<Vec<Element>> = Vec::new();
        // The edge that ends, at each curve's current end, with the set before.
        let mut last: Vec<Option<usize>> = vec![None; self.curves.len()];
        for set in members {
            let mut parts: Vec<Element> = set.iter().map(|e| elements[*e]).collect();
            merge(&mut parts);
            let before = last[parts[0].curve];
            let grown = before.and_then(|edge| self.grown(&edges[edge], &parts).map(|g| (edge, g)));
            let edge = match grown {
                Some((edge, grown)) => {
                    edges[edge] = grown;
                    edge
                }
                None => {
                    edges.push(parts.clone());
                    edges.len() - 1
                }
            };
            for part in &parts {
                last[part.curve] = Some(edge);
            }
        }
        edges.iter().map(|parts| self.edge(parts)).collect()
    }

    /// `edge` with `more` appended, when each of its curves goes on in one of `more`, all at the same place.
    fn grown(&self, edge: &[Element], more: &[Element]) -> Option<Vec<Element>> {
        if edge.len() != more.len() {
            return None;
        }
        let mut place = None;
        let mut joined = Vec::with_capacity(edge.len());
        for (a, b) in edge.iter().zip(more) {
            let forward = a.range.1 == b.range.0;
            if a.curve != b.curve || !(forward || b.range.1 == a.range.0) {
                return None;
            }
            let curve = self.curves[a.curve];
            let point = curve.at(if forward { b.range.0 } else { a.range.0 }).point;
            let place = *place.get_or_insert(point);
            let length = |e: &Element| curve.length_to(e.range.1) - curve.length_to(e.range.0);
            // Circles that start in different places go on in each other at both.
            if (point - place).length() > 0.3 * length(a).min(length(b)) {
                return None;
            }
            let range = (a.range.0.min(b.range.0), a.range.1.max(b.range.1));
            joined.push(Element { curve: a.curve, range });
        }
        Some(joined)
    }

    fn edge(&self, parts: &[Element]) -> Edge {
        let lead = &parts[0];
        let lead_curve = self.curves[lead.curve];
        let uses: Vec<EdgeUse> = parts
            .iter()
            .enumerate()
            .map(|(k, part)| {
                let curve = self.curves[part.curve];
                let here = curve.at(middle(part));
                let there = nearest(lead_curve, here.point, lead.range).at;
                EdgeUse {
                    curve: curve.address,
                    interval: part.range,
                    forward: k == 0 || here.tangent.dot(there.tangent) >= 0.0,
                    length: curve.length_to(part.range.1) - curve.length_to(part.range.0),
                }
            })
            .collect();
        Edge { kind: self.kind(parts), uses, gap: None }
    }

    fn kind(&self, parts: &[Element]) -> EdgeKind {
        let face = |e: &Element| self.curves[e.curve].address.face;
        match parts {
            [one] if self.curves[one.curve].is_degenerate() => EdgeKind::Degenerate,
            [_] => EdgeKind::Naked,
            [a, b] if face(a) == face(b) => EdgeKind::Seam,
            [_, _] => EdgeKind::Shared,
            _ => EdgeKind::NonManifold,
        }
    }
}

fn middle(e: &Element) -> f64 {
    0.5 * (e.range.0 + e.range.1)
}

/// Joins touching elements of the same curve; `parts` are sorted by curve and parameter.
fn merge(parts: &mut Vec<Element>) {
    parts.dedup_by(|b, a| {
        let touch = a.curve == b.curve && a.range.1 == b.range.0;
        if touch {
            a.range.1 = b.range.1;
        }
        touch
    });
}

/// Disjoint sets of elements (union-find).
struct Sets {
    parent: Vec<usize>,
    size: Vec<usize>,
}

impl Sets {
    fn new(count: usize) -> Self {
        Self { parent: (0..count).collect(), size: vec![1; count] }
    }

    fn root(&mut self, mut e: usize) -> usize {
        while self.parent[e] != e {
            self.parent[e] = self.parent[self.parent[e]];
            e = self.parent[e];
        }
        e
    }

    fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        if a != b {
            let (low, high) = (a.min(b), a.max(b));
            self.parent[high] = low;
            self.size[low] += self.size[high];
        }
    }

    fn is_alone(&mut self, e: usize) -> bool {
        let root = self.root(e);
        self.size[root] == 1
    }

    /// The sets, each rising, in the order of their first members.
    fn members(&mut self) -> Vec<Vec<usize>> {
        let mut place: Vec<Option<usize>> = vec![None; self.parent.len()];
        let mut sets: Vec<Vec<usize>> = Vec::new();
        for e in 0..self.parent.len() {
            let root = self.root(e);
            match place[root] {
                Some(k) => sets[k].push(e),
                None => {
                    place[root] = Some(sets.len());
                    sets.push(vec![e]);
                }
            }
        }
        sets
    }
}
