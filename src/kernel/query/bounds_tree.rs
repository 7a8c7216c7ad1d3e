//! A tree of boxes: which of many boxes a line passes, or a point is near.
//!
//! A plain bounding volume hierarchy, split at the median of the longest axis of the box centres; leaves
//! hold up to four items. Items keep their numbers; the order of visits depends on the items only.

use glam::DVec3;

use crate::kernel::view::{Bounds, Ray};

const LEAF: usize = 4;

/// A bounding volume hierarchy over numbered boxes.
#[derive(Debug, Clone, Default)]
pub struct BoundsTree {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Bounds,
    /// Leaf: first item. Inner node: number of the right child; the left one follows its parent.
    first: u32,
    /// Items of a leaf; 0 for inner nodes.
    count: u32,
}

impl BoundsTree {
    /// Builds the tree over `bounds`; empty boxes are never found.
    pub fn new(bounds: &[Bounds]) -> Self {
        let mut items: Vec<u32> =
            (0..bounds.len() as u32).filter(|i| !bounds[*i as usize].is_empty()).collect();
        let mut nodes = Vec::new();
        let count = items.len();
        if count > 0 {
            build(bounds, &mut items, 0..count, &mut nodes);
        }
        Self { nodes, items }
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds {
        self.nodes.first().map_or(Bounds::EMPTY, |n| n.bounds)
    }

    /// Calls `visit` with each item whose box, grown by `margin`, the whole line of `ray` passes.
    pub fn along_line(&self, ray: &Ray, margin: f64, mut visit: impl FnMut(usize)) {
        let inverse = ray.direction.recip();
        self.descend(|b| meets_line(b, ray, inverse, margin), &mut visit);
    }

    /// Calls `visit` with each item whose box lies within `distance` of `point`.
    pub fn within(&self, point: DVec3, distance: f64, mut visit: impl FnMut(usize)) {
        let near = |b: &Bounds| (point.clamp(b.min, b.max) - point).length_squared() <= distance * distance;
        self.descend(near, &mut visit);
    }

    /// The least `distance` of an item from `point`, asked of those only whose boxes may be nearer than the best so far;
    /// infinite without items.
    pub fn nearest(&self, point: DVec3, mut distance: impl FnMut(usize) -> f64) -> f64 {
        let squared = |at: usize| {
            let b = &self.nodes[at].bounds;
            (point.clamp(b.min, b.max) - point).length_squared()
        };
        let mut best = f64::INFINITY;
        let mut stack = Vec::with_capacity(40);
        if !self.nodes.is_empty() {
            stack.push((0, squared(0)));
        }
        while let Some((at, away)) = stack.pop() {
            if away > best * best {
                continue;
            }
            let node = &self.nodes[at];
            if node.count > 0 {
                let items = node.first as usize..(node.first + node.count) as usize;
                best = self.items[items].iter().fold(best, |best, i| best.min(distance(*i as usize)));
            } else {
                let [left, right] = [at + 1, node.first as usize].map(|child| (child, squared(child)));
                // The nearer one is looked at first.
                stack.extend(if left.1 <= right.1 { [right, left] } else { [left, right] });
            }
        }
        best
    }

    /// Calls `visit` with each item whose box comes within `distance`, along every axis, of `around`.
    pub fn meeting(&self, around: &Bounds, distance: f64, mut visit: impl FnMut(usize)) {
        let meets = |b: &Bounds| {
            (b.min - around.max).max_element() <= distance && (around.min - b.max).max_element() <= distance
        };
        self.descend(meets, &mut visit);
    }

    fn descend(&self, enter: impl Fn(&Bounds) -> bool, visit: &mut impl FnMut(usize)) {
        // Median splits keep the depth below 32 for any 32-bit number of items.
        let mut stack = Vec::with_capacity(40);
        if !self.nodes.is_empty() {
            stack.push(0);
        }
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at];
            if !enter(&node.bounds) {
                continue;
            }
            if node.count > 0 {
                let items = node.first as usize..(node.first + node.count) as usize;
                self.items[items].iter().for_each(|i| visit(*i as usize));
            } else {
                stack.push(node.first as usize);
                stack.push(at + 1);
            }
        }
    }
}

