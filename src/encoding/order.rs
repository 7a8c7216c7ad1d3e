//! The list of cells to draw, one stretch for each face in the order of the slots.
//!
//! Where two faces are equally deep the one drawn first stays, so the order must not depend on how a scene
//! came about. Stretches have room to spare, filled with [`NO_CELL`]: a face that gets a few more cells
//! by an edit writes a few words. Only when the room is used up are all stretches laid out again.

use std::ops::Range;

use super::arena::Arena;

/// Stands where nothing is to be drawn. Mirror of `NO_CELL` in `shaders/pass/cast.wgsl`.
pub const NO_CELL: u32 = u32::MAX;

/// Cells in drawing order.
#[derive(Debug, Clone, Default)]
pub struct DrawOrder {
    words: Arena<u32>,
    stretches: Vec<Range<u32>>,
}

impl DrawOrder {
    /// Positions of cells, or [`NO_CELL`].
    pub fn words(&mut self) -> &mut Arena<u32> {
        &mut self.words
    }

    /// Draws `cells` for the face in `slot`.
    pub fn set(&mut self, slot: u32, cells: Range<u32>) {
        let slot = slot as usize;
        let end = self.words.data().len() as u32;
        if self.stretches.len() <= slot {
            self.stretches.resize(slot + 1, end..end);
        }
        if cells.len() > self.stretches[slot].len() {
            self.widen(slot, cells.len());
        }
        let stretch = self.stretches[slot].clone();
        let mut values: Vec<u32> = cells.collect();
        values.resize(stretch.len(), NO_CELL);
        self.words.put(stretch.start, &values);
    }

    /// Gives a face room for `count` cells and some more.
    fn widen(&mut self, slot: usize, count: usize) {
        let room = (count + (count / 4).max(4)) as u32;
        if slot + 1 == self.stretches.len() {
            self.stretches[slot].end = self.stretches[slot].start + room;
            return;
        }
        let mut words = Vec::with_capacity(self.words.data().len() + room as usize);
        for (k, stretch) in self.stretches.iter_mut().enumerate() {
            let first = words.len() as u32;
            words.extend_from_slice(&self.words.data()[stretch.start as usize..stretch.end as usize]);
            if k == slot {
                words.resize((first + room) as usize, NO_CELL);
            }
            *stretch = first..words.len() as u32;
        }
        self.words.put(0, &words);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_stay_in_the_order_of_the_slots_through_growth_and_removal() {
        let mut order = DrawOrder::default();
        let mut expected: Vec<Range<u32>> = Vec::new();
        for k in 0..40u32 {
            order.set(k, 10 * k..10 * k + k % 7);
            expected.push(10 * k..10 * k + k % 7);
        }
        for step in 0..200u32 {
            let slot = step * 17 % 40;
            let cells = 1000 * step..1000 * step + step * 7 % 23;
            order.set(slot, cells.clone());
            expected[slot as usize] = cells;
            let drawn: Vec<u32> = order.words().data().iter().copied().filter(|c| *c != NO_CELL).collect();
            assert_eq!(drawn, expected.iter().cloned().flatten().collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_face_with_a_few_more_cells_writes_a_few_words() {
        let mut order = DrawOrder::default();
        (0..1000u32).for_each(|k| order.set(k, 10 * k..10 * k + 5));
        order.words().take_dirty();
        order.set(500, 5000..5007);
        let written: usize = order.words().take_dirty().iter().map(|r| r.len()).sum();
        assert!(written < 24, "{written}");
    }
}
