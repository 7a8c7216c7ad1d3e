//! Vertices inside a face to begin with: rows as far apart as the curvature allows.
//!
//! Where a surface bends both ways, triangles with corners on the circle over which it rises by the tolerance are as large as
//! they can be, and nearest to as many as possible is an even lattice of them. So rows of one parameter are laid a
//! height of such a triangle apart, and vertices on each a side apart, every second row by half a side along; both follow
//! the curvature over a grid of samples. Refinement then has little to add: it would else put one vertex after the other
//! where the next one makes it superfluous.

use glam::DVec2;

use super::bends::{Bends, SAMPLES};
use crate::kernel::trim::UvRect;

/// Sides and heights of the triangles for circles of radius one.
const SIDE: f64 = 1.732;
const HEIGHT: f64 = 1.5;
/// Part of the tolerance that lattices are made for.
const PART: f64 = 0.92;
/// Directions along which the face is shorter than this many steps get no vertices.
const FEWEST: f64 = 1.3;

/// A vertex to begin with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seed {
    /// Native parameters.
    pub uv: DVec2,
    /// Distances of its neighbours in u and in v.
    pub spacing: DVec2,
}

/// About how many lattice vertices the part `bounds` of a face takes, were all of it inside.
pub(super) fn expected(bends: &Bends, bounds: &UvRect, tolerance: f64) -> f64 {
    let area = bounds.size().x * bounds.size().y / (HEIGHT * SIDE * 2.0 * PART * tolerance);
    let all = bends.bends.iter().zip(&bends.depths);
    let mean = all.map(|(b, depth)| (b.x * b.y).sqrt() / depth).sum::<f64>() / bends.bends.len() as f64;
    let count = area * mean;
    if count.is_finite() { count } else { 0.0 }
}

/// Lattice vertices over the part `bounds` of a face, at most about `most`; `None` where it would take more.
pub(super) fn seeds(bends: &Bends, bounds: &UvRect, tolerance: f64, most: usize) -> Option<Vec<Seed>> {
    let size = bounds.size();
    if !(size.min_element() > 0.0) {
        return Some(Vec::new());
    }
    // Per native parameter: one over the radius of the circle at the samples.
    let per = |bend: f64| (bend / (2.0 * PART * tolerance)).sqrt();
    let density = |k: usize| {
        let share = DVec2::new((k / SAMPLES) as f64 + 0.5, (k % SAMPLES) as f64 + 0.5) / SAMPLES as f64;
        let bend = bends.at(bounds.native(share));
        DVec2::new(per(bend.x), per(bend.y))
    };
    let grid: Vec<DVec2> = (0..SAMPLES * SAMPLES).map(density).collect();
    // Rows run along the direction in which their own spacing changes least.
    let rows_of_v = uneven(&grid, 1, 0) <= uneven(&grid, 0, 1);
    let (along, across) = if rows_of_v { (0, 1) } else { (1, 0) };
    let index = |i: usize, j: usize| if rows_of_v { i * SAMPLES + j } else { j * SAMPLES + i };
    let cell = size / SAMPLES as f64;
    let mean = |j: usize| (0..SAMPLES).map(|i| grid[index(i, j)][across]).sum::<f64>() / SAMPLES as f64;
    let down: Vec<f64> = (0..SAMPLES).map(|j| mean(j) * cell[across] / HEIGHT).collect();
    let total: f64 = down.iter().sum();
    let widest = (0..SAMPLES)
        .map(|j| (0..SAMPLES).map(|i| grid[index(i, j)][along]).sum::<f64>() * cell[along] / SIDE)
        .fold(0.0, f64::max);
    if !(total >= FEWEST && widest >= FEWEST) {
        return Some(Vec::new());
    }
    if !(total * widest < most as f64) {
        return None;
    }
    let rows = total.round().max(2.0) as usize;
    let mut seeds = Vec::new();
    for row in 1..rows {
        let at = share(&down, total * row as f64 / rows as f64);
        let j = (at as usize).min(SAMPLES - 1);
        let steps: Vec<f64> = (0..SAMPLES).map(|i| grid[index(i, j)][along] * cell[along] / SIDE).collect();
        let length: f64 = steps.iter().sum();
        let count = length.round().max(1.0) as usize;
        let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
        for k in 0..count {
            let step = k as f64 + shift;
            if step == 0.0 {
                continue;
            }
            let place = share(&steps, length * step / count as f64);
            let i = (place as usize).min(SAMPLES - 1);
            let mut uv = DVec2::ZERO;
            uv[along] = bounds.min[along] + place * cell[along];
            uv[across] = bounds.min[across] + at * cell[across];
            let mut spacing = DVec2::ZERO;
            spacing[along] = cell[along] / steps[i].max(1e-300);
            spacing[across] = cell[across] / down[j].max(1e-300);
            seeds.push(Seed { uv, spacing });
        }
    }
    Some(seeds)
}

/// Where the running sum of `steps` reaches `target`, in steps and shares of one.
fn share(steps: &[f64], target: f64) -> f64 {
    let mut before = 0.0;
    for (k, step) in steps.iter().enumerate() {
        if before + step >= target {
            return k as f64 + if *step > 0.0 { (target - before) / step } else { 0.0 };
        }
        before += step;
    }
    steps.len() as f64
}

/// How much the density along `axis` changes in the direction `other`, relative to itself.
fn uneven(grid: &[DVec2], axis: usize, other: usize) -> f64 {
    let at = |i: usize, j: usize| {
        if other == 0 { grid[i * SAMPLES + j][axis] } else { grid[j * SAMPLES + i][axis] }
    };
    let mut worst = 0.0f64;
    for j in 0..SAMPLES {
        let line = || (0..SAMPLES).map(|i| at(i, j));
        let (low, high) = line().fold((f64::INFINITY, 0.0f64), |(l, h), x| (x.min(l), x.max(h)));
        worst = worst.max((high - low) / high.max(f64::MIN_POSITIVE));
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattices_follow_the_curvature_and_developable_faces_have_none() {
        let bounds = UvRect { min: DVec2::ZERO, max: DVec2::new(1.0, 2.0) };
        let even = Bends {
            bounds,
            bends: [DVec2::new(8.0, 8.0); SAMPLES * SAMPLES],
            twist: 0.0,
            depths: [1.0; SAMPLES * SAMPLES],
        };
        let found = seeds(&even, &bounds, 1e-3, 100_000).expect("not too many");
        let (radius, area) = ((2.0 * PART * 1e-3 / 8.0f64).sqrt(), 2.0);
        let expected = area / (SIDE * HEIGHT * radius * radius);
        assert!((found.len() as f64 / expected - 1.0).abs() < 0.1, "{} {expected}", found.len());
        assert!(found.iter().all(|s| s.uv.cmpgt(bounds.min).all() && s.uv.cmplt(bounds.max).all()));
        assert!((found.len() as f64 / super::expected(&even, &bounds, 1e-3) - 1.0).abs() < 0.1);
        assert_eq!(seeds(&even, &bounds, 1e-3, 100), None);
        let bent_once = Bends {
            bounds,
            bends: [DVec2::new(8.0, 0.0); SAMPLES * SAMPLES],
            twist: 0.0,
            depths: [1.0; SAMPLES * SAMPLES],
        };
        assert_eq!(seeds(&bent_once, &bounds, 1e-3, 100_000), Some(Vec::new()));
    }
}
