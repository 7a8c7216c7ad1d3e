//! From a loop record to one closed chain of Bezier curves in native parameters.
//!
//! Curves are laid end to end: a jump by a period of a closed surface is undone by shifting what
//! follows, any other gap is closed with a line. A chain that ends one period away from where it began is a
//! ring, to be closed along the border later.

use glam::DVec2;

use super::domain::{Periods, UvRect};
use super::remark::TrimRemark;
use crate::kernel::bezier::BezierCurve2;
use crate::kernel::nurbs::NurbsCurve2;

/// Curves end to end, each with the number of the record's curve it came from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chain {
    /// Position of the loop in the record.
    pub loop_index: usize,
    /// The curves; `None` marks lines that close gaps.
    pub curves: Vec<(BezierCurve2, Option<u32>)>,
    /// Whole periods between its end and its start; zero for a closed chain.
    pub turns: DVec2,
}

/// Gaps up to this fraction of the face's size are closed by moving an end point.
const SNAP: f64 = 1e-9;
/// Smaller gaps than this fraction are not worth a remark.
const NOTABLE: f64 = 1e-6;
/// A jump counts as whole periods when it misses them by less than this fraction of one.
const PERIOD_SLACK: f64 = 0.02;

/// Lays chains; knows the size against which gaps are judged.
pub struct ChainLayer<'a> {
    /// The surface's domain.
    pub surface: UvRect,
    /// Size of the face in native parameters.
    pub scale: DVec2,
    /// Asked only when there is a gap: the surface's periods.
    pub periods: &'a mut dyn FnMut() -> Periods,
    /// Where remarks go.
    pub remarks: &'a mut Vec<TrimRemark>,
}

impl ChainLayer<'_> {
    /// The chain of one loop; `None` when it has no extent.
    pub fn lay(&mut self, loop_index: usize, curves: &[NurbsCurve2]) -> Option<Chain> {
        let mut chain = Chain { loop_index, ..Chain::default() };
        let mut shift = DVec2::ZERO;
        for (number, curve) in self.directed(loop_index, curves).iter().enumerate() {
            for (piece, _) in curve.to_bezier() {
                let (low, high) = piece.hull();
                if self.relative(high - low) < 1e-13 {
                    continue;
                }
                let mut piece = if shift == DVec2::ZERO { piece } else { piece.map_points(|p| p + shift) };
                if let Some((last, _)) = chain.curves.last() {
                    let end = last.end();
                    let turns = self.whole_periods(end, piece.start());
                    if turns != DVec2::ZERO {
                        shift -= turns;
                        piece = piece.map_points(|p| p - turns);
                    }
                    self.bridge(&mut chain, number, end, piece.start());
                }
                chain.curves.push((piece, Some(number as u32)));
            }
        }
        let (Some((first, _)), Some((last, _))) = (chain.curves.first(), chain.curves.last()) else {
            self.remarks.push(TrimRemark::EmptyLoop { loop_index });
            return None;
        };
        let (start, end) = (first.start(), last.end());
        chain.turns = -self.whole_periods(end, start);
        if chain.turns == DVec2::ZERO {
            self.bridge(&mut chain, 0, end, start);
        }
        Some(chain)
    }

    /// The curves, those turned round that run against the others.
    fn directed<'c>(
        &mut self,
        loop_index: usize,
        curves: &'c [NurbsCurve2],
    ) -> std::borrow::Cow<'c, [NurbsCurve2]> {
        let ends = |c: &NurbsCurve2| {
            let (a, b) = c.domain();
            (c.point(a), c.point(b))
        };
        let far = |a: DVec2, b: DVec2| self.relative(a - b) > 1e-3;
        let mut turned: Vec<usize> = Vec::new();
        if curves.len() > 1 {
            let all: Vec<_> = curves.iter().map(ends).collect();
            let mut last = all[0].1;
            // The first one decides for the others; with only it against them it is the one to turn.
            let second = all[1];
            if far(last, second.0)
                && far(last, second.1)
                && !(far(all[0].0, second.0) && far(all[0].0, second.1))
            {
                turned.push(0);
                last = all[0].0;
            }
            for (i, (start, end)) in all.iter().enumerate().skip(1) {
                let next = if far(last, *start) && !far(last, *end) {
                    turned.push(i);
                    *start
                } else {
                    *end
                };
                last = next;
            }
        }
        if turned.is_empty() {
            return curves.into();
        }
        let mut result = curves.to_vec();
        for i in turned {
            result[i] = result[i].reversed();
            self.remarks.push(TrimRemark::Reversed { loop_index, curve: i });
        }
        result.into()
    }

    fn relative(&self, offset: DVec2) -> f64 {
        (offset / self.scale).abs().max_element()
    }

    /// The whole periods by which `to` is away from `from`, zero unless hardly anything else is left
    /// and the jump is not along a pole (where a line closes it).
    fn whole_periods(&mut self, from: DVec2, to: DVec2) -> DVec2 {
        if self.relative(to - from) < 1e-3 {
            return DVec2::ZERO;
        }
        let periods = (self.periods)();
        let mut jump = DVec2::ZERO;
        for axis in 0..2 {
            let period = periods.period[axis];
            if period > 0.0 && !self.along_pole(&periods, axis, from, to) {
                jump[axis] = ((to[axis] - from[axis]) / period).round() * period;
            }
        }
        let rest = to - from - jump;
        let slack = (0..2).all(|axis| {
            let unit = if periods.period[axis] > 0.0 { periods.period[axis] } else { self.scale[axis] };
            rest[axis].abs() < PERIOD_SLACK * unit
        });
        if slack { jump } else { DVec2::ZERO }
    }

    /// Whether both points lie on a pole that runs along `axis`.
    fn along_pole(&self, periods: &Periods, axis: usize, from: DVec2, to: DVec2) -> bool {
        let other = 1 - axis;
        let near = |p: DVec2, border: f64| (p[other] - border).abs() < 1e-4 * self.scale[other];
        let borders = [self.surface.min[other], self.surface.max[other]];
        (0..2).any(|side| periods.poles[other][side] && near(from, borders[side]) && near(to, borders[side]))
    }

    /// Closes a gap with a line when it is too large for moving an end point.
    fn bridge(&mut self, chain: &mut Chain, curve: usize, from: DVec2, to: DVec2) {
        let relative = self.relative(to - from);
        if relative <= SNAP {
            return;
        }
        chain.curves.push((BezierCurve2::polynomial(vec![from, to]), None));
        if relative > NOTABLE {
            let uv = from.distance(to);
            self.remarks.push(TrimRemark::Gap { loop_index: chain.loop_index, curve, uv, relative });
        }
    }
}
