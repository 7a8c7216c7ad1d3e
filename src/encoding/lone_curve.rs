//! What trimming the pixels of a triangle takes. Where one trim segment alone passes through: on which side of it they are.
//!
//! Such a triangle carries the segment with it, so that its pixels look into no grid. Elsewhere the winding number is
//! constant: with the even-odd rule, what is kept lies on one side. The segment's value is the same as in the grid, bit for
//! bit, with values below and above its ends that hold for the whole triangle.

use glam::DVec2;

use super::coverage::{Coverage, MARGIN, any_touching, triangle_coverage};
use crate::kernel::trim::grid::layout::{ENTRY_HI, ENTRY_LO, ENTRY_RATIONAL, ENTRY_SHIFT, FLAG_NON_ZERO};
use crate::kernel::trim::record::{crossing, entry_degree, load};
use crate::kernel::trim::{BELOW_ONE, ParityGrid, TrimStructure};

/// What drawing a triangle takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TriangleTrim {
    /// Nothing of it is kept.
    Empty,
    /// Everything is.
    Whole,
    /// One segment alone passes through it.
    Lone(LoneCurve),
    /// The grid tells what is kept.
    Several,
}

impl TriangleTrim {
    /// That of a triangle of normalised parameters.
    pub fn of(grid: &ParityGrid, corners: [DVec2; 3]) -> Self {
        match triangle_coverage(grid, corners) {
            Coverage::Empty => Self::Empty,
            Coverage::Whole => Self::Whole,
            Coverage::Mixed => LoneCurve::of(grid, corners).map_or(Self::Several, Self::Lone),
        }
    }

    /// Whether the trims keep a part of it only, as far as the grid tells.
    pub fn is_mixed(self) -> bool {
        matches!(self, Self::Lone(_) | Self::Several)
    }
}

/// A segment and the side of it that is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct LoneCurve {
    /// Entry word; its values below and above the ends are those of the triangle.
    pub entry: u32,
    /// Whether points are kept where the value is 0.
    pub zero_kept: bool,
}

impl LoneCurve {
    /// The only segment that touches the triangle of normalised parameters `corners`, if there is one whose record shaders read at
    /// once: a line, a curve of degree 2 or a polynomial cubic.
    pub fn of(grid: &ParityGrid, corners: [DVec2; 3]) -> Option<Self> {
        const VALUES: u32 = ENTRY_LO | ENTRY_HI;
        if grid.header.flags & FLAG_NON_ZERO != 0 {
            return None;
        }
        let mut found: Option<u32> = None;
        let mut is_other = |entry: u32| *found.get_or_insert(entry & !VALUES) != entry & !VALUES;
        // Pixels at the rim of a triangle may lie outside by what rasterizers round.
        let [a, b, c] = corners;
        let (min, max) = (a.min(b).min(c), a.max(b).max(c));
        let margin = ((max - min) / 256.0).max(DVec2::splat(MARGIN));
        let mut several = false;
        each_part(corners, 2, &mut |[a, b, c]| {
            let rect = (a.min(b).min(c), a.max(b).max(c));
            several = several || any_touching(grid, rect, margin, &mut is_other);
        });
        let entry = found.filter(|_| !several)?;
        let degree = entry_degree(entry);
        if degree > 3 || degree == 3 && entry & ENTRY_RATIONAL != 0 {
            return None;
        }
        let values = values(grid, entry, (min - margin, max + margin))?;
        let curve = Self { entry: entry | values, zero_kept: false };
        // What is kept, and whether the grid says so all over the triangle.
        let mut zero_kept = None;
        let mut agrees = true;
        each_part(corners, 2, &mut |[a, b, c]| {
            let p = ((a + b + c) / 3.0).as_vec2();
            let kept = grid.classify(p) != curve.value(grid, p.to_array());
            agrees &= *zero_kept.get_or_insert(kept) == kept;
        });
        Some(Self { zero_kept: zero_kept.filter(|_| agrees)?, ..curve })
    }

    /// Whether a point of the triangle is kept.
    pub fn keeps(&self, grid: &ParityGrid, uv: [f32; 2]) -> bool {
        self.value(grid, uv) != self.zero_kept
    }

