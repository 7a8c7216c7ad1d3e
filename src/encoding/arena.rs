//! A growing array handed out in ranges: what the GPU sees as one storage buffer.
//!
//! Ranges are taken first-fit from a free list kept sorted and coalesced (neighbouring free ranges are
//! always one), else from the end. Every write is noted as a dirty range, so that an upload sends only
//! what changed. Invariant: live ranges and free ranges partition `0..len`.

use std::collections::BTreeMap;
use std::ops::Range;

/// Elements in ranges. Freed ranges keep their bytes until they are used again.
#[derive(Debug, Clone)]
pub struct Arena<T> {
    data: Vec<T>,
    /// First element to length.
    free: BTreeMap<u32, u32>,
    /// First element to end, disjoint and not touching.
    dirty: BTreeMap<u32, u32>,
}

impl<T> Default for Arena<T> {
    fn default() -> Self {
        Self { data: Vec::new(), free: BTreeMap::new(), dirty: BTreeMap::new() }
    }
}

impl<T: Copy> Arena<T> {
    /// All elements, live and free.
    pub fn data(&self) -> &[T] {
        &self.data
    }

    /// Elements in use.
    pub fn live(&self) -> usize {
        self.data.len() - self.free.values().map(|n| *n as usize).sum::<usize>()
    }

    /// Free ranges in order.
    pub fn free_ranges(&self) -> impl Iterator<Item = Range<u32>> + '_ {
        self.free.iter().map(|(start, length)| *start..*start + *length)
    }

    /// Copies `values` into a free range. An empty slice gives an empty range at 0.
    pub fn insert(&mut self, values: &[T]) -> Range<u32> {
        if values.is_empty() {
            return 0..0;
        }
        let count = values.len() as u32;
        let hole = self.free.iter().find(|(_, length)| **length >= count).map(|(s, l)| (*s, *l));
        let start = match hole {
            Some((start, length)) => {
                self.free.remove(&start);
                if length > count {
                    self.free.insert(start + count, length - count);
                }
                self.data[start as usize..(start + count) as usize].copy_from_slice(values);
                start
            }
            None => {
                // A free range at the very end is grown instead of left behind.
                let start = self.take_tail().unwrap_or(self.data.len() as u32);
                self.data.truncate(start as usize);
                self.data.extend_from_slice(values);
                start
            }
        };
        self.touch(start..start + count);
        start..start + count
    }

    /// Gives a range back. It must be one that `insert` returned and that was not removed yet.
    pub fn remove(&mut self, range: Range<u32>) {
        let (mut start, mut end) = (range.start, range.end);
        if start == end {
            return;
        }
        if let Some((s, l)) = self.free.range(..start).next_back().map(|(s, l)| (*s, *l))
            && s + l == start
        {
            self.free.remove(&s);
            start = s;
        }
        if let Some(length) = self.free.remove(&end) {
            end += length;
        }
        self.free.insert(start, end - start);
    }

    /// Overwrites one element of a live range.
    pub fn set(&mut self, index: u32, value: T) {
        self.data[index as usize] = value;
        self.touch(index..index + 1);
    }

    /// Takes the ranges written since the last call, in order.
    pub fn take_dirty(&mut self) -> Vec<Range<u32>> {
        let length = self.data.len() as u32;
        let dirty = std::mem::take(&mut self.dirty);
        dirty.into_iter().map(|(s, e)| s..e.min(length)).filter(|r| r.start < r.end).collect()
    }

    /// Marks everything as written: after the buffer was made anew.
    pub fn touch_all(&mut self) {
        self.dirty.clear();
        if !self.data.is_empty() {
            self.dirty.insert(0, self.data.len() as u32);
        }
    }

    fn take_tail(&mut self) -> Option<u32> {
        let (start, length) = self.free.last_key_value().map(|(s, l)| (*s, *l))?;
        (start + length == self.data.len() as u32).then(|| {
            self.free.remove(&start);
            start
        })
    }

    fn touch(&mut self, range: Range<u32>) {
        let (mut start, mut end) = (range.start, range.end);
        let overlapping: Vec<u32> =
            self.dirty.range(..=end).rev().take_while(|(_, e)| **e >= start).map(|(s, _)| *s).collect();
        for key in overlapping {
            if let Some(e) = self.dirty.remove(&key) {
                start = start.min(key);
                end = end.max(e);
            }
        }
        self.dirty.insert(start, end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn edits_never_leak_or_overlap(steps in prop::collection::vec((any::<u16>(), 0usize..40, any::<bool>()), 1..400)) {
            let mut arena = Arena::default();
            let mut live: Vec<(Range<u32>, u32)> = Vec::new();
            let mut mirror: Vec<u32> = Vec::new();
            for (k, (pick, count, add)) in steps.into_iter().enumerate() {
                if add || live.is_empty() {
                    let range = arena.insert(&vec![k as u32; count]);
                    prop_assert_eq!(range.len(), count);
                    live.push((range, k as u32));
                } else {
                    let (range, _) = live.swap_remove(pick as usize % live.len());
                    arena.remove(range);
                }
                for range in arena.take_dirty() {
                    mirror.resize(mirror.len().max(range.end as usize), 0);
                    let (a, b) = (range.start as usize, range.end as usize);
                    mirror[a..b].copy_from_slice(&arena.data()[a..b]);
                }
                for (range, value) in &live {
                    prop_assert!(mirror[range.start as usize..range.end as usize].iter().all(|v| v == value));
                }
                let held: usize = live.iter().map(|(r, _)| r.len()).sum();
                prop_assert_eq!(arena.live(), held);
                let free: Vec<_> = arena.free_ranges().collect();
                prop_assert!(free.windows(2).all(|w| w[0].end < w[1].start));
            }
            for (range, _) in live {
                arena.remove(range);
            }
            prop_assert_eq!(arena.live(), 0);
            prop_assert!(arena.free_ranges().count() <= 1);
        }
    }
}
