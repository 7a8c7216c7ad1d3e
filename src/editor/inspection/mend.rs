//! Closing the gap of an edge: one side's trim is fitted to the other side's curve, as one step to undo.
//!
//! The two faces are lent to [`crate::inspect::mend`] by themselves, so that the size of the scene does not matter.
//! Where the surfaces do not meet, trims cannot reach the tolerance: then the gap is closed as far as they allow.
//! What was reached is told once the edges of the face have been measured again, from the figures that the table
//! shows, with any other edge of the face that became worse.

use bevy::prelude::*;

use super::{Chosen, Findings, InspectionChoices};
use crate::editor::editing::{EditRequest, OpenDocument};
use crate::editor::object::FacePlace;
use crate::editor::panels::Notices;
use crate::editor::tools::{Action, CommandRequest};
use crate::inspect::mend::harm::harm_of;
use crate::inspect::mend::{MendError, MendOptions, Mended, close};
use crate::inspect::{Edge, EdgeKey, Length};
use crate::scene::document::SceneRecord;
use crate::scene::records::{FaceRecord, ModelRecord};
use crate::scene::{Change, Document, Edit, FaceId};

/// Tries to close a gap as far as the surfaces allow.
const TRIES: usize = 5;
/// Closing is worth a step when this part of the gap is left at most.
const WORTH: f64 = 0.9;

/// How gaps are to be closed.
#[derive(Resource, Debug, Clone, Copy, PartialEq)]
pub struct MendChoices {
    /// Largest gap that may be left, millimetres.
    pub tolerance: f64,
    /// Whose trim moves: position in the edge's uses; without one the side that comes closest.
    pub side: Option<usize>,
}

impl Default for MendChoices {
    fn default() -> Self {
        Self { tolerance: 1e-4, side: None }
    }
}

/// Asks for the gap of an edge to be closed.
#[derive(Message, Debug, Clone, Copy, PartialEq, Eq)]
pub struct CloseGap(pub EdgeKey);

/// What became of the gap closed last.
#[derive(Resource, Debug, Clone, Default, PartialEq)]
pub struct MendOutcome {
    /// The edge, and what to say about it; until its gap changes again.
    pub last: Option<(EdgeKey, String)>,
    /// Its gap when that was said.
    gap: Option<f64>,
    pending: Option<Pending>,
}

/// A gap whose new figure is still to be measured.
#[derive(Debug, Clone, PartialEq)]
struct Pending {
    edge: EdgeKey,
    /// The face whose trim moves, by its number in the inspection.
    face: usize,
    revision: u64,
    /// Gaps of its edges before, model units.
    before: Vec<(EdgeKey, f64)>,
    /// The tolerance, if it cannot be reached.
    missed: Option<f64>,
}

/// Whether an edge has a gap that can be closed: two sides that do not coincide.
pub fn can_close(edge: &Edge) -> bool {
    edge.uses.len() == 2 && edge.gap.is_some_and(|g| g.maximum > 0.0)
}

/// Works out the edits asked for.
pub(super) fn serve(
    mut commands: MessageReader<CommandRequest>,
    mut requests: MessageReader<CloseGap>,
    findings: Res<Findings>,
    chosen: Res<Chosen>,
    choices: Res<MendChoices>,
    document: OpenDocument,
    places: Query<&FacePlace>,
    mut outcome: ResMut<MendOutcome>,
    mut notices: ResMut<Notices>,
    mut edits: MessageWriter<EditRequest>,
) {
    let by_command = commands.read().any(|c| c.0 == Action::CloseGap).then_some(chosen.edge);
    let keys = requests.read().map(|r| Some(r.0)).chain(by_command);
    // Of several at once only the last: the others may change its faces.
    let Some(key) = keys.last() else { return };
    let Some((key, edge)) = key.and_then(|key| Some((key, findings.edge(&key)?))) else {
        notices.info("Choose an edge in the table of gaps first".into());
        return;
    };
    match mend(edge, &findings, &document, &choices) {
        Ok((mended, missed)) => {
            let face = edge.uses[mended.side].curve.face;
            let gap = |k: EdgeKey| Some((k, findings.edge(&k)?.gap?.maximum));
            let edges = findings.inspection().map(|i| i.edges_of(face)).unwrap_or_default();
            outcome.pending = Some(Pending {
                edge: key,
                face,
                revision: findings.revision,
                before: edges.into_iter().filter_map(gap).collect(),
                missed,
            });
            edits.write(EditRequest::Apply(mended.edit));
        }
        Err(error) => {
            let number = |side: usize| {
                let face = edge.uses.get(side).and_then(|u| findings.face(u.curve.face));
                face.and_then(|f| places.get(f).ok()).map_or(0, |p| p.number)
            };
            let text = words(&error, findings.unit(), choices.side.map(number));
            outcome.last = Some((key, text.clone()));
            outcome.gap = edge.gap.map(|g| g.maximum);
            notices.error(text);
        }
    }
}

