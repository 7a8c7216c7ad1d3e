//! What to say of all edges at once: counts by kind, quantiles and a histogram of gaps.

use serde::Serialize;

use super::edge::{Edge, EdgeKind};
use super::inspection::Inspection;

/// Number and length of the edges of one kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Tally {
    /// Number of edges.
    pub count: usize,
    /// Their length (model units).
    pub length: f64,
}

/// Edges by kind, and how their gaps are spread.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Statistics {
    /// Edges of two faces.
    pub shared: Tally,
    /// Edges of one face.
    pub naked: Tally,
    /// Edges of three faces or more.
    pub non_manifold: Tally,
    /// Edges of a face with itself.
    pub seam: Tally,
    /// Edges that are one point.
    pub degenerate: Tally,
    /// The largest gap of each edge that has one, rising (model units).
    pub gaps: Vec<f64>,
}

impl Statistics {
    /// Counts the edges of `inspection`.
    pub fn of(inspection: &Inspection) -> Self {
        let mut result = Self::default();
        for (_, edge) in inspection.edges() {
            result.add(edge);
        }
        result.gaps.sort_by(f64::total_cmp);
        result
    }

    fn add(&mut self, edge: &Edge) {
        let tally = match edge.kind {
            EdgeKind::Shared => &mut self.shared,
            EdgeKind::Naked => &mut self.naked,
            EdgeKind::NonManifold => &mut self.non_manifold,
            EdgeKind::Seam => &mut self.seam,
            EdgeKind::Degenerate => &mut self.degenerate,
        };
        tally.count += 1;
        tally.length += edge.length();
        self.gaps.extend(edge.gap.map(|g| g.maximum));
    }

    /// Gives lengths in another unit: `by` of it are one of the present unit.
    pub fn scale(&mut self, by: f64) {
        let tallies =
            [&mut self.shared, &mut self.naked, &mut self.non_manifold, &mut self.seam, &mut self.degenerate];
        tallies.into_iter().for_each(|t| t.length *= by);
        self.gaps.iter_mut().for_each(|g| *g *= by);
    }

    /// The gap that the part `q` (0 to 1) of the edges stays below or at; 0 without gaps.
    pub fn quantile(&self, q: f64) -> f64 {
        let last = self.gaps.len().saturating_sub(1);
        let at = (q.clamp(0.0, 1.0) * last as f64).round() as usize;
        self.gaps.get(at).copied().unwrap_or(0.0)
    }

    /// Number of gaps above `limit` (model units).
    pub fn above(&self, limit: f64) -> usize {
        self.gaps.len() - self.gaps.partition_point(|g| *g <= limit)
    }

    /// Numbers of gaps below the first of `limits` (rising, model units), between each two, and from the last on.
    pub fn histogram(&self, limits: &[f64]) -> Vec<usize> {
        let below: Vec<usize> = limits.iter().map(|l| self.gaps.partition_point(|g| g < l)).collect();
        let first = std::iter::once(0).chain(below.iter().copied());
        let next = below.iter().copied().chain(std::iter::once(self.gaps.len()));
        first.zip(next).map(|(a, b)| b - a).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_gap_is_in_one_bin_and_quantiles_are_gaps() {
        let gaps = vec![0.0, 1e-7, 1e-6, 5e-6, 2e-3, 1.0];
        let statistics = Statistics { gaps, ..Statistics::default() };
        assert_eq!(statistics.histogram(&[1e-6, 1e-3, 1.0]), [2, 2, 1, 1]);
        assert_eq!((statistics.quantile(0.0), statistics.quantile(1.0)), (0.0, 1.0));
        assert_eq!(statistics.above(1e-6), 3);
        assert_eq!(Statistics::default().quantile(0.5), 0.0);
    }
}
