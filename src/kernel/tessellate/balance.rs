//! Vertices beside the surface: where it bends to one side, triangles with corners on it are all on the other side of it.
//!
//! Triangles between points of a surface use half of what a tolerance allows, for they keep to one side. Vertices put off it by
//! nearly the tolerance, away from where it bends to, have the surface pass through their triangles, which may then be
//! nearly twice as deep: that takes half as many. The same holds for chords of curves, which become longer by a factor of
//! 1.4. Saddles and straight lines gain nothing: there vertices stay where they were.

use glam::DVec3;

use super::chords::{ChordLimits, Place, is_within_chord};
use super::outline::Run;
use crate::kernel::nurbs::surface::SurfaceJet;

/// Part of the tolerance that vertices inside are put off the surface by.
pub(super) const BALANCE: f64 = 0.5;
/// Surfaces that bend one way only but for this part of the square of their mean curvature have straight lines: there triangles
/// are long and their corners on the boundary.
const NEARLY: f64 = 0.02;
/// The same as a part of the smallest radius of curvature, at most.
const OF_RADIUS: f64 = 0.1;
/// The same as a part of the distance from the nearest vertex, at most.
pub(super) const OF_DISTANCE: f64 = 0.2;

/// How a surface bends at a place, its derivatives by any parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bend {
    /// Unit normal along `du x dv`.
    pub(super) normal: DVec3,
    /// Normal parts of the second derivatives: uu, uv, vv.
    pub(super) second: DVec3,
    /// The side that the surface bends to along the normal, both ways: 1 or -1, 0 for saddles.
    pub(super) side: f64,
    /// The largest curvature.
    pub(super) sharpest: f64,
}

impl Bend {
    /// From derivatives; `None` where they give no normal.
    pub(super) fn new(jet: &SurfaceJet) -> Option<Self> {
        let cross = jet.du.cross(jet.dv);
        let (length, e, g) = (cross.length(), jet.du.length_squared(), jet.dv.length_squared());
        if !(length > 1e-9 * (e * g).sqrt() && length > 0.0) {
            return None;
        }
        let normal = cross / length;
        let second = DVec3::new(jet.duu.dot(normal), jet.duv.dot(normal), jet.dvv.dot(normal));
        let (l, m, n) = (second.x, second.y, second.z);
        let area = length * length;
        let gauss = (l * n - m * m) / area;
        let mean = 0.5 * (l * g + n * e - 2.0 * m * jet.du.dot(jet.dv)) / area;
        let sharpest = mean.abs() + (mean * mean - gauss).max(0.0).sqrt();
        let side = if gauss > NEARLY * mean * mean { mean.signum() } else { 0.0 };
        Some(Self { normal, second, side, sharpest })
    }

    /// How far along the normal a vertex is put, for a tolerance.
    pub(super) fn shift(&self, tolerance: f64) -> f64 {
        -self.side * (BALANCE * tolerance).min(OF_RADIUS / self.sharpest)
    }
}

/// What a chord with both ends off the curve spans, and one with one end, of a chord on the curve; a percent is left for the
/// proof.
const INNER: f64 = 1.4;
const OUTER: f64 = 1.195;
/// Numbers of chords, each a fortieth more than the one before, that are tried.
const TRIES: usize = 4;

