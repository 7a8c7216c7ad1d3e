//! Closing all gaps of a model that trims can close, worst first.
//!
//! After each edit the face is inspected again, and the edit is taken back when it has opened another of the face's
//! edges beyond the tolerance and beyond what it was, or left a stretch naked or non-manifold: closing one gap must not
//! make another. Then the other side is tried.

use std::collections::BTreeMap;

use super::harm::{Harm, Surroundings};
use super::{MendError, MendOptions, Mended, close};
use crate::inspect::{EdgeKey, Inspection};
use crate::scene::document::SceneRecord;
use crate::scene::edit::EditError;

/// Rounds through all gaps; later ones close what earlier ones moved.
const ROUNDS: usize = 3;

/// What became of the gaps of a model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BatchReport {
    /// Edges closed, with their figures before and after (model units).
    pub closed: Vec<(EdgeKey, f64, f64)>,
    /// Edges that stay open, with their gap and the reason.
    pub open: Vec<(EdgeKey, f64, String)>,
}

/// Closes the gaps of model number `model` of `scene` that exceed `tolerance` (model units).
///
/// # Errors
/// An edit does not fit the scene; that would be an error of this program.
pub fn close_all(scene: &mut SceneRecord, model: usize, tolerance: f64) -> Result<BatchReport, EditError> {
    let Some(record) = scene.models.get(model) else { return Ok(BatchReport::default()) };
    let millimetres = record.unit.millimetres;
    let mut inspection = Inspection::in_unit(&record.faces, millimetres);
    let mut report = BatchReport::default();
    for _ in 0..ROUNDS {
        let before = report.closed.len();
        report.open.clear();
        for key in too_wide(&inspection, tolerance) {
            let Some(edge) = inspection.edge(&key).cloned() else { continue };
            let gap = edge.gap.map_or(0.0, |g| g.maximum);
            if gap <= tolerance {
                continue;
            }
            let mut reason = None;
            for side in 0..2 {
                let faces = &scene.models[model].faces;
                let error = match close(faces, &edge, &MendOptions { tolerance, side: Some(side), model }) {
                    Ok(mended) => match try_out(scene, &mut inspection, &mended, tolerance)? {
                        None => {
                            report.closed.push((key, mended.before, mended.after));
                            reason = None;
                            break;
                        }
                        Some(harm) => harm,
                    },
                    Err(MendError::Closed { .. }) => break,
                    Err(error) => error,
                };
                // That it could be closed, at a price, says more than why the other side cannot.
                if reason.is_none() || matches!(error, MendError::Harms { .. }) {
                    reason = Some(error);
                }
            }
            report.open.extend(reason.map(|error| (key, gap, error.told(millimetres))));
        }
        if report.closed.len() == before {
            break;
        }
    }
    Ok(report)
}

/// The edges with gaps above `tolerance`, the widest first.
fn too_wide(inspection: &Inspection, tolerance: f64) -> Vec<EdgeKey> {
    let gap = |e: &crate::inspect::Edge| e.gap.map_or(0.0, |g| g.maximum);
    let mut found: Vec<(f64, EdgeKey)> =
        inspection.edges().map(|(k, e)| (gap(e), *k)).filter(|(g, _)| *g > tolerance).collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    found.into_iter().map(|(_, key)| key).collect()
}

/// Applies an edit and keeps it unless it makes another edge worse; how it does.
fn try_out(
    scene: &mut SceneRecord,
    inspection: &mut Inspection,
    mended: &Mended,
    tolerance: f64,
) -> Result<Option<MendError>, EditError> {
    let gaps = |inspection: &Inspection| -> BTreeMap<EdgeKey, f64> {
        let of = |k: EdgeKey| inspection.edge(&k).and_then(|e| e.gap).map(|g| (k, g.maximum));
        inspection.edges_of(mended.face).into_iter().filter_map(of).collect()
    };
    let (before, around) = (gaps(inspection), Surroundings::of(inspection, mended.face));
    mended.edit.apply(scene)?;
    inspection.update(mended.face, &scene.models[mended.model].faces[mended.face]);
    let after = gaps(inspection);
    let worse = after
        .iter()
        .any(|(key, gap)| *gap > tolerance && before.get(key).is_none_or(|old| *gap > old * (1.0 + 1e-6)));
    let harm = around.harm(inspection).or((worse || before.len() != after.len()).then_some(Harm::Opens));
    let Some(harm) = harm else { return Ok(None) };
    mended.edit.inverse().apply(scene)?;
    inspection.update(mended.face, &scene.models[mended.model].faces[mended.face]);
    Ok(Some(MendError::Harms { harm }))
}
