//! The connected parts of a face: one outer loop each, with its holes.
//!
//! An island in a hole is part of one face here, but a trimmed surface (144) has a single outer boundary and
//! other systems make nonsense of loops nested deeper. Nesting is counted on polygons close to the
//! loops; roles are believed where nesting does not speak clearly against them.

use glam::DVec2;

use crate::exchange::boundary::start;
use crate::kernel::nurbs::NurbsCurve2;
use crate::kernel::query::SplineCarrier;
use crate::scene::records::{LoopRecord, LoopRole};

/// Points to a knot span of a curve.
const PARTS: usize = 12;

/// One connected part.
#[derive(Debug, PartialEq)]
pub(crate) struct Region<'a> {
    /// Its outer boundary; the whole surface without.
    pub outer: Option<&'a LoopRecord>,
    /// Its holes.
    pub inner: Vec<&'a LoopRecord>,
}

/// The parts of a face, in the order of their outer loops.
pub(crate) fn regions<'a>(carrier: &SplineCarrier, loops: &[&'a LoopRecord]) -> Vec<Region<'a>> {
    let polygons: Vec<Polygon> = loops.iter().map(|l| Polygon::of(l)).collect();
    let periods = carrier.periods();
    let holders: Vec<Vec<usize>> = (0..loops.len())
        .map(|i| (0..loops.len()).filter(|j| *j != i && polygons[*j].holds(&polygons[i], periods)).collect())
        .collect();
    let holes_only = loops.iter().all(|l| l.role == LoopRole::Inner);
    let depth = |i: usize| holders[i].len() + usize::from(holes_only);
    // A hole cannot hold what is said to bound the face from outside: then one of the two is mislabelled.
    let holds_an_outer =
        |i: usize| (0..loops.len()).any(|j| loops[j].role == LoopRole::Outer && holders[j].contains(&i));
    let bounds_a_part = |i: usize| {
        depth(i).is_multiple_of(2)
            && (loops[i].role != LoopRole::Inner || depth(i) >= 2 || holds_an_outer(i))
            && !loops[i].curves.is_empty()
    };
    let outer: Vec<usize> = (0..loops.len()).filter(|i| bounds_a_part(*i)).collect();
    let mut regions: Vec<Region<'a>> = Vec::new();
    if holes_only || outer.is_empty() {
        regions.push(Region { outer: None, inner: Vec::new() });
    }
    let first = regions.len();
    regions.extend(outer.iter().map(|i| Region { outer: Some(loops[*i]), inner: Vec::new() }));
    for i in (0..loops.len()).filter(|i| !outer.contains(i)) {
        // The innermost part around the hole; a hole that nothing holds stays with the first part.
        let around = (0..outer.len()).filter(|k| holders[i].contains(&outer[*k]));
        let home = around.max_by_key(|k| depth(outer[*k])).map_or(0, |k| first + k);
        regions[home].inner.push(loops[i]);
    }
    regions
}

/// A loop as a polygon in the surface's parameters.
struct Polygon {
    points: Vec<DVec2>,
    min: DVec2,
    max: DVec2,
}

impl Polygon {
    fn of(trim: &LoopRecord) -> Self {
        let points: Vec<DVec2> = trim.curves.iter().flat_map(flattened).collect();
        let (min, max) = points
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(min, max), p| (min.min(*p), max.max(*p)));
        Self { points, min, max }
    }

    /// Whether most of `other` lies inside, moved by whole periods to where this one is.
    fn holds(&self, other: &Self, periods: [Option<f64>; 2]) -> bool {
        const SAMPLES: usize = 7;
        if self.points.len() < 3 || other.points.is_empty() {
            return false;
        }
        let away = 0.5 * (self.min + self.max - other.min - other.max);
        let shift = |k: usize| periods[k].map_or(0.0, |t| (away[k] / t).round() * t);
        let shift = DVec2::new(shift(0), shift(1));
        let count = other.points.len().min(SAMPLES);
        let inside = (0..count)
            .filter(|k| self.contains(other.points[k * other.points.len() / count] + shift))
            .count();
        2 * inside > count
    }

    fn contains(&self, p: DVec2) -> bool {
        if p.cmplt(self.min).any() || p.cmpgt(self.max).any() {
            return false;
        }
        let mut inside = false;
        let mut a = self.points[self.points.len() - 1];
        for b in &self.points {
            if (a.y <= p.y) != (b.y <= p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
            a = *b;
        }
        inside
    }
}

