//! The union of many boxes, kept while single ones change: a binary tree of unions in one array.
//!
//! Changing one box walks from its leaf to the root, so that the box around 50,000 faces costs sixteen
//! unions per edit. Invariant: node `k` is the union of nodes `2k` and `2k + 1`; the leaves are the upper half.

use crate::kernel::view::Bounds;

/// Boxes by position, and their union.
#[derive(Debug, Clone)]
pub(super) struct BoundsTree {
    /// Node 1 is the root; leaf `i` is node `leaves + i`.
    nodes: Vec<Bounds>,
    leaves: usize,
}

impl Default for BoundsTree {
    fn default() -> Self {
        Self { nodes: vec![Bounds::EMPTY; 2], leaves: 1 }
    }
}

impl BoundsTree {
    /// The union of all boxes.
    pub fn all(&self) -> Bounds {
        self.nodes[1]
    }

    /// Sets the box at a position; an empty box removes it.
    pub fn set(&mut self, index: usize, bounds: Bounds) {
        if index >= self.leaves {
            self.grow(index + 1);
        }
        let mut node = self.leaves + index;
        self.nodes[node] = bounds;
        while node > 1 {
            node /= 2;
            let union = self.nodes[2 * node].union(self.nodes[2 * node + 1]);
            if union == self.nodes[node] {
                break;
            }
            self.nodes[node] = union;
        }
    }

    fn grow(&mut self, count: usize) {
        let leaves = count.next_power_of_two();
        let mut nodes = vec![Bounds::EMPTY; 2 * leaves];
        nodes[leaves..leaves + self.leaves].copy_from_slice(&self.nodes[self.leaves..]);
        for node in (1..leaves).rev() {
            nodes[node] = nodes[2 * node].union(nodes[2 * node + 1]);
        }
        (self.nodes, self.leaves) = (nodes, leaves);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn the_root_is_the_union(steps in prop::collection::vec((0usize..300, prop::option::of(-9.0..9.0f64)), 1..200)) {
            let mut tree = BoundsTree::default();
            let mut plain = vec![Bounds::EMPTY; 300];
            for (index, place) in steps {
                let bounds = place.map_or(Bounds::EMPTY, |x| Bounds::of([DVec3::splat(x), DVec3::splat(x + 1.0)]));
                tree.set(index, bounds);
                plain[index] = bounds;
                let union = plain.iter().fold(Bounds::EMPTY, |a, b| a.union(*b));
                prop_assert_eq!(tree.all(), union);
            }
        }
    }
}
