//! One face by itself: its boundary is divided by its own needs, and again where chords turn out too long.

use std::collections::BTreeMap;

use glam::DVec3;

use super::chords::{STEP, halve_chord, is_common};
use super::mesh::FaceMesh;
use super::options::{TessellateError, TessellationOptions};
use super::simplify::simplify_along;
use super::tessellator::{Boundary, CHORD_SHARE, LongChord, Tessellator};
use crate::kernel::face::Face;

/// Times that too long chords are divided.
const ROUNDS: usize = 6;

/// The mesh of a single face, its boundary divided by its own needs.
///
/// # Errors
/// See [`TessellateError`].
pub fn tessellate(face: &Face, options: &TessellationOptions) -> Result<FaceMesh, TessellateError> {
    tessellate_with(face, options, &|| false)
}

/// The same, given up when `cancelled` says so.
///
/// # Errors
/// See [`TessellateError`].
pub fn tessellate_with(
    face: &Face,
    options: &TessellationOptions,
    cancelled: &dyn Fn() -> bool,
) -> Result<FaceMesh, TessellateError> {
    let tessellator = Tessellator::new(face, options)?;
    let mut boundary = tessellator.own_boundary();
    if options.simplify {
        let longest = options.max_edge.unwrap_or(f64::INFINITY);
        let runs = tessellator.outline().chains.iter().flatten();
        for (samples, run) in boundary.iter_mut().flatten().zip(runs) {
            *samples = simplify_along(run, samples, CHORD_SHARE * options.tolerance, longest);
        }
    }
    let mut parts = BTreeMap::new();
    for _ in 0..ROUNDS {
        let long = tessellator.long_chords(&boundary);
        if long.is_empty() {
            break;
        }
        tessellator.shorten(&mut boundary, &long, &mut parts);
    }
    for _ in 0..ROUNDS {
        let (mesh, long) = tessellator.mesh(&boundary, cancelled)?;
        if long.is_empty() {
            return Ok(mesh);
        }
        tessellator.shorten(&mut boundary, &long, &mut parts);
    }
    tessellator.mesh(&boundary, cancelled).map(|found| found.0)
}

impl Tessellator<'_> {
    /// Divides chords that are too long: a run of which many are is divided anew for a smaller part of the
    /// tolerance (kept in `parts`), so that its chords stay even; else each is halved.
    fn shorten(
        &self,
        boundary: &mut Boundary,
        long: &[LongChord],
        parts: &mut BTreeMap<(usize, usize), f64>,
    ) {
        for group in long.chunk_by(|a, b| (a.chain, a.run) == (b.chain, b.run)) {
            let LongChord { chain, run, .. } = group[0];
            let samples = &mut boundary[chain][run];
            let source = &self.outline().chains[chain][run];
            let crossed = group.iter().any(|c| c.crossed);
            if crossed && samples.iter().any(|s| s.off != DVec3::ZERO) {
                let part = parts.get(&(chain, run)).copied().unwrap_or(1.0);
                *samples = self.divide(source, part, true);
            } else if is_common(group.len(), samples.len() - 1) {
                let part = parts.entry((chain, run)).or_insert(1.0);
                *part *= STEP;
                *samples = self.divide(source, *part, crossed || !self.leaves_room());
            } else {
                for chord in group.iter().rev() {
                    halve_chord(source, samples, chord.index);
                }
            }
        }
    }
}