fn flattened(curve: &NurbsCurve2) -> Vec<DVec2> {
    if curve.degree() == 1 && curve.points().len() == 2 {
        return vec![start(curve)];
    }
    let breaks = curve.knots().breaks();
    let at = |w: &[f64], k: usize| curve.point(w[0] + (w[1] - w[0]) * k as f64 / PARTS as f64);
    breaks.windows(2).flat_map(|w| (0..PARTS).map(move |k| at(w, k))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::demo;

    #[test]
    fn islands_become_parts_of_their_own_and_plain_holes_do_not() {
        let model = demo::model();
        let split = |name: &str| {
            let face = model.faces.iter().find(|f| f.name.as_deref() == Some(name)).unwrap();
            let carrier = SplineCarrier::new(face.surface.clone());
            let loops: Vec<&LoopRecord> = face.loops.iter().collect();
            let counts: Vec<usize> = regions(&carrier, &loops).iter().map(|r| r.inner.len()).collect();
            assert_eq!(counts.iter().sum::<usize>() + counts.len(), face.loops.len(), "{name}");
            counts
        };
        assert_eq!(split("Ring").len(), 1);
        // Nested rings and lettering.
        assert!(split("Medal").len() >= 3);
        let sail = split("Sail");
        assert!(sail.len() > 1 && sail[0] > 400 && sail[1..].iter().all(|holes| *holes == 0), "{sail:?}");
    }

    #[test]
    fn roles_decide_where_nesting_does_not() {
        let square = |x: f64, role| {
            let (min, max) = (DVec2::new(x, 0.0), DVec2::new(x + 1.0, 1.0));
            LoopRecord::new(role, demo_rectangle(min, max))
        };
        let carrier = SplineCarrier::new(demo::holes(4).surface);
        let apart = [square(0.0, LoopRole::Outer), square(5.0, LoopRole::Inner)];
        let list: Vec<&LoopRecord> = apart.iter().collect();
        assert_eq!(regions(&carrier, &list), [Region { outer: Some(&apart[0]), inner: vec![&apart[1]] }]);
        let two = [square(0.0, LoopRole::Unknown), square(5.0, LoopRole::Unknown)];
        let list: Vec<&LoopRecord> = two.iter().collect();
        assert_eq!(regions(&carrier, &list).len(), 2);
        // Some programs list a hole of a cylinder as the outer loop of its face.
        let mut swapped = [square(0.25, LoopRole::Outer), square(0.0, LoopRole::Inner)];
        swapped[0].curves = demo_rectangle(DVec2::splat(0.25), DVec2::splat(0.75));
        let list: Vec<&LoopRecord> = swapped.iter().collect();
        assert_eq!(regions(&carrier, &list), [Region { outer: Some(&swapped[1]), inner: vec![&swapped[0]] }]);
        let holes = [square(0.0, LoopRole::Inner), square(5.0, LoopRole::Inner)];
        let list: Vec<&LoopRecord> = holes.iter().collect();
        assert_eq!(regions(&carrier, &list), [Region { outer: None, inner: vec![&holes[0], &holes[1]] }]);
    }

    fn demo_rectangle(min: DVec2, max: DVec2) -> Vec<NurbsCurve2> {
        crate::kernel::primitives::outline::rectangle(min, max)
    }
}
