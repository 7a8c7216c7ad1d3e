//! All edges of a model with their gaps, kept up to date face by face.
//!
//! Curves are numbered; those that coincide as a whole are found by hashing, the others by a spatial index and
//! pairwise overlaps. Curves that have to do with each other form clusters, and each cluster is worked out by
//! itself, so that after a change only the clusters that the face's curves were in, or are in now, are touched.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::sync::Arc;

use rayon::prelude::*;

use super::arrange::Cluster;
use super::curve_index::CurveIndex;
use super::edge::{CurveAddress, Edge, EdgeKey, EdgeKind, EdgeUse};
use super::face_curves::lift;
use super::lifted::LiftedCurve;
use super::measure::{Stretch, gap};
use super::overlap::{Overlap, overlaps};
use super::scale::Scale;
use super::whole::{Groups, marks};
use crate::kernel::view::Bounds;
use crate::scene::records::FaceRecord;

/// The edges of a model.
#[derive(Debug, Clone)]
pub struct Inspection {
    scale: Scale,
    /// Shared by copies, so that one can be looked at while the other is kept up to date.
    curves: Vec<Option<Arc<LiftedCurve>>>,
    /// Numbers without a curve that nothing refers to.
    free: Vec<u32>,
    /// Numbers given up since the index was built.
    given_up: Vec<u32>,
    of_face: Vec<Vec<u32>>,
    index: CurveIndex,
    groups: Groups,
    /// Overlaps by their first curve.
    overlaps: Vec<Vec<Overlap>>,
    /// Curves that each curve has an overlap with, either way.
    partners: Vec<Vec<u32>>,
    edges: BTreeMap<EdgeKey, Edge>,
    keys: Vec<Vec<EdgeKey>>,
}

impl Inspection {
    /// Inspects `faces`, in millimetres.
    pub fn of(faces: &[FaceRecord]) -> Self {
        Self::in_unit(faces, 1.0)
    }

    /// Inspects `faces`, in a unit that is `millimetres` long.
    pub fn in_unit(faces: &[FaceRecord], millimetres: f64) -> Self {
        Self::with_scale(faces, |size| Scale::new(size, millimetres))
    }

    /// Inspects `faces`; `scale` gives the distances by which neighbours are found, from the size of them all.
    pub fn with_scale(faces: &[FaceRecord], scale: impl FnOnce(f64) -> Scale) -> Self {
        let lifted: Vec<Vec<LiftedCurve>> =
            faces.par_iter().enumerate().map(|(k, face)| lift(k, face)).collect();
        let all = lifted.iter().flatten().fold(Bounds::EMPTY, |b, c| b.union(*c.bounds()));
        let mut of_face = Vec::with_capacity(faces.len());
        let mut curves = Vec::new();
        for face in lifted {
            let first = curves.len() as u32;
            curves.extend(face.into_iter().map(|c| Some(Arc::new(c))));
            of_face.push((first..curves.len() as u32).collect());
        }
        let count = curves.len();
        let mut inspection = Self {
            scale: scale(all.diagonal()),
            index: CurveIndex::new(&curves),
            curves,
            free: Vec::new(),
            given_up: Vec::new(),
            of_face,
            groups: Groups::default(),
            overlaps: vec![Vec::new(); count],
            partners: vec![Vec::new(); count],
            edges: BTreeMap::new(),
            keys: vec![Vec::new(); count],
        };
        let ids: Vec<u32> = (0..count as u32).collect();
        inspection.group(&ids);
        let alone: Vec<u32> = ids.iter().copied().filter(|id| inspection.is_alone(*id)).collect();
        inspection.find_overlaps(&alone);
        inspection.settle(&ids);
        inspection
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.of_face.len()
    }