/// The edit that closes a gap, addressed to the scene, and the tolerance if it cannot be reached.
fn mend(
    edge: &Edge,
    findings: &Findings,
    document: &OpenDocument,
    choices: &MendChoices,
) -> Result<(Mended, Option<f64>), MendError> {
    let numbers = edge.faces();
    let (mut ids, mut records) = (Vec::new(), Vec::new());
    for number in &numbers {
        let stale = MendError::Stale { face: number + 1 };
        let entity = findings.face(*number).ok_or(stale.clone())?;
        let id = document.id(entity).ok_or(stale.clone())?;
        ids.push(id);
        records.push(document.face(id).ok_or(stale)?.to_record());
    }
    let mut local = edge.clone();
    for one in &mut local.uses {
        one.curve.face = numbers.binary_search(&one.curve.face).unwrap_or_default();
    }
    let wanted = choices.tolerance / findings.unit();
    let sides = choices.side.map_or(vec![0, 1], |side| vec![side.min(1)]);
    let mut best: Option<Mended> = None;
    let mut first_error = None;
    for side in sides {
        let tried = as_far_as_possible(&records, &local, side, wanted);
        match tried.and_then(|mended| harmless(mended, &records, &numbers, findings, document)) {
            Ok(mended) if best.as_ref().is_none_or(|b| mended.after < b.after) => best = Some(mended),
            Ok(_) => {}
            Err(error) => first_error = first_error.or(Some(error)),
        }
        if best.as_ref().is_some_and(|b| b.after <= wanted) {
            break;
        }
    }
    let mut mended = best.ok_or(first_error.unwrap_or(MendError::Partial))?;
    mended.edit = addressed(mended.edit, &ids);
    let missed = (mended.after > wanted).then_some(choices.tolerance);
    Ok((mended, missed))
}

/// Closes to `wanted`, or to a little more than what the surfaces leave if that is worth it.
fn as_far_as_possible(
    faces: &[FaceRecord],
    edge: &Edge,
    side: usize,
    wanted: f64,
) -> Result<Mended, MendError> {
    let mut tolerance = wanted;
    let mut first_error = None;
    for _ in 0..TRIES {
        let error = match close(faces, edge, &MendOptions { tolerance, side: Some(side), model: 0 }) {
            Ok(mended) => return Ok(mended),
            Err(error) => error,
        };
        let (next, gap) = match error {
            MendError::SurfacesApart { left, gap } => (1.05 * left, gap),
            MendError::NotReached { reached, gap } => (1.05 * reached, gap),
            other => return Err(first_error.unwrap_or(other)),
        };
        first_error = first_error.or(Some(error));
        if !(next > tolerance && next < WORTH * gap) {
            break;
        }
        tolerance = next;
    }
    Err(first_error.unwrap_or(MendError::Partial))
}

/// `mended`, unless it would spoil other edges: those of faces that were not lent have to be looked at for that.
fn harmless(
    mended: Mended,
    lent: &[FaceRecord],
    numbers: &[usize],
    findings: &Findings,
    document: &OpenDocument,
) -> Result<Mended, MendError> {
    let stale = MendError::Stale { face: mended.face + 1 };
    let inspection = findings.inspection().ok_or(stale.clone())?;
    let model = ModelRecord { faces: lent.to_vec(), ..ModelRecord::default() };
    let mut scene = SceneRecord { models: vec![model], ..SceneRecord::default() };
    mended.edit.apply(&mut scene).map_err(|_| stale.clone())?;
    let face = *numbers.get(mended.face).ok_or(stale)?;
    let record = |number: usize| Some(document.face(document.id(findings.face(number)?)?)?.to_record());
    match harm_of(inspection, face, &scene.models[0].faces[mended.face], &record) {
        Some(harm) => Err(MendError::Harms { harm }),
        None => Ok(mended),
    }
}

