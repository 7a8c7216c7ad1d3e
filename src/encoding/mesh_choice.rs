//! Which pieces of faces a view is drawn from, and what closes the gaps between them.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use super::level::LevelView;
use super::mesh::{Key, MeshScene, Part, Want};
use super::piece::{Halves, WHOLE};
use super::scene::FaceSlot;
use super::seam;
use crate::kernel::face::UvRect;
use crate::kernel::view::Bounds;

/// Whether a piece can be drawn, the better first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Cover {
    Yes,
    NotYet,
    Never,
}

/// A selection under way.
pub(super) struct Choice<'a> {
    held: &'a MeshScene,
    view: &'a LevelView,
    error_px: f64,
    wanted: Vec<Want>,
    keys: Vec<Key>,
}

impl<'a> Choice<'a> {
    pub(super) fn new(held: &'a MeshScene, view: &'a LevelView, error_px: f64) -> Self {
        Self { held, view, error_px, wanted: Vec::new(), keys: Vec::new() }
    }

    /// What is drawn and what is lacking.
    pub(super) fn made(self) -> (Vec<Key>, Vec<Want>) {
        (self.keys, self.wanted)
    }

    /// Chooses for a piece within `bounds`, and wants what it has not.
    pub(super) fn cover(
        &mut self,
        (slot, node): (FaceSlot, u32),
        bounds: &Bounds,
        rect: Option<UvRect>,
    ) -> Cover {
        let Some(level) = self.view.level(bounds, self.error_px) else { return Cover::Yes };
        let divided = self.held.divided.get(&(slot, node));
        let halves = divided.and_then(|d| d.halves);
        let (before, wanted) = (self.keys.len(), self.wanted.len());
        let by_halves = |choice: &mut Self| {
            halves.map_or(Cover::NotYet, |halves| {
                let half = |choice: &mut Self, k: usize| {
                    let piece = &halves.pieces[k];
                    choice.cover((slot, 2 * node + k as u32), &piece.bounds, Some(piece.rect))
                };
                half(choice, 0).max(half(choice, 1))
            })
        };
        if divided.is_some_and(|d| level <= d.level) {
            let found = if halves.is_some() { by_halves(self) } else { Cover::Never };
            if found == Cover::Yes {
                return found;
            }
            self.keys.truncate(before);
            if found == Cover::Never {
                self.wanted.truncate(wanted);
                return found;
            }
        } else if !self.held.parts.contains_key(&(slot, node, level)) {
            self.wanted.push(Want { slot, node, level, rect });
        }
        let parts = &self.held.parts;
        let finer = parts.range((slot, node, i32::MIN)..=(slot, node, level)).next_back();
        let any = finer.or_else(|| parts.range((slot, node, level)..=(slot, node, i32::MAX)).next());
        if let Some((key, _)) = any {
            self.keys.push(*key);
            return Cover::Yes;
        }
        if divided.is_none_or(|d| level <= d.level) {
            return Cover::NotYet;
        }
        // Its halves are there from when it was nearer; they are of no further use.
        let wanted = self.wanted.len();
        let found = by_halves(self);
        self.wanted.truncate(wanted);
        if found == Cover::Yes {
            return found;
        }
        self.keys.truncate(before);
        Cover::NotYet
    }
}

/// Closes the gaps between the selected pieces of one face.
pub(super) struct Seams<'a> {
    held: &'a MeshScene,
    slot: FaceSlot,
    /// Those that are drawn.
    keys: BTreeMap<u32, Key>,
    /// Those of which a part is drawn.
    above: BTreeSet<u32>,
    triangles: Vec<u32>,
}

impl<'a> Seams<'a> {
    pub(super) fn new(held: &'a MeshScene, keys: &[Key]) -> Self {
        let up = |key: &Key| std::iter::successors(Some(key.1 / 2), |n| (*n > WHOLE).then_some(n / 2));
        Self {
            held,
            slot: keys[0].0,
            keys: keys.iter().map(|key| (key.1, *key)).collect(),
            above: keys.iter().flat_map(up).collect(),
            triangles: Vec::new(),
        }
    }

    /// Triangles that close all of them, three vertices each.
    pub(super) fn all(mut self) -> Vec<u32> {
        self.inside(WHOLE);
        self.triangles
    }

    /// Closes the seams inside a piece. Returns what of it is drawn.
    fn inside(&mut self, node: u32) -> Vec<&'a Part> {
        if let Some(key) = self.keys.get(&node) {
            return vec![&self.held.parts[key]];
        }
        let divided = self.held.divided.get(&(self.slot, node)).filter(|_| self.above.contains(&node));
        let Some(Halves { axis, at, .. }) = divided.and_then(|d| d.halves) else { return Vec::new() };
        let (mut low, mut high) = (self.inside(2 * node), self.inside(2 * node + 1));
        let side = |parts: &[&'a Part], k: usize| {
            let line = |part: &&&Part| [part.rect.min, part.rect.max][k][axis] == at;
            let first = |chain: &&[seam::OnLine]| chain.first().map(|v| v.0);
            let mut chains: Vec<_> =
                parts.iter().filter(line).map(|part| part.borders[axis][k].as_slice()).collect();
            chains.sort_by(|a, b| first(a).partial_cmp(&first(b)).unwrap_or(Ordering::Equal));
            chains
        };
        seam::close([&side(&low, 1), &side(&high, 0)], &mut self.triangles);
        low.append(&mut high);
        low
    }
}