    /// All edges, by the address of their first use.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = (&EdgeKey, &Edge)> {
        self.edges.iter()
    }

    /// An edge.
    pub fn edge(&self, key: &EdgeKey) -> Option<&Edge> {
        self.edges.get(key)
    }

    /// The edges that the curves of a face are on.
    pub fn edges_of(&self, face: usize) -> Vec<EdgeKey> {
        let keys: BTreeSet<EdgeKey> = self
            .of_face
            .get(face)
            .into_iter()
            .flatten()
            .flat_map(|id| &self.keys[*id as usize])
            .copied()
            .collect();
        keys.into_iter().collect()
    }

    /// The distances by which neighbours are found.
    pub fn scale(&self) -> &Scale {
        &self.scale
    }

    /// The lifted curve at an address.
    pub fn curve(&self, address: &CurveAddress) -> Option<&LiftedCurve> {
        self.id_at(address).and_then(|id| self.at(id))
    }

    /// Takes face number `face` anew from `record` (one past the last adds a face); only edges that it had or has
    /// are worked out again. The distances by which neighbours are found stay as they were.
    pub fn update(&mut self, face: usize, record: &FaceRecord) {
        if face > self.of_face.len() {
            return;
        }
        if face == self.of_face.len() {
            self.of_face.push(Vec::new());
        }
        self.replace(face, lift(face, record));
    }

    /// Takes the curves of a face away; its number stays.
    pub fn clear(&mut self, face: usize) {
        if face < self.of_face.len() {
            self.replace(face, Vec::new());
        }
    }

    fn replace(&mut self, face: usize, new: Vec<LiftedCurve>) {
        let old = std::mem::take(&mut self.of_face[face]);
        let mut touched: BTreeSet<u32> = BTreeSet::new();
        for id in &old {
            touched.extend(self.partners[*id as usize].iter());
            touched.extend(self.groups.remove_group_of(*id));
            self.unlink(*id);
        }
        for id in &old {
            touched.remove(id);
            self.drop_edges(*id, &mut touched);
            self.curves[*id as usize] = None;
            self.given_up.push(*id);
        }
        old.iter().for_each(|id| {
            touched.remove(id);
        });
        let ids: Vec<u32> = new.into_iter().map(|curve| self.add(curve)).collect();
        self.of_face[face] = ids.clone();
        // Groups that lost or may get a member are formed again.
        let mut again: BTreeSet<u32> = ids.iter().copied().collect();
        again.extend(touched.iter().copied().filter(|id| self.groups.of(*id).is_empty()));
        let before: Vec<u32> = again.iter().copied().collect();
        self.group(&before);
        let mut entered: HashSet<u32> = HashSet::new();
        for id in &before {
            if self.groups.number(*id).is_some_and(|group| entered.insert(group)) {
                again.extend(self.groups.of(*id));
                touched.extend(self.groups.of(*id));
            }
        }
        for id in &again {
            touched.extend(self.partners[*id as usize].iter());
            self.unlink(*id);
        }
        let alone: Vec<u32> = again.iter().copied().filter(|id| self.is_alone(*id)).collect();
        self.find_overlaps(&alone);
        // A pair that was passed over as long as both were in groups is looked at from the one that left.
        touched.extend(again);
        let all: Vec<u32> = touched.into_iter().collect();
        self.settle(&all);
    }

    fn add(&mut self, curve: LiftedCurve) -> u32 {
        let id = match self.free.pop() {
            Some(id) => id,
            None => {
                self.curves.push(None);
                self.overlaps.push(Vec::new());
                self.partners.push(Vec::new());
                self.keys.push(Vec::new());
                self.curves.len() as u32 - 1
            }
        };
        self.curves[id as usize] = Some(Arc::new(curve));
        if self.index.insert(id, &self.curves) {
            self.free.append(&mut self.given_up);
        }
        id
    }

    fn at(&self, id: u32) -> Option<&LiftedCurve> {
        self.curves[id as usize].as_deref()
    }

    fn address(&self, id: u32) -> Option<CurveAddress> {
        self.at(id).map(|c| c.address)
    }

    fn is_alone(&self, id: u32) -> bool {
        self.groups.of(id).len() < 2
    }

    /// Enters curves into groups, in the order of their addresses.
    fn group(&mut self, ids: &[u32]) {
        let mut ids = ids.to_vec();
        ids.sort_by_key(|id| self.address(*id));
        let curve = |id: u32| self.at(id).filter(|c| !c.is_degenerate());
        let found: Vec<_> =
            ids.par_iter().with_min_len(256).map(|id| Some((*id, marks(curve(*id)?)))).collect();
        for (id, marks) in found.into_iter().flatten() {
            if let Some(curve) = self.curves[id as usize].as_deref() {
                self.groups.insert(id, curve, marks);
            }
        }
    }

    /// Finds and enters the overlaps of curves that coincide with no other as a whole.
    fn find_overlaps(&mut self, alone: &[u32]) {
        let found: Vec<Vec<Overlap>> = alone.par_iter().map(|id| self.overlaps_of(*id)).collect();
        for overlap in found.into_iter().flatten() {
            let [a, b] = overlap.curves;
            self.overlaps[a as usize].push(overlap);
            for (x, y) in [(a, b), (b, a)] {
                let partners = &mut self.partners[x as usize];
                if !partners.contains(&y) {
                    partners.push(y);
                }
            }
        }
    }

    /// Overlaps of `id` with the first of each group near it; with those alone too it is looked at once.
    fn overlaps_of(&self, id: u32) -> Vec<Overlap> {
        let Some(curve) = self.at(id).filter(|c| !c.is_degenerate()) else { return Vec::new() };
        let reach = self.scale.reach(curve);
        let mut near = Vec::new();
        self.index.near(curve.bounds(), reach, &self.curves, |other| {
            let group = self.groups.of(other);
            let leads = group.first() == Some(&other);
            let mine = group.len() > 1 || self.address(id) < self.address(other);
            // Edges of the model that are complete are left to themselves.
            let edge = self.at(other).and_then(|c| c.edge);
            let leads =
                leads && !(group.len() > 1 && edge.is_some() && curve.edge.is_some() && edge != curve.edge);
            if other != id && leads && (mine || !self.partners[other as usize].contains(&id)) {
                near.push(other);
            }
        });
        near.sort_by_key(|other| self.address(*other));
        let pair = |other: &u32| self.at(*other).map(|b| overlaps(curve, b, [id, *other], &self.scale));
        near.iter().filter_map(pair).flatten().collect()
    }

    /// Forgets the overlaps of a curve.
    fn unlink(&mut self, id: u32) {
        self.overlaps[id as usize].clear();
        for partner in std::mem::take(&mut self.partners[id as usize]) {
            self.partners[partner as usize].retain(|p| *p != id);
            self.overlaps[partner as usize].retain(|o| o.curves[1] != id);
        }
    }

    /// Removes the edges that a curve is on; the other curves on them are put into `touched`.
    fn drop_edges(&mut self, id: u32, touched: &mut BTreeSet<u32>) {
        for key in std::mem::take(&mut self.keys[id as usize]) {
            let Some(edge) = self.edges.remove(&key) else { continue };
            for other in edge.uses {
                if let Some(other) = self.id_at(&other.curve).filter(|o| *o != id) {
                    self.keys[other as usize].retain(|k| *k != key);
                    touched.insert(other);
                }
            }
        }
    }

    fn id_at(&self, address: &CurveAddress) -> Option<u32> {
        let of_face = self.of_face.get(address.face)?;
        // Numbers of a face are in the order of its curves.
        let at = of_face.binary_search_by(|id| self.address(*id).as_ref().cmp(&Some(address))).ok()?;
        of_face.get(at).copied()
    }

    /// Works out the clusters that `ids` are in.
    fn settle(&mut self, ids: &[u32]) {
        let mut seen = vec![false; self.curves.len()];
        let mut entered: HashSet<u32> = HashSet::new();
        let mut clusters: Vec<Vec<u32>> = Vec::new();
        for id in ids.iter().copied().filter(|id| self.at(*id).is_some()) {
            if seen[id as usize] {
                continue;
            }
            seen[id as usize] = true;
            let mut cluster = vec![id];
            let mut next = 0;
            while let Some(at) = cluster.get(next).copied() {
                next += 1;
                // A group is entered as a whole, by whoever is met first.
                let new = self.groups.number(at).is_some_and(|group| entered.insert(group));
                let group = if new { self.groups.of(at) } else { &[] };
                let mates = group.iter().chain(&self.partners[at as usize]);
                cluster.extend(mates.filter(|m| !std::mem::replace(&mut seen[**m as usize], true)));
            }
            cluster.sort_by_key(|id| self.address(*id));
            clusters.push(cluster);
        }
        let mut ignored = BTreeSet::new();
        for id in clusters.iter().flatten() {
            self.drop_edges(*id, &mut ignored);
        }
        let made: Vec<Vec<Edge>> = clusters.par_iter().map(|cluster| self.work_out(cluster)).collect();
        for edge in made.into_iter().flatten() {
            self.enter(edge);
        }
    }

    fn work_out(&self, ids: &[u32]) -> Vec<Edge> {
        let curves: Vec<&LiftedCurve> = ids.iter().filter_map(|id| self.at(*id)).collect();
        let places: HashMap<u32, usize> = ids.iter().enumerate().map(|(k, id)| (*id, k)).collect();
        let mut found = Vec::new();
        let mut wholes = Vec::new();
        for (k, id) in ids.iter().enumerate() {
            for overlap in &self.overlaps[*id as usize] {
                let Some(other) = places.get(&overlap.curves[1]) else { continue };
                found.push(Overlap { curves: [k as u32, *other as u32], ..*overlap });
            }
            let group = self.groups.of(*id);
            if group.len() > 1 && group[0] == *id {
                let mut members: Vec<usize> = group.iter().filter_map(|m| places.get(m).copied()).collect();
                members.sort_unstable();
                wholes.push(members);
            }
        }
        let cluster = Cluster { curves, overlaps: found, wholes, reach: self.scale.reach };
        let mut edges = cluster.edges();
        for edge in &mut edges {
            self.measure(edge);
        }
        edges
    }

    /// Fills in the gap of an edge.
    fn measure(&self, edge: &mut Edge) {
        let stretch = |u: &EdgeUse| self.curve(&u.curve).map(|curve| Stretch { curve, range: u.interval });
        let Some((lead, others)) = edge.uses.split_first() else { return };
        let Some(lead) = stretch(lead).filter(|_| edge.kind != EdgeKind::Degenerate) else { return };
        for (k, other) in others.iter().enumerate() {
            let Some(side) = stretch(other) else { continue };
            let found = gap(lead, side, other.forward, [0, k + 1]);
            if edge.gap.is_none_or(|worst| found.maximum > worst.maximum) {
                edge.gap = Some(found);
            }
        }
    }

    fn enter(&mut self, edge: Edge) {
        let Some(first) = edge.uses.first() else { return };
        // Edges of one curve come by rising parameter.
        let mut key = EdgeKey { curve: first.curve, position: 0 };
        while self.edges.contains_key(&key) {
            key.position += 1;
        }
        for one in &edge.uses {
            if let Some(id) = self.id_at(&one.curve).filter(|id| !self.keys[*id as usize].contains(&key)) {
                self.keys[id as usize].push(key);
            }
        }
        self.edges.insert(key, edge);
    }
}
