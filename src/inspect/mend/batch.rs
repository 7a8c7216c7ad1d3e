//! Closing all gaps of a model that trims can close, worst first.
//!
//! After each edit the face is inspected again, and the edit is taken back when it has opened another of the face's
//! edges beyond the tolerance and beyond what it was: closing one gap must not make another.

use std::collections::BTreeMap;

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
            let faces = &scene.models[model].faces;
            match close(faces, &edge, &MendOptions { tolerance, side: None, model }) {
                Ok(mended) if try_out(scene, &mut inspection, &mended, model, tolerance)? => {
                    report.closed.push((key, mended.before, mended.after));
                }
                Ok(_) => report.open.push((key, gap, "closing it opens another edge of the face".into())),
                Err(MendError::Closed { .. }) => {}
                Err(error) => report.open.push((key, gap, error.told(millimetres))),
            }
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

/// Applies an edit and keeps it unless it makes another edge worse; whether it was kept.
fn try_out(
    scene: &mut SceneRecord,
    inspection: &mut Inspection,
    mended: &Mended,
    model: usize,
    tolerance: f64,
) -> Result<bool, EditError> {
    let gaps = |inspection: &Inspection| -> BTreeMap<EdgeKey, f64> {
        let of = |k: EdgeKey| inspection.edge(&k).and_then(|e| e.gap).map(|g| (k, g.maximum));
        inspection.edges_of(mended.face).into_iter().filter_map(of).collect()
    };
    let before = gaps(inspection);
    mended.edit.apply(scene)?;
    inspection.update(mended.face, &scene.models[model].faces[mended.face]);
    let after = gaps(inspection);
    let same_edges = before.len() == after.len();
    let worse = after
        .iter()
        .any(|(key, gap)| *gap > tolerance && before.get(key).is_none_or(|old| *gap > old * (1.0 + 1e-6)));
    if same_edges && !worse {
        return Ok(true);
    }
    mended.edit.inverse().apply(scene)?;
    inspection.update(mended.face, &scene.models[model].faces[mended.face]);
    Ok(false)
}
