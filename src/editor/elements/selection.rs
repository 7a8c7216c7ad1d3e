//! Which elements of the active face are selected, and which one is under the pointer.

use std::borrow::Borrow;
use std::collections::BTreeSet;

use bevy::prelude::*;

use super::active::FaceInHand;
use super::element::{Element, PointAddress};
use crate::editor::selection::SelectMode;
use crate::scene::records::LoopRecord;

/// The selected elements of the active face, in order of address.
#[derive(Resource, Debug, Default)]
pub struct ElementSelection {
    /// The face they belong to: the one whose loops can be edited.
    pub face: Option<Entity>,
    set: BTreeSet<Element>,
    /// The element under the pointer, in the uv panel or in 3D.
    pub hovered: Option<Element>,
    /// Counts changes of the selected set.
    pub revision: u64,
}

/// Asks for a change of the selected elements of the active face.
#[derive(Message, Debug, Clone, PartialEq, Eq)]
pub struct ElementRequest {
    /// Elements meant; none with [`SelectMode::Replace`] clears.
    pub elements: Vec<Element>,
    /// What to do with them.
    pub mode: SelectMode,
}

impl ElementSelection {
    /// Whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.set.is_empty()
    }

    /// Whether `element` itself is selected.
    pub fn contains(&self, element: Element) -> bool {
        self.set.contains(&element)
    }

    /// Whether `element` or one that it is part of is selected.
    pub fn covers(&self, element: Element) -> bool {
        if self.set.is_empty() {
            return false;
        }
        let of_curve = element.curve().map(|(trim_loop, curve)| Element::Curve { trim_loop, curve });
        let of_loop = element.trim_loop().map(|trim_loop| Element::Loop { trim_loop });
        [Some(element), of_curve, of_loop].into_iter().flatten().any(|e| self.set.contains(&e))
    }

    /// The selected elements, in order of address.
    pub fn elements(&self) -> impl Iterator<Item = Element> + '_ {
        self.set.iter().copied()
    }

    /// The one selected element, if it is one.
    pub fn only(&self) -> Option<Element> {
        let mut all = self.elements();
        all.next().filter(|_| all.next().is_none())
    }

    /// All control points of trim curves that the selection stands for, each once, in order.
    pub fn points<L: Borrow<LoopRecord>>(&self, loops: &[L]) -> Vec<PointAddress> {
        let all: BTreeSet<PointAddress> = self.set.iter().flat_map(|e| e.points_of(loops)).collect();
        all.into_iter().collect()
    }

    /// Curves selected as such, or whose loop is: loop and curve, in order.
    pub fn curves<L: Borrow<LoopRecord>>(&self, loops: &[L]) -> Vec<(usize, usize)> {
        let all: BTreeSet<(usize, usize)> = self
            .set
            .iter()
            .flat_map(|e| match *e {
                Element::Curve { trim_loop, curve } => vec![(trim_loop, curve)],
                Element::Loop { trim_loop } => {
                    let count = loops.get(trim_loop).map_or(0, |l| l.borrow().curves.len());
                    (0..count).map(|c| (trim_loop, c)).collect()
                }
                _ => Vec::new(),
            })
            .collect();
        all.into_iter().collect()
    }

    /// Whether a curve or anything of it is selected, or its loop is.
    pub fn touches(&self, trim_loop: usize, curve: usize) -> bool {
        let first = Element::Point { trim_loop, curve, point: 0 };
        let last = Element::Point { trim_loop, curve, point: usize::MAX };
        self.covers(Element::Curve { trim_loop, curve }) || self.set.range(first..=last).next().is_some()
    }

    /// Loops of which anything is selected, in order.
    pub fn loops(&self) -> Vec<usize> {
        let all: BTreeSet<usize> = self.set.iter().filter_map(|e| e.trim_loop()).collect();
        all.into_iter().collect()
    }

    /// Selected control points of the surface, in order.
    pub fn surface_points(&self) -> Vec<usize> {
        let point = |e: &Element| match e {
            Element::SurfacePoint { point } => Some(*point),
            _ => None,
        };
        self.set.iter().filter_map(point).collect()
    }

    /// Applies one request; counts it only if something changed.
    pub fn apply(&mut self, elements: &[Element], mode: SelectMode) {
        let before = self.set.clone();
        match mode {
            SelectMode::Replace => self.set = elements.iter().copied().collect(),
            SelectMode::Add => self.set.extend(elements),
            SelectMode::Toggle => {
                for element in elements {
                    if !self.set.remove(element) {
                        self.set.insert(*element);
                    }
                }
            }
        }
        if self.set != before {
            self.revision += 1;
        }
    }

    /// Drops what `face` does not have (any more).
    pub fn prune(&mut self, face: &FaceInHand) {
        let before = self.set.len();
        self.set.retain(|e| e.exists_in(face));
        if self.set.len() != before {
            self.revision += 1;
        }
        self.hovered = self.hovered.filter(|e| e.exists_in(face));
    }

    /// Turns to another face, with nothing selected.
    pub fn turn_to(&mut self, face: Option<Entity>) {
        if self.face != face {
            *self = Self { face, revision: self.revision + 1, ..Self::default() };
        }
    }
}