fn build(bounds: &[Bounds], items: &mut [u32], range: std::ops::Range<usize>, nodes: &mut Vec<Node>) {
    let part = &mut items[range.clone()];
    let of = |i: u32| bounds[i as usize];
    let all = part.iter().fold(Bounds::EMPTY, |b, i| b.union(of(*i)));
    let at = nodes.len();
    nodes.push(Node { bounds: all, first: range.start as u32, count: range.len() as u32 });
    if range.len() <= LEAF {
        return;
    }
    let centres = Bounds::of(part.iter().map(|i| of(*i).centre()));
    let size = centres.max - centres.min;
    let axis = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |a, b| {
        of(*a).centre()[axis].total_cmp(&of(*b).centre()[axis]).then(a.cmp(b))
    });
    build(bounds, items, range.start..range.start + middle, nodes);
    let right = nodes.len() as u32;
    build(bounds, items, range.start + middle..range.end, nodes);
    nodes[at].first = right;
    nodes[at].count = 0;
}

/// Slab test of the infinite line (Kay & Kajiya 1986).
fn meets_line(b: &Bounds, ray: &Ray, inverse: DVec3, margin: f64) -> bool {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (low, high) = (b.min[axis] - margin - ray.origin[axis], b.max[axis] + margin - ray.origin[axis]);
        if ray.direction[axis] == 0.0 {
            if low > 0.0 || high < 0.0 {
                return false;
            }
        } else {
            let (x, y) = (low * inverse[axis], high * inverse[axis]);
            enter = enter.max(x.min(y));
            leave = leave.min(x.max(y));
        }
    }
    enter <= leave
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_find_the_same_boxes_as_asking_each() {
        let boxes: Vec<Bounds> = (0..200)
            .map(|k| {
                let at = DVec3::new((k * 37 % 50) as f64, (k * 61 % 41) as f64, (k * 13 % 29) as f64);
                Bounds { min: at, max: at + DVec3::new(1.0, (k % 5) as f64, 0.0) }
            })
            .collect();
        let tree = BoundsTree::new(&boxes);
        for k in 0..100 {
            let toward = DVec3::new((k % 7) as f64 - 3.0, (k % 5) as f64 - 2.0, 1.0 - (k % 3) as f64);
            let Some(direction) = toward.try_normalize() else { continue };
            let ray = Ray { origin: DVec3::new(20.0 + k as f64 * 0.1, 20.0, 14.0), direction };
            let mut found = Vec::new();
            tree.along_line(&ray, 0.0, |i| found.push(i));
            found.sort_unstable();
            let each: Vec<usize> =
                (0..boxes.len()).filter(|i| meets_line(&boxes[*i], &ray, direction.recip(), 0.0)).collect();
            // A leaf is reported as a whole, so the tree may name a few more.
            assert!(each.iter().all(|i| found.contains(i)));
            assert!(found.len() < 120);
        }
    }

    #[test]
    fn the_nearest_is_that_of_all_and_few_are_asked() {
        let at = |k: usize| DVec3::new((k * 37 % 50) as f64, (k * 61 % 41) as f64, (k * 13 % 29) as f64);
        let boxes: Vec<Bounds> = (0..200).map(|k| Bounds { min: at(k), max: at(k) + DVec3::ONE }).collect();
        let tree = BoundsTree::new(&boxes);
        let mut asked = 0;
        for k in 0..100 {
            let point = DVec3::new(k as f64 * 0.7 - 10.0, k as f64 * 0.4, 14.5);
            let off = |i: usize| point.distance(at(i) + 0.5);
            let nearest = tree.nearest(point, |i| {
                asked += 1;
                off(i)
            });
            assert_eq!(nearest, (0..boxes.len()).map(off).fold(f64::INFINITY, f64::min));
        }
        assert!(asked < 100 * boxes.len() / 5, "{asked}");
        assert_eq!(BoundsTree::new(&[]).nearest(DVec3::ZERO, |_| 0.0), f64::INFINITY);
    }
}