    /// Whether the segment's u is larger than that of a point, or what stands for it beyond its ends.
    fn value(&self, grid: &ParityGrid, [u, v]: [f32; 2]) -> bool {
        let address = (grid.header.data_base + (self.entry >> ENTRY_SHIFT)) as usize;
        let ends = load(&grid.data, address);
        if v < ends[1] {
            self.entry & ENTRY_LO != 0
        } else if v >= ends[3] {
            self.entry & ENTRY_HI != 0
        } else {
            crossing(&grid.data, address, ends, self.entry, u, v, &mut ())
        }
    }
}

/// The values below and above the ends of a segment that are those of all points of a rectangle, which holds neither end:
/// those of the side on which the rectangle reaches beyond them. `None` where it reaches around an end.
fn values(grid: &ParityGrid, entry: u32, (min, max): (DVec2, DVec2)) -> Option<u32> {
    let ends = load(&grid.data, (grid.header.data_base + (entry >> ENTRY_SHIFT)) as usize);
    let [u0, v0, u1, v1] = ends.map(f64::from);
    // Points are clamped to the parameters.
    let (min, max) = (min.max(DVec2::ZERO), max.min(DVec2::splat(f64::from(BELOW_ONE))));
    let (below, above) = (min.y < v0, max.y >= v1);
    if v0 == v1 {
        // All that it tells is what is below it.
        return (min.x >= u0.min(u1) && max.x <= u0.max(u1)).then_some(ENTRY_LO);
    }
    let around = match u1.total_cmp(&u0) {
        std::cmp::Ordering::Greater => below && min.x < u0 || above && max.x >= u1,
        std::cmp::Ordering::Less => below && max.x >= u0 || above && min.x < u1,
        std::cmp::Ordering::Equal => below || above,
    };
    // Below the lower end of one that runs to the right lies its right side, above the upper end its left.
    (!around).then_some(if u1 > u0 { ENTRY_HI } else { ENTRY_LO })
}

/// The quarters of the quarters, and so on, of a triangle.
fn each_part([a, b, c]: [DVec2; 3], times: u32, look: &mut impl FnMut([DVec2; 3])) {
    if times == 0 {
        return look([a, b, c]);
    }
    let (p, q, r) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a));
    for part in [[a, p, r], [p, b, q], [r, q, c], [p, q, r]] {
        each_part(part, times - 1, look);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::demo;

    #[test]
    fn a_lone_curve_tells_what_the_grid_tells() {
        let records = demo::model().faces;
        let mut kinds = [0usize; 4];
        for record in records.iter().filter(|f| f.loops.len() > 3) {
            let face = record.derive().expect("valid test data");
            for k in 0..2_000u32 {
                // Anywhere, of any size and shape.
                let part =
                    |i: u32| f64::from((k * 7 + i).wrapping_mul(2_654_435_769) >> 8) / f64::from(1 << 24);
                let a = DVec2::new(part(0), part(1));
                let size = 0.05 * part(6) * part(6);
                let near = |i: u32| {
                    (a + size * (DVec2::new(part(i), part(i + 1)) - 0.5)).clamp(DVec2::ZERO, DVec2::ONE)
                };
                let [b, c] = [near(2), near(4)];
                let trim = TriangleTrim::of(&face.grid, [a, b, c]);
                let kept = |p: DVec2| match trim {
                    TriangleTrim::Empty => Some(false),
                    TriangleTrim::Whole => Some(true),
                    TriangleTrim::Lone(curve) => Some(curve.keeps(&face.grid, p.as_vec2().to_array())),
                    TriangleTrim::Several => None,
                };
                let kind = match trim {
                    TriangleTrim::Empty => 0,
                    TriangleTrim::Whole => 1,
                    TriangleTrim::Lone(_) => 2,
                    TriangleTrim::Several => 3,
                };
                kinds[kind] += 1;
                for i in 0..=12 {
                    for j in 0..=12 - i {
                        let p = a + (b - a) * f64::from(i) / 12.0 + (c - a) * f64::from(j) / 12.0;
                        // Points are clamped to the parameters.
                        let p = p.min(DVec2::splat(f64::from(BELOW_ONE)));
                        let told = face.grid.classify(p.as_vec2());
                        assert!(kept(p).is_none_or(|kept| kept == told), "{trim:?} at {p} of {a} {b} {c}");
                    }
                }
            }
        }
        assert!(kinds.iter().all(|n| *n > 300), "{kinds:?}");
    }
}
