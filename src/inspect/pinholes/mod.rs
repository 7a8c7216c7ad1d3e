//! Pin holes on the screen: pixels through which something farther shows between two faces that share an edge.
//!
//! Candidates come from the picture (a nearer surface on both sides, [`crate::reference::holes`]) and, where a gap is
//! wider than a few pixels, from the strip between the two exact curves. Each is proved in f64: its ray must pass the
//! edge within the measured gap and half a pixel, and between the two sides. If the exact surfaces are hit there, the
//! hole is our own solver's, or so near that the picture's rounding shows; else it is real, and the curves tell whether
//! the sides stand apart or overlap.

mod prove;
mod screen;
mod walk;

use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;

use self::prove::{Shown, prove};
use self::screen::Screen;
use self::walk::{Suspect, wide_holes};
use super::{EdgeKey, Inspection};
use crate::encoding::View;
use crate::kernel::face::Face;
use crate::kernel::view::Camera;
use crate::reference::holes::{HoleCandidate, candidates, z_of};
use crate::reference::visibility::VisibilityBuffer;

/// Why a pixel shows through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum HoleClass {
    /// The sides stand apart: across the edge or, seen at a slant, along the normal.
    Gap,
    /// The sides overlap, one above the other, and one looks in between.
    Overlap,
    /// The exact surfaces have no hole there.
    Solver,
    /// They have none there either, and a pixel is finer than [`FINEST_PIXEL`] tells: the picture is rounded.
    Rounding,
}

/// Pictures place points of a face in single precision. A pixel narrower than this part of the face's size shows its
/// rounding.
pub const FINEST_PIXEL: f64 = 5e-7;

/// A proved pin hole.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PinHole {
    /// Column and row from the upper left.
    pub pixel: [u32; 2],
    /// The edge between whose sides one sees.
    pub edge: EdgeKey,
    /// The faces on both sides (positions in the model).
    pub faces: [usize; 2],
    /// The point of the edge nearest to the ray.
    pub point: DVec3,
    /// How far apart the sides are there (model units).
    pub gap: f64,
    /// Why one sees through.
    pub class: HoleClass,
}

/// The edges that two faces share.
#[derive(Debug, Clone, Default)]
pub struct EdgePairs {
    pairs: BTreeMap<(usize, usize), Vec<EdgeKey>>,
}

impl EdgePairs {
    /// Looks at all edges with two sides or more.
    pub fn of(inspection: &Inspection) -> Self {
        let mut pairs: BTreeMap<(usize, usize), Vec<EdgeKey>> = BTreeMap::new();
        for (key, edge) in inspection.edges() {
            for (k, a) in edge.uses.iter().enumerate() {
                for b in &edge.uses[k + 1..] {
                    let (a, b) = (a.curve.face, b.curve.face);
                    let list = pairs.entry((a.min(b), a.max(b))).or_default();
                    if list.last() != Some(key) {
                        list.push(*key);
                    }
                }
            }
        }
        Self { pairs }
    }

    /// The edges between two faces (positions in the model); of a face with itself, its seams.
    pub fn between(&self, a: usize, b: usize) -> &[EdgeKey] {
        self.pairs.get(&(a.min(b), a.max(b))).map_or(&[], Vec::as_slice)
    }
}

/// What holes are found in.
#[derive(Clone, Copy)]
pub struct HoleScene<'a> {
    /// Edges and gaps.
    pub inspection: &'a Inspection,
    /// Which faces share edges.
    pub pairs: &'a EdgePairs,
    /// The face at a position of the model, if it could be derived.
    pub face: &'a (dyn Fn(usize) -> Option<&'a Face> + Sync),
    /// The face (position in the model) in a slot of the packed scene.
    pub face_of_slot: &'a (dyn Fn(u32) -> Option<usize> + Sync),
}

/// All pin holes of a picture, by rows. `view` is what `buffer` was cast with, for `camera`.
pub fn pin_holes(scene: &HoleScene, buffer: &VisibilityBuffer, view: &View, camera: &Camera) -> Vec<PinHole> {
    let shares = |a: u32, b: u32| match ((scene.face_of_slot)(a), (scene.face_of_slot)(b)) {
        (Some(a), Some(b)) => !scene.pairs.between(a, b).is_empty(),
        _ => false,
    };
    let screen = Screen::new(camera, view);
    // A pixel may be suspected of more than one edge, where three faces meet: the first that can be proved counts.
    let mut found: BTreeMap<(u32, u32), Vec<Suspect>> = BTreeMap::new();
    let mut suspect = |suspect: Suspect| {
        let [x, y] = suspect.candidate.pixel;
        let all = found.entry((y, x)).or_default();
        let known = |s: &Suspect| s.candidate.faces == suspect.candidate.faces && s.beyond == suspect.beyond;
        if !all.iter().any(known) {
            all.push(suspect);
        }
    };
    for candidate in candidates(buffer, view, &shares) {
        if let (Some(a), Some(b)) =
            ((scene.face_of_slot)(candidate.faces[0]), (scene.face_of_slot)(candidate.faces[1]))
        {
            let candidate = HoleCandidate { faces: [a as u32, b as u32], ..candidate };
            suspect(Suspect { candidate, beyond: false });
        }
    }
    let edges: Vec<_> = scene.inspection.edges().filter(|(_, edge)| edge.uses.len() > 1).collect();
    let wide: Vec<Suspect> =
        edges.par_iter().flat_map_iter(|(_, edge)| wide_holes(scene, buffer, view, &screen, edge)).collect();
    for beyond in [false, true] {
        wide.iter().filter(|s| s.beyond == beyond).for_each(|s| suspect(*s));
    }
    let shown = |candidate: &HoleCandidate| {
        let here = buffer.at(candidate.pixel[0] as i32, candidate.pixel[1] as i32);
        match here.words[0] {
            0 => Shown { z: f64::INFINITY, face: None },
            word => Shown { z: z_of(view, &here).into(), face: (scene.face_of_slot)(word - 1) },
        }
    };
    let proved =
        |list: &Vec<Suspect>| list.iter().find_map(|s| prove(scene, &screen, s, shown(&s.candidate)));
    found.into_values().collect::<Vec<_>>().par_iter().filter_map(proved).collect()
}