/// Vertices along a smooth stretch of a curve that would take `plain` chords between points of it, or `total` were they
/// divisible: fewer, put off it on the outside of its bends. Both ends stay. `cuts` divides by shares. `None` where that
/// saves nothing or cannot be proved.
pub(super) fn balanced(
    run: &Run,
    total: f64,
    plain: usize,
    limits: &ChordLimits,
    cuts: &dyn Fn(&[f64]) -> Vec<f64>,
) -> Option<Vec<Place>> {
    let fewest = 2 + ((total - 2.0 * OUTER) / INNER).ceil().max(0.0) as usize;
    let counts = (0..TRIES).map(|k| fewest + (fewest * k).div_ceil(40));
    counts.take_while(|count| *count < plain).find_map(|count| {
        let mut weights = vec![1.0; count];
        (weights[0], weights[count - 1]) = (OUTER / INNER, OUTER / INNER);
        let cuts = cuts(&weights);
        let points: Vec<DVec3> = cuts.iter().map(|s| run.point(*s)).collect();
        // Chords with one end off the curve are shorter by the ratio.
        let own = |k: usize| {
            let length = points[k].distance(points[k + 1]);
            if k == 0 || k + 1 == count { length * INNER / OUTER } else { length }
        };
        let places: Vec<Place> = (0..=count)
            .map(|k| {
                if k == 0 || k == count {
                    return (cuts[k], DVec3::ZERO);
                }
                let length = own(k - 1).max(own(k));
                let bend = run.curvature(cuts[k]);
                let depth = (bend.length() * length * length / 16.0).min(limits.tolerance);
                (cuts[k], -bend.normalize_or_zero() * depth)
            })
            .collect();
        let at = |k: usize| points[k] + places[k].1;
        let fits = |k: usize| {
            at(k).distance(at(k + 1)) <= limits.length
                && is_within_chord(run, (cuts[k], cuts[k + 1]), [at(k), at(k + 1)], limits.tolerance)
        };
        (0..count).all(fits).then(|| places[1..].to_vec())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::bezier::{BezierCurve2, BezierCurve3};
    use crate::kernel::tessellate::chords::divide;
    use crate::kernel::tessellate::line_error::distance_to_segment;
    use crate::kernel::tessellate::outline::LiftedPiece;
    use crate::kernel::tessellate::{ChordLimits, TessellationOptions};
    use glam::DVec2;

    #[test]
    fn chords_through_a_circle_are_fewer_and_keep_the_tolerance() {
        let corner = |k: usize| {
            let at = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
            (at[k % 4], at[k % 4] + at[(k + 1) % 4], at[(k + 1) % 4])
        };
        let piece = |k: usize| {
            let (a, b, c) = corner(k);
            LiftedPiece {
                uv: BezierCurve2::polynomial(vec![DVec2::X * k as f64, DVec2::X * (k + 1) as f64]),
                space: BezierCurve3 { points: vec![a, b, c], weights: vec![1.0, 0.5f64.sqrt(), 1.0] },
            }
        };
        let run = Run { source: None, pieces: (0..4).map(piece).collect() };
        for tolerance in [0.1, 3e-2, 1e-2, 1e-3, 1e-4] {
            let options = TessellationOptions::new(tolerance);
            let limits = ChordLimits::new(&options);
            let found = divide(&run, &limits, &options);
            let plain = divide(&run, &ChordLimits { balanced: false, ..limits }, &options);
            assert!(plain.iter().all(|s| s.off == DVec3::ZERO && (s.point.length() - 1.0).abs() < 1e-12));
            assert!(found.len() < plain.len(), "{tolerance}: {} {}", found.len(), plain.len());
            assert_eq!((found[0].off, found[found.len() - 1].off), (DVec3::ZERO, DVec3::ZERO));
            for pair in found.windows(2) {
                let farthest = (0..=100)
                    .map(|k| run.point(pair[0].s + (pair[1].s - pair[0].s) * f64::from(k) / 100.0))
                    .map(|p| distance_to_segment(p, pair[0].point, pair[1].point))
                    .fold(0.0, f64::max);
                assert!(farthest <= tolerance, "{farthest} {tolerance}");
            }
        }
    }

    #[test]
    fn vertices_are_put_to_the_outside_of_bowls_and_stay_on_saddles_and_cylinders() {
        let jet = |xx: f64, yy: f64| SurfaceJet {
            point: DVec3::ZERO,
            du: DVec3::X,
            dv: DVec3::Y,
            duu: DVec3::Z * xx,
            duv: DVec3::ZERO,
            dvv: DVec3::Z * yy,
        };
        let shift = |xx, yy| Bend::new(&jet(xx, yy)).expect("a normal").shift(0.1);
        assert_eq!(shift(0.5, 0.25), -BALANCE * 0.1);
        assert_eq!(shift(-0.5, -0.25), BALANCE * 0.1);
        assert_eq!(shift(0.5, -0.25), 0.0);
        assert_eq!(shift(0.5, 0.0), 0.0);
        // Sharper bends take a part of their radius.
        assert!((shift(4.0, 2.0) + OF_RADIUS / 4.0).abs() < 1e-12);
        assert!(Bend::new(&SurfaceJet { dv: DVec3::X, ..jet(1.0, 1.0) }).is_none());
    }
}
