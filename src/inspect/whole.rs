//! Curves that coincide as a whole: the usual case, found by hashing.
//!
//! Each curve is entered by the point at half its arc length, in cells as large as its tolerance; those that meet
//! there are compared at five fractions of their arc length, in both directions. Only the first of a group
//! stays in the table, so that a pile of equal curves costs no more than others. Where the file says on which
//! edge of the model curves lie, that decides instead, however far apart they are.

use std::collections::HashMap;

use glam::DVec3;

use super::lifted::LiftedCurve;
use super::scale::Scale;
use crate::kernel::trim::EdgeId;

/// Points by which curves are compared: ends, quarters, middle.
pub type Marks = [DVec3; 5];
type Cell = (i32, [i64; 3]);

/// Groups of curves that coincide as a whole. Curves and groups are numbers; groups of one are groups too.
#[derive(Debug, Clone, Default)]
pub struct Groups {
    cells: HashMap<Cell, Vec<u32>>,
    named: HashMap<EdgeId, u32>,
    groups: Vec<Group>,
    free: Vec<u32>,
    group_of: Vec<Option<u32>>,
}

#[derive(Debug, Clone)]
struct Group {
    members: Vec<u32>,
    marks: Marks,
    tolerance: f64,
    cell: Cell,
    part: Option<usize>,
    edge: Option<EdgeId>,
}

/// The marks of a curve.
pub fn marks(curve: &LiftedCurve) -> Marks {
    let [start, end] = curve.ends();
    let at = |part: f64| curve.at(curve.parameter_at(part * curve.length())).point;
    [start, at(0.25), at(0.5), at(0.75), end]
}

fn agree(a: &Marks, b: &Marks, tolerance: f64) -> bool {
    let near = |i: usize, j: usize| (a[i] - b[j]).length_squared() <= tolerance * tolerance;
    near(2, 2) && ((0..5).all(|k| near(k, k)) || (0..5).all(|k| near(k, 4 - k)))
}

fn may_be_same<T: PartialEq>(a: Option<T>, b: Option<T>) -> bool {
    a.is_none() || b.is_none() || a == b
}

fn cell_size(level: i32) -> f64 {
    // A cell is at least twice the tolerance, so a match lies in one of the eight nearest cells.
    2f64.powi(level + 2)
}

fn cell(p: DVec3, level: i32) -> Cell {
    let at = (p / cell_size(level)).floor();
    (level, [at.x as i64, at.y as i64, at.z as i64])
}

impl Groups {
    /// The curves that coincide with `id`, itself included; empty for one never entered.
    pub fn of(&self, id: u32) -> &[u32] {
        match self.group_of.get(id as usize) {
            Some(Some(group)) => &self.groups[*group as usize].members,
            _ => &[],
        }
    }

    /// The number of the group that `id` is in.
    pub fn number(&self, id: u32) -> Option<u32> {
        self.group_of.get(id as usize).copied().flatten()
    }

    /// Enters a curve with its [`marks`]: into the group it coincides with, else into one of its own.
    pub fn insert(&mut self, id: u32, curve: &LiftedCurve, marks: Marks) {
        let tolerance = Scale::whole(curve);
        if self.group_of.len() <= id as usize {
            self.group_of.resize(id as usize + 1, None);
        }
        let level = tolerance.log2().floor() as i32;
        let named = curve.edge.and_then(|edge| self.named.get(&edge).copied());
        let group = match named.or_else(|| self.find(&marks, tolerance, level, curve)) {
            Some(group) => {
                self.groups[group as usize].members.push(id);
                group
            }
            None => {
                let cell = cell(marks[2], level);
                let new =
                    Group { members: vec![id], marks, tolerance, cell, part: curve.part, edge: curve.edge };
                let group = match self.free.pop() {
                    Some(group) => {
                        self.groups[group as usize] = new;
                        group
                    }
                    None => {
                        self.groups.push(new);
                        self.groups.len() as u32 - 1
                    }
                };
                self.cells.entry(cell).or_default().push(group);
                if let Some(edge) = curve.edge {
                    self.named.insert(edge, group);
                }
                group
            }
        };
        self.group_of[id as usize] = Some(group);
    }

    /// Takes out the group that `id` is in; its members can be entered again.
    pub fn remove_group_of(&mut self, id: u32) -> Vec<u32> {
        let Some(group) = self.group_of.get_mut(id as usize).and_then(Option::take) else {
            return Vec::new();
        };
        let members = std::mem::take(&mut self.groups[group as usize].members);
        for member in &members {
            self.group_of[*member as usize] = None;
        }
        let (cell, edge) = (self.groups[group as usize].cell, self.groups[group as usize].edge);
        if let Some(edge) = edge {
            self.named.remove(&edge);
        }
        self.free.push(group);
        if let Some(list) = self.cells.get_mut(&cell) {
            list.retain(|g| *g != group);
        }
        members
    }

    /// The first group that `curve` coincides with; edges or bodies that are known to differ never do.
    fn find(&self, marks: &Marks, tolerance: f64, level: i32, curve: &LiftedCurve) -> Option<u32> {
        let mut best = None;
        for level in level - 1..=level + 1 {
            let size = cell_size(level);
            let low = cell(marks[2] - 0.5 * size, level).1;
            for k in 0..8 {
                let at = [low[0] + (k & 1), low[1] + (k >> 1 & 1), low[2] + (k >> 2)];
                for group in self.cells.get(&(level, at)).into_iter().flatten() {
                    let other = &self.groups[*group as usize];
                    let fits = may_be_same(curve.part, other.part) && may_be_same(curve.edge, other.edge);
                    if fits && agree(marks, &other.marks, tolerance.max(other.tolerance)) {
                        best = Some(best.map_or(*group, |b: u32| b.min(*group)));
                    }
                }
            }
        }
        best
    }
}
