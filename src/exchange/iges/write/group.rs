//! Parts as groups (402, form 7), behind all faces and in the order of the parts.

use super::WriteError;
use super::appearance::{label, property};
use super::deck::{Batch, Deck, Entity, Status};
use super::list::{Field, Link};
use crate::scene::records::PartRecord;

/// Writes groups for the parts that hold any of `faces` (directory entry and part of each).
///
/// # Errors
/// [`WriteError::TooLarge`].
pub(crate) fn groups(
    deck: &mut Deck,
    parts: &[PartRecord],
    faces: &[(u64, Option<usize>)],
) -> Result<(), WriteError> {
    // A parent stands before its parts; anything else would be a ring.
    let parent = |part: usize| parts[part].parent.filter(|p| *p < part);
    let mut members: Vec<Vec<Field>> = vec![Vec::new(); parts.len()];
    let mut held = vec![false; parts.len()];
    for (_, part) in faces {
        let mut at = part.filter(|p| *p < parts.len());
        while let Some(part) = at.filter(|p| !held[*p]) {
            held[part] = true;
            at = parent(part);
        }
    }
    let kept: Vec<usize> = (0..parts.len()).filter(|p| held[*p]).collect();
    let mut batch = Batch::default();
    let names: Vec<Option<Link>> = kept.iter().map(|p| property(&mut batch, &parts[*p].name)).collect();
    // The groups follow their names, so where each will be is known before it is made.
    let first = names.iter().flatten().count();
    for (rank, part) in kept.iter().enumerate() {
        if let Some(parent) = parent(*part) {
            members[parent].push(Field::Pointer(Link::Local(first + rank)));
        }
    }
    for (entry, part) in faces {
        if let Some(list) = part.and_then(|p| members.get_mut(p)) {
            list.push(Field::Pointer(Link::Entry(*entry)));
        }
    }
    for (part, name) in kept.iter().zip(names) {
        let list = std::mem::take(&mut members[*part]);
        let status = if parent(*part).is_some() { Status::Member } else { Status::Independent };
        let fields = std::iter::once(Field::Integer(list.len() as i64)).chain(list).collect();
        let mut group = Entity { form: 7, ..Entity::new(402, status, fields) };
        label(&mut group, &parts[*part].name, name);
        batch.push(group);
    }
    deck.append(&[batch]).map(drop)
}
