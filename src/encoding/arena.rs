//! A growing array handed out in ranges: what the GPU sees as one storage buffer.
//!
//! Ranges are taken from the shortest free range that is long enough, else from the end; neighbouring free
//! ranges are always one. Every write is noted as a dirty range, so that an upload sends only what
//! changed, and replacing a range writes only what differs. All steps cost the logarithm of the number of
//! free ranges. Invariant: live ranges and free ranges partition `0..len`.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use bytemuck::NoUninit;

/// Elements in ranges. Freed ranges keep their bytes until they are used again.
#[derive(Debug, Clone)]
pub struct Arena<T> {
    data: Vec<T>,
    /// First element to length.
    free: BTreeMap<u32, u32>,
    /// The same as (length, first element).
    by_length: BTreeSet<(u32, u32)>,
    /// Elements in free ranges.
    free_count: usize,
    /// First element to end, disjoint and not touching.
    dirty: BTreeMap<u32, u32>,
}

impl<T> Default for Arena<T> {
    fn default() -> Self {
        Self {
            data: Vec::new(),
            free: BTreeMap::new(),
            by_length: BTreeSet::new(),
            free_count: 0,
            dirty: BTreeMap::new(),
        }
    }
}

/// Equal stretches shorter than this many bytes between two differences are written again: many small
/// writes cost more than a longer one.
const SHORT_STRETCH: usize = 512;

impl<T: NoUninit> Arena<T> {
    /// All elements, live and free.
    pub fn data(&self) -> &[T] {
        &self.data
    }

    /// Elements in use.
    pub fn live(&self) -> usize {
        self.data.len() - self.free_count
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
        let start = match self.by_length.range((count, 0)..).next().copied() {
            Some((length, start)) => {
                self.unfree(start, length);
                self.free(start + count..start + length);
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

    /// Puts `values` in the place of a live range: in the same place if they fit, and then only what differs
    /// is written.
    pub fn replace(&mut self, range: Range<u32>, values: &[T]) -> Range<u32> {
        let (start, count) = (range.start, values.len() as u32);
        if range.is_empty() || values.is_empty() {
            self.remove(range);
            return self.insert(values);
        }
        let behind = self.free.get(&range.end).copied().unwrap_or(0);
        let at_end = range.end as usize == self.data.len();
        if count > range.len() as u32 + behind && !at_end {
            self.remove(range);
            return self.insert(values);
        }
        let kept = (range.len()).min(values.len());
        self.rewrite(start, &values[..kept]);
        if count > range.len() as u32 {
            let more = &values[kept..];
            if at_end {
                self.data.extend_from_slice(more);
            } else {
                self.unfree(range.end, behind);
                self.free(start + count..range.end + behind);
                self.data[range.end as usize..(start + count) as usize].copy_from_slice(more);
            }
            self.touch(range.end..start + count);
        } else {
            self.remove(start + count..range.end);
        }
        start..start + count
    }

    /// Writes what differs of `values` from `start` on.
    fn rewrite(&mut self, start: u32, values: &[T]) {
        let block = (64 / size_of::<T>().max(1)).max(1);
        let join = (SHORT_STRETCH / size_of::<T>().max(1)).max(1) as u32;
        let mut open: Option<Range<u32>> = None;
        let old = &mut self.data[start as usize..start as usize + values.len()];
        let mut ranges = Vec::new();
        for (k, (old, new)) in old.chunks_mut(block).zip(values.chunks(block)).enumerate() {
            if bytemuck::cast_slice::<T, u8>(old) == bytemuck::cast_slice::<T, u8>(new) {
                continue;
            }
            old.copy_from_slice(new);
            let first = start + (k * block) as u32;
            let end = first + new.len() as u32;
            open = match open.take() {
                Some(range) if first - range.end <= join => Some(range.start..end),
                before => {
                    ranges.extend(before);
                    Some(first..end)
                }
            };
        }
        ranges.extend(open);
        ranges.into_iter().for_each(|range| self.touch(range));
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
            self.unfree(s, l);
            start = s;
        }
        if let Some(length) = self.free.get(&end).copied() {
            self.unfree(end, length);
            end += length;
        }
        self.free(start..end);
    }

    fn free(&mut self, range: Range<u32>) {
        if !range.is_empty() {
            self.free.insert(range.start, range.len() as u32);
            self.by_length.insert((range.len() as u32, range.start));
            self.free_count += range.len();
        }
    }

    fn unfree(&mut self, start: u32, length: u32) {
        if self.free.remove(&start).is_some() {
            self.by_length.remove(&(length, start));
            self.free_count -= length as usize;
        }
    }

    /// Overwrites elements from `start` on, growing the array as far as needed: for arrays whose places are
    /// handed out by someone else.
    pub fn put(&mut self, start: u32, values: &[T]) {
        let kept = (self.data.len() - start as usize).min(values.len());
        self.rewrite(start, &values[..kept]);
        if kept < values.len() {
            self.touch(self.data.len() as u32..start + values.len() as u32);
            self.data.extend_from_slice(&values[kept..]);
        }
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
            self.unfree(start, length);
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
                if pick % 3 == 0 && !live.is_empty() {
                    let at = pick as usize % live.len();
                    let (range, old) = live[at].clone();
                    let range = arena.replace(range, &vec![if add { old } else { k as u32 }; count]);
                    prop_assert_eq!(range.len(), count);
                    live[at] = (range, if add { old } else { k as u32 });
                } else if add || live.is_empty() {
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
                prop_assert_eq!(arena.free_ranges().map(|r| r.len()).sum::<usize>() + held, arena.data().len());
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