/// The edit for faces of the scene instead of those lent.
fn addressed(mut edit: Edit, ids: &[FaceId]) -> Edit {
    for change in &mut edit.changes {
        if let Change::Curves { face, .. } | Change::Loops { face, .. } = change
            && let Some(id) = ids.get(face.face)
        {
            *face = *id;
        }
    }
    edit
}

/// Tells what was reached, once it is measured.
pub(super) fn report(
    mut outcome: ResMut<MendOutcome>,
    findings: Res<Findings>,
    choices: Res<InspectionChoices>,
    places: Query<&FacePlace>,
    mut notices: ResMut<Notices>,
) {
    let gap = |key: &EdgeKey| findings.edge(key).and_then(|e| e.gap).map(|g| g.maximum);
    // Taken back, or edited since.
    if outcome.last.as_ref().is_some_and(|(key, _)| gap(key) != outcome.gap) {
        outcome.last = None;
    }
    let is_news = |p: &Pending| p.revision != findings.revision;
    let Some(pending) = outcome.pending.as_ref().filter(|p| is_news(p)) else { return };
    let before = pending.before.iter().find(|(key, _)| *key == pending.edge).map(|b| b.1);
    let (Some(before), Some(after)) = (before, gap(&pending.edge)) else {
        outcome.pending = None;
        return;
    };
    if after == before {
        // Another face was measured; this one is on its way.
        return;
    }
    let unit = findings.unit();
    let length = |x: f64| Length { mm: x * unit };
    let number = |face: usize| findings.face(face).and_then(|f| places.get(f).ok()).map_or(0, |p| p.number);
    let mut text = format!(
        "Gap closed from {} to {}; the trim of face {} moved",
        length(before),
        length(after),
        number(pending.face)
    );
    if let Some(wanted) = pending.missed {
        text += &format!(". The surfaces come no closer than that ({} was asked for)", Length { mm: wanted });
    }
    let limit = choices.tolerance / unit;
    let worse = pending.before.iter().filter_map(|(key, old)| {
        let now = gap(key).filter(|now| *key != pending.edge && *now > limit && *now > 1.000001 * old)?;
        Some((key, *old, now))
    });
    if let Some((key, old, now)) = worse.max_by(|a, b| a.2.total_cmp(&b.2)) {
        let other = findings.edge(key).map(Edge::faces).unwrap_or_default();
        let other: Vec<String> = other.into_iter().map(|f| number(f).to_string()).collect();
        text += &format!(
            ". But the edge of faces {} opened from {} to {}",
            other.join(", "),
            length(old),
            length(now)
        );
    }
    let edge = pending.edge;
    notices.info(text.clone());
    *outcome = MendOutcome { last: Some((edge, text)), gap: Some(after), pending: None };
}

/// Why it was not closed. `side`: number of the face that was to move.
fn words(error: &MendError, unit: f64, side: Option<usize>) -> String {
    match error {
        MendError::Sides { sides: 1 } => "A naked edge has no other side to close it to".into(),
        MendError::Partial => match side {
            Some(face) => format!(
                "Only a part of the trim of face {face} lies on this edge: split it at the end of the edge, or let the other side move"
            ),
            None => "Both trims reach beyond this edge: split one at the end of the edge first".into(),
        },
        _ => format!("Nothing was changed: {}", error.told(unit)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_give_lengths_in_units_that_fit() {
        let error = MendError::SurfacesApart { left: 2.5e-3, gap: 7.6e-2 };
        assert!(words(&error, 1.0, None).contains("2.50 um") && words(&error, 1.0, None).contains("76.0 um"));
        assert!(words(&MendError::Closed { gap: 1e-6 }, 25.4, None).contains("25.4 nm"));
        assert!(words(&MendError::Partial, 1.0, Some(12)).contains("face 12"));
    }
}
