//! Which stretches between the same two vertices run along each other: seams.
//!
//! The nearest are put together first; what is left alone, two between the same two vertices, may be farther apart.

use std::collections::BTreeMap;

use glam::DVec3;

use super::seams::{Seam, Stretch};
use super::stretches::SAME_FACE;
use crate::kernel::tessellate::Run;

/// Stretches between the same vertices that each one is compared with at most.
const MOST_BESIDE: usize = 24;
/// Two stretches of which one is shorter than this part of the other are not one.
const ALIKE: f64 = 0.5;
/// Runs whose control points are within this part of the reach are one.
const ROUNDING: f64 = 1e-6;
/// Two stretches of which this part of their length is between them are not one, whatever their ends.
const THIN: f64 = 0.05;

/// Stretches to be paired, each with its run and how far off others may be.
pub(super) struct Pairing<'a, 'r> {
    /// The stretches; pairing sets their seams and directions.
    pub(super) stretches: &'a mut [Stretch],
    /// The run of each.
    pub(super) runs: Vec<&'r Run>,
    /// The reach of each.
    pub(super) reaches: Vec<f64>,
    /// About the length of each.
    pub(super) lengths: Vec<f64>,
    /// Reach of two that are left between the same two vertices.
    pub(super) last_two: f64,
}

impl Pairing<'_, '_> {
    /// Puts stretches between the same vertices together where their middles meet.
    pub(super) fn seams(mut self) -> Vec<Seam> {
        let mut groups: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for (k, stretch) in self.stretches.iter().enumerate() {
            let [a, b] = stretch.ends;
            groups.entry([a.min(b), a.max(b)]).or_default().push(k);
        }
        let mut seams: Vec<Seam> = Vec::new();
        for group in groups.into_values() {
            let mut own = self.side_by_side(&group);
            self.pair_last_two(&mut own);
            seams.extend(own.into_iter().map(|stretches| Seam { stretches }));
        }
        seams.sort_by_key(|s| s.stretches[0]);
        for (number, seam) in seams.iter().enumerate() {
            seam.stretches.iter().for_each(|k| self.stretches[*k].seam = number);
        }
        seams
    }

    /// How far apart two stretches may be.
    fn reach(&self, a: usize, b: usize) -> f64 {
        let reach = self.reaches[a].min(self.reaches[b]);
        let one_face = self.stretches[a].address.face == self.stretches[b].address.face;
        if one_face { SAME_FACE * reach } else { reach }
    }

    /// Whether stretch `b` runs along `a`; then whether in the same direction, and how far off.
    fn beside(&self, a: usize, b: usize, reach: f64) -> Option<(bool, f64)> {
        // Both ways round a loop end alike.
        let (short, long) = (self.lengths[a].min(self.lengths[b]), self.lengths[a].max(self.lengths[b]));
        if short + 4.0 * reach < ALIKE * long {
            return None;
        }
        let [x, y] = [a, b].map(|k| (self.runs[k], &self.stretches[k]));
        let (forward, off) = beside(x.0, x.1, y.0, y.1, reach)?;
        if x.1.ends[0] != x.1.ends[1] {
            return Some((forward, off));
        }
        // Of closed ones, one may run along part of the other.
        let back = beside(y.0, y.1, x.0, x.1, reach)?.1;
        Some((forward, off.max(back)))
    }

    /// Where two stretches of different faces are left between the same two vertices, and no others, they are one seam as
    /// long as the gap between them leaves chords their share of the tolerance.
    fn pair_last_two(&mut self, seams: &mut Vec<Vec<usize>>) {
        let [a, b] = match seams.as_slice() {
            [a, b] if a.len() == 1 && b.len() == 1 => [a[0], b[0]],
            _ => return,
        };
        let [x, y] = [self.stretches[a], self.stretches[b]];
        if x.address.face == y.address.face {
            return;
        }
        let short = self.lengths[a].min(self.lengths[b]);
        let reach = self.last_two.max(self.reach(a, b)).min(THIN * short);
        if let Some((forward, _)) = self.beside(a, b, reach) {
            self.stretches[b].forward = forward == self.stretches[a].forward;
            *seams = vec![vec![a, b]];
        }
    }

    /// Parts stretches between the same two vertices into those that run along each other, the nearest first; sets their
    /// directions. Two of the same face are one only if they are as good as one: the sides of a sliver are not.
    fn side_by_side(&mut self, group: &[usize]) -> Vec<Vec<usize>> {
        let mut pairs: Vec<(f64, usize, usize, bool)> = Vec::new();
        for (i, a) in group.iter().enumerate() {
            // Many stretches between two vertices: by the first few.
            for (j, b) in group.iter().enumerate().skip(i + 1).take(MOST_BESIDE) {
                if let Some((forward, off)) = self.beside(*a, *b, self.reach(*a, *b)) {
                    pairs.push((off, i, j, forward));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        // Each stretch's seam, and its direction in it.
        let mut seams: Vec<Vec<(usize, bool)>> = (0..group.len()).map(|i| vec![(i, true)]).collect();
        let mut of: Vec<usize> = (0..group.len()).collect();
        for (off, i, j, forward) in pairs {
            let (a, b) = (of[i].min(of[j]), of[i].max(of[j]));
            let face = |m: &(usize, bool)| self.stretches[group[m.0]].address.face;
            let common = seams[a].iter().any(|m| seams[b].iter().any(|n| face(m) == face(n)));
            if a == b || common && off > SAME_FACE * self.reaches[group[i]].min(self.reaches[group[j]]) {
                continue;
            }
            let direction = |k: usize| seams[of[k]].contains(&(k, true));
            let same = (direction(i) == direction(j)) == forward;
            for (k, along) in std::mem::take(&mut seams[b]) {
                of[k] = a;
                seams[a].push((k, along == same));
            }
        }
        seams.retain(|seam| !seam.is_empty());
        for seam in &mut seams {
            seam.sort_unstable();
            let first = seam[0].1;
            seam.iter().for_each(|(k, along)| self.stretches[group[*k]].forward = *along == first);
        }
        seams.into_iter().map(|seam| seam.into_iter().map(|m| group[m.0]).collect()).collect()
    }
}

/// Whether `b` runs along `a`; then whether in the same direction, and how far off.
fn beside(a: &Run, along: &Stretch, b: &Run, other: &Stretch, reach: f64) -> Option<(bool, f64)> {
    let at = |stretch: &Stretch, share: f64| stretch.range.0 + (stretch.range.1 - stretch.range.0) * share;
    let closed = along.ends[0] == along.ends[1];
    let opposite = !closed && along.ends != other.ends;
    let whole = along.range == (0.0, a.range()) && other.range == (0.0, b.range());
    if !closed && whole && a.is_like(b, !opposite, ROUNDING * reach) {
        return (!opposite || along.ends[0] == other.ends[1]).then_some((!opposite, 0.0));
    }
    let near = |p: DVec3, guess: f64| {
        let foot = |guess: f64| {
            let s = a.project(p, guess, along.range);
            Some((s, a.point(s).distance(p))).filter(|f| f.1 <= reach)
        };
        // Mostly the two are run through alike.
        let guess = at(along, if opposite { 1.0 - guess } else { guess });
        (!closed).then(|| foot(guess)).flatten().or_else(|| {
            let (s, off) = a.nearest_within(p, reach)?;
            let (from, to) = along.range;
            if s >= from && s <= to { Some((s, off)) } else { foot(s) }
        })
    };
    let mut off = 0.0f64;
    let mut places = [0.0; 5];
    for (place, share) in places.iter_mut().zip([0.5, 0.3, 0.7, 0.12, 0.88]) {
        let found = near(b.point(at(other, share)), share)?;
        *place = found.0;
        off = off.max(found.1);
    }
    if closed {
        // By the order of places.
        return Some((places[1] < places[2], off));
    }
    if opposite {
        return (along.ends[0] == other.ends[1]).then_some((false, off));
    }
    Some((true, off))
}
